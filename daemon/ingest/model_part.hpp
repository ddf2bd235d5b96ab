#pragma once

#include <optional>

#include "core/ocean/grid_format.hpp"
#include "daemon/ingest/grid_file.hpp"
#include "daemon/ingest/part.hpp"
#include "daemon/ingest/units.hpp"

/// One file of a model on its own grid: staggered, rotated, curvilinear, terrain-following.
namespace glidehelm::ingest {

/// Brings the velocity of `files` (the file of the currents first, then its partner and grid files) onto a rectilinear
/// grid with fixed depths: averages staggered components to the centres, turns them to east and north, interpolates
/// vertically in every column, maps horizontally (regrid.hpp). docs/decisions/018 states the errors. Sets axes, values,
/// `layout`, `recognised_by`, variables, units, warnings and the water (model_water.hpp).
///
/// Nothing when this is no such file (no velocity, or no positions in two dimensions, no staggering and no terrain-following
/// levels): the plain reader's fault then counts. Refused: what regrid.hpp, vertical.hpp, curvilinear.hpp and grid_file.hpp
/// refuse, velocities whose direction is open, s-levels without their stretching, more than 5e8 nodes.
Result<std::optional<ocean::Grid>> read_model(const ModelFiles& files, const Units& units, const ReadOptions& options);

}  // namespace glidehelm::ingest
