#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/geo.hpp"
#include "core/ocean/analytic.hpp"

namespace glidehelm::test {

/// Numbers from 0 to 1, the same on every machine (xorshift64*). The state must not be 0.
struct Dice {
  std::uint64_t state;
  double roll() {
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return static_cast<double>((state * 2685821657736338717ULL) >> 11) * 0x1p-53;
  }
  double between(double a, double b) { return a + (b - a) * roll(); }
};

/// A mean current (`east`, `north`, m/s) and fourteen eddies within 90 km of `origin`, the fastest flow of each between half of
/// `speed` and all of it, on a ring of 12 to 28 km (Thesis 5.6). The same dice, the same sea.
inline std::vector<ocean::AnalyticSpec> random_sea(Dice dice, GeoPoint origin, double speed, double east,
                                                   double north) {
  ocean::AnalyticSpec hills, mean;
  hills.kind = "gaussians";
  mean.kind = "constant";
  hills.origin = mean.origin = origin;
  hills.length_scale = Metres{1000};
  hills.speed_scale = MetresPerSecond{1};
  for (int i = 0; i < 14; ++i) {
    const double s = dice.between(12, 28);  // km; |grad| of w·N is w/(2π s³)·e^(−1/2) at r = s
    const double w =
        (dice.roll() < 0.5 ? -1 : 1) * dice.between(0.5, 1.0) * speed * 2 * kPi * s * s * s / std::exp(-0.5);
    hills.gaussians.push_back({w, dice.between(-90, 90), dice.between(-90, 90), s * s, 0, s * s, 0, 0});
  }
  mean.params = {{"u", east}, {"v", north}};
  return {hills, mean};
}

}  // namespace glidehelm::test
