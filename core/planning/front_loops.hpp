#pragma once

#include <vector>

#include "core/planning/winding.hpp"

namespace glidehelm::planning {

/// Closes the pieces that are left of a front when markers inside the reached set are dropped.
///
/// `markers` are pieces in any order, each ended by a marker that `joins`. Where two sheets of a front cross, one piece ends and another
/// begins, both just inside the other's water: so ends and beginnings are paired, nearest first, and each end joins its own. What comes of it
/// are the outline of the reached set and one loop for each of its holes. A joining edge is as long as the cut was deep and sweeps water
/// that both sheets have reached. (Joining the pieces in the order of the old polygon would draw edges right across the reached set, and,
/// as it bends, across water nobody has reached.)
///
/// A polygon in which nothing joins is one loop and stays. Time: the square of the number of pieces, for each of the few rounds of
/// pairing.
std::vector<Marker> closed_loops(const std::vector<Marker>& markers);

}  // namespace glidehelm::planning
