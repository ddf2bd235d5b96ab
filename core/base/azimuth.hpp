#pragma once

#include <cmath>

#include "core/base/units.hpp"

namespace glidehelm {

/// The angle folded into (-π, π].
inline Radians wrapped(Radians angle) {
  const double a = std::remainder(angle.si(), 2 * kPi);
  return Radians{a <= -kPi ? a + 2 * kPi : a};
}

/// A direction, clockwise from true north, kept in [0, 2π). The tag says a direction of what, so that a course is
/// never taken for a heading (the Thesis calls our heading "bearing" and our course "heading"; see docs/notation.md).
template <class Tag>
class Azimuth {
 public:
  constexpr Azimuth() = default;
  /// Any finite angle; it is folded into [0, 2π).
  explicit Azimuth(Radians clockwise_from_north) : rad_{folded(clockwise_from_north.si())} {}
  /// The direction of the vector (east, north); north for the null vector.
  static Azimuth of(double east, double north) { return Azimuth{Radians{std::atan2(east, north)}}; }

  [[nodiscard]] Radians from_north() const { return Radians{rad_}; }
  [[nodiscard]] double degrees() const { return in_degrees(Radians{rad_}); }
  [[nodiscard]] double east() const { return std::sin(rad_); }
  [[nodiscard]] double north() const { return std::cos(rad_); }

  friend constexpr auto operator<=>(Azimuth, Azimuth) = default;
  /// The signed turn from `b` to `a`, in (-π, π].
  friend Radians operator-(Azimuth a, Azimuth b) { return wrapped(Radians{a.rad_ - b.rad_}); }
  friend Azimuth operator+(Azimuth a, Radians turn) { return Azimuth{Radians{a.rad_ + turn.si()}}; }

 private:
  static double folded(double a) {
    a = std::fmod(a, 2 * kPi);
    if (a < 0) a += 2 * kPi;
    return a >= 2 * kPi ? 0.0 : a;  // a tiny negative angle rounds up to a full turn
  }
  double rad_{};
};

using Heading = Azimuth<struct HeadingTag>;  ///< where the vehicle points, through the water (Thesis ψ_g)
using Course = Azimuth<struct CourseTag>;    ///< direction over ground (Thesis ψ_e)
using Bearing = Azimuth<struct BearingTag>;  ///< direction from one position to another

}  // namespace glidehelm
