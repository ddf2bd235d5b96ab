#pragma once

#include <cmath>
#include <optional>

#include "core/ocean/grid_format.hpp"
#include "core/ocean/time_axis.hpp"

/// How long a forecast may be used (product.md 7).
namespace glidehelm::ocean {

inline constexpr double kOldAfter = 36 * 3600.0;      ///< seconds: from then on it is said to be old …
inline constexpr double kExpiredAfter = 72 * 3600.0;  ///< … and from then on it is not planned on

/// The epoch second from which a grid ages: its reference time, or the time of its last field when it names none (an
/// archive or a nowcast is as new as its end). None when it does not age: without times, or when the mission takes it as a
/// tide that comes again (`outside_time: cycle`).
inline std::optional<double> issued_s(const GridAxes& axes, const GridFacts& facts, OutsideTime outside_time) {
  if (!axes.has_time || outside_time == OutsideTime::cycle) return std::nullopt;
  return std::isnan(facts.reference_s) ? axes.times_s.back() : facts.reference_s;
}

}  // namespace glidehelm::ocean
