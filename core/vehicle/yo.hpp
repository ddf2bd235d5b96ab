#pragma once

#include "core/base/expected.hpp"
#include "core/model/glider.hpp"
#include "core/ocean/field.hpp"

/// The depths of a dive, for flights in currents that change with depth.
namespace glidehelm::vehicle {

/// Depth in metres at `since_dive` seconds of a stint of `length` seconds: from the surface down to dive_depth, between
/// climb_to and dive_depth in straight lines, and up again so that the stint ends at the surface (Thesis 2.12–2.14;
/// seeds/README.md). The vertical speed is U·tan(glide angle).
double yo_depth(const model::Glider& glider, double since_dive, double length);

/// A current and the depth that it was found at.
struct Reached {
  ocean::Sample sample;
  double depth_m{};
};
/// The current at a depth, or, below the bottom, the deepest one above it (to half a metre), with its depth.
Expected<Reached, ocean::NoCurrent> reached_above_bottom(ocean::FieldRef full, GeoPoint p, double depth, double t_s);
/// The current at a depth, or, below the bottom, the deepest one above it (to half a metre): there the glider turns.
Expected<ocean::Sample, ocean::NoCurrent> current_above_bottom(ocean::FieldRef full, GeoPoint p, double depth,
                                                               double t_s);

}  // namespace glidehelm::vehicle
