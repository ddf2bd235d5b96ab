#pragma once

#include "core/base/azimuth.hpp"
#include "core/base/current.hpp"
#include "core/base/geo.hpp"

namespace glidehelm::simulator {

/// Convergence of the UTM grid: the angle from true north to grid north, clockwise; 0 on the zone's central meridian.
/// γ = atan(tan(λ − λ_zone)·sin φ) on the sphere (slocum.md 4.2; the ellipsoidal term is below 0.001°).
Radians grid_convergence(GeoPoint p);
/// Point scale of UTM: 0.9996 on the central meridian, growing with the square of the distance from it. The zone's
/// meridian is that of `p` (slocum.md 4.2: the printed range is UTM-scaled).
double grid_scale(GeoPoint p);

/// The glider's local frame: the UTM grid turned by the magnetic variation, fixed where the mission started. Its y axis
/// points `rotation` clockwise from true north. (Inside one mission the grid itself turns a little against true north,
/// by Δλ·sin φ; this simulator keeps the rotation of the mission's start.)
struct LocalFrame {
  Radians rotation;

  /// r = −variation + γ, with m_gps_mag_var positive west (slocum.md 4.2).
  static LocalFrame from_variation(Radians magnetic_variation_west, GeoPoint mission_start);
  /// The m_gps_mag_var that a glider with this frame prints.
  [[nodiscard]] Radians magnetic_variation(GeoPoint mission_start) const;

  struct Xy {
    double x, y;
  };
  /// What the glider prints for a true current.
  [[nodiscard]] Xy local(Current current) const;
  /// What the glider prints for a true bearing, in degrees of [0, 360).
  [[nodiscard]] double local_bearing_deg(Bearing bearing) const;
};

}  // namespace glidehelm::simulator
