#pragma once

#include <string>
#include <vector>

#include "config/paths.hpp"
#include "config/yaml_reader/fields.hpp"
#include "core/chart/chart.hpp"

/// The keys `keep_in` and `keep_out` of a mission: polygons in the file, or the path of a GeoJSON file.
namespace glidehelm::config {

inline constexpr std::size_t kLargestGeoJson = 16U << 20;  ///< bytes
inline constexpr std::size_t kMostVertices = 100'000;      ///< of all polygons of one key

struct AreasDraft {
  std::string geojson;  ///< path as resolved; empty: the polygons stand in the mission file
  std::vector<chart::Area> areas;
};

/// One polygon: a list of corners.
Shape polygon_shape();
/// At least three different corners, else complaints.
void read_polygon(const At& at, chart::Area& area);
/// "[{lat_deg: …, lon_deg: …}, …]".
std::string polygon_text(const std::vector<GeoPoint>& corners);

Shape areas_shape();
void read_areas(const At& at, AreasDraft& draft);
void print_areas(const AreasDraft& draft, const std::string& path, const std::string& key, Effective& out);
/// Loads `draft.geojson`, if any, into `draft.areas`; errors stand at the key `path`.
void load_areas(AreasDraft& draft, const LoadFile& load, const std::string& path, Reading& reading);

/// Polygons of a GeoJSON text: Polygon, MultiPolygon, Feature or FeatureCollection of them, [longitude, latitude] in
/// degrees. A polygon takes the `name` of its feature's properties, else a number. A polygon with a hole is an error: the
/// hole is a keep-out area and is to be drawn as one. The error says where in the file and what.
Expected<std::vector<chart::Area>, std::string> areas_from_geojson(const std::string& text);

}  // namespace glidehelm::config
