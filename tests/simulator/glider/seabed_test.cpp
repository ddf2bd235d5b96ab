#include "simulator/glider/seabed.hpp"

#include <catch2/catch.hpp>

#include "core/base/local_metric.hpp"
#include "tests/simulator/support.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using simulator::Seabed;
using simulator::SeabedSpec;

namespace {

/// Water down to 123.4 m east of 5.0°, none of it deeper west of that than 40 m.
struct Basin {
  Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth z, double) const {
    const double floor = p.lon.degrees() >= 5.0 ? 123.4 : 40.0;
    if (z.below_surface.si() > floor) return unexpected(ocean::NoCurrent::below_bottom);
    return ocean::Sample{water(0, 0), false};
  }
  ocean::Coverage coverage() const { return {}; }
  MetresPerSecond fastest() const { return MetresPerSecond{0}; }
};

}  // namespace

TEST_CASE("without a floor nothing is found") {
  CHECK_FALSE(Seabed({}, kStill).exists());
  CHECK_FALSE(Seabed({}, kStill).depth(kHome, 0, Metres{11'000}));
}

TEST_CASE("a plane gets deeper by its slope in its direction only, and never lies above the water") {
  SeabedSpec spec;
  spec.kind = SeabedSpec::Kind::plane;
  spec.origin = kHome;
  spec.depth = Metres{100};
  spec.slope = 0.02;
  spec.deepens = Bearing{degrees(90)};
  const Seabed floor{spec, kStill};
  const auto at = [&](double deg, double km) {
    return floor.depth(destination(kHome, Bearing{degrees(deg)}, Metres{km * 1e3}), 0, Metres{1000});
  };
  // The local offset is good to 1e-4 of 3 km, 6 mm of depth at this slope; north it leans by 3 km·tan φ/R·1.5 km ≈ 0.6 m.
  REQUIRE(at(90, 3));
  CHECK(at(90, 3)->si() == Approx(160).margin(0.02));
  CHECK(at(0, 3)->si() == Approx(100).margin(0.02));
  CHECK(at(270, 3)->si() == Approx(40).margin(0.02));
  CHECK(at(270, 8)->si() == 0);
  CHECK_FALSE(floor.depth(kHome, 0, Metres{99}));
}

TEST_CASE("a bank rises at the origin and is gone far from it") {
  SeabedSpec spec;
  spec.kind = SeabedSpec::Kind::plane;
  spec.origin = kHome;
  spec.depth = Metres{200};
  spec.hump_height = Metres{150};
  spec.hump_radius = Metres{1000};
  const Seabed floor{spec, kStill};
  CHECK(floor.depth(kHome, 0, Metres{1000})->si() == 50);
  const auto one = floor.depth(destination(kHome, Bearing{}, Metres{1000}), 0, Metres{1000});
  CHECK(one->si() == Approx(200 - 150 * std::exp(-0.5)).margin(0.02));
  const auto six = floor.depth(destination(kHome, Bearing{}, Metres{6000}), 0, Metres{1000});
  CHECK(six->si() == Approx(200).margin(1e-4));
}

TEST_CASE("the floor of the true ocean is where its water ends below") {
  const Basin basin;
  SeabedSpec spec;
  spec.kind = SeabedSpec::Kind::truth;
  const Seabed floor{spec, basin};
  REQUIRE(floor.depth(geo_point(40, 5.1), 0, Metres{500}));
  CHECK(floor.depth(geo_point(40, 5.1), 0, Metres{500})->si() == Approx(123.4).margin(0.1));
  CHECK(floor.depth(geo_point(40, 4.9), 0, Metres{500})->si() == Approx(40).margin(0.1));
  CHECK_FALSE(floor.depth(geo_point(40, 5.1), 0, Metres{120}));
}
