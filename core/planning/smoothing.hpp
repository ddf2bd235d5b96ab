#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/planning/lattice_search.hpp"

namespace glidehelm::planning {

/// Seconds from a place of a way straight to another, leaving at an epoch second; none when that cannot be flown (obstacles too).
using StraightTime = std::function<std::optional<double>(const WayPoint& from, const WayPoint& to, double t_s)>;

/// Path smoothing in a time-varying environment (Eichhorn section 4, Table 3). A grid knows few directions, so its ways are stairs;
/// here waypoints are left out as long as the straight line past them comes earlier to the next one (test IV) *and* the rest of the way, flown
/// from then, comes no later to the goal (test V): an earlier arrival at a waypoint may meet a worse current behind it. Repeated until
/// no waypoint can be left out.
///
/// The result has the same ends, times of its own, and never arrives later than the way given. A way whose legs cannot all be flown comes back as
/// it is. O(n²) times per round for n waypoints.
///
/// Erratum of Table 3: line (I) compares the waypoints with the smoothed ones after these have been stored as the waypoints, so that it would end after
/// one round; the lengths before and after a round are meant.
std::vector<WayPoint> smooth(std::vector<WayPoint> way, const StraightTime& seconds);

}  // namespace glidehelm::planning
