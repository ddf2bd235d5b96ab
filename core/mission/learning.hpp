#pragma once

#include <optional>

#include "core/base/current.hpp"
#include "core/base/geo.hpp"
#include "core/model/surfacing.hpp"

namespace glidehelm::mission {

/// Angle of the glider's local frame: its y axis points this far clockwise from true north (slocum.md 4.2).
struct FrameRotation {
  Radians clockwise;
  enum class From { configured, magnetic_variation, assumed_zero } from{From::assumed_zero};
  friend bool operator==(const FrameRotation&, const FrameRotation&) = default;
};

/// UTM grid convergence at a position: the angle from true north to grid north, clockwise positive; 0 on the central
/// meridian of the position's zone. γ = atan(tan(λ − λ_zone)·sin φ). The zone is the standard 6° one.
Radians utm_convergence(GeoPoint p);

/// The rotation in order of trust: configured; from `m_gps_mag_var` (positive west) and the convergence at `origin`:
/// r = −variation + γ; zero when the dialog tells nothing. `origin` is the position of the mission's local frame.
FrameRotation frame_rotation(std::optional<Radians> configured, std::optional<Radians> magnetic_variation,
                             GeoPoint origin);

/// A velocity of the local frame in true east and north: the only place where a `LocalVelocity` becomes a `Current`.
/// east = x·cos r + y·sin r, north = −x·sin r + y·cos r (slocum.md 4.2).
Current true_current(model::LocalVelocity local, Radians rotation);
/// The inverse: what a glider with that rotation prints for a true current.
model::LocalVelocity local_velocity(Current current, Radians rotation);

/// The depth-averaged current that the glider itself believes in its next stint, in the true frame: what it printed last.
/// Also nonsense counts here (the first value after a deployment), because the glider will steer by it. None when it was
/// not printed, is not finite, or is faster than the firmware lets through (2.8 m/s, slocum.md S7).
std::optional<Current> believed_current(const model::Surfacing& surfacing, Radians rotation);

}  // namespace glidehelm::mission
