#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/ingest/netcdf_file.hpp"

/// Which variables are the current, and which axes it lies on.
namespace glidehelm::ingest {

/// The two components, and why they were taken: "standard_name eastward_sea_water_velocity", "name uo", "asked for".
struct VelocityPair {
  const Variable* east{};
  const Variable* north{};
  std::string why;
};

/// Finds the pair, in this order: the names that were asked for; a standard_name that ends with
/// eastward_/northward_sea_water_velocity (the exact one before prefixed ones; anomalies, tides and flags end otherwise);
/// the names water_u/water_v, uo/vo, ugos/vgos, u/v and others (recognise.cpp), whatever their case, and
/// eastward_*/northward_*. Both must have at least two dimensions, the same ones. Several pairs by standard_name are
/// settled by the list of names, else refused as ambiguous. When there is none, the fault says what the file is where that
/// can be seen (tidal constituents, a mesh, a curvilinear grid, groups), and lists the variables that exist.
Result<VelocityPair> recognise_velocity(const NetcdfFile& file, const std::string& east, const std::string& north);

/// A component of the current, of which the other may be published in a file of its own.
struct LoneComponent {
  const Variable* variable{};
  bool is_east{};
  std::string why;
};
/// Every variable that is a component by its standard_name, else by a known name, in the order of preference.
std::vector<LoneComponent> velocity_components(const NetcdfFile& file);

/// Heights of the sea surface whose slope is the current: one variable, or an anomaly and the mean that it belongs to.
struct SeaHeights {
  const Variable* height{};
  const Variable* mean{};  ///< to be added; null where `height` is the whole
  std::string why;
};
/// In this order: standard_name sea_surface_height_above_geoid; the names adt, zos, ssh, surf_el, sossheig; sla with mdt.
/// Nothing when there are none; a fault for an anomaly without its mean, whose slope is not the current.
Result<std::optional<SeaHeights>> recognise_heights(const NetcdfFile& file);

enum class Role { none, time, depth, latitude, longitude, projected, terrain };
/// What a variable says it is the axis of, by standard_name, units, axis, positive and name, in this order.
Role role_of(const Variable& variable);

/// One axis of the current: the position of its dimension within the variable (nothing for a scalar coordinate), and the
/// coordinate variable.
struct AxisOf {
  std::optional<std::size_t> position;
  const Variable* coordinate{};
};
struct Axes {
  std::optional<AxisOf> time, depth;
  AxisOf latitude, longitude;
  /// Dimensions of length one that are none of these: read at 0.
  std::vector<std::size_t> dropped;
};

/// The axes of a rectilinear latitude–longitude grid in any order; time and depth may be missing or scalar. Refused by
/// name: unstructured, curvilinear, projected and terrain-following grids, tidal constituents, and unknown dimensions
/// longer than one.
Result<Axes> recognise_axes(const NetcdfFile& file, const Variable& velocity);

}  // namespace glidehelm::ingest
