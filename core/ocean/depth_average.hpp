#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/units.hpp"
#include "core/ocean/grid_format.hpp"

namespace glidehelm::ocean {

/// How much time a glider spends at which depth: the density is `above` between the surface and `upper`, and `below`
/// between `upper` and `lower` (any common scale).
struct DiveProfile {
  Metres upper{20}, lower{200};
  double above{1}, below{1};

  /// The yo-yo of Thesis 2.12–2.14: the outer dives cross [0, climb_to] once down and once up, the n yos of a stint cross
  /// [climb_to, dive_depth] 2n times, all at the same vertical speed, so time is proportional to distance and the
  /// densities are 2 and 2n. n follows from 2.14 solved for n, T_u·w = 2·(dive_depth + (n − 1)·(dive_depth − climb_to)),
  /// with the vertical speed w = horizontal · tan(glide angle) (2.13 with the two speeds kept apart, seeds/README.md); n
  /// is a mean, not rounded. A stint too short to reach dive_depth turns at w·T_u/2 with n = 1.
  /// Precondition: 0 ≤ climb_to < dive_depth, 0 < glide angle < π/2, positive speed and stint.
  static DiveProfile of_stint(Metres climb_to, Metres dive_depth, MetresPerSecond horizontal, Radians glide_angle,
                              Seconds stint);
  /// The plain mean between two depths.
  static DiveProfile between(Metres upper, Metres lower) { return {upper, lower, 0, 1}; }
  /// The same glider where it turns at `depth` already (by altimeter): it sinks and climbs as far in the same time, so the
  /// integral of the density stays; more yos share the water between `upper` and `depth`. Where `depth` is not below
  /// `upper` the whole time is spent evenly above it. Unchanged when `depth` is at or below `lower`. Precondition:
  /// depth > 0.
  [[nodiscard]] DiveProfile turned_at(Metres depth) const;
  friend bool operator==(const DiveProfile&, const DiveProfile&) = default;
};

/// The weights with which the levels of a column enter its mean over `profile`, when the column has water down to the
/// level `wet − 1`: the exact integral of the piecewise linear current (the first level's value above it) against the
/// profile's density, over the part of the profile that lies in the water, divided by the integral of the density. The
/// weights sum to 1. Empty when the profile has no time in that part of the column. Precondition: 0 < wet ≤ depths.size().
std::vector<double> column_weights(std::span<const double> depths_m, std::size_t wet, const DiveProfile& profile);

/// Depth in metres at which a glider turns at a position (radians) because the bottom is near; not finite or not positive:
/// unknown, the profile is flown in full.
using TurningDepth = std::function<double(double lat, double lon)>;

/// The mean current over a dive, column by column, as a grid without depths: what moves a diving glider in two
/// dimensions. A column ends at its first dry level (the glider turns at the bottom); a column without water, or without
/// any part of the profile in its water, has no value. A grid with one level is returned as it is. Time and space are
/// left alone. With `turning`, each column is averaged over the profile turned there. O(values).
Grid depth_average(const GridView& grid, const DiveProfile& profile, const TurningDepth& turning = {});

}  // namespace glidehelm::ocean
