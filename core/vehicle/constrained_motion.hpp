#pragma once

#include <cmath>
#include <optional>

#include "core/base/current.hpp"
#include "core/base/local_metric.hpp"

/// The constrained motion model (Thesis 2.2.2.2): a course over ground is held against the current, instead of a heading
/// through water. Graph searches move so from node to node; the product flies headings (motion.hpp).
///
/// U_g speed through water, U_c current, ψ_e course, ψ_g heading (docs/notation.md). With the component of the current along the
/// course and the one across it, the speed over ground is √(U_g² − across²) + along. A course is infeasible when the cross
/// current is stronger than the vehicle, and when that speed is not positive (erratum of 2.16, 4.13: the current is
/// against and stronger). Where U_c > U_g the feasible courses are a cone of 2·asin(U_g/U_c) centred on the current (2.19 and
/// its erratum), and each can be held at two speeds, of which this is the larger.
namespace glidehelm::vehicle {

/// A course that is held.
struct HeldCourse {
  Heading heading;
  MetresPerSecond ground_speed;  ///< positive
  friend bool operator==(const HeldCourse&, const HeldCourse&) = default;
};

/// Trigonometric form (2.15–2.17): ψ_g = ψ_e + asin s, U_e = U_g·√(1 − s²) + U_c·cos ψ_ec with s = U_c/U_g·sin ψ_ec and
/// ψ_ec = ψ_e − ψ_c. None: infeasible. Precondition: speed > 0.
std::optional<HeldCourse> hold_course(Course wanted, MetresPerSecond speed, const Current& current);

/// Speed over ground on the course of a unit vector (m/s); not positive, or NaN, when the course is infeasible.
inline double speed_on_course(double east, double north, double speed, double current_east, double current_north) {
  const double along = east * current_east + north * current_north,
               across = east * current_north - north * current_east;
  return std::sqrt(speed * speed - across * across) + along;
}

/// Soullignac's form without trigonometry (2.22–2.27): seconds over the straight `way` (metres) in a uniform current (m/s). None:
/// infeasible. Zero for no way.
///
/// The root (√Δ − ⟨d,U_c⟩)/(U_g² − U_c²) of 2.25 is written as d²/(√Δ + ⟨d,U_c⟩): the same, and 2.27 at U_g = U_c, where the
/// printed one is 0/0. A denominator that is not positive is the infeasible case ⟨d,U_c⟩ ≤ 0 with U_g ≤ U_c (erratum of 2.25).
inline std::optional<double> crossing_time(Offset way, double speed, double current_east, double current_north) {
  const double d2 = way.east * way.east + way.north * way.north;
  if (d2 == 0) return 0.0;
  const double cross = current_east * way.north - current_north * way.east;
  const double delta = speed * speed * d2 - cross * cross;
  if (!(delta >= 0)) return std::nullopt;
  const double below = std::sqrt(delta) + way.east * current_east + way.north * current_north;
  // Rounding leaves some 1e-16 of d·U where the exact denominator is null.
  if (!(below > 1e-12 * std::sqrt(d2) * speed)) return std::nullopt;
  return d2 / below;
}

}  // namespace glidehelm::vehicle
