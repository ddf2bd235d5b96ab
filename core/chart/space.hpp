#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"

/// Positions as the geometry of the chart sees them: on the ellipsoid in space for distances, on the plane of longitude
/// and latitude for "which side".
namespace glidehelm::chart {

/// A point of the WGS84 ellipsoid in earth-centred coordinates, metres. Distances between such points are chords: up to
/// 60 km a chord is shorter than the geodesic by 4e-6 of its length (s³/24R²), at every latitude and across ±180°, with
/// no angle to fold.
struct Space {
  double x, y, z;
  static Space at(double lat, double lon) {
    const double s = std::sin(lat);
    const double n = LocalMetric::kEquatorialRadius / std::sqrt(1.0 - LocalMetric::kEccentricity2 * s * s);
    const double r = n * std::cos(lat);
    return {r * std::cos(lon), r * std::sin(lon), n * (1.0 - LocalMetric::kEccentricity2) * s};
  }
};
inline Space operator-(const Space& a, const Space& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline double dot(const Space& a, const Space& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Squared distance of `p` from the straight piece between `a` and `b`.
inline double squared_distance(const Space& p, const Space& a, const Space& b) {
  const Space ab = b - a, ap = p - a;
  const double length2 = dot(ab, ab);
  const double t = length2 > 0 ? std::clamp(dot(ap, ab) / length2, 0.0, 1.0) : 0.0;
  const Space off{ap.x - t * ab.x, ap.y - t * ab.y, ap.z - t * ab.z};
  return dot(off, off);
}

/// Longitude (from some middle) and latitude as a plane, radians. Shorelines, and the segments that planners ask about,
/// are straight here.
struct Plane {
  double x, y;
};

/// Twice the signed area of the triangle: positive when `c` lies left of the way from `a` to `b`.
inline double turn(const Plane& a, const Plane& b, const Plane& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// True when the two pieces cross. A point exactly on a line counts as right of it, so that a way through a corner
/// between two pieces crosses one of them.
inline bool cross(const Plane& a, const Plane& b, const Plane& c, const Plane& d) {
  return (turn(c, d, a) > 0) != (turn(c, d, b) > 0) && (turn(a, b, c) > 0) != (turn(a, b, d) > 0);
}

/// A difference of longitudes folded into [-π, π].
inline double folded(double dlon) { return dlon > kPi || dlon < -kPi ? std::remainder(dlon, 2 * kPi) : dlon; }

/// Longest piece at this latitude whose chord, plane line and geodesic are one line to 0.1 m: chord and surface differ by
/// l²/8R, plane line and geodesic by l²·tan φ/8R.
inline double longest_piece(double lat) {
  constexpr double kLongest = 2000.0;
  return kLongest / std::sqrt(std::max(1.0, std::tan(std::min(std::abs(lat), 1.54))));
}

}  // namespace glidehelm::chart
