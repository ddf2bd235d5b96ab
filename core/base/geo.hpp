#pragma once

#include <string>

#include "core/base/azimuth.hpp"
#include "core/base/expected.hpp"
#include "core/base/units.hpp"

namespace glidehelm {

/// A coordinate that is not one: what was found and what is allowed.
struct OutOfRange {
  std::string what;  ///< "latitude" or "longitude"
  double found_deg{};
  [[nodiscard]] std::string message() const;
  friend bool operator==(const OutOfRange&, const OutOfRange&) = default;
};

/// WGS84 geodetic latitude in [-π/2, π/2].
class Latitude {
 public:
  constexpr Latitude() = default;
  /// Finite and within ±90°, or the reason why not.
  static Expected<Latitude, OutOfRange> from_degrees(double deg);
  /// For values computed by our own kernels; clamps rounding beyond a pole. Precondition: finite.
  static Latitude from_kernel(double radians);
  [[nodiscard]] Radians from_equator() const { return Radians{rad_}; }
  [[nodiscard]] double radians() const { return rad_; }
  [[nodiscard]] double degrees() const { return in_degrees(Radians{rad_}); }
  friend constexpr auto operator<=>(Latitude, Latitude) = default;

 private:
  explicit constexpr Latitude(double rad) : rad_{rad} {}
  double rad_{};
};

/// WGS84 longitude, kept in [-π, π).
class Longitude {
 public:
  constexpr Longitude() = default;
  /// Finite and within [-360°, 360°] (products use 0–360 as well as ±180), or the reason why not.
  static Expected<Longitude, OutOfRange> from_degrees(double deg);
  /// Any finite angle, folded: kernels let the longitude run on across the antimeridian.
  static Longitude from_kernel(double radians);
  [[nodiscard]] double radians() const { return rad_; }
  [[nodiscard]] double degrees() const { return in_degrees(Radians{rad_}); }
  friend constexpr auto operator<=>(Longitude, Longitude) = default;

 private:
  explicit constexpr Longitude(double rad) : rad_{rad} {}
  double rad_{};
};

/// A position on the WGS84 ellipsoid.
struct GeoPoint {
  Latitude lat;
  Longitude lon;
  static Expected<GeoPoint, OutOfRange> from_degrees(double lat_deg, double lon_deg);
  static GeoPoint from_kernel(double lat_rad, double lon_rad);
  friend constexpr auto operator<=>(const GeoPoint&, const GeoPoint&) = default;
};

/// A position known at compile or test time. Throws std::invalid_argument when out of range: misuse, not input.
GeoPoint geo_point(double lat_deg, double lon_deg);

/// Shortest way between two positions on WGS84.
struct Geodesic {
  Metres length;
  Bearing departing;  ///< at the first point; north when the points coincide
};
/// GeographicLib's inverse problem: error below 15 nm. About 1 µs: for edges, not for inner loops (local_metric.hpp).
Geodesic geodesic(const GeoPoint& from, const GeoPoint& to);
Metres distance(const GeoPoint& from, const GeoPoint& to);
/// GeographicLib's direct problem.
GeoPoint destination(const GeoPoint& from, Bearing departing, Metres length);
template <class Tag>
GeoPoint destination(const GeoPoint& from, Azimuth<Tag> direction, Metres length) {
  return destination(from, Bearing{direction.from_north()}, length);
}

}  // namespace glidehelm
