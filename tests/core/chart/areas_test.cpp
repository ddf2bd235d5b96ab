#include "core/chart/areas.hpp"

#include <catch2/catch.hpp>

#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

namespace {

std::vector<GeoPoint> corners_of(const LonLat& points) {
  std::vector<GeoPoint> corners;
  for (const auto& [lon, lat] : points) corners.push_back(geo_point(lat, lon));
  return corners;
}

AreaProblem problem_of(const LonLat& points) {
  const auto area = checked_area("permit", corners_of(points));
  REQUIRE_FALSE(area);
  CHECK(area.error().area == "permit");
  CHECK(area.error().message().find("permit") != std::string::npos);
  return area.error();
}

using What = AreaProblem::What;

}  // namespace

TEST_CASE("a simple polygon is an area, either way round, with or without its first corner again") {
  const LonLat square = box_of(-15.1, -14.9, 27.9, 28.1);
  auto closed = square, reversed = square;
  closed.push_back(square.front());
  std::reverse(reversed.begin(), reversed.end());
  const auto area = checked_area("box", corners_of(square));
  REQUIRE(area);
  CHECK(area->vertices.size() == 4);
  CHECK(checked_area("box", corners_of(closed)).value() == *area);
  CHECK(checked_area("box", corners_of(reversed)));
  CHECK(checked_area("across", corners_of({{179, 0}, {-179, 0}, {-179, 2}, {179, 2}})));
  CHECK(checked_area("concave", corners_of({{0, 0}, {4, 0}, {4, 3}, {2, 1}, {0, 3}})));
}

TEST_CASE("what is no area is refused with the corners at fault") {
  CHECK(problem_of({{0, 0}, {1, 0}}).what == What::too_few_corners);
  CHECK(problem_of({{0, 0}, {1, 0}, {0, 0}}).what == What::too_few_corners);
  CHECK(problem_of({{0, 0}, {1, 0}, {1, 0}, {0, 1}}) == AreaProblem{What::repeated_corner, "permit", 1, 0});
  CHECK(problem_of({{0, 0}, {1, 1}, {1, 0}, {0, 1}}) == AreaProblem{What::crosses_itself, "permit", 0, 2});
  CHECK(problem_of({{0, 0}, {1, 1}, {1, 0}, {0, 1}}).message() ==
        "area \"permit\": the edges from corner 1 and from corner 3 cross or touch");
  CHECK(problem_of({{0, 86}, {1, 0}, {1, 1}}) == AreaProblem{What::too_far_north, "permit", 0, 0});
  CHECK(problem_of({{-100, 0}, {0, 10}, {100, 0}, {0, -10}}).what == What::too_wide);
  // around the pole: the longitudes make a whole turn
  CHECK(problem_of({{0, 80}, {90, 80}, {180, 80}, {-90, 80}}).what == What::too_wide);
}

TEST_CASE("edges that touch, overlap or fold back are refused") {
  // a corner on another edge
  CHECK(problem_of({{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}}).what == What::crosses_itself);
  // two corners at one place: a figure of eight
  CHECK(problem_of({{0, 0}, {2, 2}, {4, 0}, {4, 4}, {2, 2}, {0, 4}}).what == What::crosses_itself);
  // a spike
  CHECK(problem_of({{0, 0}, {4, 0}, {4, 4}, {4, 2}}).what == What::crosses_itself);
  CHECK(problem_of({{0, 0}, {1, 0}, {2, 0}}).what == What::crosses_itself);
}

TEST_CASE("the edges of an area are geodesics") {
  // 20° of longitude at 60°N: the geodesic runs 43 km north of the parallel
  const Region region = region_of(checked_area("wide", corners_of(box_of(-10, 10, 55, 60))).value());
  const auto way = geodesic(geo_point(60, 10), geo_point(60, -10));
  for (const double part : {0.1, 0.3, 0.5, 0.8}) {
    const auto on = destination(geo_point(60, 10), way.departing, part * way.length);
    INFO(part << ": " << on.lat.degrees());
    CHECK(on.lat.degrees() > 60.1);
    CHECK(region.distance(Space::at(on.lat.radians(), on.lon.radians()), 1e6) < 0.2);
    CHECK(region.contains(on.lat.radians() - 1e-7, on.lon.radians()));
    CHECK_FALSE(region.contains(on.lat.radians() + 1e-7, on.lon.radians()));
  }
}

TEST_CASE("a random star is an area, with two corners swapped it crosses itself") {
  std::mt19937_64 random{4};
  for (int k = 0; k < 50; ++k) {
    auto points = star(-179.9, 50, 1, 12, random);
    for (auto& [lon, lat] : points) lon = lon < -180 ? lon + 360 : lon;
    CHECK(checked_area("star", corners_of(points)));
    std::swap(points[3], points[9]);
    CHECK(problem_of(points).what == What::crosses_itself);
  }
}

TEST_CASE("an area of too few corners has no inside") {
  const auto region = region_of(Area{"line", corners_of({{0, 0}, {1, 1}})});
  CHECK_FALSE(region.contains(rad(0.5), rad(0.5)));
  CHECK(region.distance(Space::at(0, 0), 5) == 5);
}
