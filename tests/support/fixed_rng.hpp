#pragma once

#include "daemon/world/rng.hpp"

namespace glidehelm::test {

/// The same numbers for the same seed (SplitMix64).
class FixedRng final : public world::Rng {
 public:
  explicit FixedRng(std::uint64_t seed = 1) : state_{seed} {}
  std::uint64_t next() override {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// In [0, n).
  std::uint64_t below(std::uint64_t n) { return next() % n; }
  bool coin() { return (next() >> 63) != 0; }

 private:
  std::uint64_t state_;
};

}  // namespace glidehelm::test
