#include "simulator/glider/dynamics.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulator/support.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using simulator::Accident;
using simulator::Dynamics;
using simulator::Hull;

namespace {

const chart::Chart kOpen;
const GeoPoint kHome = geo_point(40.0, 5.0);

std::optional<Accident> swim(Dynamics& d, Heading h, double seconds, double dt) {
  d.begin_dive();
  for (double left = seconds; left > 1e-9; left -= dt)
    if (auto accident = d.swim(h, dt, left)) return accident;
  return std::nullopt;
}

}  // namespace

TEST_CASE("in still water a held heading covers speed times time") {
  Dynamics d{Hull{}, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  REQUIRE_FALSE(swim(d, Heading{degrees(180)}, 14'400, 4));
  // Midpoint steps of 1.2 m along the meridian: M(φ) changes by 1e-8 within a step; 1 mm covers the sum.
  CHECK(distance(d.position(), destination(kHome, Bearing{degrees(180)}, Metres{4320})).si() < 1e-3);
  CHECK(d.depth().si() == 0);
  CHECK(d.time_s() == Approx(14'400));
}

TEST_CASE("a uniform current adds its drift to the way through water") {
  Dynamics d{Hull{}, {kUniform, kUniform}, kOpen};
  d.place(kHome, 0);
  REQUIRE_FALSE(swim(d, Heading{degrees(180)}, 14'400, 4));
  // 0.12 east, −0.10 − 0.30 north, straight in the local metric: 1728 m and −5760 m. The parallel's radius changes by
  // 0.08 % over 5.7 km of latitude, so the mean of both ends gives the easting to 1 m.
  const auto moved =
      local_offset(kHome.lat.radians(), kHome.lon.radians(), d.position().lat.radians(), d.position().lon.radians());
  CHECK(moved.east == Approx(1728).margin(1));
  CHECK(moved.north == Approx(-5760).margin(0.1));
  CHECK(d.dive_truth().water.east.si() == Approx(0.12).epsilon(1e-9));
  CHECK(d.dive_truth().heading.degrees() == Approx(180));
}

TEST_CASE("the yo turns at its depths and reaches the surface at the end of the dive") {
  Dynamics d{Hull{}, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  d.begin_dive();
  const double rate = 0.3 * std::tan(degrees(26).si());  // 0.1463 m/s
  double shallowest_inside = 1e9;
  int turns = 0;
  double before = 0, direction = 1;
  for (double left = 14'400; left > 0; left -= 4) {
    REQUIRE_FALSE(d.swim(Heading{}, 4, left));
    const double z = d.depth().si();
    if ((z - before) * direction < 0) {
      ++turns;
      direction = -direction;
      if (direction > 0) shallowest_inside = std::min(shallowest_inside, before);
    }
    before = z;
  }
  CHECK(d.deepest().si() == Approx(200).margin(4 * rate));
  CHECK(shallowest_inside == Approx(20).margin(4 * rate));
  CHECK(d.depth().si() == 0);
  // 200/rate down, 180/rate for each half cycle after that: 1367 s + n·1230 s, and the last climb of up to 1367 s:
  // between 9 and 11 turns fit into 14 400 s.
  CHECK(turns >= 9);
  CHECK(turns <= 11);
}

TEST_CASE("a dive too short for the full depth turns up in time") {
  Dynamics d{Hull{}, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  REQUIRE_FALSE(swim(d, Heading{}, 1200, 4));
  const double rate = 0.3 * std::tan(degrees(26).si());
  CHECK(d.deepest().si() == Approx(600 * rate).margin(8 * rate));
}

TEST_CASE("the current is met at the depth of the yo, a dive's mean is the mean over the profile") {
  // Linear shear: 0.4 m/s east at the surface, 0 at 200 m. A triangle wave between 20 and 200 m spends equal time at
  // each depth, so the mean there is 0.4·(1 − 110/200) = 0.18; the first descent and last climb through the top 20 m
  // (2 × 137 s of 14 400 s, mean 0.38) and the cut last yo move it by at most 0.02.
  const FormulaField sheared{[](double, double, double z, double) { return water(0.4 * (1 - z / 200), 0); }};
  Dynamics d{Hull{}, {sheared, sheared}, kOpen};
  d.place(kHome, 0);
  REQUIRE_FALSE(swim(d, Heading{}, 14'400, 4));
  CHECK(d.dive_truth().water.east.si() == Approx(0.18).margin(0.02));
}

TEST_CASE("the surface drift follows the shallowest current and the wind's leeway") {
  Hull hull;
  hull.leeway = water(0.05, 0);
  Dynamics d{hull, {kStill, kUniform}, kOpen};
  d.place(kHome, 1000);
  REQUIRE_FALSE(d.drift(1900));
  const auto moved =
      local_offset(kHome.lat.radians(), kHome.lon.radians(), d.position().lat.radians(), d.position().lon.radians());
  CHECK(moved.east == Approx(900 * 0.17).epsilon(1e-4));
  CHECK(moved.north == Approx(-90).epsilon(1e-4));
  CHECK(d.time_s() == 1900);
}

TEST_CASE("a heading bias turns the true heading") {
  Hull hull;
  hull.heading_bias = degrees(5);
  Dynamics d{hull, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  REQUIRE_FALSE(swim(d, Heading{degrees(350)}, 3600, 4));
  CHECK(geodesic(kHome, d.position()).departing.degrees() == Approx(355).margin(0.01));
}

TEST_CASE("leaving the true ocean's area or time is an accident that says where and when") {
  FormulaField small = kStill;
  small.limits.south = degrees(39.99).si();
  Dynamics d{Hull{}, {small, small}, kOpen};
  d.place(kHome, 0);
  const auto left = swim(d, Heading{degrees(180)}, 14'400, 4);
  REQUIRE(left);
  CHECK(left->what == Accident::What::left_truth);
  CHECK(left->at.lat.degrees() == Approx(39.99).margin(1e-4));
  CHECK(left->message().find("left the area of the true ocean at 39.9") == 0);

  FormulaField brief = kStill;
  brief.limits.last_s = 600;
  Dynamics e{Hull{}, {brief, brief}, kOpen};
  e.place(kHome, 0);
  const auto ended = swim(e, Heading{}, 14'400, 4);
  REQUIRE(ended);
  CHECK(ended->what == Accident::What::truth_ended);
  CHECK(ended->t_s == Approx(600).margin(4));
}

namespace {

/// Land east of 5.01°; no data north of 40.01°.
struct Shore {
  Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth, double) const {
    if (p.lon.degrees() > 5.01) return unexpected(ocean::NoCurrent::land);
    if (p.lat.degrees() > 40.01) return unexpected(ocean::NoCurrent::no_data);
    return ocean::Sample{water(0.05, 0), false};
  }
  ocean::Coverage coverage() const { return {}; }
  MetresPerSecond fastest() const { return MetresPerSecond{0.05}; }
};

}  // namespace

TEST_CASE("without a coastline the truth's land grounds the glider") {
  const Shore shore;
  Dynamics d{Hull{}, {shore, shore}, kOpen};
  d.place(kHome, 0);
  const auto accident = swim(d, Heading{degrees(90)}, 14'400, 4);
  REQUIRE(accident);
  CHECK(accident->what == Accident::What::aground);
  CHECK(accident->at.lon.degrees() == Approx(5.01).margin(1e-4));
}

TEST_CASE("water without data carries the glider with the last current met") {
  const Shore shore;
  Dynamics d{Hull{}, {shore, shore}, kOpen};
  d.place(kHome, 0);
  REQUIRE_FALSE(swim(d, Heading{}, 7200, 4));
  CHECK(d.position().lat.degrees() > 40.015);
  CHECK(d.dive_truth().water.east.si() == Approx(0.05).epsilon(1e-9));
}
