#pragma once

#include <cstddef>
#include <vector>

#include "core/chart/bathymetry.hpp"
#include "daemon/ingest/fault.hpp"

namespace glidehelm::ingest {

/// Depths on points that lie in rows and columns, however bent: degrees, longitudes without a jump; NaN position: no point.
/// Depths positive down, NaN unknown.
struct DepthMesh {
  std::size_t rows{}, columns{};
  std::vector<double> lats, lons, depths;
};

/// The same depths on nodes even in latitude and longitude, as chart::DepthGrid wants them.
///
/// When the axes are even (to 1 % of a step at the last node) the depths are taken over as they are. Otherwise each node
/// takes the shoalest of all points whose cell (half way to the neighbours; the box around it) meets the four grid cells
/// at the node; the step is the mean one of the mesh. Every depth that the even surface has anywhere is thus at most that
/// of the point in whose cell it lies: bilinear means of four nodes, none of them deeper. Shallows grow by up to a cell and
/// a half; unknown grows likewise, and beyond the mesh all is unknown. O(points + nodes).
Result<chart::DepthGrid> even_depths(const std::vector<double>& lats, const std::vector<double>& lons,
                                     const std::vector<double>& depths);
Result<chart::DepthGrid> even_depths(const DepthMesh& mesh);

}  // namespace glidehelm::ingest
