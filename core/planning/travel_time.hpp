#pragma once

#include <cstdint>

#include "core/planning/mean_motion.hpp"

namespace glidehelm::planning {

/// How far the time of a step may be from that of its two halves, as a share of it.
inline constexpr double kTravelTimeTolerance = 1e-3;

/// Seconds that a straight segment (radians) takes from epoch second `t_s` in a current that varies in place and time: Eichhorn's
/// wfunc (sections 3.1, 3.2).
///
/// Idea: the segment is marched over in steps that are lengths, not times. Over a piece the arithmetic mean of the currents at its two ends
/// counts (eq. 3 to 6), the far one at the time at which the vehicle comes there. The step is controlled as in solvers of differential
/// equations (Eichhorn's [30], Hundsdorfer and Verwer): each is taken whole and in two halves; the halves count, and the difference of
/// both times, as a share of them, is held below `tolerance`. The mean of both ends errs with the cube of a piece, so the
/// difference is three times the error of the halves, and the share falls with the square of the step: the next one is
/// multiplied by 0.9·√(tolerance/share). The time is good to a third of the tolerance in a current that is steady and smooth over a step, to
/// the tolerance in one that changes while the vehicle passes.
///
/// Infeasible wherever the course cannot be held: a negative discriminant, and a speed that is not positive (eq. 6 and its erratum).
/// `segment_time` is Garau's function for the same purpose; it halves where the currents of both ends differ.
///
/// Departures: the paper leaves the details to a report that we do not have. Ours: halves as the second method, because the currents of the two
/// ends alone are blind to a jet between them; steps of 1/128 of the segment up to the whole, multiplied by 1/4 to 4 from one to the
/// next. The smallest step is taken whatever its error. A current is sampled anew where the first guess of its time could cost more than the
/// tolerance. `evaluations` counts samples: two to four for every step, also refused ones, and one more.
Expected<double, NoPassage> travel_time(const MeanMotion& motion, double lat0, double lon0, double lat1, double lon1,
                                        double t_s, std::uint64_t& evaluations,
                                        double tolerance = kTravelTimeTolerance);

}  // namespace glidehelm::planning
