#pragma once

#include "core/ocean/grid_format.hpp"
#include "daemon/ingest/model_planes.hpp"
#include "daemon/ingest/part.hpp"
#include "daemon/ingest/units.hpp"

namespace glidehelm::ingest {

/// What reading a model's currents has settled, and its water is read by.
struct ModelFrame {
  const Mesh& centres;
  const Window& window;
  const Mask& wet;  ///< of the centres; may be empty
};

/// The water (water.hpp) of a model on its own grid: at the centres of the window that are water and in the area asked for, each
/// counting alike, brought onto fixed depths as the currents are. It has levels and times of its own; a surface that moves counts as for
/// the currents.
ocean::GridWater read_model_water(const ModelFiles& files, const ModelFrame& frame, const Units& units,
                                  const ReadOptions& options);

}  // namespace glidehelm::ingest
