#include "config/areas.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

namespace glidehelm::config {

namespace {

using Json = nlohmann::json;

struct Corner {
  std::optional<double> lat_deg, lon_deg;
};

const Fields<Corner>& corner_fields() {
  static const Fields<Corner> kFields = [] {
    Fields<Corner> f;
    f.latitude({"lat_deg", "latitude of a corner", true}, &Corner::lat_deg);
    f.longitude({"lon_deg", "longitude of a corner", true}, &Corner::lon_deg);
    return f;
  }();
  return kFields;
}

/// Drops a last corner that repeats the first, then counts the corners that differ.
std::size_t distinct_corners(std::vector<GeoPoint>& corners) {
  if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  auto sorted = corners;
  std::sort(sorted.begin(), sorted.end());
  return static_cast<std::size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
}

/// One geometry or collection after the other; stops at the first error.
class GeoJsonReader {
 public:
  std::vector<chart::Area> areas;
  std::string error;

  bool read(const Json& json, const std::string& where, const std::string& name) {
    if (!json.is_object()) return fail(where, "not an object");
    const auto type = json.find("type");
    if (type == json.end() || !type->is_string()) return fail(where, "no \"type\"");
    const auto& word = type->get_ref<const std::string&>();
    if (word == "FeatureCollection") return read_collection(json, where);
    if (word == "Feature") return read_feature(json, where);
    if (word == "Polygon") return read_polygon(coordinates(json), where, name);
    if (word == "MultiPolygon") return read_polygons(coordinates(json), where, name);
    return fail(where, "type " + shown(word) + "; allowed: Polygon, MultiPolygon, Feature, FeatureCollection");
  }

 private:
  bool fail(const std::string& where, const std::string& what) {
    error = where.empty() ? what : where + ": " + what;
    return false;
  }

  static const Json& coordinates(const Json& json) {
    static const Json kNone;
    const auto found = json.find("coordinates");
    return found == json.end() ? kNone : *found;
  }

  bool read_collection(const Json& json, const std::string& where) {
    const auto features = json.find("features");
    if (features == json.end() || !features->is_array()) return fail(where, "no list \"features\"");
    // Features of features do not exist in GeoJSON; refusing them here also bounds the recursion.
    for (std::size_t i = 0; i < features->size(); ++i) {
      const auto inner = "feature " + std::to_string(i);
      if (!(*features)[i].is_object() || (*features)[i].value("type", Json{}) != "Feature")
        return fail(inner, "not a Feature");
      if (!read_feature((*features)[i], inner)) return false;
    }
    return true;
  }

  bool read_feature(const Json& json, const std::string& where) {
    const auto geometry = json.find("geometry");
    if (geometry == json.end() || !geometry->is_object()) return fail(where, "no \"geometry\"");
    const auto type = geometry->value("type", Json{});
    if (type == "Feature" || type == "FeatureCollection") return fail(where, "a feature inside a geometry");
    std::string name;
    if (const auto properties = json.find("properties"); properties != json.end() && properties->is_object())
      if (const auto found = properties->find("name"); found != properties->end() && found->is_string())
        name = shown(found->get_ref<const std::string&>());
    return read(*geometry, where, name);
  }

  bool read_polygons(const Json& json, const std::string& where, const std::string& name) {
    if (!json.is_array()) return fail(where, "no list \"coordinates\"");
    for (const auto& polygon : json)
      if (!read_polygon(polygon, where, name)) return false;
    return true;
  }

  bool read_polygon(const Json& json, const std::string& where, const std::string& name) {
    if (!json.is_array() || json.empty() || !json.front().is_array())
      return fail(where, "no list of rings in \"coordinates\"");
    if (json.size() > 1) return fail(where, "a polygon with a hole; draw the hole as an area of its own");
    chart::Area area;
    area.name = name.empty() ? std::to_string(areas.size() + 1) : name;
    for (const auto& corner : json.front()) {
      if (!corner.is_array() || corner.size() < 2 || !corner[0].is_number() || !corner[1].is_number())
        return fail(where, "a corner that is no [longitude, latitude]");
      const auto point = GeoPoint::from_degrees(corner[1].get<double>(), corner[0].get<double>());
      if (!point) return fail(where, point.error().message());
      if (++vertices_ > kMostVertices) return fail(where, "more than " + std::to_string(kMostVertices) + " corners");
      area.vertices.push_back(*point);
    }
    if (distinct_corners(area.vertices) < 3) return fail(where, "fewer than three different corners");
    areas.push_back(std::move(area));
    return true;
  }

  std::size_t vertices_{};
};

std::string corner_text(const GeoPoint& p) {
  return "{lat_deg: " + yaml_number(p.lat.radians(), kPi / 180) +
         ", lon_deg: " + yaml_number(p.lon.radians(), kPi / 180) + "}";
}

}  // namespace

void read_polygon(const At& at, chart::Area& area) {
  if (!expect_list(at, 3, std::numeric_limits<int>::max())) return;
  bool whole = true;
  for (std::size_t i = 0; i < at.node.items.size(); ++i) {
    const auto corner_at = at.item(i);
    Corner corner;
    if (expect_map(corner_at)) corner_fields().read(corner_at, corner);
    if (corner.lat_deg && corner.lon_deg)
      area.vertices.push_back(GeoPoint::from_degrees(*corner.lat_deg, *corner.lon_deg).value());
    else
      whole = false;
  }
  if (whole && distinct_corners(area.vertices) < 3) at.complain("fewer than three different corners");
}

Shape polygon_shape() {
  Shape polygon;
  polygon.kind = Shape::Kind::list;
  polygon.at_least = 3;
  polygon.parts.push_back(corner_fields().shape());
  return polygon;
}

std::string polygon_text(const std::vector<GeoPoint>& corners) {
  std::string text;
  for (const auto& corner : corners) text += (text.empty() ? "[" : ", ") + corner_text(corner);
  return text + "]";
}

Shape areas_shape() {
  Shape list;
  list.kind = Shape::Kind::list;
  list.parts.push_back(polygon_shape());
  return Fields<Corner>::any_of({list, Shape{}});
}

void read_areas(const At& at, AreasDraft& draft) {
  draft = {};
  if (at.node.is(Node::Kind::scalar)) {
    if (const auto path = read_text(at, kAnyText)) draft.geojson = path_beside(at.reading.problems.file(), *path);
    return;
  }
  if (at.node.is(Node::Kind::broken)) return;
  if (!at.node.is(Node::Kind::list)) {
    at.complain("neither polygons nor a path", at.found(),
                "[[{lat_deg, lon_deg}, …], …] or the path of a GeoJSON file");
    return;
  }
  for (std::size_t i = 0; i < at.node.items.size(); ++i) {
    chart::Area area;
    area.name = std::to_string(i + 1);
    read_polygon(at.item(i), area);
    draft.areas.push_back(std::move(area));
  }
}

void print_areas(const AreasDraft& draft, const std::string& path, const std::string& key, Effective& out) {
  if (!draft.geojson.empty()) {
    out.leaf(path, key, yaml_text(draft.geojson));
    return;
  }
  std::string text = "[";
  for (const auto& area : draft.areas) text += (text.size() == 1 ? "" : ", ") + polygon_text(area.vertices);
  out.leaf(path, key, text + "]");
}

void load_areas(AreasDraft& draft, const LoadFile& load, const std::string& path, Reading& reading) {
  if (draft.geojson.empty()) return;
  const auto text = load(draft.geojson);
  if (!text) {
    reading.complain(path, "cannot read " + shown(draft.geojson) + ": " + text.error().reason);
    return;
  }
  auto areas = areas_from_geojson(*text);
  if (!areas)
    reading.complain(path, shown(draft.geojson) + ": " + areas.error());
  else
    draft.areas = std::move(*areas);
}

Expected<std::vector<chart::Area>, std::string> areas_from_geojson(const std::string& text) {
  if (text.size() > kLargestGeoJson) return unexpected(std::string{"larger than 16 MiB"});
  const auto json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return unexpected(std::string{"not JSON"});
  GeoJsonReader reader;
  if (!reader.read(json, "", "")) return unexpected(std::move(reader.error));
  if (reader.areas.empty()) return unexpected(std::string{"no polygon in the file"});
  return std::move(reader.areas);
}

}  // namespace glidehelm::config
