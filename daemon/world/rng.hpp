#pragma once

#include <cstdint>

namespace glidehelm::world {

/// Randomness for what must differ between processes (back-off jitter, scratch names). Planners take seeds instead.
class Rng {
 public:
  virtual ~Rng() = default;
  virtual std::uint64_t next() = 0;
};

}  // namespace glidehelm::world
