#pragma once

#include <span>
#include <vector>

#include "core/planning/lattice_search.hpp"

namespace glidehelm::planning {

/// The headings of stints along a way of nodes (Thesis 4.3: "the nodes do not represent surfacing points, so we must compute the
/// actual surfacing points afterwards").
///
/// The glider holds a heading for a whole stint, whatever corners the way has. At each dive the nearest place of the way that is still
/// ahead says how far it has come; where the way would be a stint and a surface interval later is the place to come up at, and
/// the heading is the one whose held flight comes up beside it with no error across. A heading that runs aground (it cuts a
/// corner) gives way to one towards a nearer place, which leaves the way on the outside. Ends when the goal is entered, when
/// the way is used up, at the horizon, or where no such heading is safe. `margin`: clearance that the stints keep.
std::vector<Heading> headings_along(std::span<const WayPoint> way, const Problem& problem, const ocean::Ocean& ocean,
                                    const chart::Chart& chart, Metres margin);

}  // namespace glidehelm::planning
