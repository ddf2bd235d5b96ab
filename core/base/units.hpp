#pragma once

#include <cmath>
#include <compare>

#include "core/base/time.hpp"

namespace glidehelm {

/// A number with a unit: SI inside, no implicit way in or out.
///
/// The constructor is explicit and user-provided on purpose: as an aggregate, `GeoPoint{39.5, 2.1}` would compile by
/// brace elision. `si()` is the only way out and belongs to edges (text, files) and to inner kernels.
template <class Tag>
class Quantity {
 public:
  constexpr Quantity() = default;
  explicit constexpr Quantity(double si) : si_{si} {}

  [[nodiscard]] constexpr double si() const { return si_; }

  friend constexpr auto operator<=>(Quantity, Quantity) = default;
  friend constexpr Quantity operator+(Quantity a, Quantity b) { return Quantity{a.si_ + b.si_}; }
  friend constexpr Quantity operator-(Quantity a, Quantity b) { return Quantity{a.si_ - b.si_}; }
  friend constexpr Quantity operator-(Quantity a) { return Quantity{-a.si_}; }
  friend constexpr Quantity operator*(Quantity a, double k) { return Quantity{a.si_ * k}; }
  friend constexpr Quantity operator*(double k, Quantity a) { return Quantity{a.si_ * k}; }
  friend constexpr Quantity operator/(Quantity a, double k) { return Quantity{a.si_ / k}; }
  friend constexpr double operator/(Quantity a, Quantity b) { return a.si_ / b.si_; }
  constexpr Quantity& operator+=(Quantity b) {
    si_ += b.si_;
    return *this;
  }
  constexpr Quantity& operator-=(Quantity b) {
    si_ -= b.si_;
    return *this;
  }

 private:
  double si_{};
};

using Metres = Quantity<struct MetresTag>;
using MetresPerSecond = Quantity<struct MetresPerSecondTag>;
/// A difference of angles, or an angle without a reference direction. Directions are `Heading`, `Course`, `Bearing`.
using Radians = Quantity<struct RadiansTag>;

constexpr Metres operator*(MetresPerSecond v, Seconds t) { return Metres{v.si() * t.count()}; }
constexpr Metres operator*(Seconds t, MetresPerSecond v) { return v * t; }
constexpr MetresPerSecond operator/(Metres d, Seconds t) { return MetresPerSecond{d.si() / t.count()}; }
constexpr Seconds operator/(Metres d, MetresPerSecond v) { return Seconds{d.si() / v.si()}; }

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180.0;  ///< in radians
constexpr Radians degrees(double deg) { return Radians{deg * kDegree}; }
constexpr double in_degrees(Radians angle) { return angle.si() * (180.0 / kPi); }

/// Depth below the surface, positive down.
struct Depth {
  Metres below_surface;
  friend constexpr auto operator<=>(Depth, Depth) = default;
};

}  // namespace glidehelm
