#include "core/vehicle/yo.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::vehicle {

namespace {
constexpr double kBottomFound = 0.5;  // metres
}

double yo_depth(const model::Glider& glider, double since_dive, double length) {
  const double lowest = glider.dive_depth.si(), highest = std::min(glider.climb_to.si(), lowest);
  const double vertical = glider.horizontal_speed.si() * std::tan(glider.glide_angle.si());
  const double way = vertical * since_dive, way_up = vertical * (length - since_dive);
  double depth = way;
  if (way > lowest) {
    const double amplitude = lowest - highest;
    // Metres into the present pair of a climb and a dive.
    const double into = amplitude > 0 ? std::fmod(way - lowest, 2 * amplitude) : 0.0;
    depth = lowest - (into <= amplitude ? into : 2 * amplitude - into);
  }
  return std::clamp(std::min(depth, way_up), 0.0, lowest);
}

Expected<Reached, ocean::NoCurrent> reached_above_bottom(ocean::FieldRef full, GeoPoint p, double depth, double t_s) {
  const auto at = [&](double metres) { return full.sample(p, Depth{Metres{metres}}, t_s); };
  auto found = at(depth);
  if (found) return Reached{*found, depth};
  if (found.error() != ocean::NoCurrent::below_bottom) return unexpected(found.error());
  found = at(0);
  double water = 0, ground = depth;
  while (found && ground - water > kBottomFound) {
    const double middle = 0.5 * (water + ground);
    if (const auto deeper = at(middle)) {
      found = deeper;
      water = middle;
    } else {
      ground = middle;
    }
  }
  if (!found) return unexpected(found.error());
  return Reached{*found, water};
}

Expected<ocean::Sample, ocean::NoCurrent> current_above_bottom(ocean::FieldRef full, GeoPoint p, double depth,
                                                               double t_s) {
  const auto reached = reached_above_bottom(full, p, depth, t_s);
  if (!reached) return unexpected(reached.error());
  return reached->sample;
}

}  // namespace glidehelm::vehicle
