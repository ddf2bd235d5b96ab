#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/model/dive_schedule.hpp"
#include "core/model/glider.hpp"
#include "core/model/waypoint_list.hpp"
#include "core/vehicle/motion.hpp"

/// Headings to waypoints and back (product.md 6, "From headings to waypoints"; slocum.md 4.4–4.5).
namespace glidehelm::vehicle {

}  // namespace glidehelm::vehicle
