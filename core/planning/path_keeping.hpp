#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/planning/planner.hpp"
#include "core/vehicle/steering.hpp"

namespace glidehelm::planning {

/// The headings of stint `k` and those after it, from a dive at epoch second `dive_s`; `rest` are the ones that were meant. The
/// answer may be `rest` itself.
using Replan = std::function<std::vector<Heading>(int k, GeoPoint dive, double dive_s, std::span<const Heading> rest)>;

/// Flies a planner's headings as the lists that will be emitted (vehicle::fly_helm), keeping to the path that they mean.
///
/// The glider's law leaves a held heading for the last minutes of a stint, up to a few hundred metres. Over many stints in
/// currents that part neighbouring paths that adds up, and the headings of a path that is no longer flown lead elsewhere.
/// So each heading is turned, by at most 15°, until the stint comes up beside where the held headings would have come up
/// (the error along the track stays); the last one until its track meets the goal. A stint that comes up within 20 m as it is
/// keeps its heading.
///
/// With `replan` a stint that begins more than half a kilometre from where the path has it (the law is behind along the track,
/// too, and no turn mends that), and every one after the last heading, asks for the headings of the rest of the way anew.
///
/// `until_s`: epoch second after which nothing is flown; the problem's horizon when that is earlier. After the last heading
/// the goal itself is steered to. Two or three stints are integrated for one that is corrected.
vehicle::FlownList fly_path(std::span<const Heading> headings, const Problem& problem, const ocean::Ocean& ocean,
                            const chart::Chart& chart, double until_s = 1e18, const Replan& replan = {});

}  // namespace glidehelm::planning
