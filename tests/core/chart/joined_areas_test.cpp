#include "core/chart/joined_areas.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/chart/chart.hpp"
#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

TEST_CASE("inside each of several areas land and water are as they were, and between them all is land") {
  // One on each side of the antimeridian, and one in the north; the second has land along its own border.
  const auto west =
      coast_of(area_of(170, 176, -20, -14), {box_of(172, 173, -18, -17), box_of(172.4, 172.6, -17.6, -17.4)});
  const auto east = coast_of(area_of(-178, -172, -19, -15), {box_of(-178, -177, -19, -15)});
  const auto north = coast_of(area_of(178, 182, -10, -8), {});
  const std::vector<std::shared_ptr<const Coast>> coasts{east, north, west};
  const auto joined = joined_areas(coasts);
  REQUIRE(joined);
  CHECK((*joined)->area() == area_of(170, 188, -20, -8));
  const Chart chart{ChartSources{*joined, {}, {}}};
  std::mt19937_64 random{3};
  std::uniform_real_distribution<double> lat{-20, -8}, lon{170, 188};
  for (int k = 0; k < 20'000; ++k) {
    const auto p = GeoPoint::from_kernel(rad(lat(random)), rad(lon(random)));
    bool land = true;
    for (const auto& coast : coasts)
      if (coast->covers(p.lat.radians(), p.lon.radians()))
        land = coast->land().contains(p.lat.radians(), p.lon.radians());
    INFO(p.lat.degrees() << " " << p.lon.degrees());
    CHECK(chart.is_land(p) == land);
  }
  // The border of an area keeps a track away like a shore: 0.1° of latitude south of the northern area's southern border is land,
  // 0.1° inside it is 11.06 km from it. The border of the box is one all the same.
  CHECK(chart.clearance(geo_point(-9.9, 180)).si() ==
        Approx(distance(geo_point(-9.9, 180), geo_point(-10, 180)).si()).margin(1.5));
  CHECK(chart.clearance(geo_point(-19.9, 174)).si() ==
        Approx(distance(geo_point(-19.9, 174), geo_point(-20, 174)).si()).margin(1.5));
  CHECK(Coast::parse((*joined)->text()).value()->text() == (*joined)->text());
}

TEST_CASE("a way from one area into another is never clear") {
  const std::vector<std::shared_ptr<const Coast>> coasts{coast_of(area_of(0, 1, 40, 41), {}),
                                                         coast_of(area_of(1.01, 2, 40, 41), {})};
  const Chart chart{ChartSources{joined_areas(coasts).value(), {}, {}}};
  CHECK(chart.segment_is_clear(rad(40.5), rad(0.2), rad(40.5), rad(0.8), 100));
  CHECK_FALSE(chart.segment_is_clear(rad(40.5), rad(0.9), rad(40.5), rad(1.1), 0));
}

TEST_CASE("areas that cannot be one file are refused with the reason") {
  const auto one = coast_of(area_of(0, 1, 40, 41), {});
  CHECK(joined_areas({one}).value() == one);
  CHECK_FALSE(joined_areas({}));
  CHECK(joined_areas({one, coast_of(area_of(0.5, 2, 40.5, 42), {})}).error().problem.find("overlap or touch") !=
        std::string::npos);
  CHECK(joined_areas({one, coast_of(area_of(1, 2, 40, 41), {})}).error().problem.find("overlap or touch") !=
        std::string::npos);
  CHECK(joined_areas({one, coast_of(area_of(100, 102, 40, 41), {}), coast_of(area_of(-102, -100, 40, 41), {})})
            .error()
            .problem.find("more than 180 degrees apart") != std::string::npos);
}
