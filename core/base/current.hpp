#pragma once

#include <cmath>

#include "core/base/units.hpp"

namespace glidehelm {

/// Velocity of the water over ground, in true east and north.
struct Current {
  MetresPerSecond east, north;
  [[nodiscard]] MetresPerSecond speed() const { return MetresPerSecond{std::hypot(east.si(), north.si())}; }
  friend constexpr auto operator<=>(const Current&, const Current&) = default;
};

}  // namespace glidehelm
