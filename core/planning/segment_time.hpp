#pragma once

#include <cstdint>

#include "core/planning/mean_motion.hpp"

namespace glidehelm::planning {

/// Seconds that a straight segment (radians) takes from epoch second `t_s`, by the constrained motion model.
///
/// Recursive splitting (Garau, "The path planner", eq. 2): a segment whose currents at both ends differ by more than a twentieth
/// of the speed is halved; over a piece the mean of its ends counts. Departures: the *vectors* are compared and the middle
/// as well, since an eddy has equal speeds on both sides; currents are taken at the time at which the vehicle is there; seven
/// halvings at most. `evaluations` counts samples.
Expected<double, NoPassage> segment_time(const MeanMotion& motion, double lat0, double lon0, double lat1, double lon1,
                                         double t_s, std::uint64_t& evaluations);

}  // namespace glidehelm::planning
