#pragma once

#include <memory>
#include <vector>

#include "core/chart/coast.hpp"

namespace glidehelm::chart {

/// Coasts of several areas as one: its area is the smallest box around them all, and what lies between them is land, since
/// it was not charted. Inside each area, land and water are as they were; the area's border is now a shore (a track keeps the
/// margin from it), except where it is the border of the box.
///
/// Refused: none at all, areas that overlap or touch (land would cancel out, and their borders would be a wall between them), a box
/// wider than 180°, and what Coast::make refuses. Linear in the points.
Expected<std::shared_ptr<const Coast>, CoastError> joined_areas(
    const std::vector<std::shared_ptr<const Coast>>& coasts);

}  // namespace glidehelm::chart
