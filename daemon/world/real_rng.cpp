#include "daemon/world/real_rng.hpp"

#include <sys/random.h>

#include <cstdlib>

namespace glidehelm::world {

std::uint64_t RealRng::next() {
  std::uint64_t value{};
  if (getrandom(&value, sizeof value, 0) != static_cast<ssize_t>(sizeof value))
    std::abort();  // cannot happen for 8 bytes
  return value;
}

}  // namespace glidehelm::world
