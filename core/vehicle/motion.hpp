#pragma once

#include <optional>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/geo.hpp"
#include "core/ocean/field.hpp"

/// How a glider moves: stints, drifts, steering.
namespace glidehelm::vehicle {

/// One underwater segment as a planner means it: a constant heading held from the dive to the surfacing.
struct Stint {
  GeoPoint dive, surface;
  double dive_s{}, surface_s{};        ///< epoch seconds
  Heading heading;                     ///< through water, held
  Current dac;                         ///< mean of the current met on the way (time-weighted)
  bool arrives{};                      ///< the goal radius is crossed inside this stint
  Metres steering_error;               ///< ideal surfacing − surfacing of the list flown by the glider's law
  friend bool operator==(const Stint&, const Stint&) = default;
};

/// Why a motion did not reach its end.
enum class Lost { aground, left_area, left_forecast, no_data };
std::string_view word(Lost reason);
Lost lost_by(ocean::NoCurrent reason);

}  // namespace glidehelm::vehicle
