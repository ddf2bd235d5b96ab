#include "core/ocean/field.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ocean;

TEST_CASE("every reason for no current has the word of the JSON contract") {
  CHECK(word(NoCurrent::land) == "land");
  CHECK(word(NoCurrent::no_data) == "no_data");
  CHECK(word(NoCurrent::below_bottom) == "below_bottom");
  CHECK(word(NoCurrent::outside_area) == "outside_area");
  CHECK(word(NoCurrent::outside_time) == "outside_time");
}

TEST_CASE("a coverage across the antimeridian contains both of its sides") {
  Coverage box;
  box.west = 170 * kPi / 180;
  box.east = 190 * kPi / 180;
  CHECK(box.contains(geo_point(0, 175)));
  CHECK(box.contains(geo_point(0, -175)));
  CHECK_FALSE(box.contains(geo_point(0, -169)));
  CHECK_FALSE(box.contains(geo_point(0, 0)));
}

TEST_CASE("a longitude many turns away is wound back at once, and one that is no number is nowhere") {
  const auto at = [](double lon) { return GeoPoint::from_kernel(0, lon); };
  Coverage box;
  box.west = 0.1;
  box.east = 0.5;
  CHECK(box.contains(at(0.1)));
  CHECK(box.contains(at(0.5)));
  for (const double turns : {-1000.0, -1.0, 1.0, 1000.0}) {
    CHECK(box.contains(at(0.3 + 2 * kPi * turns)));
    CHECK_FALSE(box.contains(at(0.6 + 2 * kPi * turns)));
    CHECK_FALSE(box.contains(at(0.05 + 2 * kPi * turns)));
  }
  // The edges, a turn away: what is lost in the rounding of 2π, 4e-16, does not put them outside.
  for (const double edge : {0.1, 0.5}) {
    CHECK(box.contains(at(edge + 2 * kPi)));
    CHECK(box.contains(at(edge - 2 * kPi)));
  }
  // Across the antimeridian, and all round the globe.
  Coverage across;
  across.west = kPi - 0.2;
  across.east = kPi + 0.2;
  CHECK(across.contains(at(-kPi + 0.1)));
  CHECK_FALSE(across.contains(at(-kPi + 0.3)));
  CHECK(Coverage{}.contains(at(1e300)));  // a turn less than the rounding: no loop comes to its end
  const double inf = std::numeric_limits<double>::infinity();
  for (const double none : {inf, -inf, std::nan("")}) CHECK_FALSE(box.contains(at(none)));
}

TEST_CASE("a FieldRef answers as the field it looks at") {
  const test::Uniform field{0.3, -0.4};
  const FieldRef ref{field};
  const auto sample = ref.sample(geo_point(10, 20), 0);
  REQUIRE(sample);
  CHECK(sample->current.east == MetresPerSecond{0.3});
  CHECK(ref.fastest() == MetresPerSecond{0.5});
}

TEST_CASE("a field without a kernel moves lanes by its samples, and loses those that have none") {
  test::FromFunction field{[](double, double, double) { return std::pair{0.5, 0.0}; }, 0.5, {}};
  field.box.east = 0.0;
  Lanes lanes{};
  lanes.count = 2;
  lanes.lat = {};
  lanes.lon = {};
  lanes.lon[0] = -0.01;
  lanes.lon[1] = -1e-5;  // 64 m from the edge, 0.5 m/s for an hour
  lanes.water_east = {};
  lanes.water_north = {};
  lanes.lost = {};
  FieldRef{field}.advance(lanes, 0, 3600);
  // On the equator a radian of longitude is the equatorial radius; the current is uniform, so the step is exact.
  CHECK(lanes.lon[0] == Approx(-0.01 + 1800 / LocalMetric::kEquatorialRadius).epsilon(1e-12));
  CHECK(lanes.lost[0] == 0);
  CHECK(lanes.lost[1] == static_cast<std::uint8_t>(NoCurrent::outside_area));
  CHECK(lanes.lon[1] == -1e-5);
}
