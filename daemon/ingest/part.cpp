#include "daemon/ingest/part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "daemon/ingest/component.hpp"
#include "daemon/ingest/whole_file.hpp"

namespace glidehelm::ingest {

namespace {

constexpr double kRefusedSpeed = 5.0, kWarnedSpeed = 3.5;
constexpr double kNodesAtMost = 2e9;  // 16 GB of floats

struct GridAxesInFile {
  Ascending times, depths, lats, lons;
  bool has_time{}, has_depth{};
};

std::string text_of(const char* format, double a, double b) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, format, a, b);
  return buffer;
}

Result<GridAxesInFile> read_axes(const NetcdfFile& file, const Axes& axes, const Units& units,
                                 const ReadOptions& options, std::vector<std::string>& warnings) {
  GridAxesInFile out;
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
  return out;
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

/// Reads one component into every second float of `values`, time by time.
Result<Done> read_component(const NetcdfFile& file, const Variable& variable, const Axes& axes,
                            const GridAxesInFile& in, const Component& component, float* values) {
  const std::size_t rank = variable.dimensions.size();
  const auto [low_lat, high_lat] = std::minmax_element(in.lats.source.begin(), in.lats.source.end());
  const std::size_t depths = in.depths.values.size(), rows = in.lats.values.size(), columns = in.lons.values.size();
  std::vector<std::size_t> start(rank, 0), count(rank, 1), stride(rank, 1);
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
      for (std::size_t d = rank, step = 1; d-- > 0; step *= count[d]) stride[d] = step;
      const std::size_t depth_stride = in.has_depth && axes.depth->position ? stride[*axes.depth->position] : 0;
      for (std::size_t z = 0; z < depths; ++z)
        for (std::size_t j = 0; j < rows; ++j)
          for (std::size_t i = run.first; i <= run.last; ++i) {
            const std::size_t at = in.depths.source[z] * depth_stride +
                                   (in.lats.source[j] - *low_lat) * stride[*axes.latitude.position] +
                                   (in.lons.source[i] - run.source) * stride[*axes.longitude.position];
            values[2 * (((t * depths + z) * rows + j) * columns + i)] = static_cast<float>(component((*stored)[at]));
          }
    }
  }
  return Done{};
}

std::string place_text(const ocean::GridAxes& axes, std::size_t node) {
  const std::size_t columns = axes.lons_deg.size(), rows = axes.lats_deg.size(), depths = axes.depths_m.size();
  const std::size_t i = node % columns, j = node / columns % rows, z = node / columns / rows % depths,
                    t = node / columns / rows / depths;
  std::string text = text_of("%.4f, %.4f", axes.lats_deg[j], axes.lons_deg[i]);
  if (axes.has_depth) text += text_of(", %.1f m", axes.depths_m[z], 0);
  if (axes.has_time) text += ", " + utc_text(instant_at(axes.times_s[t]));
  return text;
}

/// Pairs the missing values, leaves out empty times, and refuses what cannot be a sea.
Result<Done> check_values(ocean::Grid& grid, std::vector<std::string>& warnings) {
  auto& values = grid.values;
  auto& axes = grid.axes;
  const std::size_t plane = axes.nodes() / axes.times_s.size();
  std::vector<std::size_t> kept;
  double fastest = 0;
  std::size_t fastest_node = 0;
  bool all_zero = true;
  std::vector<std::string> zero_times;
  for (std::size_t t = 0; t < axes.times_s.size(); ++t) {
    bool any = false, zero = true;
    for (std::size_t n = t * plane; n < (t + 1) * plane; ++n) {
      float &east = values[2 * n], &north = values[2 * n + 1];
      if (std::isnan(east) || std::isnan(north)) {
        east = north = std::numeric_limits<float>::quiet_NaN();
        continue;
      }
      any = true;
      zero = zero && east == 0 && north == 0;
      const double speed = std::hypot(static_cast<double>(east), static_cast<double>(north));
      if (speed > fastest) fastest = speed, fastest_node = n;
    }
    if (any) kept.push_back(t);
    if (any && zero) zero_times.push_back(axes.has_time ? utc_text(instant_at(axes.times_s[t])) : "its only time");
    all_zero = all_zero && (!any || zero);
  }
  if (kept.empty()) return fault("every value is missing");
  if (all_zero) return fault("every value is exactly zero: no sea is that still, the file was probably never filled");
  if (!zero_times.empty())
    return fault("every value at " + zero_times.front() + " is exactly zero (" + std::to_string(zero_times.size()) +
                 " of " + std::to_string(axes.times_s.size()) + " times): the file is probably still being written");
  if (fastest > kRefusedSpeed)
    return fault("a current of " + text_of("%.2f m/s", fastest, 0) + " at " + place_text(axes, fastest_node) +
                 ", allowed is at most 5 m/s (is the unit right?)");
  if (fastest > kWarnedSpeed)
    warnings.push_back("a current of " + text_of("%.2f m/s", fastest, 0) + " at " + place_text(axes, fastest_node));
  if (kept.size() == axes.times_s.size()) return Done{};

  warnings.push_back(std::to_string(axes.times_s.size() - kept.size()) + " of " + std::to_string(axes.times_s.size()) +
                     " times have no value at all and are left out");
  for (std::size_t k = 0; k < kept.size(); ++k) {
    axes.times_s[k] = axes.times_s[kept[k]];
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(2 * plane * kept[k]), 2 * plane,
                values.begin() + static_cast<std::ptrdiff_t>(2 * plane * k));
  }
  axes.times_s.resize(kept.size());
  values.resize(2 * plane * kept.size());
  return Done{};
}

/// The forecast's reference time: a variable with that standard_name, else the global attribute `forecast_reference_time`
/// or `bulletin_date`; NaN when the file names none that can be read.
double reference_time(const NetcdfFile& file, const Units& units) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (const auto& variable : file.variables()) {
    if (variable.text("standard_name") != "forecast_reference_time" || !is_number(variable.type)) continue;
    std::vector<std::string> ignored;
    const auto values = times(file, variable, units, std::nullopt, ignored);
    return values ? values->values.back() : kNone;
  }
  for (const char* name : {"forecast_reference_time", "bulletin_date"})
    if (const auto time = utc_from_text(file.text(name))) return epoch_seconds(*time);
  return kNone;
}

std::string base_name(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

}  // namespace

Result<Part> read_part(const std::string& name, std::span<const std::byte> bytes, const Units& units,
                       const ReadOptions& options) {
  if (auto whole = check_whole(bytes); !whole) return unexpected(whole.error());
  const auto file = NetcdfFile::open(bytes);
  if (!file) return unexpected(file.error());
  const auto pair = recognise_velocity(*file, options.east, options.north);
  if (!pair) return unexpected(pair.error());
  const auto axes = recognise_axes(*file, *pair->east);
  if (!axes) return unexpected(axes.error());

  Part part{name, {}};
  auto& facts = part.grid.facts;
  auto in = read_axes(*file, *axes, units, options, facts.warnings);
  if (!in) return unexpected(in.error());
  part.grid.axes = {in->times.values, in->depths.values, in->lats.values, in->lons.values, in->has_time, in->has_depth};
  double nodes = 1;  // in floating point, which does not wrap
  for (const auto* axis : {&in->times, &in->depths, &in->lats, &in->lons})
    nodes *= static_cast<double>(axis->values.size());
  if (nodes > kNodesAtMost)
    return fault("it has " + text_of("%.3g", nodes, 0) + " nodes, allowed is " + text_of("%.3g", kNodesAtMost, 0) +
                 "; cut it with --area W/E/S/N");
  part.grid.values.resize(2 * part.grid.axes.nodes());
  float* values = part.grid.values.data();
  for (const auto* variable : {pair->east, pair->north}) {
    const auto component = Component::of(*variable, units, facts.warnings);
    if (!component) return unexpected(component.error());
    auto read = read_component(*file, *variable, *axes, *in, *component, values++);
    if (!read) return unexpected(read.error());
  }
  if (auto checked = check_values(part.grid, facts.warnings); !checked) return unexpected(checked.error());

  facts.east_variable = pair->east->name;
  facts.north_variable = pair->north->name;
  facts.east_unit = pair->east->unit().value_or("");
  facts.north_unit = pair->north->unit().value_or("");
  facts.recognised_by = pair->why;
  if (axes->time) facts.time_unit = axes->time->coordinate->unit().value_or("");
  facts.reference_s = reference_time(*file, units);
  facts.cycle = base_name(name);
  if (!std::isnan(facts.reference_s))
    facts.cycle += ", cycle " + utc_text(instant_at(facts.reference_s));
  else if (in->has_time)
    facts.cycle += ", from " + utc_text(instant_at(part.grid.axes.times_s.front()));
  facts.sources = {{name, Sha256::of(bytes)}};
  return part;
}

}  // namespace glidehelm::ingest
