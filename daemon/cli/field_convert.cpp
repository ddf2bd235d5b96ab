#include "daemon/cli/field_convert.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/ocean/depth_average.hpp"
#include "daemon/cli/field_text.hpp"
#include "daemon/cli/new_file.hpp"
#include "simulator/netcdf_classic.hpp"

namespace glidehelm::cli {

namespace {

using simulator::ClassicAttribute;
using simulator::ClassicVariable;

/// Keeps the times within [from, to]; false when none is left. A field without a time axis is kept as it is.
bool keep_times(ocean::Grid& grid, const FieldConvertOptions& options) {
  if (!grid.axes.has_time || (!options.from && !options.to)) return true;
  const double from = options.from ? epoch_seconds(*options.from) : -INFINITY;
  const double to = options.to ? epoch_seconds(*options.to) : INFINITY;
  auto& times = grid.axes.times_s;
  const auto first = std::lower_bound(times.begin(), times.end(), from);
  const auto behind = std::upper_bound(times.begin(), times.end(), to);
  if (first >= behind) return false;
  const auto plane = static_cast<std::ptrdiff_t>(grid.values.size() / times.size());
  const auto begin = (first - times.begin()) * plane, end = (behind - times.begin()) * plane;
  grid.values.erase(grid.values.begin() + end, grid.values.end());
  grid.values.erase(grid.values.begin(), grid.values.begin() + begin);
  std::vector<ocean::NodeRun> filled;
  for (const auto& run : grid.filled) {
    const auto low = std::max<std::uint64_t>(run.first, static_cast<std::uint64_t>(begin) / 2);
    const auto high = std::min<std::uint64_t>(run.first + run.length, static_cast<std::uint64_t>(end) / 2);
    if (low < high) filled.push_back({low - static_cast<std::uint64_t>(begin) / 2, high - low});
  }
  grid.filled = std::move(filled);
  times.erase(behind, times.end());
  times.erase(times.begin(), first);
  return true;
}

std::string doubles(const std::vector<double>& values) {
  std::string data;
  data.reserve(8 * values.size());
  for (const double value : values) simulator::put_double(data, value);
  return data;
}

/// The file's own fill value; no current is that fast, and netCDF's tools know it.
constexpr float kFill = 9.96920996838687e+36F;

/// One component of the current.
ClassicVariable component(const ocean::Grid& grid, std::size_t side, std::vector<std::uint32_t> dimensions,
                          const std::string& cell_methods) {
  ClassicVariable variable{side == 0 ? "uo" : "vo",
                           std::move(dimensions),
                           {{"standard_name", std::string{side == 0 ? "east" : "north"} + "ward_sea_water_velocity"},
                            {"long_name", std::string{side == 0 ? "east" : "north"} + "ward current"},
                            {"units", "m s-1"},
                            {"_FillValue", "", kFill}},
                           ClassicVariable::Type::float32,
                           {}};
  if (!cell_methods.empty()) variable.attributes.push_back({"cell_methods", cell_methods});
  variable.data.reserve(2 * grid.values.size());
  for (std::size_t n = side; n < grid.values.size(); n += 2)
    simulator::put_float(variable.data, std::isnan(grid.values[n]) ? kFill : grid.values[n]);
  return variable;
}

/// The names and hashes of what went in, for who finds the file later.
std::string source_text(const ocean::GridFacts& facts) {
  std::string text = facts.cycle;
  for (const auto& source : facts.sources)
    text += "\n" + source.name.substr(source.name.rfind('/') + 1) + " sha256 " + source.hash.hex();
  return text;
}

std::string netcdf_file(const ocean::Grid& grid, const std::string& cell_methods) {
  const auto& axes = grid.axes;
  constexpr const char* kSince = "seconds since 1970-01-01 00:00:00";
  std::vector<std::pair<std::string, std::size_t>> dimensions;
  std::vector<std::uint32_t> all;
  std::vector<ClassicVariable> variables;
  const auto add_axis = [&](const char* name, const std::vector<double>& values,
                            std::vector<ClassicAttribute> attributes) {
    const auto id = static_cast<std::uint32_t>(dimensions.size());
    dimensions.emplace_back(name, values.size());
    all.push_back(id);
    variables.push_back({name, {id}, std::move(attributes), ClassicVariable::Type::float64, doubles(values)});
  };
  if (axes.has_time)
    add_axis("time", axes.times_s,
             {{"standard_name", "time"}, {"units", kSince}, {"calendar", "standard"}, {"axis", "T"}});
  if (axes.has_depth)
    add_axis("depth", axes.depths_m, {{"standard_name", "depth"}, {"units", "m"}, {"positive", "down"}, {"axis", "Z"}});
  add_axis("lat", axes.lats_deg, {{"standard_name", "latitude"}, {"units", "degrees_north"}, {"axis", "Y"}});
  add_axis("lon", axes.lons_deg, {{"standard_name", "longitude"}, {"units", "degrees_east"}, {"axis", "X"}});
  if (!std::isnan(grid.facts.reference_s))
    variables.push_back({"forecast_reference_time",
                         {},
                         {{"standard_name", "forecast_reference_time"}, {"units", kSince}, {"calendar", "standard"}},
                         ClassicVariable::Type::float64,
                         doubles({grid.facts.reference_s})});
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}})
    variables.push_back(component(grid, side, all, cell_methods));
  return simulator::classic_file(dimensions,
                                 {{"Conventions", "CF-1.8"},
                                  {"title", "currents read and checked by glidehelm"},
                                  {"source", source_text(grid.facts)},
                                  {"history", "glidehelm field convert"}},
                                 variables);
}

std::string misuse_of(const FieldConvertOptions& options) {
  if (options.files.empty()) return "no file was named";
  if (!options.out.ends_with(".nc") && !options.out.ends_with(".grid"))
    return "--out " + options.out + ": allowed is a name that ends in .nc (CF NetCDF) or .grid (flat grid)";
  if (options.depth_mean && !(options.depth_mean->first >= 0 && options.depth_mean->second > options.depth_mean->first))
    return "--depth-mean MIN,MAX: allowed is 0 ≤ MIN < MAX";
  if (options.from && options.to && *options.to < *options.from) return "--times FROM,TO: FROM is after TO";
  return {};
}

/// "0 to 400 m", for people.
std::string range_text(const std::pair<double, double>& depths) {
  return decimal(depths.first, 0) + " to " + decimal(depths.second, 0) + " m";
}

}  // namespace

int run_field_convert(const FieldConvertOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  if (const auto misuse = misuse_of(options); !misuse.empty()) return refuse_field(err, 2, misuse);
  if (const auto why = why_not_new(options.out, world.files); !why.empty()) return refuse_field(err, 1, why);
  auto reading = options.ingest;
  if (!reading.fill_gaps_km) reading.fill_gaps_km = 0;
  const auto loaded = daemon::ingest_files(options.files, reading, world);
  if (!loaded) return refuse_field(err, 1, loaded.error());
  const auto& view = (*loaded)->view;
  for (const auto& warning : view.facts.warnings) err << "glidehelm field: warning: " << warning << '\n';

  ocean::Grid grid;
  std::string cell_methods;
  if (options.depth_mean && view.axes.depths_m.size() > 1) {
    grid = ocean::depth_average(
        view, ocean::DiveProfile::between(Metres{options.depth_mean->first}, Metres{options.depth_mean->second}));
    cell_methods = "depth: mean (comment: " + range_text(*options.depth_mean) + ", each column down to its bottom)";
  } else {
    if (options.depth_mean) err << "glidehelm field: warning: one depth only: --depth-mean changes nothing\n";
    grid = {view.axes, view.facts, {view.values, view.values + 2 * view.axes.nodes()}, view.filled};
  }
  if (!keep_times(grid, options))
    return refuse_field(err, 1,
                        "no time is within --times; the files have " + std::to_string(view.axes.times_s.size()) + ", " +
                            time_text(view.axes.times_s.front()) + " to " + time_text(view.axes.times_s.back()));
  if (!grid.filled.empty())
    err << "glidehelm field: warning: filled gaps are written like published values; leave out --fill-gaps to keep "
           "them apart\n";

  const bool netcdf = options.out.ends_with(".nc");
  // The classic format counts the bytes of a variable with 32 bits.
  if (netcdf && grid.axes.nodes() >= (std::size_t{1} << 30))
    return refuse_field(err, 1, "more than 4 GiB in one variable, which the format cannot hold; cut it with --box");
  const auto bytes = netcdf ? netcdf_file(grid, cell_methods) : ocean::write_grid(grid);
  if (const auto wrong = write_new_file(options.out, bytes, world.files); !wrong.empty())
    return refuse_field(err, 1, wrong);
  out << options.out << ": " << grid.axes.times_s.size() << (grid.axes.times_s.size() == 1 ? " time, " : " times, ")
      << grid.axes.depths_m.size() << (grid.axes.depths_m.size() == 1 ? " depth, " : " depths, ")
      << grid.axes.lats_deg.size() << " by " << grid.axes.lons_deg.size() << " nodes, " << bytes.size() << " bytes\n";
  return 0;
}

}  // namespace glidehelm::cli
