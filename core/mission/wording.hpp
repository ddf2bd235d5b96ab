#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/base/geo.hpp"
#include "core/base/utc.hpp"

/// How the pilot's sentences write places, times and durations.
namespace glidehelm::mission {

/// A position as a pilot reads it: four decimals of a degree are 10 m.
inline std::string place(GeoPoint p) { return fmt::format("{:.4f},{:.4f}", p.lat.degrees(), p.lon.degrees()); }

inline std::string hours(Seconds t) {
  const auto minutes = static_cast<long>(std::llround(t.count() / 60.0));
  return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

inline std::string clock_text(Instant t) { return utc_text(t); }

}  // namespace glidehelm::mission
