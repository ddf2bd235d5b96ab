#include "daemon/ingest/depth_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/base/one_line.hpp"
#include "core/base/text.hpp"
#include "daemon/ingest/ascii_grid.hpp"
#include "daemon/ingest/grid_file.hpp"
#include "daemon/ingest/recognise.hpp"
#include "daemon/ingest/whole_file.hpp"

namespace glidehelm::ingest {

namespace {

using Positive = DepthOptions::Positive;

constexpr const char* kAskPositive =
    "say --positive up (heights: the sea is negative) or --positive down (depths: the sea is positive)";

bool has(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

/// What words say about heights or depths: true up, false down.
std::optional<bool> direction_of(std::string_view words) {
  const std::string text = lower(words);
  if (has(text, "depth")) return false;
  for (const auto* up : {"elevation", "height", "altitude", "relief", "topography"})
    if (has(text, up)) return true;
  return std::nullopt;
}

/// Names that only ever hold one of the two.
std::optional<bool> direction_of_name(std::string_view name) {
  const std::string word = lower(name);
  for (const auto* up : {"elevation", "altitude", "topo", "height"})
    if (word == up) return true;
  for (const auto* down : {"depth", "deptho"})
    if (word == down) return false;
  return std::nullopt;
}

Sign told(Positive positive) { return {positive == Positive::up, "--positive"}; }

std::string words_of(const Sign& sign) {
  return std::string{sign.up ? "heights, positive up" : "depths, positive down"} + ", by " + sign.why;
}

/// Numbers of the file become depths, in place.
Result<Done> turn_down(std::vector<double>& values, const Sign& sign) {
  double deepest = -std::numeric_limits<double>::infinity();
  for (double& value : values) {
    if (sign.up) value = -value;
    if (!(std::abs(value) <= 12'000)) value = kNaN;  // deeper than the deepest trench, higher than any mountain
    if (!std::isnan(value)) deepest = std::max(deepest, value);
  }
  if (std::isinf(deepest)) return fault("no depth is known anywhere");
  if (deepest <= 0) return fault("with " + words_of(sign) + ", every place would be land; " + kAskPositive);
  return Done{};
}

/// The part of an even grid that covers an area, with a node to spare.
Result<Done> keep(chart::DepthGrid& grid, const Area& area) {
  const double width = grid.lon_step_deg * static_cast<double>(grid.columns - 1);
  const double middle = grid.west_deg + 0.5 * width;
  const double shift = 360 * std::round((middle - 0.5 * (area.west + area.east)) / 360);
  const auto first = [](double at, double from, double step) { return std::max(0.0, std::floor((at - from) / step)); };
  const auto last = [](double at, double from, double step, std::size_t n) {
    return std::min(static_cast<double>(n - 1), std::ceil((at - from) / step));
  };
  const double c0 = first(area.west + shift, grid.west_deg, grid.lon_step_deg);
  const double c1 = last(area.east + shift, grid.west_deg, grid.lon_step_deg, grid.columns);
  const double r0 = first(area.south, grid.south_deg, grid.lat_step_deg);
  const double r1 = last(area.north, grid.south_deg, grid.lat_step_deg, grid.rows);
  if (!(c1 > c0 && r1 > r0)) return fault("nothing of the bathymetry lies in --area");
  chart::DepthGrid part = grid;
  part.west_deg += c0 * grid.lon_step_deg;
  part.south_deg += r0 * grid.lat_step_deg;
  part.columns = static_cast<std::size_t>(c1 - c0) + 1;
  part.rows = static_cast<std::size_t>(r1 - r0) + 1;
  part.depths_m.clear();
  for (std::size_t r = 0; r < part.rows; ++r) {
    const auto* row = grid.depths_m.data() + (static_cast<std::size_t>(r0) + r) * grid.columns;
    part.depths_m.insert(part.depths_m.end(), row + static_cast<std::size_t>(c0),
                         row + static_cast<std::size_t>(c1) + 1);
  }
  grid = std::move(part);
  return Done{};
}

// ---- ESRI ASCII

/// The zone of a grid in metres, nothing for one in degrees, with the words for it.
Result<std::optional<UtmZone>> crs_of(const AsciiGrid& grid, const DepthOptions& options, std::string& words) {
  const double east = grid.x + grid.dx * static_cast<double>(grid.columns - 1);
  const double north = grid.y + grid.dy * static_cast<double>(grid.rows - 1);
  const bool can_be_degrees = grid.x >= -360 && east <= 540 && grid.y >= -90 && north <= 90;
  const std::string asked = lower(trimmed(options.crs));
  if (const auto zone = utm_zone_from(asked)) {
    words = asked + " by --crs";
    return std::optional{*zone};
  }
  if (!asked.empty() && asked != "degrees" && asked != "epsg:4326")
    return fault("--crs " + one_line(options.crs) +
                 ": allowed are degrees, UTM on WGS84 as utm33n or utm33s, and EPSG:326NN or EPSG:327NN");
  if (asked.empty() && !options.prj.empty() && has(options.prj, "PROJCS")) {
    const auto zone = zone_of_prj(options.prj);
    if (!zone) return unexpected(zone.error());
    words = "UTM " + std::to_string(zone->number) + (zone->north ? "N" : "S") + " by the .prj file";
    return std::optional{*zone};
  }
  if (!can_be_degrees)
    return fault("the corner " + std::to_string(grid.x) + ", " + std::to_string(grid.y) +
                 " is no longitude and latitude; say in which metres it is: --crs utm33n (or a .prj file beside it)");
  words = asked.empty() ? "degrees by their range" : "degrees by --crs";
  return std::optional<UtmZone>{};
}

std::vector<double> south_first(const AsciiGrid& grid) {
  std::vector<double> values;
  values.reserve(grid.values.size());
  for (std::size_t row = grid.rows; row-- > 0;)
    values.insert(values.end(), grid.values.begin() + static_cast<std::ptrdiff_t>(row * grid.columns),
                  grid.values.begin() + static_cast<std::ptrdiff_t>((row + 1) * grid.columns));
  return values;
}

DepthMesh mesh_in_utm(const AsciiGrid& grid, const UtmZone& zone, std::vector<double> depths) {
  DepthMesh mesh{grid.rows, grid.columns, {}, {}, std::move(depths)};
  const double central = 6.0 * zone.number - 183.0;
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const auto p =
          from_utm(zone, grid.x + grid.dx * static_cast<double>(column), grid.y + grid.dy * static_cast<double>(row));
      mesh.lats.push_back(p ? p->lat.degrees() : kNaN);
      mesh.lons.push_back(p ? central + std::remainder(p->lon.degrees() - central, 360.0) : kNaN);
    }
  return mesh;
}

Result<chart::DepthGrid> read_ascii(std::string_view bytes, const DepthOptions& options) {
  auto ascii = read_ascii_grid(bytes);
  if (!ascii) return unexpected(ascii.error());
  if (options.positive == Positive::unknown)
    return fault(std::string{"an ESRI ASCII grid does not say which way its numbers count; "} + kAskPositive);
  std::string crs;
  const auto zone = crs_of(*ascii, options, crs);
  if (!zone) return unexpected(zone.error());
  const auto sign = told(options.positive);
  auto depths = south_first(*ascii);
  if (auto turned = turn_down(depths, sign); !turned) return unexpected(turned.error());
  auto grid = [&]() -> Result<chart::DepthGrid> {
    if (*zone) return even_depths(mesh_in_utm(*ascii, **zone, std::move(depths)));
    std::vector<double> lats, lons;
    for (std::size_t row = 0; row < ascii->rows; ++row) lats.push_back(ascii->y + ascii->dy * static_cast<double>(row));
    for (std::size_t k = 0; k < ascii->columns; ++k) lons.push_back(ascii->x + ascii->dx * static_cast<double>(k));
    return even_depths(lats, lons, depths);
  }();
  if (!grid) return grid;
  grid->source = "ESRI ASCII grid of " + std::to_string(ascii->columns) + " by " + std::to_string(ascii->rows) +
                 " cells, placed by " + (ascii->corner ? "corner" : "centre") + ", " + crs;
  grid->decided = words_of(sign);
  return grid;
}

// ---- NetCDF

/// True for a variable with numbers on two dimensions longer than one.
bool is_plane(const NetcdfFile& file, const Variable& variable) {
  if (!is_number(variable.type)) return false;
  std::size_t longer = 0;
  for (const auto dimension : variable.dimensions) longer += file.length_of(dimension) > 1 ? 1 : 0;
  return longer == 2 && variable.dimensions.size() >= 2;
}

/// Rank of a variable as a bathymetry: 0 standard_name, 1 known name, 2 says so in words, 3 anything else.
int rank_of(const Variable& variable) {
  const std::string standard = lower(variable.text("standard_name")), name = lower(variable.name);
  if (has(standard, "sea_floor_depth") || has(standard, "bathymetry") || standard == "surface_altitude") return 0;
  for (const auto* known :
       {"elevation", "z", "depth", "band1", "bathymetry", "topo", "deptho", "altitude", "bathy", "h", "rose"})
    if (name == known) return 1;
  return direction_of(variable.text("long_name")) ? 2 : 3;
}

Result<const Variable*> depth_variable(const NetcdfFile& file, const std::string& asked) {
  if (!asked.empty()) {
    const auto* variable = file.find(asked);
    if (variable == nullptr || !is_plane(file, *variable))
      return fault("variable " + one_line(asked) + " is not in the file, or has not two dimensions");
    return variable;
  }
  std::array<std::vector<const Variable*>, 4> ranked;
  std::string names;
  for (const auto& variable : file.variables()) {
    if (!is_plane(file, variable)) continue;
    const auto role = role_of(variable);
    if (role == Role::latitude || role == Role::longitude) continue;
    names += (names.empty() ? "" : ", ") + file.shape_of(variable);
    ranked[static_cast<std::size_t>(rank_of(variable))].push_back(&variable);
  }
  for (const auto& same : ranked) {
    if (same.size() == 1) return same.front();
    if (!same.empty()) return fault("several variables may be the depth: " + names + "; choose with --depth-variable");
  }
  return fault("no variable holds depths on latitude and longitude");
}

/// A depth's values with its two long dimensions as rows and columns, in metres.
Result<std::vector<double>> metres_of(const NetcdfFile& file, const Variable& variable, const Units& units,
                                      std::string& unit_words) {
  auto values = plain_numbers({&file, &variable});
  if (!values) return values;
  const auto unit = variable.unit();
  unit_words = unit ? "" : ", metres since no unit is given";
  if (!unit) return values;
  const auto scaling = units.scaling(*unit, "m");
  if (!scaling) return unexpected(scaling.error());
  for (double& value : *values) value = (*scaling)(value);
  return values;
}

/// Longitudes without a jump, from the first known one on.
void unwrap(std::vector<double>& lons) {
  double first = kNaN;
  for (double& lon : lons) {
    if (std::isnan(first)) first = lon;
    lon = first + std::remainder(lon - first, 360.0);
  }
}

Result<chart::DepthGrid> on_axes(const NetcdfFile& file, const Variable& variable, const Units& units,
                                 const std::vector<double>& values, std::string& words) {
  const auto axes = recognise_axes(file, variable);
  if (!axes) return unexpected(axes.error());
  std::vector<std::string> warnings;
  auto lats = latitudes(file, *axes->latitude.coordinate, units, warnings);
  if (!lats) return unexpected(lats.error());
  auto lons = longitudes(file, *axes->longitude.coordinate, units, warnings);
  if (!lons) return unexpected(lons.error());
  const bool lat_first = *axes->latitude.position < *axes->longitude.position;
  const std::size_t columns = file.length_of(variable.dimensions[*axes->longitude.position]);
  const std::size_t rows = file.length_of(variable.dimensions[*axes->latitude.position]);
  std::vector<double> depths;
  depths.reserve(values.size());
  for (const auto r : lats->source)
    for (const auto c : lons->source) depths.push_back(values[lat_first ? r * columns + c : c * rows + r]);
  words = file.shape_of(variable);
  for (const auto& warning : warnings) words += "; " + warning;
  return even_depths(lats->values, lons->values, depths);
}

Result<chart::DepthGrid> read_netcdf(std::string_view bytes, const DepthOptions& options, const Units& units) {
  const std::span<const std::byte> span{reinterpret_cast<const std::byte*>(bytes.data()), bytes.size()};
  if (auto whole = check_whole(span); !whole) return unexpected(whole.error());
  const auto file = NetcdfFile::open(span);
  if (!file) return unexpected(file.error());
  const auto variable = depth_variable(*file, options.variable);
  if (!variable) return unexpected(variable.error());
  Sign sign = told(options.positive);
  if (options.positive == Positive::unknown) {
    auto found = sign_of(**variable);
    if (!found) return unexpected(found.error());
    sign = std::move(*found);
  }
  std::string unit_words, words;
  auto values = metres_of(*file, **variable, units, unit_words);
  if (!values) return unexpected(values.error());
  if (auto turned = turn_down(*values, sign); !turned) return unexpected(turned.error());
  auto grid = [&]() -> Result<chart::DepthGrid> {
    const auto positions = own_positions({&*file, *variable});
    if (!positions || positions->lat.variable->dimensions.size() == 1)
      return on_axes(*file, **variable, units, *values, words);
    auto mesh = mesh_of(*positions);
    if (!mesh) return unexpected(mesh.error());
    if (mesh->lat.size() != values->size()) return fault("positions and depths are not of one shape");
    unwrap(mesh->lon);
    words = file->shape_of(**variable) + " on the curvilinear grid " + positions->words();
    return even_depths({mesh->rows, mesh->columns, std::move(mesh->lat), std::move(mesh->lon), std::move(*values)});
  }();
  if (!grid) return grid;
  grid->source = one_line("NetCDF " + words + unit_words);
  grid->decided = one_line(words_of(sign));
  return grid;
}

}  // namespace

Result<UtmZone> zone_of_prj(std::string_view wkt) {
  const std::string text = lower(wkt);
  const auto refused = [](const std::string& why) {
    return fault("the .prj file " + why +
                 "; read is UTM on WGS84, NAD83 or ETRS89 in metres: give --crs, or convert it");
  };
  if (!has(text, "transverse_mercator")) return refused("names no UTM projection");
  if (!has(text, "wgs_1984") && !has(text, "wgs 84") && !has(text, "north_american_1983") && !has(text, "nad83") &&
      !has(text, "etrs"))
    return refused("names another datum");
  const auto at = text.find("utm");
  const auto zone = at == std::string::npos ? at : text.find("zone", at);
  if (zone == std::string::npos) return refused("names no UTM zone");
  std::string name = "utm";
  for (auto i = zone + 4; i < text.size() && name.size() < 6; ++i) {
    const char c = text[i];
    if (c >= '0' && c <= '9') name += c;
    if (name.size() > 3 && (c == 'n' || c == 's')) {
      name += c;
      break;
    }
    if (c == '"') break;
  }
  const auto found = utm_zone_from(name);
  if (!found) return refused("names no UTM zone");
  if (!has(text, "unit[\"met")) return refused("is not in metres");
  return *found;
}

Result<Sign> sign_of(const Variable& variable) {
  std::vector<Sign> says;
  const std::string positive = lower(variable.text("positive"));
  if (positive == "up" || positive == "down")
    says.push_back({positive == "up", "its attribute positive = " + positive});
  const auto add = [&](std::optional<bool> up, const std::string& why) {
    if (up) says.push_back({*up, why});
  };
  add(direction_of(variable.text("standard_name")), "its standard_name " + variable.text("standard_name"));
  add(direction_of_name(variable.name), "its name " + variable.name);
  if (says.empty()) add(direction_of(variable.text("long_name")), "its long_name '" + variable.text("long_name") + "'");
  if (says.empty())
    return fault("variable " + one_line(variable.name) + " does not say which way its numbers count; " + kAskPositive);
  for (const auto& other : says)
    if (other.up != says.front().up)
      return fault("variable " + one_line(variable.name) + " contradicts itself: " + one_line(says.front().why) +
                   " against " + one_line(other.why) + "; " + kAskPositive);
  return says.front();
}

Result<chart::DepthGrid> read_depths(std::string_view bytes, const DepthOptions& options, const Units& units) {
  auto grid = is_ascii_grid(bytes) ? read_ascii(bytes, options) : read_netcdf(bytes, options, units);
  if (!grid) return grid;
  if (options.area)
    if (auto kept = keep(*grid, *options.area); !kept) return unexpected(kept.error());
  if (auto problem = grid->problem()) return fault(*problem);
  return grid;
}

}  // namespace glidehelm::ingest
