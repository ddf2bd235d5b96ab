#pragma once

#include <cstdint>
#include <optional>

#include "core/base/azimuth.hpp"
#include "core/planning/lattice_search.hpp"
#include "core/planning/mean_motion.hpp"

namespace glidehelm::planning {

/// The course over ground that a time-optimal way has beyond a vertex which it comes to over an edge: CALC-OPTDIR of Eichhorn's ZTVE (section
/// 2.2.2, Table 2).
///
/// Idea: the direction of the edge is the best course in the middle of it. From there the trajectory is followed under Zermelo's formula
/// (eq. 2 with 10; the general form, also for a flow with divergence) for the time of the edge: through the vertex, to about the middle of
/// the next edge, whose direction the course there should be. An edge stands for the mean of a bent way, so the answer is good to the
/// square of the time.
///
/// One step of the midpoint rule; derivatives of the current are differences over half the edge. Nine samples, counted in `evaluations`. A parallel is not
/// straight, which turns courses by 0.1° in 10 km at 60°: neglected. None where the course cannot be held or a current is missing.
std::optional<Course> optimal_course(const MeanMotion& motion, const WayPoint& from, const WayPoint& to,
                                     std::uint64_t& evaluations);

}  // namespace glidehelm::planning
