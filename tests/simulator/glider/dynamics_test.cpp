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

namespace {

simulator::SeabedSpec plane(double depth, double slope = 0, double toward_deg = 0) {
  simulator::SeabedSpec s;
  s.kind = simulator::SeabedSpec::Kind::plane;
  s.origin = kHome;
  s.depth = Metres{depth};
  s.slope = slope;
  s.deepens = Bearing{degrees(toward_deg)};
  return s;
}

}  // namespace

TEST_CASE("with a balance of forces in even water the way is the leg's horizontal speed times time") {
  Hull hull;
  hull.body.emplace();
  hull.body->compressibility_per_pa = 0;
  const auto leg = simulator::steady_flight(*hull.body, true, Metres{0});
  REQUIRE(leg);
  Dynamics d{hull, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  REQUIRE_FALSE(swim(d, Heading{}, 14'400, 4));
  // Up and down are equal (flight_test); midpoint steps leave a millimetre, the buoyancy's rounding 1e-9 of 6 km.
  CHECK(distance(d.position(), kHome).si() == Approx(14'400 * leg->horizontal.si()).margin(0.01));
  CHECK(d.leg(true, Metres{100}).vertical == Approx(leg->vertical.si()).epsilon(1e-9));
  CHECK(d.deepest().si() == Approx(200).margin(4 * leg->vertical.si()));
}

TEST_CASE("a hull that gives way climbs slower than it dives, and is at the surface when the dive is over") {
  Hull hull;
  hull.body.emplace();
  Dynamics d{hull, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  d.begin_dive();
  double before = 0, last = 0;
  for (double left = 14'400; left > 0; left -= 4) {
    REQUIRE_FALSE(d.swim(Heading{}, 4, left));
    last = before;
    before = d.depth().si();
  }
  CHECK(d.depth().si() == 0);
  // The last climb begins at most two cycles early (turn) and its time is known to Simpson's error, far below a cycle:
  // one cycle before the end at most four cycles' climb are left.
  CHECK(last <= 4 * 4 * d.leg(false, Metres{0}).vertical);
  CHECK(d.leg(false, Metres{200}).vertical < d.leg(true, Metres{200}).vertical);
}

TEST_CASE("the time of a climb is the integral of slowness over depth") {
  Hull hull;
  hull.body.emplace();
  Dynamics d{hull, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  d.begin_dive();
  for (int i = 0; i < 100; ++i) REQUIRE_FALSE(d.swim(Heading{}, 4, 1e6));
  // An independent sum of 10⁴ midpoints; its error is (Δz)² w''/24, below 1e-6; Simpson's below 1e-5 of it.
  const double z = d.depth().si();
  REQUIRE(z > 50);
  double sum = 0;
  for (int i = 0; i < 10'000; ++i) sum += z / 1e4 / d.leg(false, Metres{z * (i + 0.5) / 1e4}).vertical;
  CHECK(d.climb_seconds() == Approx(sum).epsilon(1e-4));
}

TEST_CASE("a dive that floats turns up there, a climb that cannot rise is an accident") {
  Hull hull;
  hull.body.emplace();
  hull.body->compressibility_per_pa = 0;
  hull.body->density_per_m = 0.02;  // gone at 146.8 m (flight_test)
  Dynamics d{hull, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  REQUIRE_FALSE(swim(d, Heading{}, 14'400, 4));
  CHECK(d.deepest().si() == Approx(146.8).margin(1));

  hull.body->density_per_m = 0;
  hull.body->pump_climb_m3 = 0;
  Dynamics e{hull, {kStill, kStill}, kOpen};
  e.place(kHome, 0);
  const auto accident = swim(e, Heading{}, 14'400, 4);
  REQUIRE(accident);
  CHECK(accident->what == Accident::What::sank);
  CHECK(accident->message().find("cannot climb at 40.0") == 0);
}

TEST_CASE("growth takes its share of the speed each day and keeps the angle") {
  Hull hull;
  hull.fouling_per_day = 0.05;
  Dynamics d{hull, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  REQUIRE_FALSE(d.drift(2 * 86'400.0));
  const auto leg = d.leg(true, Metres{10});
  CHECK(leg.horizontal == Approx(0.3 * 0.95 * 0.95).epsilon(1e-12));
  CHECK(leg.vertical / leg.horizontal == Approx(std::tan(degrees(26).si())).epsilon(1e-12));
  // In a stint of 4 h: ∫ 0.3·0.95^(2 + t/day) dt, a step at a time: the step's own change, 4 s·6e-7/s, is 2.4e-6.
  REQUIRE_FALSE(swim(d, Heading{}, 14'400, 4));
  const double k = std::log(0.95) / 86'400;
  const double way = 0.3 * 0.95 * 0.95 * (std::exp(k * 14'400) - 1) / k;
  CHECK(distance(d.position(), kHome).si() == Approx(way).epsilon(1e-5));
}

TEST_CASE("the altimeter turns the yo above the floor by the target altitude") {
  Hull hull;
  hull.seabed = plane(80);
  hull.target_altitude = Metres{12};
  Dynamics d{hull, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  REQUIRE_FALSE(swim(d, Heading{}, 14'400, 4));
  // It looks once a cycle: the turn comes at most a cycle's sinking, 0.59 m, late.
  CHECK(d.deepest().si() >= 68);
  CHECK(d.deepest().si() <= 68 + 4 * 0.1463 + 1e-9);
  CHECK(d.touched() == 0);
}

TEST_CASE("a floor that is not heard is touched and turns the yo too") {
  Hull hull;
  hull.seabed = plane(80);
  Dynamics d{hull, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  d.begin_dive({std::nullopt, false});
  for (double left = 14'400; left > 1e-9; left -= 4) REQUIRE_FALSE(d.swim(Heading{}, 4, left));
  CHECK(d.touched() > 0);
  CHECK(d.deepest().si() == Approx(80).margin(4 * 0.1463));
  CHECK(d.depth().si() == 0);
}

TEST_CASE("over a slope the yo follows the floor, and where the floor comes out of the water it is aground") {
  Hull hull;
  hull.seabed = plane(100, 0.04, 0);  // shoals to the south: 2500 m away it is out of the water
  Dynamics d{hull, {kStill, kStill}, kOpen};
  d.place(kHome, 0);
  const auto accident = swim(d, Heading{degrees(180)}, 14'400, 4);
  REQUIRE(accident);
  CHECK(accident->what == Accident::What::aground);
  // Aground in less than half a metre of water: 12.5 m before the line, and a step of 1.2 m.
  CHECK(distance(kHome, accident->at).si() == Approx(2500 - 12.5).margin(2));
}

TEST_CASE("a yo of N half cycles comes up after them, by the way that is left") {
  for (const int n : {1, 2, 3, 4}) {
    Dynamics d{Hull{}, {kStill, kStill}, kOpen};
    d.place(kHome, 0);
    d.begin_dive({n, true});
    double t = 0;
    for (; t < 20'000 && !(d.yo_is_over() && d.depth().si() == 0); t += 4) REQUIRE_FALSE(d.swim(Heading{}, 4, 1e9));
    const double rate = 0.3 * std::tan(degrees(26).si());
    // 200 m down, then 180 m for each half cycle more; an odd number ends at 200 m, an even one at 20 m. Each turn comes up
    // to a cycle late and so does its way back: three cycles a turn.
    const double way = 200 + 180.0 * (n - 1) + (n % 2 == 1 ? 200 : 20);
    CHECK(t == Approx(way / rate).margin(12.0 * n + 8));
    CHECK(d.pumped() == (n + 1) / 2);
    CHECK(d.pumped_depths().si() == Approx(200.0 * d.pumped()).margin(1e-9));
  }
}
