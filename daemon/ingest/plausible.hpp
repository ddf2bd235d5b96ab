#pragma once

#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
#include "daemon/ingest/fault.hpp"

namespace glidehelm::ingest {

/// What a sea cannot be, in the numbers of one file.
///
/// A node with one missing component has none. Refused, with the place: no value at all; nothing but zeros; a time of
/// nothing but zeros (a file still being written); a time that ends, or begins, in zeros (`unwritten_end`); a speed above 5 m/s. Left out, with a warning: times without any value.
/// Warned about: speeds above 3.5 m/s.
///
/// Zeros that are land: producers without a fill value write 0.0 there. At every level, a block of nodes that touch by
/// their sides and have both components exactly zero at every time becomes "no value", with a warning, if it has 9 nodes
/// or more, 4 with three times or more: water stands exactly still at no place for so long, while one node may in numbers
/// rounded to cm/s. Complexity: linear in the nodes.
Result<Done> make_plausible(ocean::Grid& grid, std::vector<std::string>& warnings);

/// What a writer that died inside a time leaves: rows (or columns) at an end of one level that are exactly zero in one component, all of
/// them, where the time before or after has numbers at 16 nodes or more; at the last time also a component that is zero all over. In words, with the place; empty when there is none. Land
/// that is zero at every time is none of it, and slack water that a tide rounds to zero does not fill whole rows from the edge of
/// the area inwards. With one time there is nothing to compare with. Linear in the nodes.
std::string unwritten_end(const ocean::Grid& grid);

/// The rule for zeros by itself; returns how many nodes of one time it made missing.
std::size_t zeros_to_land(ocean::Grid& grid);

}  // namespace glidehelm::ingest
