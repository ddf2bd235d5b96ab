#pragma once

#include "daemon/world/rng.hpp"

namespace glidehelm::world {

/// getrandom(2).
class RealRng final : public Rng {
 public:
  std::uint64_t next() override;
};

}  // namespace glidehelm::world
