#include "core/chart/coast.hpp"

#include <catch2/catch.hpp>

#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

TEST_CASE("a coast covers its area with the border, also across the antimeridian") {
  const auto coast = coast_of(area_of(178, 182, -19, -15), {});
  for (const double lon : {178.0, 180.0, -180.0, -178.0}) CHECK(coast->covers(rad(-17), rad(lon)));
  for (const double lon : {177.999, -177.999, 0.0, 90.0}) CHECK_FALSE(coast->covers(rad(-17), rad(lon)));
  CHECK(coast->covers(rad(-15), rad(179)));
  CHECK_FALSE(coast->covers(rad(-14.999), rad(179)));
}

TEST_CASE("land and charted area are regions of one coast") {
  const auto coast = coast_of(area_of(178, 182, -19, -15), {box_of(179.8, 180.3, -17.2, -16.8)});
  CHECK(coast->land().contains(rad(-17), rad(-179.9)));
  CHECK_FALSE(coast->land().contains(rad(-17), rad(-179.6)));
  CHECK(coast->charted().contains(rad(-17), rad(-179.6)));
  const auto p = geo_point(-17, -178.2);
  const double border = brute_distance(p, 182, -19, 182, -15);
  CHECK(coast->charted().distance(Space::at(rad(-17), rad(-178.2)), 1e9) == Approx(border).margin(promised(border)));
  CHECK(coast->points() == 4);
}

TEST_CASE("a coast says which point of which ring is wrong") {
  const auto area = area_of(10, 12, 40, 42);
  auto outside = ring_of(area, box_of(10.5, 11, 40.5, 41));
  outside.points[2].y = 430'000'000;
  const auto coast = Coast::make(area, "test", {ring_of(area, box_of(11, 11.5, 40.5, 41)), outside});
  REQUIRE_FALSE(coast);
  CHECK(coast.error().message() == "ring 2, point 3: lies outside the area");
  CHECK_FALSE(Coast::make(area, "", {}));
  CHECK_FALSE(Coast::make(area_of(10, 10, 40, 42), "test", {}));
}

TEST_CASE("an area of half the Earth is no wider than its longitudes can tell") {
  const auto coast = coast_of(area_of(-90, 90, -85, 85), {box_of(-89, -88, 10, 11), box_of(88, 89, 10, 11)});
  CHECK(coast->land().contains(rad(10.5), rad(-88.5)));
  CHECK(coast->land().contains(rad(10.5), rad(88.5)));
  CHECK_FALSE(coast->land().contains(rad(10.5), rad(-91.5)));
  CHECK_FALSE(coast->land().contains(rad(10.5), rad(178.5)));
}
