#pragma once

#include <cstdint>

namespace glidehelm::planning {

/// Numbers in [0, 1) that depend on seed, stream and position alone (SplitMix64).
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint64_t stream) : state_{seed * kStep} {
    state_ ^= static_cast<std::uint64_t>(next() * 0x1p53);  // mixes the seed before the stream is added
    state_ += stream * 0xd1342543de82ef95ULL;
  }
  double next() {
    std::uint64_t z = state_ += kStep;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ULL;
  std::uint64_t state_;
};

}  // namespace glidehelm::planning
