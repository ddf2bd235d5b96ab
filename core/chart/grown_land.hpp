#pragma once

#include <memory>

#include "core/base/units.hpp"
#include "core/chart/coast.hpp"

namespace glidehelm::chart {

/// Land grown and simplified on the safe side: the land of the answer holds every place of the coast's area within `buffer`
/// of its land, and no place farther from it than `buffer + simplified_by` (to 0.3 m and 1e-4 of both). So it never opens
/// water; straits narrower than about 2·(buffer + simplified_by) may close; every island stays, grown.
///
/// The area is divided into cells whose diagonal is at most `simplified_by`, and a cell is land when its middle lies within
/// `buffer` and half its diagonal of land: any place within `buffer` of land lies in such a cell, and any place of such
/// a cell is no farther than the buffer and a diagonal. The shore is the border of these cells. Land outside the area is not
/// known: near the border of the area cut a wider one first. Quarters of the area that are all water or all land are decided
/// by one distance; O(length of the shore / simplified_by) distances, and a byte for each cell.
///
/// Refused: a buffer that is not 0 to 50 km, a `simplified_by` that is not 1 m to 50 km, and more than kMostCells cells.
Expected<std::shared_ptr<const Coast>, CoastError> grown_land(const Coast& coast, Metres buffer, Metres simplified_by);

inline constexpr double kMostCells = 1 << 28;

}  // namespace glidehelm::chart
