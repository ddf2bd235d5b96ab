#pragma once

#include <cmath>

#include "core/base/geo.hpp"
#include "core/base/units.hpp"

namespace glidehelm {

/// Sine and cosine of one angle, which is in radians.
struct SineCosine {
  double sine{}, cosine{};
  static SineCosine of(double angle) { return {std::sin(angle), std::cos(angle)}; }
};

/// Sines and cosines of angles near one of them, by a series: for loops that ask at every step while the angle changes little.
///
/// Within `kReach` of the first angle the same as the library's to 1e-15 (the first term that is left out is kReach⁷/7!); farther off they are the
/// library's. Radians.
class AnglesNear {
 public:
  explicit AnglesNear(double angle) : angle_{angle}, at_{SineCosine::of(angle)} {}
  [[nodiscard]] SineCosine at(double angle) const {
    const double d = angle - angle_, d2 = d * d;
    if (!(d2 <= kReach * kReach)) return SineCosine::of(angle);
    const double sine = d * (1 - d2 / 6 * (1 - d2 / 20)), cosine = 1 - d2 / 2 * (1 - d2 / 12 * (1 - d2 / 30));
    return {at_.sine * cosine + at_.cosine * sine, at_.cosine * cosine - at_.sine * sine};
  }
  static constexpr double kReach = 0.02;  ///< 127 km of latitude

 private:
  double angle_;
  SineCosine at_;
};

/// The WGS84 metric at one latitude: what an inner loop multiplies with instead of solving geodesics.
///
/// dφ = north / M(φ), dλ = east / (N(φ) cos φ), evaluated at the *current* latitude at every step (a frame or a sphere
/// fixed at the start is not enough). Over one stint of 30 km, integrated with the midpoint rule, this agrees with
/// GeographicLib to 1e-4 at every latitude to 80° and across the antimeridian (tests/core/base/local_metric_test.cpp).
struct LocalMetric {
  double meridian_radius;  ///< M(φ), metres per radian of latitude
  double parallel_radius;  ///< N(φ)·cos φ, metres per radian of longitude

  static LocalMetric at(double lat_rad) { return of(SineCosine::of(lat_rad)); }
  /// Of a latitude whose sine and cosine are known.
  static LocalMetric of(SineCosine lat) {
    const double w2 = 1.0 - kEccentricity2 * lat.sine * lat.sine;
    const double w = std::sqrt(w2);
    const double n = kEquatorialRadius / w;
    return {n * (1.0 - kEccentricity2) / w2, n * lat.cosine};
  }

  static constexpr double kEquatorialRadius = 6378137.0;
  static constexpr double kFlattening = 1.0 / 298.257223563;
  static constexpr double kEccentricity2 = kFlattening * (2.0 - kFlattening);
};

/// A displacement in metres of east and north.
struct Offset {
  double east, north;
  [[nodiscard]] double length() const { return std::hypot(east, north); }
};

/// From one longitude to another the shorter way round, radians.
inline double longitude_difference(double from, double to) {
  const double difference = to - from;
  return difference > kPi || difference < -kPi ? std::remainder(difference, 2 * kPi) : difference;
}

/// Straight-line offset between two near positions with the metric at their middle latitude; the longitude difference
/// is folded. Error below 1e-4 of the length up to 50 km at latitudes to 80°. Radians in, metres out.
inline Offset local_offset(double lat0, double lon0, double lat1, double lon1) {
  const auto metric = LocalMetric::at(0.5 * (lat0 + lat1));
  return {longitude_difference(lon0, lon1) * metric.parallel_radius, (lat1 - lat0) * metric.meridian_radius};
}

/// Great-circle distance on a sphere whose radius makes it a lower bound of the geodesic distance: for admissible
/// heuristics over any range. The radius is the smallest radius of curvature of WGS84, M(0) = 6335439 m, so the bound
/// is at most 1 % below the true distance (the largest radius of curvature is 6399594 m, at the poles).
double distance_lower_bound(double lat0, double lon0, double lat1, double lon1);

}  // namespace glidehelm
