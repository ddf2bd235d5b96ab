#include "daemon/ingest/recognise.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/base/text.hpp"
#include "daemon/ingest/units.hpp"

namespace glidehelm::ingest {

namespace {

constexpr std::string_view kEastName = "eastward_sea_water_velocity", kNorthName = "northward_sea_water_velocity";
/// Winds have other names (u10, UGRD, uas), and are not here.
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kKnownNames{
    {{"water_u", "water_v"},
     {"uo", "vo"},
     {"ugos", "vgos"},
     {"u", "v"},
     {"utotal", "vtotal"},
     {"ucur", "vcur"},
     {"uvel", "vvel"},
     {"u_velocity", "v_velocity"},
     {"u_current", "v_current"},
     {"current_u", "current_v"},
     {"ssu", "ssv"},
     {"uogrd", "vogrd"},
     {"ewct", "nsct"},
     {"vozocrtx", "vomecrty"},
     {"u_barotropic_velocity", "v_barotropic_velocity"},
     {"ubar", "vbar"}}};
constexpr std::array<std::string_view, 5> kHeightNames{"adt", "zos", "ssh", "surf_el", "sossheig"};

bool one_of(std::string_view text, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

bool could_be_velocity(const Variable& variable) { return is_number(variable.type) && variable.dimensions.size() >= 2; }

bool looks_like(const Variable& variable, bool latitude) {
  const std::string name = lower(variable.name), standard = lower(variable.text("standard_name"));
  const std::string_view word = latitude ? "lat" : "lon";
  return standard == (latitude ? "latitude" : "longitude") || name.starts_with(word) ||
         name.starts_with(latitude ? "nav_lat" : "nav_lon");
}

/// A two-dimensional latitude: the mark of a curvilinear grid.
const Variable* curvilinear_latitude(const NetcdfFile& file) {
  for (const auto& variable : file.variables())
    if (variable.dimensions.size() == 2 && is_number(variable.type) && looks_like(variable, true) &&
        variable.name.find("bnds") == std::string::npos && variable.name.find("bounds") == std::string::npos)
      return &variable;
  return nullptr;
}
std::string curvilinear_text(const NetcdfFile& file, const Variable& latitude) {
  return "curvilinear grid: " + file.shape_of(latitude) +
         " is two-dimensional; allowed is a rectilinear grid, latitude and longitude each on an axis of its own";
}

/// The variable of a name, exact before any case.
const Variable* named(const NetcdfFile& file, std::string_view name) {
  if (const auto* exact = file.find(name)) return exact;
  for (const auto& variable : file.variables())
    if (equal_without_case(variable.name, name)) return &variable;
  return nullptr;
}

/// What a file without currents in time is, where that can be seen: for a person who pointed at the wrong one.
std::optional<std::string> known_for_something_else(const NetcdfFile& file) {
  const auto any = [&](std::initializer_list<std::string_view> names) {
    const Variable* found = nullptr;
    for (const auto name : names)
      if (found == nullptr) found = named(file, name);
    return found;
  };
  const auto* tides = any({"tide_Cmax", "tide_Cphase", "tide_Ephase", "major_axis", "uamp", "ua", "u_amp", "uRe"});
  const auto* constituents = any({"tide_period", "cons", "constituents", "con", "constituent", "tide_name"});
  if (tides != nullptr && constituents != nullptr)
    return "tidal constituents: " + file.shape_of(*tides) +
           " describes the tide by its constituents, not the current at any time; allowed are currents in time, such "
           "as "
           "a tide model predicts from them";
  for (const auto& variable : file.variables())
    if (variable.text("cf_role") == "mesh_topology")
      return "unstructured grid: " + variable.name + " describes a mesh; allowed is a rectilinear grid, latitude and " +
             "longitude each on an axis of its own";
  return std::nullopt;
}

std::string groups_text(const NetcdfFile& file) {
  if (file.groups().empty()) return "";
  std::string names;
  for (const auto& group : file.groups()) names += (names.empty() ? "" : ", ") + group;
  return " (its groups are not read: " + names + ")";
}

std::string existing(const NetcdfFile& file) {
  std::string list;
  int shown = 0, left = 0;
  for (const auto& variable : file.variables()) {
    if (!could_be_velocity(variable)) continue;
    if (shown == 12) {
      ++left;
      continue;
    }
    list += (list.empty() ? "" : ", ") + file.shape_of(variable);
    ++shown;
  }
  if (left > 0) list += " and " + std::to_string(left) + " more";
  return list.empty() ? "none with two dimensions" : list;
}

Result<VelocityPair> checked(const NetcdfFile& file, VelocityPair pair) {
  for (const auto* variable : {pair.east, pair.north})
    if (!could_be_velocity(*variable))
      return fault("variable " + file.shape_of(*variable) + " is no field of numbers over latitude and longitude");
  if (pair.east->dimensions != pair.north->dimensions) {
    if (const auto* latitude = curvilinear_latitude(file)) return fault(curvilinear_text(file, *latitude));
    return fault("staggered grid: " + file.shape_of(*pair.east) + " and " + file.shape_of(*pair.north) +
                 " lie on different dimensions; allowed is both on the same");
  }
  return pair;
}

/// Candidates by standard_name, the exact name before prefixed ones.
std::vector<const Variable*> by_standard_name(const NetcdfFile& file, std::string_view end) {
  std::vector<const Variable*> exact, prefixed;
  for (const auto& variable : file.variables()) {
    const auto name = lower(variable.text("standard_name"));
    if (!could_be_velocity(variable) || !name.ends_with(end)) continue;
    (name == end ? exact : prefixed).push_back(&variable);
  }
  return exact.empty() ? prefixed : exact;
}

bool contains(const std::vector<const Variable*>& list, const Variable* variable) {
  return variable != nullptr && std::find(list.begin(), list.end(), variable) != list.end();
}

/// "eastward_x" and "northward_x".
std::optional<VelocityPair> by_prefix(const NetcdfFile& file) {
  for (const auto& variable : file.variables()) {
    if (!could_be_velocity(variable) || !variable.name.starts_with("eastward_")) continue;
    const auto* north = file.find("northward_" + variable.name.substr(9));
    if (north != nullptr && could_be_velocity(*north)) return VelocityPair{&variable, north, "name " + variable.name};
  }
  return std::nullopt;
}

std::optional<VelocityPair> by_known_name(const NetcdfFile& file) {
  for (const auto& [east_name, north_name] : kKnownNames) {
    const auto *east = named(file, east_name), *north = named(file, north_name);
    if (east != nullptr && north != nullptr && could_be_velocity(*east) && could_be_velocity(*north))
      return VelocityPair{east, north, "name " + east->name};
  }
  return by_prefix(file);
}

}  // namespace

Result<VelocityPair> recognise_velocity(const NetcdfFile& file, const std::string& east, const std::string& north) {
  if (!east.empty() || !north.empty()) {
    const VelocityPair pair{file.find(east), file.find(north), "asked for"};
    for (const auto& [variable, name] : {std::pair{pair.east, &east}, std::pair{pair.north, &north}})
      if (variable == nullptr) return fault("no variable " + *name + "; it has " + existing(file));
    return checked(file, pair);
  }
  const auto easts = by_standard_name(file, kEastName), norths = by_standard_name(file, kNorthName);
  if (!easts.empty() && !norths.empty()) {
    if (easts.size() == 1 && norths.size() == 1)
      return checked(file, {easts[0], norths[0], "standard_name " + easts[0]->text("standard_name")});
    for (const auto& [east_name, north_name] : kKnownNames)
      if (contains(easts, named(file, east_name)) && contains(norths, named(file, north_name)))
        return checked(file,
                       {named(file, east_name), named(file, north_name),
                        "standard_name " + named(file, east_name)->text("standard_name") + ", of several by name"});
    std::string names;
    for (const auto* variable : easts) names += (names.empty() ? "" : ", ") + variable->name;
    return fault("several eastward velocities (" + names + "); say which with --variables EAST,NORTH");
  }
  if (auto pair = by_known_name(file)) return checked(file, std::move(*pair));
  if (const auto known = known_for_something_else(file)) return fault(*known);
  if (const auto* latitude = curvilinear_latitude(file))
    return fault(curvilinear_text(file, *latitude) + " (and no east and north velocity is recognised; it has " +
                 existing(file) + ")");
  return fault("no east and north velocity is recognised; it has " + existing(file) + groups_text(file) +
               "; say which with --variables EAST,NORTH");
}

std::vector<LoneComponent> velocity_components(const NetcdfFile& file) {
  std::vector<LoneComponent> found;
  const auto consider = [&](const Variable* variable, bool is_east, const std::string& why) {
    if (variable != nullptr && could_be_velocity(*variable)) found.push_back({variable, is_east, why});
  };
  for (const bool is_east : {true, false})
    for (const auto* variable : by_standard_name(file, is_east ? kEastName : kNorthName))
      consider(variable, is_east, "standard_name " + variable->text("standard_name"));
  if (!found.empty()) return found;
  for (const auto& [east_name, north_name] : kKnownNames) {
    consider(named(file, east_name), true, "name " + std::string{east_name});
    consider(named(file, north_name), false, "name " + std::string{north_name});
  }
  for (const auto& variable : file.variables()) {
    if (variable.name.starts_with("eastward_")) consider(&variable, true, "name " + variable.name);
    if (variable.name.starts_with("northward_")) consider(&variable, false, "name " + variable.name);
  }
  return found;
}

Result<std::optional<SeaHeights>> recognise_heights(const NetcdfFile& file) {
  const auto is_height = [](const Variable* variable) {
    return variable != nullptr && could_be_velocity(*variable) && lower(variable->name) != "mdt";
  };
  for (const auto& variable : file.variables())
    if (is_height(&variable) && lower(variable.text("standard_name")) == "sea_surface_height_above_geoid")
      return std::optional{
          SeaHeights{&variable, nullptr, variable.name + ", standard_name " + variable.text("standard_name")}};
  for (const auto name : kHeightNames)
    if (const auto* variable = named(file, name); is_height(variable))
      return std::optional{SeaHeights{variable, nullptr, variable->name + ", by name"}};
  const auto *anomaly = named(file, "sla"), *mean = named(file, "mdt");
  if (!is_height(anomaly)) return std::optional<SeaHeights>{};
  if (mean == nullptr || !could_be_velocity(*mean))
    return fault(
        file.shape_of(*anomaly) +
        " is the height above the mean sea surface: its slope lacks the mean current; allowed are adt, zos, or "
        "sla together with mdt");
  return std::optional{SeaHeights{anomaly, mean, anomaly->name + " + " + mean->name + ", by name"}};
}

Role role_of(const Variable& variable) {
  const std::string standard = lower(variable.text("standard_name")), name = lower(variable.name);
  const std::string unit = lower(variable.unit().value_or(""));
  if (standard == "latitude") return Role::latitude;
  if (standard == "longitude") return Role::longitude;
  if (standard == "time") return Role::time;
  if (standard == "depth") return Role::depth;
  if (standard.starts_with("projection_") || standard.starts_with("grid_l")) return Role::projected;
  if (standard.starts_with("ocean_s") || standard.starts_with("ocean_double_sigma")) return Role::terrain;
  if (one_of(unit, {"degrees_north", "degree_north", "degrees_n", "degree_n", "degreesn", "degreen"}))
    return Role::latitude;
  if (one_of(unit, {"degrees_east", "degree_east", "degrees_e", "degree_e", "degreese", "degreee"}))
    return Role::longitude;
  if (names_epoch(unit)) return Role::time;
  if (!variable.text("positive").empty()) return Role::depth;
  const std::string axis = variable.text("axis");
  if (axis == "T") return Role::time;
  if (axis == "Z") return Role::depth;
  if (one_of(name, {"lat", "latitude", "nav_lat"})) return Role::latitude;
  if (one_of(name, {"lon", "longitude", "nav_lon", "long"})) return Role::longitude;
  if (one_of(name, {"time", "t", "mt", "time_counter", "valid_time"}) || name.ends_with("_time")) return Role::time;
  if (one_of(name, {"z", "lev", "level"}) || name.starts_with("depth")) return Role::depth;
  if (one_of(name, {"s_rho", "s_w", "sigma", "siglay", "siglev"})) return Role::terrain;
  if (axis == "X" || axis == "Y") return Role::projected;
  return Role::none;
}

namespace {

/// The one-dimensional variables over a dimension, the one of the dimension's own name first.
std::vector<const Variable*> coordinates_of(const NetcdfFile& file, std::size_t dimension) {
  std::vector<const Variable*> found;
  for (const bool own : {true, false})
    for (const auto& variable : file.variables())
      if (variable.dimensions.size() == 1 && variable.dimensions[0] == dimension && is_number(variable.type) &&
          (variable.name == file.dimensions()[dimension].name) == own)
        found.push_back(&variable);
  return found;
}

const Variable* with_role(const std::vector<const Variable*>& variables, Role role) {
  for (const auto* variable : variables)
    if (role_of(*variable) == role) return variable;
  return nullptr;
}

/// A scalar coordinate that the velocity names in `coordinates`, or that is simply called "time" or "depth".
const Variable* scalar_with(const NetcdfFile& file, const Variable& velocity, Role role, std::string_view name) {
  const std::string named = " " + velocity.text("coordinates") + " ";
  for (const auto& variable : file.variables())
    if (variable.dimensions.empty() && is_number(variable.type) && role_of(variable) == role &&
        (variable.name == name || named.find(" " + variable.name + " ") != std::string::npos))
      return &variable;
  return nullptr;
}

}  // namespace

Result<Axes> recognise_axes(const NetcdfFile& file, const Variable& velocity) {
  Axes axes;
  std::optional<std::string> unknown;
  for (std::size_t d = 0; d < velocity.dimensions.size(); ++d) {
    const std::size_t dimension = velocity.dimensions[d];
    const auto& name = file.dimensions()[dimension].name;
    const auto coordinates = coordinates_of(file, dimension);
    const auto *latitude = with_role(coordinates, Role::latitude), *longitude = with_role(coordinates, Role::longitude);
    if (latitude != nullptr && longitude != nullptr)
      return fault(
          "unstructured grid: " + file.shape_of(*latitude) + " and " + file.shape_of(*longitude) +
          " lie on one dimension; allowed is a rectilinear grid, latitude and longitude each on an axis of its own");
    if (latitude != nullptr) {
      axes.latitude = {d, latitude};
    } else if (longitude != nullptr) {
      axes.longitude = {d, longitude};
    } else if (const auto* time = with_role(coordinates, Role::time)) {
      axes.time = AxisOf{d, time};
    } else if (const auto* depth = with_role(coordinates, Role::depth)) {
      axes.depth = AxisOf{d, depth};
    } else if (file.length_of(dimension) == 1) {
      axes.dropped.push_back(d);
    } else if (!unknown) {
      unknown = "dimension " + name + " of " + file.shape_of(velocity);
      if (with_role(coordinates, Role::projected) != nullptr)
        unknown = "projected grid: " + *unknown;
      else if (with_role(coordinates, Role::terrain) != nullptr || one_of(lower(name), {"s_rho", "sigma", "siglay"}))
        unknown = "terrain-following levels: " + *unknown;
    }
  }
  if (axes.latitude.coordinate == nullptr || axes.longitude.coordinate == nullptr) {
    if (const auto* latitude = curvilinear_latitude(file)) return fault(curvilinear_text(file, *latitude));
    if (!unknown) return fault(file.shape_of(velocity) + " has no latitude or no longitude axis; it needs both");
  }
  if (unknown)
    if (const auto known = known_for_something_else(file)) return fault(*known);
  if (unknown) return fault(*unknown + " is neither time, depth, latitude nor longitude");
  if (!axes.time)
    if (const auto* scalar = scalar_with(file, velocity, Role::time, "time")) axes.time = AxisOf{std::nullopt, scalar};
  if (!axes.depth)
    if (const auto* scalar = scalar_with(file, velocity, Role::depth, "depth"))
      axes.depth = AxisOf{std::nullopt, scalar};
  return axes;
}

}  // namespace glidehelm::ingest
