#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/units.hpp"

namespace glidehelm::simulator {

/// The simulator's own generator (SplitMix64) and distributions: the same seed gives the same world on every machine
/// and with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_{seed} {}

  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }
  /// In [0, 1), 53 bits.
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Box–Muller, one of the pair).
  double normal() {
    const double u = 1.0 - uniform();  // in (0, 1]
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * kPi * uniform());
  }
  /// An independent generator for a named purpose: what one part draws never shifts what another part sees.
  [[nodiscard]] Random stream(std::uint64_t purpose) const {
    Random r{state_ ^ (purpose * 0xd1342543de82ef95ULL + 0x2545f4914f6cdd1dULL)};
    r.next();
    return r;
  }

 private:
  std::uint64_t state_;
};

}  // namespace glidehelm::simulator
