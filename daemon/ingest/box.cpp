#include "daemon/ingest/box.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace glidehelm::ingest {

namespace {

std::string rounded(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

/// Runs of neighbouring columns: the output's columns [first, last] lie in the file at consecutive indices, up or down.
struct Run {
  std::size_t first{}, last{}, source{};  ///< source: the lowest index in the file
  bool down{};
};
std::vector<Run> runs_of(const std::vector<std::size_t>& source) {
  std::vector<Run> runs;
  for (std::size_t k = 0; k < source.size(); ++k) {
    if (!runs.empty()) {
      Run& run = runs.back();
      const bool single = run.first == run.last;
      if (source[k] == source[k - 1] + 1 && (single || !run.down)) {
        run.last = k;
        continue;
      }
      if (source[k] + 1 == source[k - 1] && (single || run.down)) {
        run.last = k;
        run.down = true;
        run.source = source[k];
        continue;
      }
    }
    runs.push_back({k, k, source[k], false});
  }
  return runs;
}

/// How far apart neighbours along each axis lie in what is read: the last axis runs fastest.
std::vector<std::size_t> strides_of(const std::vector<std::size_t>& count) {
  std::vector<std::size_t> strides(count.size(), 1);
  for (std::size_t d = count.size(); d-- > 1;) strides[d - 1] = strides[d] * count[d];
  return strides;
}

}  // namespace

Result<Box> read_box(const NetcdfFile& file, const Axes& axes, const Units& units, const ReadOptions& options,
                     std::vector<std::string>& warnings) {
  Box out;
  out.times = out.depths = {{0.0}, {0}};
  auto lats = latitudes(file, *axes.latitude.coordinate, units, warnings);
  if (!lats) return unexpected(lats.error());
  out.lats = std::move(*lats);
  auto lons = longitudes(file, *axes.longitude.coordinate, units, warnings);
  if (!lons) return unexpected(lons.error());
  out.lons = std::move(*lons);
  if (axes.time) {
    auto values = times(file, *axes.time->coordinate, units, options.time_epoch, warnings);
    if (!values) return unexpected(values.error());
    out.times = std::move(*values);
    out.has_time = true;
  } else {
    warnings.emplace_back("no time axis: taken as the same at every instant");
  }
  if (axes.depth) {
    auto values = depths(file, *axes.depth->coordinate, units, warnings);
    if (!values) return unexpected(values.error());
    out.depths = std::move(*values);
    out.has_depth = true;
  }
  if (options.area)
    if (auto done = cut(out.lats, out.lons, *options.area); !done) return unexpected(done.error());
  if (options.only_time_s && out.has_time) {
    const auto& values = out.times.values;
    const auto at = std::find(values.begin(), values.end(), *options.only_time_s) - values.begin();
    if (at == static_cast<std::ptrdiff_t>(values.size())) return fault("it has not the time that was asked for");
    out.times = {{*options.only_time_s}, {out.times.source[static_cast<std::size_t>(at)]}};
  }
  double nodes = 1;  // in floating point, which does not wrap
  for (const auto* axis : {&out.times, &out.depths, &out.lats, &out.lons})
    nodes *= static_cast<double>(axis->values.size());
  if (nodes > options.nodes_at_most)
    return fault("it has " + rounded(nodes) + " nodes, allowed is " + rounded(options.nodes_at_most) +
                 "; cut it with --area W/E/S/N");
  return out;
}

Result<Told> read_values(const NetcdfFile& file, const Variable& variable, const Axes& axes, const Box& in,
                         const Component& component, float* values, std::size_t step_of_values) {
  Told told;
  const bool ranged = component.has_valid_range();
  const std::size_t rank = variable.dimensions.size();
  const auto [low_lat, high_lat] = std::minmax_element(in.lats.source.begin(), in.lats.source.end());
  const std::size_t depths = in.depths.values.size(), rows = in.lats.values.size(), columns = in.lons.values.size();
  std::vector<std::size_t> start(rank, 0), count(rank, 1);
  for (const auto& run : runs_of(in.lons.source)) {
    start[*axes.latitude.position] = *low_lat;
    count[*axes.latitude.position] = *high_lat - *low_lat + 1;
    start[*axes.longitude.position] = run.source;
    count[*axes.longitude.position] = run.last - run.first + 1;
    if (in.has_depth && axes.depth->position) count[*axes.depth->position] = depths;
    for (std::size_t t = 0; t < in.times.values.size(); ++t) {
      if (in.has_time && axes.time->position) start[*axes.time->position] = in.times.source[t];
      const auto stored = file.read(variable, start, count);
      if (!stored) return unexpected(stored.error());
      const auto stride = strides_of(count);
      const std::size_t depth_stride = in.has_depth && axes.depth->position ? stride[*axes.depth->position] : 0;
      const std::size_t lat_stride = stride[*axes.latitude.position], lon_stride = stride[*axes.longitude.position];
      for (std::size_t z = 0; z < depths; ++z)
        for (std::size_t j = 0; j < rows; ++j) {
          const double* row =
              stored->data() + in.depths.source[z] * depth_stride + (in.lats.source[j] - *low_lat) * lat_stride;
          float* to = values + step_of_values * (((t * depths + z) * rows + j) * columns);
          for (std::size_t i = run.first; i <= run.last; ++i) {
            const double number = row[(in.lons.source[i] - run.source) * lon_stride];
            const double value = component(number);
            if (value == value) {
              told.nothing = false;
              if (ranged && component.outside_valid(number)) ++told.outside_valid;
            } else if (told.nothing) {
              told.marks[static_cast<std::size_t>(component.mark_of(number))] = true;
            }
            to[step_of_values * i] = static_cast<float>(value);
          }
        }
    }
  }
  return told;
}

}  // namespace glidehelm::ingest
