#include "config/areas.hpp"

#include <catch2/catch.hpp>

#include "config/mission.hpp"
#include "tests/support/config.hpp"

using namespace glidehelm;
using config::areas_from_geojson;
using Lines = std::vector<std::string>;

namespace {

const char* const kTriangle = R"({"type": "Polygon", "coordinates": [[[-15, 28], [-14, 28], [-14, 29], [-15, 28]]]})";

Lines area_errors(const std::string& safety, const std::map<std::string, std::string>& files = {}) {
  return test::errors_of(config::read_mission(test::six_lines(safety), "missions.d/m.yaml", test::files_of(files)));
}
std::string problem(const std::string& text) {
  const auto areas = areas_from_geojson(text);
  REQUIRE_FALSE(areas);
  return areas.error();
}

}  // namespace

TEST_CASE("polygons of a GeoJSON file are read with longitude first, the closing corner dropped") {
  const auto areas = areas_from_geojson(kTriangle);
  REQUIRE(areas);
  REQUIRE(areas->size() == 1);
  CHECK(areas->front().name == "1");
  CHECK(areas->front().vertices == std::vector<GeoPoint>{geo_point(28, -15), geo_point(28, -14), geo_point(29, -14)});
}

TEST_CASE("features, collections and multipolygons are read, names from their properties") {
  const std::string other = R"([[[170, -10, 0], [-170, -10, 0], [180, -5, 0]]])";
  const auto areas = areas_from_geojson(
      R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"name": "lane"}, "geometry": )" +
      std::string{kTriangle} +
      R"(}, {"type": "Feature", "properties": null, "geometry": {"type": "MultiPolygon", "coordinates": [)" + other +
      ", " + other + "]}}]}");
  REQUIRE(areas);
  REQUIRE(areas->size() == 3);
  CHECK((*areas)[0].name == "lane");
  CHECK((*areas)[1].name == "2");
  CHECK((*areas)[2].vertices[0] == geo_point(-10, 170));
}

TEST_CASE("what is no polygon says why") {
  CHECK(problem("{") == "not JSON");
  CHECK(problem("[]") == "not an object");
  CHECK(problem("{}") == "no \"type\"");
  CHECK(problem(R"({"type": "Point", "coordinates": [1, 2]})") ==
        "type Point; allowed: Polygon, MultiPolygon, Feature, FeatureCollection");
  CHECK(problem(R"({"type": "FeatureCollection", "features": []})") == "no polygon in the file");
  CHECK(problem(R"({"type": "FeatureCollection"})") == "no list \"features\"");
  CHECK(problem(R"({"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": {"type": "Point"}}]})") ==
        "feature 0: type Point; allowed: Polygon, MultiPolygon, Feature, FeatureCollection");
  CHECK(problem(R"({"type": "FeatureCollection", "features": [7]})") == "feature 0: not a Feature");
  CHECK(problem(R"({"type": "Feature", "geometry": null})") == "no \"geometry\"");
  CHECK(problem(R"({"type": "Feature", "geometry": {"type": "Feature"}})") == "a feature inside a geometry");
  CHECK(problem(R"({"type": "Polygon"})") == "no list of rings in \"coordinates\"");
  CHECK(problem(R"({"type": "Polygon", "coordinates": [[[1, 2], [3, 4], [1, 2]]]})") ==
        "fewer than three different corners");
  CHECK(problem(R"({"type": "Polygon", "coordinates": [[[1, 95], [3, 4], [1, 2]]]})").find("latitude") !=
        std::string::npos);
  CHECK(problem(R"({"type": "Polygon", "coordinates": [[[1, 1], ["3", 4], [1, 2]]]})") ==
        "a corner that is no [longitude, latitude]");
  CHECK(problem(R"({"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9]], [[1, 1], [2, 1], [2, 2]]]})") ==
        "a polygon with a hole; draw the hole as an area of its own");
  CHECK(problem(std::string(config::kLargestGeoJson + 1, ' ')) == "larger than 16 MiB");
  CHECK(problem(std::string(1'000'000, '[')) == "not JSON");
}

TEST_CASE("keep_in and keep_out name a GeoJSON file beside the mission, or hold polygons") {
  const auto m = config::read_mission(test::six_lines("safety: {keep_in: a.geojson, keep_out: [[{lat_deg: 1, lon_deg: "
                                                      "2}, {lat_deg: 2, lon_deg: 2}, {lat_deg: 2, lon_deg: 3}]]}\n"),
                                      "missions.d/m.yaml", test::files_of({{"missions.d/a.geojson", kTriangle}}));
  REQUIRE(m);
  REQUIRE(m->keep_in.size() == 1);
  CHECK(m->keep_in[0].vertices.size() == 3);
  REQUIRE(m->keep_out.size() == 1);
  CHECK(m->keep_out[0].vertices[2] == geo_point(2, 3));
}

TEST_CASE("mistakes in areas are named at their place in the mission") {
  CHECK(area_errors("safety: {keep_in: a.geojson}\n") ==
        Lines{"7:19 safety.keep_in: cannot read missions.d/a.geojson: No such file or directory"});
  CHECK(area_errors("safety: {keep_in: a.geojson}\n", {{"missions.d/a.geojson", "{}"}}) ==
        Lines{"7:19 safety.keep_in: missions.d/a.geojson: no \"type\""});
  CHECK(area_errors("safety: {keep_in: {a: 1}}\n") ==
        Lines{"7:19 safety.keep_in: neither polygons nor a path; found a map of keys; allowed: [[{lat_deg, lon_deg}, "
              "…], …] or the path of a GeoJSON file"});
  CHECK(
      area_errors("safety:\n  keep_out:\n    - - {lat_deg: 1, lon_deg: 2}\n      - {lat_deg: 95, lon_deg: 2}\n      - "
                  "{lat_deg: 2, lon: 3}\n") ==
      Lines{"10:19 safety.keep_out[0][1].lat_deg: latitude out of range; latitude and longitude swapped?; found 95; "
            "allowed: -90 to 90 °",
            "11:9 safety.keep_out[0][2].lon_deg: missing; the key is required",
            "11:22 safety.keep_out[0][2].lon: unknown key; did you mean lon_deg?"});
  CHECK(area_errors("safety: {keep_out: [[{lat_deg: 1, lon_deg: 2}, {lat_deg: 2, lon_deg: 2}]]}\n") ==
        Lines{"7:21 safety.keep_out[0]: a list of another length; found 2; allowed: a list of at least 3"});
  CHECK(area_errors(
            "safety: {keep_out: [[{lat_deg: 1, lon_deg: 2}, {lat_deg: 2, lon_deg: 2}, {lat_deg: 1, lon_deg: 2}]]}\n") ==
        Lines{"7:21 safety.keep_out[0]: fewer than three different corners"});
}
