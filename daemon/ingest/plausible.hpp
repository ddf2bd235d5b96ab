#pragma once

#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
#include "daemon/ingest/fault.hpp"

namespace glidehelm::ingest {

/// What a sea cannot be, in the numbers of one file.
///
/// A node with one missing component has none. Refused, with the place: no value at all; nothing but zeros; a time of
/// nothing but zeros (a file still being written); a speed above 5 m/s. Left out, with a warning: times without any value.
/// Warned about: speeds above 3.5 m/s.
///
/// Zeros that are land: producers without a fill value write 0.0 there. At every level, a block of nodes that touch by
/// their sides and have both components exactly zero at every time becomes "no value", with a warning, if it has 9 nodes
/// or more, 4 with three times or more: water stands exactly still at no place for so long, while one node may in numbers
/// rounded to cm/s. Complexity: linear in the nodes.
Result<Done> make_plausible(ocean::Grid& grid, std::vector<std::string>& warnings);

/// The rule for zeros by itself; returns how many nodes of one time it made missing.
std::size_t zeros_to_land(ocean::Grid& grid);

}  // namespace glidehelm::ingest
