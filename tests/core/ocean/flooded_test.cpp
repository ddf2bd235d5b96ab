#include "core/ocean/flooded.hpp"

#include <catch2/catch.hpp>

#include "tests/support/planning.hpp"

using namespace glidehelm;

namespace {

/// A current of 0.2 m/s to the east, north of the equator; south of it land, and west of the meridian the field ends.
struct HalfDry {
  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth, double) const {
    if (p.lon.radians() < 0) return unexpected(ocean::NoCurrent::outside_area);
    if (p.lat.radians() < 0) return unexpected(ocean::NoCurrent::land);
    return ocean::Sample{Current{MetresPerSecond{0.2}, MetresPerSecond{0}}, true};
  }
  [[nodiscard]] ocean::Coverage coverage() const { return test::box_around(geo_point(0, 0), 1.0); }
  [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{0.2}; }
};

}  // namespace

TEST_CASE("a flooded field is itself where it is wet, still water where it is dry, and ends where it ends") {
  const HalfDry half;
  const ocean::FloodedField flooded{half};
  const auto wet = flooded.sample(geo_point(0.5, 0.5), Depth{}, 0);
  REQUIRE(wet);
  CHECK(*wet == *half.sample(geo_point(0.5, 0.5), Depth{}, 0));
  const auto dry = flooded.sample(geo_point(-0.5, 0.5), Depth{}, 0);
  REQUIRE(dry);
  CHECK(dry->current.speed().si() == 0);
  const auto beyond = flooded.sample(geo_point(0.5, -0.5), Depth{}, 0);
  REQUIRE_FALSE(beyond);
  CHECK(beyond.error() == ocean::NoCurrent::outside_area);
  CHECK(flooded.fastest().si() == half.fastest().si());
}

TEST_CASE("lanes in a flooded field go on over dry places as in still water") {
  const HalfDry half;
  const ocean::FloodedField flooded{half};
  const auto m = LocalMetric::at(0);
  const double lon = 0.5 * kDegree, step = 600, speed = 0.3;
  ocean::Lanes lanes;
  lanes.count = 4;
  for (std::size_t k = 0; k < 4; ++k) {
    lanes.lat[k] = (k == 0 ? 0.5 : -0.5) * kDegree;  // wet, dry, dry, and west of the field
    lanes.lon[k] = k == 3 ? -lon : lon;
    lanes.water_east[k] = 0;
    lanes.water_north[k] = speed;
    lanes.lost[k] = 0;
  }
  lanes.lost[2] = 9;  // stopped before: it stays
  const auto before = lanes;
  ocean::FieldRef{flooded}.advance(lanes, 0, step);
  // Straight lines over 180 m: the metric changes by 1e-7 of them.
  CHECK((lanes.lat[0] - before.lat[0]) * m.meridian_radius == Approx(speed * step).epsilon(1e-3));
  CHECK((lanes.lon[0] - before.lon[0]) * m.parallel_radius == Approx(0.2 * step).epsilon(1e-3));
  CHECK((lanes.lat[1] - before.lat[1]) * m.meridian_radius == Approx(speed * step).epsilon(1e-3));
  CHECK(lanes.lon[1] == before.lon[1]);
  CHECK(lanes.lost[0] == 0);
  CHECK(lanes.lost[1] == 0);
  CHECK(lanes.lost[2] == 9);
  CHECK(lanes.lat[2] == before.lat[2]);
  CHECK(lanes.lost[3] == static_cast<std::uint8_t>(ocean::NoCurrent::outside_area));
  CHECK(lanes.lat[3] == before.lat[3]);
}
