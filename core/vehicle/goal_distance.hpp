#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"
#include "core/vehicle/motion.hpp"

namespace glidehelm::vehicle {

/// How far the goal's centre is, and where it lies, from positions in radians: for kernels that ask millions of times.
class GoalDistance {
 public:
  explicit GoalDistance(const Disc& goal)
      : goal_{goal}, lat_{goal.centre.lat.radians()}, lon_{goal.centre.lon.radians()}, cos_{std::cos(lat_)} {}

  [[nodiscard]] double lat() const { return lat_; }
  [[nodiscard]] double lon() const { return lon_; }

  /// Metres; a lower bound of the geodesic distance: half the chord on a sphere of WGS84's smallest radius of curvature is
  /// x = sin(angle/2), and all series are cut where they are below what they stand for.
  [[nodiscard]] double least(double lat, double lon) const {
    const double s = sine_at_most(0.5 * std::abs(lat_ - lat));
    const double t = sine_at_most(0.5 * std::abs(longitude_difference(lon, lon_)));
    const double x2 = s * s + cosine_at_most(lat) * cos_ * t * t, x = std::sqrt(std::max(0.0, x2));
    return 2 * kSmallestRadius * x * (1 + x2 * (1.0 / 6 + x2 * (3.0 / 40 + x2 * (15.0 / 336))));
  }
  /// Metres, by the local metric (to 0.01 %) within 50 km. Farther away `least`, which may be 1 % less, unless the disc itself is so large that it
  /// matters; then the geodesic.
  [[nodiscard]] double near(double lat, double lon) const {
    const double bound = least(lat, lon);
    if (bound <= kNear) return local_offset(lat, lon, lat_, lon_).length();
    // The bound is at most 1 % short within 5 000 km, so only near the rim of a very large disc the truth is needed.
    if (bound > goal_.radius.si()) return bound;
    return distance(GeoPoint::from_kernel(lat, lon), goal_.centre).si();
  }
  /// Direction to the goal on the sphere, not normalised.
  [[nodiscard]] Offset direction(double lat, double lon) const {
    const double dlon = lon_ - lon;
    return {std::sin(dlon) * cos_, std::cos(lat) * std::sin(lat_) - std::sin(lat) * cos_ * std::cos(dlon)};
  }

 private:
  static constexpr double kSmallestRadius = 6'335'439.0;  // of curvature of WGS84
  static constexpr double kNear = 50'000.0;               // metres: where the local metric is exact enough

  /// 0 ≤ x ≤ π/2; to 2e-4 there, to 1e-9 for x < 0.3.
  static double sine_at_most(double x) {
    const double x2 = x * x;
    return x * (1 - x2 * (1.0 / 6 - x2 * (1.0 / 120 - x2 * (1.0 / 5040))));
  }
  /// |x| ≤ π/2, to 5e-7.
  static double cosine_at_most(double x) {
    const double x2 = x * x;
    return 1 - x2 * (1.0 / 2 - x2 * (1.0 / 24 - x2 * (1.0 / 720 - x2 * (1.0 / 40320 - x2 * (1.0 / 3628800)))));
  }

  Disc goal_;
  double lat_, lon_, cos_;
};

}  // namespace glidehelm::vehicle
