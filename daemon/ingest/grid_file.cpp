#include "daemon/ingest/grid_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/base/text.hpp"
#include "core/base/units.hpp"
#include "daemon/ingest/component.hpp"
#include "daemon/ingest/recognise.hpp"

namespace glidehelm::ingest {

namespace {

using Names = std::pair<std::string_view, std::string_view>;

/// Latitude and longitude of centres, by the models that write them.
constexpr std::array<Names, 10> kCentres{{{"lat_rho", "lon_rho"},
                                          {"gphit", "glamt"},
                                          {"nav_lat_grid_T", "nav_lon_grid_T"},
                                          {"TLAT", "TLONG"},
                                          {"geolat", "geolon"},
                                          {"YC", "XC"},
                                          {"yh", "xh"},
                                          {"nav_lat", "nav_lon"},
                                          {"lat", "lon"},
                                          {"latitude", "longitude"}}};
constexpr std::array<Names, 5> kFacesOfU{{{"gphiu", "glamu"},
                                          {"nav_lat_grid_U", "nav_lon_grid_U"},
                                          {"geolat_u", "geolon_u"},
                                          {"lat_u", "lon_u"},
                                          {"YC", "XG"}}};
constexpr std::array<Names, 5> kFacesOfV{{{"gphiv", "glamv"},
                                          {"nav_lat_grid_V", "nav_lon_grid_V"},
                                          {"geolat_v", "geolon_v"},
                                          {"lat_v", "lon_v"},
                                          {"YG", "XC"}}};

bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }
bool is_field(const Variable& variable) { return is_number(variable.type) && variable.dimensions.size() >= 2; }

std::size_t length(const Found& found, std::size_t from_last) {
  const auto& dimensions = found.variable->dimensions;
  return found.file->length_of(dimensions[dimensions.size() - 1 - from_last]);
}

/// A pair of positions of which both exist, in one file, and fit each other.
std::optional<Positions> positions_named(const ModelFiles& files, const Names& names) {
  for (const auto* file : files.files()) {
    const Positions p{{file, file->find(names.first)}, {file, file->find(names.second)}};
    if (!p.lat || !p.lon || !is_number(p.lat.variable->type) || !is_number(p.lon.variable->type)) continue;
    const auto &a = p.lat.variable->dimensions, &b = p.lon.variable->dimensions;
    if (a.size() == 1 && b.size() == 1 && a != b) return p;
    // A leading dimension of one, as in NEMO's coordinates.nc, says nothing.
    if (a.size() >= 2 && a == b && p.shape().rows * p.shape().columns > 0) {
      std::size_t leading = 1;
      for (std::size_t d = 0; d + 2 < a.size(); ++d) leading *= file->length_of(a[d]);
      if (leading == 1) return p;
    }
  }
  return std::nullopt;
}

bool is_latitude(const Variable& v) {
  const auto standard = lower(v.text("standard_name")), name = lower(v.name);
  return standard == "latitude" || role_of(v) == Role::latitude || contains(name, "lat") || contains(name, "gphi");
}
bool is_longitude(const Variable& v) {
  const auto standard = lower(v.text("standard_name")), name = lower(v.name);
  return standard == "longitude" || role_of(v) == Role::longitude || contains(name, "lon") || contains(name, "glam");
}

std::optional<Positions> faces_named(const ModelFiles& files, const std::array<Names, 5>& names, const Shape& shape) {
  for (const auto& name : names)
    if (auto positions = positions_named(files, name); positions && positions->shape() == shape) return positions;
  return std::nullopt;
}

/// Median offset from mesh b's points to mesh a's, in cells along b's axes.
std::pair<double, double> offset_in_cells(const Mesh& a, const Mesh& b) {
  std::vector<double> along_xi, along_eta;
  for (std::size_t j = 0; j + 1 < b.rows; ++j)
    for (std::size_t i = 0; i + 1 < b.columns; ++i) {
      const std::size_t here = b.index(j, i), right = here + 1, up = here + b.columns;
      const double squeeze = std::cos(b.lat[here] * kPi / 180);
      const double xi_x = fold_degrees(b.lon[right] - b.lon[here]) * squeeze, xi_y = b.lat[right] - b.lat[here];
      const double eta_x = fold_degrees(b.lon[up] - b.lon[here]) * squeeze, eta_y = b.lat[up] - b.lat[here];
      const double x = fold_degrees(a.lon[here] - b.lon[here]) * squeeze, y = a.lat[here] - b.lat[here];
      const double determinant = xi_x * eta_y - xi_y * eta_x;
      const double xi = (x * eta_y - y * eta_x) / determinant, eta = (xi_x * y - xi_y * x) / determinant;
      if (!std::isfinite(xi) || !std::isfinite(eta)) continue;
      along_xi.push_back(xi);
      along_eta.push_back(eta);
    }
  return {median(std::move(along_xi)), median(std::move(along_eta))};
}

/// Centres half a cell beside the positions of u.
Mesh centres_from(const Mesh& u, int before) {
  Mesh centres{u.rows, u.columns, std::vector<double>(u.lat.size(), kNaN), std::vector<double>(u.lat.size(), kNaN)};
  for (std::size_t j = 0; j < u.rows; ++j)
    for (std::size_t i = 0; i < u.columns; ++i) {
      const std::size_t here = u.index(j, i);
      // Between the faces behind and before; at the end of the row as far beside the face as its neighbour lies.
      const bool end = before < 0 ? i == 0 : i + 1 == u.columns;
      const std::size_t other = (before < 0) == end ? here + 1 : here - 1;
      const double sign = end ? -0.5 : 0.5;
      centres.lat[here] = u.lat[here] + sign * (u.lat[other] - u.lat[here]);
      centres.lon[here] = u.lon[here] + sign * fold_degrees(u.lon[other] - u.lon[here]);
    }
  return centres;
}

std::string where(const Found& u, const Found& v) {
  return u.file->shape_of(*u.variable) + " (" + text(*shape_of(u)) + ") and " + v.file->shape_of(*v.variable) + " (" +
         text(*shape_of(v)) + ")";
}

}  // namespace

Found ModelFiles::find(std::string_view name) const {
  for (const auto* file : files_)
    if (const auto* variable = file->find(name); variable != nullptr && is_number(variable->type))
      return {file, variable};
  return {};
}
Found ModelFiles::first_of(std::initializer_list<std::string_view> names) const {
  for (const auto name : names)
    if (auto found = find(name)) return found;
  return {};
}

std::optional<Shape> shape_of(const Found& found) {
  if (!found || found.variable->dimensions.size() < 2) return std::nullopt;
  return Shape{length(found, 1), length(found, 0)};
}
std::string text(const Shape& shape) { return std::to_string(shape.rows) + " by " + std::to_string(shape.columns); }

Result<std::vector<double>> plain_numbers(const Found& found) {
  std::vector<std::size_t> start(found.variable->dimensions.size(), 0), count;
  for (const auto dimension : found.variable->dimensions) count.push_back(found.file->length_of(dimension));
  return plain_numbers(found, start, count);
}

Result<std::vector<double>> plain_numbers(const Found& found, const std::vector<std::size_t>& start,
                                          const std::vector<std::size_t>& count) {
  auto values = found.file->read(*found.variable, start, count);
  if (!values) return values;
  const Missing missing{*found.variable};
  const auto *scale = found.variable->find("scale_factor"), *offset = found.variable->find("add_offset");
  for (double& value : *values) {
    if (missing(value) || !(std::abs(value) < 9e36)) {
      value = kNaN;
      continue;
    }
    if (scale != nullptr && !scale->numbers.empty()) value *= scale->numbers[0];
    if (offset != nullptr && !offset->numbers.empty()) value += offset->numbers[0];
  }
  return values;
}

std::optional<double> scalar_of(const Found& found) {
  if (!found) return std::nullopt;
  for (const auto dimension : found.variable->dimensions)
    if (found.file->length_of(dimension) != 1) return std::nullopt;
  const auto values = plain_numbers(found);
  if (!values || values->size() != 1 || std::isnan((*values)[0])) return std::nullopt;
  return (*values)[0];
}

Shape Positions::shape() const {
  if (lat.variable->dimensions.size() == 1) return {length(lat, 0), length(lon, 0)};
  return {length(lat, 1), length(lat, 0)};
}
std::string Positions::words() const { return lat.variable->name + ", " + lon.variable->name; }

Result<Mesh> mesh_of(const Positions& positions) {
  const Shape shape = positions.shape();
  Mesh mesh{shape.rows, shape.columns, {}, {}};
  for (const auto& [found, list] : {std::pair{&positions.lat, &mesh.lat}, std::pair{&positions.lon, &mesh.lon}}) {
    auto values = plain_numbers(*found);
    if (!values) return unexpected(values.error());
    if (lower(found->variable->unit().value_or("")).rfind("rad", 0) == 0)
      for (double& value : *values) value *= 180 / kPi;
    *list = std::move(*values);
  }
  if (positions.lat.variable->dimensions.size() == 1) {
    const auto lats = std::move(mesh.lat), lons = std::move(mesh.lon);
    mesh.lat.assign(shape.rows * shape.columns, 0);
    mesh.lon = mesh.lat;
    for (std::size_t j = 0; j < shape.rows; ++j)
      for (std::size_t i = 0; i < shape.columns; ++i) {
        mesh.lat[mesh.index(j, i)] = lats[j];
        mesh.lon[mesh.index(j, i)] = lons[i];
      }
  }
  if (drop_impossible_positions(mesh) == mesh.lat.size())
    return fault(positions.words() + " hold no position (are they missing, or metres of a map projection?)");
  return mesh;
}

std::optional<Positions> own_positions(const Found& velocity) {
  const auto& dimensions = velocity.variable->dimensions;
  if (dimensions.size() < 2) return std::nullopt;
  const std::vector<std::size_t> last{dimensions[dimensions.size() - 2], dimensions[dimensions.size() - 1]};
  const std::string named = " " + velocity.variable->text("coordinates") + " ";
  for (const bool by_attribute : {true, false}) {
    Positions positions;
    for (const auto& variable : velocity.file->variables()) {
      if (!is_number(variable.type) || variable.dimensions != last || contains(variable.name, "bnds") ||
          contains(variable.name, "bounds"))
        continue;
      if (by_attribute && !contains(named, " " + variable.name + " ")) continue;
      if (!positions.lat && is_latitude(variable))
        positions.lat = {velocity.file, &variable};
      else if (!positions.lon && is_longitude(variable))
        positions.lon = {velocity.file, &variable};
    }
    if (positions.lat && positions.lon) return positions;
  }
  Positions axes;
  for (const auto& variable : velocity.file->variables()) {
    if (!is_number(variable.type) || variable.dimensions.size() != 1) continue;
    if (!axes.lat && variable.dimensions[0] == last[0] && role_of(variable) == Role::latitude)
      axes.lat = {velocity.file, &variable};
    if (!axes.lon && variable.dimensions[0] == last[1] && role_of(variable) == Role::longitude)
      axes.lon = {velocity.file, &variable};
  }
  if (axes.lat && axes.lon) return axes;
  return std::nullopt;
}

namespace {

struct Centred {
  Mesh centres;
  Staggering staggering;
  std::string words;
};

/// Shapes alone tell: a column less and a row less (ROMS), or one more of each.
std::optional<Staggering> staggering_by_shape(const Shape& c, const Shape& u, const Shape& v) {
  Staggering s{true, {false, 0, u.rows, u.columns}, {true, 0, v.rows, v.columns}, {}};
  if (u == Shape{c.rows, c.columns - 1} && v == Shape{c.rows - 1, c.columns}) {
    s.u.before = s.v.before = -1;
    s.words = "u and v on the inner faces";
    return s;
  }
  if (u == Shape{c.rows, c.columns + 1} && v == Shape{c.rows + 1, c.columns}) {
    s.words = "u and v on all faces";
    return s;
  }
  return std::nullopt;
}

/// All of one shape: the positions of u and v must tell.
Result<Centred> centred_by_positions(const ModelFiles& files, const std::optional<Positions>& centre, const Found& u,
                                     const Found& v, bool east_north) {
  const Shape shape = *shape_of(u);
  auto at_u = faces_named(files, kFacesOfU, shape), at_v = faces_named(files, kFacesOfV, shape);
  if (!at_u || !at_v) at_u = own_positions(u), at_v = own_positions(v);
  if (at_u && at_v) {
    const auto mesh_u = mesh_of(*at_u), mesh_v = mesh_of(*at_v);
    if (!mesh_u) return unexpected(mesh_u.error());
    if (!mesh_v) return unexpected(mesh_v.error());
    const auto [xi, eta] = offset_in_cells(*mesh_u, *mesh_v);
    constexpr double kNear = 0.1;
    if (std::abs(xi) < kNear && std::abs(eta) < kNear) return Centred{*mesh_u, Staggering{}, at_u->words()};
    const int before = xi > 0 ? -1 : 0;
    const double half = xi > 0 ? 0.5 : -0.5;
    if (std::abs(xi - half) < kNear && std::abs(eta + half) < kNear) {
      Staggering s{true, {false, before, shape.rows, shape.columns}, {true, before, shape.rows, shape.columns}, {}};
      s.words = before < 0 ? "u and v on the faces behind their centres" : "u and v on the faces before their centres";
      if (centre) {
        auto centres = mesh_of(*centre);
        if (!centres) return unexpected(centres.error());
        const auto [from_u, aside] = offset_in_cells(*mesh_u, *centres);
        if (std::abs(from_u - half) < kNear && std::abs(aside) < kNear)
          return Centred{std::move(*centres), s, centre->words()};
      }
      return Centred{centres_from(*mesh_u, before), s, "half a cell beside " + at_u->words()};
    }
    char how[96];
    std::snprintf(how, sizeof how, "u lies %.2f, %.2f cells from v", xi, eta);
    return fault_alone("the staggering of " + where(u, v) + " is not known: " + how +
                       ", allowed is none or half a cell along each axis");
  }
  if (centre && east_north) {
    auto centres = mesh_of(*centre);
    if (!centres) return unexpected(centres.error());
    return Centred{std::move(*centres), Staggering{}, centre->words()};
  }
  return fault_alone(
      where(u, v) + " have the shape of the grid's centres but no positions of their own: they may lie on the " +
      "centres or on the faces; needed are positions in their file, or glamu, gphiu, glamv and gphiv in a grid file");
}

}  // namespace

bool has_plane_positions(const ModelFiles& files) {
  return std::any_of(kCentres.begin(), kCentres.end(), [&](const Names& names) {
    const auto positions = positions_named(files, names);
    return positions && positions->lat.variable->dimensions.size() > 1;
  });
}

Result<ModelGrid> model_grid(const ModelFiles& files, const Found& u, const Found& v, bool east_north) {
  const Shape su = *shape_of(u), sv = *shape_of(v);
  std::optional<Positions> same_shape;
  std::string seen;
  std::optional<Centred> centred;
  for (const auto& names : kCentres) {
    const auto positions = positions_named(files, names);
    if (!positions) continue;
    const Shape shape = positions->shape();
    seen += (seen.empty() ? "" : "; ") + positions->words() + " " + text(shape);
    if (auto staggering = staggering_by_shape(shape, su, sv)) {
      auto mesh = mesh_of(*positions);
      if (!mesh) return unexpected(mesh.error());
      centred = Centred{std::move(*mesh), *staggering, positions->words()};
      break;
    }
    if (shape == su && su == sv && !same_shape) same_shape = positions;
  }
  if (!centred && su == sv) {
    auto found = centred_by_positions(files, same_shape, u, v, east_north);
    if (!found) return unexpected(found.error());
    centred = std::move(*found);
  }
  if (!centred)
    return fault_alone(where(u, v) + " fit no positions of grid points (" + (seen.empty() ? "there are none" : seen) +
                       "); name the model's grid file among the files or with --grid-file");
  ModelGrid grid{std::move(centred->centres), centred->staggering, {}, centred->words};
  grid.words = std::string{separable_axes(grid.centres) ? "rectilinear" : "curvilinear"} +
               (grid.staggering.staggered ? " Arakawa C grid of " : " grid of ") +
               text(Shape{grid.centres.rows, grid.centres.columns}) + " points (" + grid.centre_words + ")" +
               (grid.staggering.staggered ? ", " + grid.staggering.words + ", averaged to the points" : "");
  return grid;
}

namespace {

using Sense = ModelVelocity::Sense;

struct KnownPair {
  std::string_view u, v;
  Sense sense;
};
constexpr std::array<KnownPair, 8> kKnown{{{"u_eastward", "v_northward", Sense::east_north},
                                           {"u", "v", Sense::open},
                                           {"u_sur", "v_sur", Sense::open},
                                           {"uo", "vo", Sense::open},
                                           {"vozocrtx", "vomecrty", Sense::grid_axes},
                                           {"water_u", "water_v", Sense::open},
                                           {"uVelocity", "vVelocity", Sense::open},
                                           {"ubar", "vbar", Sense::open}}};

/// What the attributes of a component say about its direction.
Sense sense_of(const Variable& u) {
  const auto standard = lower(u.text("standard_name")), words = lower(u.text("long_name"));
  if (standard.ends_with("eastward_sea_water_velocity")) return Sense::east_north;
  if (contains(standard, "sea_water") && standard.ends_with("x_velocity")) return Sense::grid_axes;
  if (contains(words, "eastward") || contains(words, "zonal")) return Sense::east_north;
  for (const char* part : {"u-momentum", "x-direction", "x-axis", "i-axis", "xi-direction", "along x", "grid x"})
    if (contains(words, part)) return Sense::grid_axes;
  return Sense::open;
}

bool is_u(const Variable& variable) {
  const auto standard = lower(variable.text("standard_name"));
  return is_field(variable) && (standard.ends_with("eastward_sea_water_velocity") ||
                                (contains(standard, "sea_water") && standard.ends_with("_x_velocity")));
}

/// The standard_name of the other component.
std::string partner_name(std::string standard) {
  const auto replace = [&](const std::string& from, const std::string& to) {
    if (const auto at = standard.rfind(from); at != std::string::npos) standard.replace(at, from.size(), to);
  };
  if (contains(standard, "eastward"))
    replace("eastward", "northward");
  else
    replace("_x_velocity", "_y_velocity");
  return standard;
}

std::vector<ModelVelocity> by_standard_name(const ModelFiles& files, bool exact) {
  std::vector<ModelVelocity> found;
  for (const auto* file : files.files())
    for (const auto& u : file->variables()) {
      const auto standard = lower(u.text("standard_name"));
      const bool is_exact = standard == "eastward_sea_water_velocity" || standard == "sea_water_x_velocity";
      if (!is_u(u) || is_exact != exact) continue;
      const auto wanted = partner_name(standard);
      for (const auto* other : files.files())
        for (const auto& v : other->variables())
          if (is_field(v) && lower(v.text("standard_name")) == wanted && v.dimensions.size() == u.dimensions.size())
            found.push_back({{file, &u}, {other, &v}, "standard_name " + u.text("standard_name"), sense_of(u)});
    }
  return found;
}

}  // namespace

Result<std::optional<ModelVelocity>> model_velocity(const ModelFiles& files, const std::string& east,
                                                    const std::string& north) {
  const auto made = [&](std::string_view u_name, std::string_view v_name, const std::string& why,
                        Sense sense) -> std::optional<ModelVelocity> {
    const Found u = files.find(u_name), v = files.find(v_name);
    if (!u || !v || !is_field(*u.variable) || !is_field(*v.variable)) return std::nullopt;
    return ModelVelocity{u, v, why, sense == Sense::open ? sense_of(*u.variable) : sense};
  };
  if (!east.empty() || !north.empty()) return made(east, north, "asked for", Sense::open);
  for (const bool exact : {true, false}) {
    const auto found = by_standard_name(files, exact);
    if (found.size() == 1) return std::optional{found.front()};
    for (const auto& known : kKnown)
      for (const auto& one : found)
        if (one.u.variable->name == known.u && one.v.variable->name == known.v) return std::optional{one};
    if (found.empty()) continue;
    std::string names;
    for (const auto& one : found)
      names += (names.empty() ? "" : "; ") + one.u.variable->name + ", " + one.v.variable->name;
    return fault("several velocities (" + names + "); say which with --variables EAST,NORTH");
  }
  for (const auto& known : kKnown)
    if (auto found = made(known.u, known.v, "name " + std::string{known.u}, known.sense)) return found;
  return std::optional<ModelVelocity>{};
}

Found lone_component(const NetcdfFile& file, bool u) {
  for (const auto& variable : file.variables()) {
    const auto standard = lower(variable.text("standard_name"));
    const bool is_v = standard.ends_with("northward_sea_water_velocity") ||
                      (contains(standard, "sea_water") && standard.ends_with("_y_velocity"));
    if (is_field(variable) && (u ? is_u(variable) : is_v)) return {&file, &variable};
  }
  for (const auto& known : kKnown) {
    const auto* variable = file.find(u ? known.u : known.v);
    if (variable != nullptr && is_field(*variable)) return {&file, variable};
  }
  return {};
}

std::optional<std::string> described_grid(const NetcdfFile& file) {
  if (lone_component(file, true) || lone_component(file, false)) return std::nullopt;
  for (const auto& variable : file.variables())  // heights are a forecast of their own
    if (contains(lower(variable.text("standard_name")), "sea_surface_height")) return std::nullopt;
  bool marked = false;
  for (const char* mark : {"mask_rho", "tmask", "angle", "h", "Bathymetry", "bathymetry", "glamu", "lat_u", "mask",
                           "hraw", "e1t", "wet", "pm"})
    marked = marked || file.find(mark) != nullptr;
  if (!marked) return std::nullopt;
  const ModelFiles alone{{&file}};
  for (const auto& names : kCentres)
    if (const auto positions = positions_named(alone, names)) {
      // Fields over a rectilinear grid are data of their own, not the grid of others.
      const bool plane = positions->lat.variable->dimensions.size() > 1;
      const bool data = std::any_of(file.variables().begin(), file.variables().end(), [](const Variable& variable) {
        return is_number(variable.type) && variable.dimensions.size() > 2;
      });
      if (plane || !data) return positions->words();
    }
  return std::nullopt;
}

Contents contents_of(const NetcdfFile& file, const std::string& east, const std::string& north) {
  const ModelFiles alone{{&file}};
  if (const auto both = model_velocity(alone, east, north); !both || both->has_value()) return Contents::currents;
  bool u = false, v = false;
  const auto has = [&](std::string_view name) {
    const auto* variable = file.find(name);
    return variable != nullptr && is_field(*variable);
  };
  if (!east.empty() || !north.empty()) {
    u = has(east);
    v = has(north);
  } else {
    u = static_cast<bool>(lone_component(file, true));
    v = static_cast<bool>(lone_component(file, false));
  }
  if (u != v) return u ? Contents::u_only : Contents::v_only;
  if (u) return Contents::currents;
  return described_grid(file) ? Contents::grid : Contents::other;
}

}  // namespace glidehelm::ingest
