#include "core/vehicle/constrained_motion.hpp"

namespace glidehelm::vehicle {

std::optional<HeldCourse> hold_course(Course wanted, MetresPerSecond speed, const Current& current) {
  const double strength = std::hypot(current.east.si(), current.north.si()) / speed.si();
  const Course along = Course::of(current.east.si(), current.north.si());
  const double turn = (wanted - along).si(), s = strength * std::sin(turn);
  if (std::abs(s) > 1) return std::nullopt;
  const MetresPerSecond ground_speed = speed * (std::sqrt(1 - s * s) + strength * std::cos(turn));
  if (!(ground_speed.si() > 1e-12 * speed.si())) return std::nullopt;  // null but for rounding
  return HeldCourse{Heading{wanted.from_north()} + Radians{std::asin(s)}, ground_speed};
}

}  // namespace glidehelm::vehicle
