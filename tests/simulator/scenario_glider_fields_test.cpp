#include <catch2/catch.hpp>
#include <string>

#include "simulator/scenario.hpp"
#include "tests/simulator/scenario_errors.hpp"

using namespace glidehelm;
using test::errors_of;
using namespace glidehelm::simulator;

namespace {

std::string scenario(const std::string& glider, const std::string& top = {}) {
  return "schema: glidehelm/scenario/v1\nstart: 2026-03-01T00:00:00Z\ntruth: {still: true}\n" + top +
         "gliders:\n  - name: sim01\n    start: {lat_deg: 40.0, lon_deg: 5.0}\n"
         "    goal: {lat_deg: 40.5, lon_deg: 5.5}\n    folder: sim01\n" +
         glider;
}

GliderSetup setup_of(const std::string& text) {
  const auto s = read_scenario(text, "/x/s.yaml");
  if (!s)
    for (const auto& e : s.error()) UNSCOPED_INFO(e.message());
  REQUIRE(s);
  return s->gliders.at(0).plan.setup;
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("what a scenario leaves out of the glider is the point model without faults") {
  const auto s = setup_of(scenario(""));
  CHECK_FALSE(s.hull.body);
  CHECK(s.hull.seabed.kind == SeabedSpec::Kind::none);
  CHECK(s.surfacing == SurfaceRules{});
  CHECK(s.aborts == AbortRules{});
  CHECK(s.gps == GpsSetup{});
  CHECK(s.wind == WindSetup{});
  CHECK(s.energy == EnergySpec{});
  CHECK(s.altimeter_silent == FaultPlan{});
}

TEST_CASE("every key of flight, behaviours and instruments reaches the glider in SI units") {
  const auto s = setup_of(scenario(
      "    vehicle: {motion: force_balance, believed_speed_m_per_s: 0.28, biofouling_percent_per_day: 1.5,\n"
      "      target_altitude_m: 20, altimeter_range_m: 60, speed_estimate: depth_rate, angle_error_deg: 2,\n"
      "      body: {volume_l: 60, pump_dive_cc: -230, pump_climb_cc: 240, pitch_dive_deg: 24, parasite_drag: 0.1}}\n"
      "    surfacing: {half_cycles: 6, every_h: 3, no_comms_h: 8, at_waypoint: true, heading_idle: resume}\n"
      "    aborts: {max_wpt_distance_m: 90000, overdepth_m: 205, fallback_calls: 4, fallback_every_min: 30}\n"
      "    gps: {noise_m: 4, far_off_m: 5000}\n"
      "    wind: {speed_m_per_s: 8, from_deg: 300, gusts_m_per_s: 2, lasting_h: 12, leeway_percent: 3}\n"
      "    energy: {pump_volume_cc: 450, pump_efficiency: 0.4, dive_w: 2, surface_w: 3, call_w: 7, battery_wh: 2500}\n"
      "    faults: {stale_fixes: {probability: 0.1}, invalid_fixes: {surfacings: [2]}, far_fixes: {surfacings: [3]},\n"
      "      silent_altimeter: {probability: 0.5}}\n",
      "seabed: {kind: plane, depth_m: 90, slope_percent: 1, deepens_toward_deg: 90, hump_m: 30, hump_radius_m: "
      "2000}\n"));
  REQUIRE(s.hull.body);
  CHECK(s.hull.body->volume_m3 == Approx(0.06).epsilon(1e-12));
  CHECK(s.hull.body->pump_dive_m3 == Approx(-230e-6).epsilon(1e-12));
  CHECK(s.hull.body->pump_climb_m3 == Approx(240e-6).epsilon(1e-12));
  CHECK(in_degrees(s.hull.body->pitch_dive) == Approx(24));
  CHECK(s.belief.speed.si() == 0.28);
  CHECK(s.hull.fouling_per_day == Approx(0.015));
  CHECK(s.hull.target_altitude.si() == 20);
  CHECK(s.hull.altimeter_range.si() == 60);
  CHECK(s.speed_by_depth_rate);
  CHECK(in_degrees(s.angle_error) == Approx(2));
  CHECK(s.surfacing == SurfaceRules{6, 10'800.0, 28'800.0, true, SurfaceRules::Idle::resume});
  CHECK(s.aborts == AbortRules{Metres{90'000}, Metres{205}, 4, 1800});
  CHECK(s.gps.noise.si() == 4);
  CHECK(s.gps.far_off.si() == 5000);
  CHECK(s.gps.stale.probability == 0.1);
  CHECK(s.gps.invalid.surfacings == std::vector<int>{2});
  CHECK(s.gps.far.surfacings == std::vector<int>{3});
  CHECK(s.altimeter_silent.probability == 0.5);
  CHECK(s.wind.speed.si() == 8);
  CHECK(s.wind.from.degrees() == Approx(300));
  CHECK(s.wind.lasting_s == 12 * 3600);
  CHECK(s.wind.leeway == Approx(0.03));
  CHECK(s.energy.pump_volume_m3 == Approx(450e-6).epsilon(1e-12));
  CHECK(s.energy.battery_wh == 2500);
  CHECK(s.hull.seabed.kind == SeabedSpec::Kind::plane);
  CHECK(s.hull.seabed.slope == Approx(0.01));
  CHECK(s.hull.seabed.origin == s.start);
}

TEST_CASE("a glider that learns its speed begins with that of its descent") {
  const auto s = setup_of(scenario("    vehicle: {motion: force_balance, speed_estimate: depth_rate}\n"));
  const auto down = steady_flight(Body{}, true, Metres{100});
  REQUIRE(down);
  CHECK(s.belief.speed == down->horizontal);
}

TEST_CASE("what contradicts itself is reported with its key") {
  CHECK(says(errors_of(scenario("    vehicle: {motion: force_balance}\n")), "believed_speed_m_per_s"));
  CHECK(says(errors_of(scenario("    vehicle: {motion: force_balance, horizontal_speed_m_per_s: 0.3, "
                                "believed_speed_m_per_s: 0.3}\n")),
             "given beside motion: force_balance"));
  CHECK(says(errors_of(scenario("    vehicle: {body: {volume_l: 60}}\n")), "not used by motion: point"));
  CHECK(says(errors_of(scenario("    vehicle: {motion: force_balance, believed_speed_m_per_s: 0.3, "
                                "body: {density_per_km: 100}}\n")),
             "floats while diving"));
  CHECK(says(errors_of(scenario("    energy: {volts_empty: 17}\n")), "not below volts_full"));
  CHECK(says(errors_of(scenario("    surfacing: {half_cycle: 3}\n")), "half_cycles"));
  CHECK(says(errors_of(scenario("    gps: {noise_m: -1}\n")), "0 to 1000"));
  CHECK(says(errors_of(scenario("", "seabed: {kind: flat}\n")), "plane"));
}

TEST_CASE("a fleet's gliders take the same keys, each over the same floor") {
  const auto s = read_scenario(
      "schema: glidehelm/scenario/v1\nstart: 2026-03-01T00:00:00Z\ntruth: {still: true}\n"
      "seabed: {kind: plane, origin: {lat_deg: 40, lon_deg: 5}}\n"
      "fleet:\n  count: 2\n  area: {west_deg: 4, east_deg: 6, south_deg: 39, north_deg: 41}\n  leg_km: 20\n"
      "  each: {gps: {noise_m: 3}, faults: {stale_fixes: {probability: 0.2}}}\n",
      "/x/s.yaml");
  REQUIRE(s);
  REQUIRE(s->gliders.size() == 2);
  for (const auto& g : s->gliders) {
    CHECK(g.plan.setup.gps.noise.si() == 3);
    CHECK(g.plan.setup.gps.stale.probability == 0.2);
    CHECK(g.plan.setup.hull.seabed.origin.lat.degrees() == Approx(40));
  }
}
