#pragma once

#include <cstddef>

#include "core/ocean/grid_format.hpp"
#include "daemon/ingest/netcdf_file.hpp"

/// Holes in measured currents.
namespace glidehelm::ingest {

/// Fills the gaps of a surface grid, every time by itself, and marks what it filled in `grid.filled`.
///
/// A node without a value is a gap, and no edge, when values lie within `distance_m` of it in opposite directions: of
/// eight sectors of 45° around it, in at least one and in the one across. It takes the mean of all values within that
/// distance, weighted by 1/d² (Shepard). Filled values do not fill others, so that nothing reaches farther than the distance.
/// Land between two waters narrower than that is filled too: the coastline says where land is, not this grid.
///
/// Returns the number of nodes filled. Precondition: one level. Complexity: missing nodes times nodes within the distance.
std::size_t fill_gaps(ocean::Grid& grid, double distance_m);

/// Two cells, metres: the larger of the two sides, at the middle latitude. HF radar nets average over about this far (the
/// 6 km totals of the Mid-Atlantic over 15 km), so that a value of two cells away is not independent of the gap.
double two_cells(const ocean::GridAxes& axes);

/// True when a file says that it comes from a high-frequency radar: in a global attribute or the long name of a variable.
bool is_radar(const NetcdfFile& file);

}  // namespace glidehelm::ingest
