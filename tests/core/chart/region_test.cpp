#include "core/chart/region.hpp"

#include <catch2/catch.hpp>

#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

TEST_CASE("a region answers in longitudes of any turn") {
  Outline outline;
  outline.middle = kPi;
  outline.add_ring(std::vector<Plane>{{rad(-1), rad(10)}, {rad(1), rad(10)}, {rad(1), rad(12)}, {rad(-1), rad(12)}});
  const Region region{std::move(outline)};
  for (const double lon : {179.5, -179.5, 180.5, -180.5, 540.0}) {
    CHECK(region.contains(rad(11), rad(lon)));
    CHECK_FALSE(region.contains(rad(11), rad(lon + 180)));
  }
  CHECK(region.touches(rad(11), rad(178.995), rad(11), rad(179.005), 0));
  CHECK(region.touches(rad(11), rad(-181.005), rad(11), rad(179.005), 0));
  CHECK_FALSE(region.touches(rad(11), rad(178.98), rad(11), rad(178.99), 0));
  CHECK(region.touches(rad(11), rad(178.98), rad(11), rad(178.99), 1200));
}

TEST_CASE("an empty region holds nothing and is far from everything") {
  const Region none;
  CHECK_FALSE(none.contains(0, 0));
  CHECK(none.distance(Space::at(0, 0), 123) == 123);
  CHECK_FALSE(none.touches(0, 0, 0.0001, 0, 100));
}
