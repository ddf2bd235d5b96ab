#include "core/chart/grown_land.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <tuple>

#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

namespace {

/// Distance from a place to the rings as drawn, by golden section on the ellipsoid (shares nothing with the chart).
double distance_to(const std::vector<LonLat>& rings, const GeoPoint& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& ring : rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const auto& [lon0, lat0] = ring[k];
      const auto& [lon1, lat1] = ring[(k + 1) % ring.size()];
      least = std::min(least, brute_distance(p, lon0, lat0, lon1, lat1));
    }
  return least;
}

bool is_land(const Coast& coast, const GeoPoint& p) { return coast.land().contains(p.lat.radians(), p.lon.radians()); }

}  // namespace

TEST_CASE("grown land holds the true buffer and nothing farther than the buffer and the bound") {
  std::mt19937_64 random{11};
  std::size_t near = 0, far = 0, between = 0;
  for (const auto& [south, west, buffer, bound] : std::vector<std::tuple<double, double, double, double>>{
           {0.2, -20, 0, 700}, {35, 179.8, 1500, 400}, {-70, 10, 3000, 900}, {-0.3, 3, 500, 2500}}) {
    const auto area = area_of(west, west + 0.8, south, south + 0.5);
    std::vector<LonLat> rings{star(west + 0.25, south + 0.25, 0.2 * std::cos(south * kPi / 180), 40, random),
                              star(west + 0.6, south + 0.15, 0.1 * std::cos(south * kPi / 180), 9, random),
                              box_of(west + 0.65, west + 0.6502, south + 0.4, south + 0.4002)};  // a rock of 20 m
    const auto coast = coast_of(area, rings);
    const auto grown = grown_land(*coast, Metres{buffer}, Metres{bound});
    REQUIRE(grown);
    std::uniform_real_distribution<double> x{west + 0.001, west + 0.799}, y{south + 0.001, south + 0.499};
    for (int k = 0; k < 1500; ++k) {
      const auto p = geo_point(y(random), std::remainder(x(random), 360.0));
      const double away = is_land(*coast, p) ? 0 : distance_to(rings, p);
      // Distances of both sides are exact to 0.2 m and 1e-4.
      if (away <= buffer) {
        ++near;
        CHECK(is_land(**grown, p));
      } else if (away > buffer + bound + 0.3 + 1e-4 * (buffer + bound)) {
        ++far;
        CHECK_FALSE(is_land(**grown, p));
      } else {
        ++between;
      }
    }
    // The rock is an island still.
    CHECK(is_land(**grown, geo_point(south + 0.4001, std::remainder(west + 0.6501, 360.0))));
  }
  CHECK(near > 500);
  CHECK(far > 1000);
  CHECK(between > 30);
}

TEST_CASE("grown land is a coast file like any other, its border marked as cut") {
  const auto area = area_of(5, 6, 50, 51);
  // Land along the whole western border, closed along it.
  CoastRing ring = ring_of(area, box_of(5, 5.3, 50, 51));
  ring.cut = {true, false, true, true};
  const auto coast = Coast::make(area, "test", {ring}).value();
  const auto grown = grown_land(*coast, Metres{2000}, Metres{1000});
  REQUIRE(grown);
  const auto read = Coast::parse((*grown)->text());
  REQUIRE(read);
  CHECK((*read)->rings() == (*grown)->rings());
  CHECK((*grown)->rings().size() == 1);
  CHECK((*grown)->source() == "test; land grown by 2000 m and simplified outwards by at most 1000 m");
  std::size_t cut = 0;
  for (const auto& r : (*grown)->rings())
    for (const bool c : r.cut) cut += c ? 1 : 0;
  CHECK(cut == 3);
  // A degree of longitude at 50.5 N is 70.9 km: the new shore lies between 2 and 3 km east of the old one.
  const double shore = 5.3 + 2.0 / 70.9, bound = 5.3 + 3.1 / 70.9;
  CHECK(is_land(**grown, geo_point(50.5, shore)));
  CHECK_FALSE(is_land(**grown, geo_point(50.5, bound)));
}

TEST_CASE("water stays water far from land, lakes shrink and requests without sense are refused") {
  const auto area = area_of(5, 6, 50, 51);
  const auto coast = coast_of(area, {box_of(5.2, 5.8, 50.2, 50.8), box_of(5.45, 5.55, 50.45, 50.55)});
  const auto grown = grown_land(*coast, Metres{500}, Metres{300});
  REQUIRE(grown);
  CHECK_FALSE(is_land(**grown, geo_point(50.5, 5.5)));
  CHECK(is_land(**grown, geo_point(50.5, 5.454)));  // 284 m from the lake's shore
  CHECK((*grown)->rings().size() == 2);
  const auto empty = grown_land(*coast_of(area, {}), Metres{500}, Metres{300});
  REQUIRE(empty);
  CHECK((*empty)->rings().empty());
  CHECK_FALSE(grown_land(*coast, Metres{-1}, Metres{300}));
  CHECK_FALSE(grown_land(*coast, Metres{500}, Metres{0.5}));
  CHECK_FALSE(grown_land(*coast, Metres{0}, Metres{2}));  // 70 by 111 km in cells of 1.4 m
  CHECK_FALSE(grown_land(*coast, Metres{std::nan("")}, Metres{300}));
}
