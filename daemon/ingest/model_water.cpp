#include "daemon/ingest/model_water.hpp"

#include <array>
#include <utility>

#include "daemon/ingest/water.hpp"

namespace glidehelm::ingest {

namespace {

/// Both variables, ready to be read.
struct WaterPair {
  Side temperature, salinity;
  Levels levels;
  std::vector<double> depths;  ///< of the column
  std::size_t times{1};
};

Result<Side> water_side(const Found& found, const Shape& shape, const Window& window, Result<Component> component) {
  if (!component) return unexpected(component.error());
  if (shape_of(found) != shape)
    return fault(found.file->shape_of(*found.variable) + " does not have the shape of the grid's points, " +
                 text(shape));
  auto parts = split(found);
  if (!parts) return unexpected(parts.error());
  return Side{found, *component, *parts, window};
}

std::size_t times_in(const Side& side) { return side.split.time ? length_of(side.found, *side.split.time) : 1; }

Result<WaterPair> prepare_water(const ModelFiles& files, const WaterVariables& variables, const ModelFrame& frame,
                                const Units& units, const ReadOptions& options) {
  const Shape shape{frame.centres.rows, frame.centres.columns};
  auto temperature = water_side(variables.temperature, shape, frame.window,
                                temperature_component(*variables.temperature.variable, units));
  if (!temperature) return unexpected(temperature.error());
  auto salinity =
      water_side(variables.salinity, shape, frame.window, salinity_component(*variables.salinity.variable, units));
  if (!salinity) return unexpected(salinity.error());
  const ModelVelocity both{variables.temperature, variables.salinity, variables.why};
  std::vector<std::string> said_of_the_currents;
  auto levels = levels_of(files, both, temperature->split, salinity->split, shape, units, options.stretching,
                          said_of_the_currents);
  if (!levels) return unexpected(levels.error());
  auto depths = depths_of(*levels, shape, frame.window, plane_of(frame.wet, 0, shape, frame.window));
  const std::size_t times = times_in(*temperature);
  if (times_in(*salinity) != times) return fault("they have different times");
  return WaterPair{std::move(*temperature), std::move(*salinity), std::move(*levels), std::move(depths), times};
}

/// Both at one time, by depth; masked where the model has land.
Result<std::array<LevelPlanes, 2>> water_at(const WaterPair& pair, const ModelFrame& frame, std::size_t time) {
  const Shape shape{frame.centres.rows, frame.centres.columns};
  std::array<LevelPlanes, 2> planes;
  std::size_t outside = 0;
  for (const auto& [side, into] : {std::pair{&pair.temperature, &planes[0]}, std::pair{&pair.salinity, &planes[1]}}) {
    auto read = read_levels(*side, time, pair.levels.count, outside);
    if (!read) return unexpected(read.error());
    *into = std::move(*read);
  }
  for (std::size_t k = 0; k < pair.levels.count; ++k) {
    const auto wet = plane_of(frame.wet, frame.wet.levels == pair.levels.count ? k : 0, shape, frame.window);
    for (std::size_t n = 0; n < wet.size(); ++n)
      if (wet[n] == 0) planes[0][k][n] = planes[1][k][n] = kNaN;
  }
  if (pair.levels.terrain) {
    const auto surface = surface_at(pair.levels, time);
    if (!surface) return unexpected(surface.error());
    return at_fixed_depths(pair.levels, shape.columns, frame.window, *surface, pair.depths, {&planes[0], &planes[1]});
  }
  if (pair.levels.order.empty()) return planes;
  std::array<LevelPlanes, 2> ordered;
  for (std::size_t side = 0; side < 2; ++side)
    for (const std::size_t level : pair.levels.order) ordered[side].push_back(std::move(planes[side][level]));
  return ordered;
}

}  // namespace

ocean::GridWater read_model_water(const ModelFiles& files, const ModelFrame& frame, const Units& units,
                                  const ReadOptions& options) {
  const auto variables = recognise_water(files);
  if (!variables) return {};
  const auto pair = prepare_water(files, *variables, frame, units, options);
  if (!pair) return no_water(*variables, pair.error().what);
  const std::size_t levels = pair->depths.size(), columns = frame.centres.columns;
  if (levels > kWaterLevelsAtMost) return no_water(*variables, "they have too many depths");
  WaterMean mean{levels};
  std::vector<double> t(levels), s(levels);
  const auto times = times_to_read(pair->times);
  for (const std::size_t time : times) {
    const auto planes = water_at(*pair, frame, time);
    if (!planes) return no_water(*variables, planes.error().what);
    for (std::size_t n = 0; n < frame.window.points(); ++n) {
      if (!in_area(frame.centres, frame.window.whole(n, columns), options.area)) continue;
      for (std::size_t k = 0; k < levels; ++k) {
        t[k] = (*planes)[0][k][n];
        s[k] = (*planes)[1][k][n];
      }
      mean.add(t, s);
    }
  }
  return water_of(mean, pair->depths, *variables, times.size(), pair->times);
}

}  // namespace glidehelm::ingest
