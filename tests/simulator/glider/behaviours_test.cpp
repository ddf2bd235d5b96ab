#include "simulator/glider/behaviours.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulator/support.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using simulator::Glider;
using simulator::GliderSetup;

namespace {

GliderSetup setup_towards(double bearing_deg, double radius = 200) {
  GliderSetup s;
  s.start = geo_point(40.0, 5.0);
  s.start_s = 1.7e9;
  s.list.waypoints = {destination(s.start, Bearing{degrees(bearing_deg)}, Metres{60'000})};
  s.list.radius = Metres{radius};
  s.list.initial = 0;
  return s;
}

/// Fixes, drifts, dives; the record of the dive.
simulator::DiveRecord round(Glider& g) {
  REQUIRE_FALSE(g.take_fixes());
  auto record = g.dive(g.fix_s() + g.setup().times.surface);
  REQUIRE_FALSE(record.accident);
  return record;
}

}  // namespace

TEST_CASE("the measured current equals the truth in a uniform current, whatever the correction believes") {
  for (const int correction : {0, 1}) {
    auto setup = setup_towards(20);
    setup.belief.correction = correction;
    Glider g{setup, {kUniform, kUniform}, kOpen};
    CHECK_FALSE(g.water());
    for (int k = 0; k < 3; ++k) round(g);
    REQUIRE_FALSE(g.take_fixes());
    REQUIRE(g.water());
    // Reckoning by Euler with the metric at a cycle's start against the truth's midpoint, 0.3 m in 4.3 km, is 2e-5 m/s
    // over a stint; the offset's own error is 1e-4 of some 2 km, 1.5e-5 m/s. Together below 1e-4.
    CHECK(g.water()->east.si() == Approx(0.12).margin(1e-4));
    CHECK(g.water()->north.si() == Approx(-0.10).margin(1e-4));
  }
}

TEST_CASE("the initial value holds the drift until the first fix, the final one does not") {
  // Still below, 0.5 m/s on the surface: 25 s of drift over a dive of 14 400 s is 8.7e-4 m/s.
  const FormulaField fast{[](double, double, double, double) { return water(0.5, 0); }};
  Glider g{setup_towards(0), {kStill, fast}, kOpen};
  round(g);
  REQUIRE_FALSE(g.take_fixes());
  CHECK(g.initial_water()->east.si() == Approx(0.5 * 25 / 14'400).margin(1e-4));
  CHECK(g.water()->east.si() == Approx(0).margin(1e-4));
}

TEST_CASE("with correction 1 the second dive holds the wanted course, with correction 0 it drifts off it") {
  for (const int correction : {0, 1}) {
    auto setup = setup_towards(20);
    setup.belief.correction = correction;
    Glider g{setup, {kUniform, kUniform}, kOpen};
    round(g);
    const auto second = round(g);
    const auto way = geodesic(second.dive, second.surface).departing;
    const auto wanted = geodesic(second.dive, setup.list.waypoints[0]).departing;
    if (correction == 1) {
      // The believed current is the true one to 1e-4 m/s (above): 0.02° at 0.28 m/s over ground; the bearing changes
      // along the way by less than 0.05°.
      CHECK(std::fabs((way.from_north() - wanted.from_north()).si()) < degrees(0.1).si());
    } else {
      // Heading ≈ bearing: the course leans to the cross current, atan(0.147/0.247) ≈ 31°, less what re-aiming on a
      // reckoned track that ignores the drift changes: nothing. A lean of 25° or more proves that none is corrected.
      CHECK(std::fabs((way.from_north() - wanted.from_north()).si()) > degrees(25).si());
    }
  }
}

TEST_CASE("the printed fix is taken after the surfacing and holds the drift until then") {
  const FormulaField fast{[](double, double, double, double) { return water(0.5, 0); }};
  Glider g{setup_towards(0), {kStill, fast}, kOpen};
  const auto dive = round(g);
  REQUIRE_FALSE(g.take_fixes());
  CHECK(g.fix_s() == Approx(dive.surface_s + 60));
  CHECK(distance(dive.surface, g.fix()).si() == Approx(30).margin(0.01));
}

TEST_CASE("stints spread evenly within the jitter, the same for the same seed") {
  auto setup = setup_towards(0);
  setup.stint_jitter = 0.05;
  setup.cycle_s = 60;
  std::vector<double> first, again;
  for (auto* lengths : {&first, &again}) {
    Glider g{setup, {kStill, kStill}, kOpen};
    for (int k = 0; k < 40; ++k) {
      const auto r = round(g);
      lengths->push_back(r.surface_s - r.dive_s);
    }
  }
  CHECK(first == again);
  const auto [low, high] = std::minmax_element(first.begin(), first.end());
  CHECK(*low >= 14'400 * 0.95 - 1e-6);
  CHECK(*high <= 14'400 * 1.05 + 1e-6);
  // 40 even draws miss the outer tenth at one end with probability 0.9^40 = 1.5 %; the seed is fixed.
  CHECK(*high - *low > 0.08 * 14'400);
}

TEST_CASE("the measured current is clipped as the firmware clips it") {
  // A belief of 3 m/s while the hull swims at 0.3: the error looks like a current of −2.7 m/s and −3.5 with 0.8 against.
  auto setup = setup_towards(0);
  setup.belief.speed = MetresPerSecond{3.0};
  setup.list.waypoints = {destination(setup.start, Bearing{}, Metres{200'000})};
  const FormulaField against{[](double, double, double, double) { return water(0, -0.8); }};
  Glider g{setup, {against, against}, kOpen};
  round(g);
  REQUIRE_FALSE(g.take_fixes());
  CHECK(g.water()->north.si() == -2.8);
}

TEST_CASE("the arrival is the first instant inside the goal radius") {
  auto setup = setup_towards(90);
  Glider g{setup, {kStill, kStill}, kOpen};
  const auto goal = destination(setup.start, Bearing{degrees(90)}, Metres{3000});
  g.watch(goal, Metres{1000});
  CHECK_FALSE(g.arrived_s());
  const auto dive = round(g);
  REQUIRE(g.arrived_s());
  // 2000 m at 0.3 m/s after the dive; the crossing is interpolated within one cycle of 1.2 m.
  CHECK(*g.arrived_s() - dive.dive_s == Approx(2000 / 0.3).margin(2));
  CHECK(g.closest().si() <= 1000);
}

TEST_CASE("a finished list with end_action 0 brings the glider up by the shortest way") {
  auto setup = setup_towards(0);
  setup.list.waypoints = {destination(setup.start, Bearing{}, Metres{900})};
  setup.list.legs = -2;
  Glider g{setup, {kStill, kStill}, kOpen};
  const auto dive = round(g);
  CHECK(g.mission_over());
  // Hit after 700 m at 0.3 m/s, 2333 s: 1367 s down to 200 m and 966 s up again, so 58.6 m are left to climb at
  // 0.1463 m/s, 401 s. The turn and the hit come up to two cycles of 4 s late, each of which adds as much climb.
  CHECK(dive.surface_s - dive.dive_s == Approx(700 / 0.3 + 401).margin(24));
  CHECK(g.because() == simulator::because::kHeadingIdle);
}

namespace {

constexpr double kRate = 0.3 * 0.48773258856586144;  // of the point model: 0.3 m/s · tan 26°

simulator::DiveRecord first_dive(GliderSetup setup) {
  Glider g{std::move(setup), {kStill, kStill}, kOpen};
  return round(g);
}

}  // namespace

TEST_CASE("the yo's half cycles end a dive instead of the stint") {
  auto setup = setup_towards(0);
  setup.surfacing.half_cycles = 4;
  const auto dive = first_dive(setup);
  CHECK(dive.because == simulator::because::kYoIsOver);
  CHECK(dive.half_cycles == 4);
  // 200 + 3·180 + 20 m at 0.1463 m/s; each of three turns a cycle late with its way back, the last step whole.
  CHECK(dive.surface_s - dive.dive_s == Approx(760 / kRate).margin(40));
}

TEST_CASE("a timer brings it up from where it is, and says so") {
  auto setup = setup_towards(0);
  setup.surfacing.every_s = 1000;
  const auto dive = first_dive(setup);
  CHECK(dive.because.start_when == 9.0);
  CHECK(dive.because.text == "timeout expired");
  // 1000 s down and as long up again, a cycle or two later.
  CHECK(dive.surface_s - dive.dive_s == Approx(2000).margin(16));
  CHECK(dive.deepest.si() == Approx(1000 * kRate).margin(8 * kRate));
}

TEST_CASE("no call for a while brings it up, a call in time does not") {
  auto setup = setup_towards(0);
  setup.surfacing.no_comms_s = 3 * 3600;
  Glider silent{setup, {kStill, kStill}, kOpen}, heard{setup, {kStill, kStill}, kOpen};
  const auto dive = round(silent);
  CHECK(dive.because.start_when == 12.0);
  // Counted from the start of the run, 960 s before the dive; then the climb from at most 200 m.
  CHECK(dive.surface_s - dive.dive_s >= 3 * 3600 - 960);
  CHECK(dive.surface_s - dive.dive_s <= 3 * 3600 - 960 + 200 / kRate + 8);

  REQUIRE_FALSE(heard.take_fixes());
  const double dive_s = heard.fixes_done_s() + 900;
  heard.called(dive_s + 4000, 600);  // as if the last word came then: three hours after it the stint is over
  CHECK(heard.dive(dive_s).because.start_when == 2.0);
}

TEST_CASE("a hit waypoint brings it up when a behaviour waits for that, and else does not") {
  auto setup = setup_towards(0);
  setup.list.waypoints = {destination(setup.start, Bearing{}, Metres{1100}),
                          destination(setup.start, Bearing{}, Metres{30'000})};
  const auto on = first_dive(setup);
  CHECK(on.because.start_when == 2.0);
  CHECK(on.surface_s - on.dive_s == Approx(14'400));
  setup.surfacing.at_waypoint = true;
  const auto up = first_dive(setup);
  CHECK(up.because.text == "Hit a waypoint");
  CHECK(up.because.start_when == 8.0);
  CHECK(up.hits == 1);
  // 900 m at 0.3 m/s = 3000 s: down 1367 s, up 1230 s to 20 m, down again for 402 s to 79 m: 540 s of climb, cycles late.
  CHECK(up.surface_s - up.dive_s == Approx(3000 + 540).margin(30));
}

TEST_CASE("an idle heading ends the mission, brings the glider up once, or does neither") {
  using Idle = simulator::SurfaceRules::Idle;
  for (const auto idle : {Idle::quit, Idle::resume, Idle::ignore}) {
    auto setup = setup_towards(0);
    setup.list.waypoints = {destination(setup.start, Bearing{}, Metres{900})};
    setup.list.legs = -2;
    setup.surfacing.heading_idle = idle;
    Glider g{setup, {kStill, kStill}, kOpen};
    const auto first = round(g);
    CHECK(g.mission_over() == (idle == Idle::quit));
    CHECK((first.because.start_when == 3.0) == (idle != Idle::ignore));
    if (idle == Idle::quit) continue;
    const auto second = round(g);  // the heading is held, nothing brings it up before its time
    CHECK(second.surface_s - second.dive_s == Approx(14'400));
    CHECK(geodesic(second.dive, second.surface).departing.east() == Approx(0).margin(1e-3));
  }
}

TEST_CASE("without a valid fix the older one stays, nothing is measured, and reckoning goes on") {
  for (const bool invalid : {false, true}) {
    auto setup = setup_towards(0);
    (invalid ? setup.gps.invalid : setup.gps.stale).surfacings = {2};
    setup.belief.correction = 0;
    Glider g{setup, {kUniform, kUniform}, kOpen};
    round(g);
    const auto fix = g.fix();
    const auto reckoned = g.navigator().reckoned();
    REQUIRE_FALSE(g.take_fixes());
    CHECK_FALSE(g.fix_is_fresh());
    CHECK(g.fix() == fix);
    CHECK_FALSE(g.water());
    CHECK(g.reckoned() == reckoned);
    CHECK(g.invalid_fix().has_value() == invalid);
    if (invalid) CHECK(*g.invalid_fix() == g.position());
    CHECK(g.fixes_done_s() == g.surfaced_s() + 60);
    // The next dive is reckoned from the reckoned place: 0.3 m/s for a stint; the metric's error is below a metre.
    g.dive(g.fixes_done_s() + 900);
    CHECK(distance(reckoned, g.navigator().reckoned()).si() == Approx(4320).margin(1));
    REQUIRE_FALSE(g.take_fixes());
    CHECK(g.fix_is_fresh());
    // Two dives of reckoning and one surface interval that it did not see: 960 s of 28 800 too much, and 1e-4 (above).
    REQUIRE(g.water());
    CHECK(g.water()->east.si() == Approx(0.12 * (1 + 960.0 / 28'800)).margin(2e-4));
    CHECK(g.water()->north.si() == Approx(-0.10 * (1 + 960.0 / 28'800)).margin(2e-4));
  }
}

TEST_CASE("noise of the fixes moves the measured current by noise over dive time") {
  auto setup = setup_towards(0);
  setup.gps.noise = Metres{10};
  setup.stint_s = 3600;
  Glider g{setup, {kStill, kStill}, kOpen};
  double worst = 0, sum = 0;
  constexpr int kDives = 60;
  for (int k = 0; k < kDives; ++k) {
    round(g);
    if (k == 0) continue;
    const double e = g.water()->east.si();
    sum += e * e;
    worst = std::max(worst, std::fabs(e));
  }
  // What is measured is `used`, the last measurement, plus the error of this dive; in still water the whole error of dive k
  // is (first fix − dive fix − 25/35·(second − first))/T: its variance is (1 + (60/35)²… ) at most 10²·(1 + 2.94 + 0.51).
  const double sigma = 10 * std::sqrt(1 + 2.94 + 0.51) / 3600;
  CHECK(std::sqrt(sum / (kDives - 1)) == Approx(sigma).epsilon(0.37));  // 4/√(2·59)
  CHECK(worst < 5 * sigma);
}

TEST_CASE("the energy of a stint is pump, hotel and call by their closed forms") {
  auto setup = setup_towards(0);
  setup.energy.battery_wh = 100;
  Glider g{setup, {kStill, kStill}, kOpen};
  REQUIRE_FALSE(g.take_fixes());
  g.called(g.fixes_done_s() + 45, 795);
  const auto dive = g.dive(g.fixes_done_s() + 900);
  // From the surfacing to the dive 60 + 900 s, then 14 400 s, 1.5 W; the call 795 s at 6 W.
  CHECK(dive.energy.hotel_wh == Approx(1.5 * (960 + 14'400) / 3600).epsilon(1e-9));
  CHECK(dive.energy.call_wh == Approx(6.0 * 795 / 3600).epsilon(1e-12));
  // Turns at 200 m every 2461 s, the first after 1367 s: five full ones, the sixth (13 672 s) when the way up is the rest;
  // its depth is between nothing and 200 m.
  const auto full = simulator::pump_wh(setup.energy, 5, Metres{1000});
  CHECK(dive.energy.pump_wh >= full);
  CHECK(dive.energy.pump_wh <= full + simulator::pump_wh(setup.energy, 1, Metres{200}));
  CHECK(g.energy() == dive.energy);
  REQUIRE(g.battery_left());
  CHECK(*g.battery_left() == Approx(1 - dive.energy.total_wh() / 100).epsilon(1e-12));
}

TEST_CASE("an empty battery aborts") {
  auto setup = setup_towards(0);
  setup.energy.battery_wh = 12;  // a stint takes 6.4 Wh, and the pump 2.3 to 2.9
  Glider g{setup, {kStill, kStill}, kOpen};
  round(g);
  CHECK_FALSE(g.abort());
  round(g);
  REQUIRE(g.abort());
  CHECK(g.abort()->details == "battery empty");
  CHECK(*g.battery_left() == 0);
}

TEST_CASE("a waypoint too far away and too great a depth abort and bring the glider up") {
  auto setup = setup_towards(0);
  setup.aborts.max_wpt_distance = Metres{50'000};
  Glider far{setup, {kStill, kStill}, kOpen};  // its waypoint is 60 km away
  const auto dive = round(far);
  REQUIRE(far.abort());
  CHECK(far.abort()->code == 18);
  CHECK(far.abort()->message().find("MS_ABORT_WPT_TOOFAR(18): 599") == 0);
  CHECK(dive.surface_s - dive.dive_s < 60);

  setup = setup_towards(0);
  setup.aborts.overdepth = Metres{150};
  Glider deep{setup, {kStill, kStill}, kOpen};
  const auto record = round(deep);
  REQUIRE(deep.abort());
  CHECK(deep.abort()->cause == "MS_ABORT_OVERDEPTH");
  CHECK(record.deepest.si() == Approx(150).margin(8 * kRate));
}

TEST_CASE("after an abort the glider drifts from call to call, so often as its fallback says") {
  auto setup = setup_towards(0);
  setup.aborts.max_wpt_distance = Metres{50'000};
  setup.aborts.fallback_calls = 2;
  setup.aborts.fallback_every_s = 1800;
  Glider g{setup, {kUniform, kUniform}, kOpen};
  round(g);
  REQUIRE(g.abort());
  for (int k = 0; k < 2; ++k) {
    CHECK_FALSE(g.fallback_is_over());
    const auto drift = round(g);
    CHECK(drift.deepest.si() == 0);
    CHECK(drift.surface_s - drift.dive_s == Approx(1800));
    // 0.12 east, 0.10 south for half an hour.
    CHECK(distance(drift.dive, drift.surface).si() == Approx(1800 * std::hypot(0.12, 0.10)).epsilon(1e-3));
  }
  CHECK(g.fallback_is_over());
  CHECK_FALSE(g.mission_over());
}

TEST_CASE("a speed taken from the depth rate is true with the true angle and wrong with a wrong one") {
  for (const double error_deg : {0.0, 3.0}) {
    auto setup = setup_towards(0);
    setup.speed_by_depth_rate = true;
    setup.angle_error = degrees(error_deg);
    setup.belief = {MetresPerSecond{0.5}, 0};
    Glider g{setup, {kStill, kStill}, kOpen};
    const auto dive = round(g);
    const double believed = kRate / std::tan(degrees(26 + error_deg).si());
    CHECK(g.navigator().belief().speed.si() == Approx(believed).epsilon(1e-9));
    CHECK(distance(dive.dive, g.navigator().reckoned()).si() == Approx(believed * 14'400).margin(1));
  }
}

TEST_CASE("a fouled glider that measures its depth rate knows its speed, one that does not reckons too far") {
  for (const bool measures : {true, false}) {
    auto setup = setup_towards(0);
    setup.hull.fouling_per_day = 0.04;
    setup.speed_by_depth_rate = measures;
    Glider g{setup, {kStill, kStill}, kOpen};
    for (int k = 0; k < 12; ++k) round(g);
    REQUIRE_FALSE(g.take_fixes());
    // Two days and an hour: 0.3·(1 − 0.96²·…) ≈ 0.024 m/s slower. What is not known looks like a current against it.
    if (measures)
      CHECK(std::fabs(g.water()->north.si()) < 1e-3);
    else
      CHECK(g.water()->north.si() < -0.02);
  }
}

TEST_CASE("wind drives the glider on the surface only") {
  auto setup = setup_towards(0);
  setup.wind.speed = MetresPerSecond{10};
  setup.wind.from = Bearing{degrees(270)};
  Glider g{setup, {kStill, kStill}, kOpen};
  REQUIRE_FALSE(g.take_fixes());
  const auto dive = g.dive(g.fixes_done_s() + 900);
  // 0.2 m/s east for 960 s; then straight north.
  CHECK(distance(setup.start, dive.dive).si() == Approx(192).epsilon(1e-4));
  CHECK(dive.truth.water.east.si() == 0);
}

TEST_CASE("everything drawn comes back from the same seed and differs from another's") {
  const auto fixes = [](std::uint64_t seed) {
    auto setup = setup_towards(30);
    setup.seed = seed;
    setup.cycle_s = 60;
    setup.gps.noise = Metres{8};
    setup.gps.stale.probability = setup.gps.far.probability = 0.2;
    setup.wind.gusts = MetresPerSecond{5};
    setup.stint_jitter = 0.1;
    Glider g{setup, {kUniform, kUniform}, kOpen};
    std::vector<GeoPoint> all;
    for (int k = 0; k < 10; ++k) {
      round(g);
      all.push_back(g.fix());
    }
    return all;
  };
  CHECK((fixes(1) == fixes(1)));
  CHECK((fixes(1) != fixes(2)));
}
