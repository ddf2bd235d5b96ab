#include "simulator/dockserver/report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/simulator/support.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using simulator::Glider;
using simulator::kDialogSensors;
using simulator::tell_only;

namespace {

simulator::GliderSetup setup() {
  simulator::GliderSetup s;
  s.start = geo_point(59.82, 23.3);
  s.start_s = 1.7e9;
  s.cycle_s = 60;
  s.list.waypoints = {geo_point(59.0, 23.3)};
  s.list.initial = 0;
  s.frame = simulator::LocalFrame::from_variation(degrees(-7.5), s.start);
  return s;
}

const simulator::SensorValue* find(const simulator::Report& r, const std::string& name) {
  for (const auto& s : r.sensors)
    if (s.name == name) return &s;
  return nullptr;
}

}  // namespace

TEST_CASE("before the first dive the current was never measured, and no line speaks of it") {
  Glider g{setup(), {kStill, kStill}, kOpen};
  REQUIRE_FALSE(g.take_fixes());
  const auto r = report_of(g, g.fix_s() + 45, 700);
  REQUIRE(find(r, "m_water_vx") != nullptr);
  CHECK_FALSE(find(r, "m_water_vx")->age_s);
  CHECK(find(r, "m_final_water_vx") == nullptr);
  CHECK_FALSE(r.water_measured);
}

TEST_CASE("a report has what a pilot needs: belief, variation, correction, waypoint, currents") {
  auto s = setup();
  s.belief = {MetresPerSecond{0.27}, 0};
  s.clock_skew_s = 100;
  Glider g{s, {kUniform, kUniform}, kOpen};
  REQUIRE_FALSE(g.take_fixes());
  REQUIRE_FALSE(g.dive(g.fix_s() + 900).accident);
  REQUIRE_FALSE(g.take_fixes());
  const auto r = report_of(g, g.fix_s() + 45, 700);
  CHECK(find(r, "m_avg_speed")->value == 0.27);
  CHECK(find(r, "u_use_current_correction")->value == 0);
  CHECK(find(r, "m_gps_mag_var")->value == Approx(degrees(-7.5).si()).epsilon(1e-12));
  CHECK(find(r, "c_wpt_lat")->value == 5900);
  CHECK(find(r, "m_final_water_vx") != nullptr);
  CHECK(r.gps_age_s == Approx(45));
  CHECK(r.clock_s == Approx(g.fix_s() + 145));
  CHECK(r.segment == 1);
  CHECK(
      std::is_sorted(r.sensors.begin(), r.sensors.end(), [](const auto& a, const auto& b) { return a.name < b.name; }));
}

TEST_CASE("a glider whose list has ended says that its heading is idle") {
  auto s = setup();
  s.list.waypoints = {destination(s.start, Bearing{}, Metres{400})};
  s.list.legs = -2;
  Glider g{s, {kStill, kStill}, kOpen};
  REQUIRE_FALSE(g.take_fixes());
  REQUIRE_FALSE(g.dive(g.fix_s() + 900).accident);
  const auto r = report_of(g, g.surfaced_s(), 0);
  CHECK(r.start_when == 3.0);
}

TEST_CASE("a dialog leaves out sensors and the waypoint, and tells a variation that is off") {
  Glider g{setup(), {kUniform, kUniform}, kOpen};
  REQUIRE_FALSE(g.take_fixes());
  REQUIRE_FALSE(g.dive(g.fix_s() + 900).accident);
  REQUIRE_FALSE(g.take_fixes());
  const auto all = report_of(g, g.fix_s() + 45, 700);
  auto some = all;
  tell_only({}, some);
  REQUIRE(some.sensors.size() == all.sensors.size());
  for (std::size_t i = 0; i < all.sensors.size(); ++i) {
    CHECK(some.sensors[i].name == kDialogSensors.at(i));
    CHECK(some.sensors[i].value == all.sensors[i].value);
  }
  CHECK(some.waypoint);
  tell_only({{"m_vacuum"}, degrees(6), false, false}, some);
  CHECK(find(some, "m_vacuum") == nullptr);
  CHECK(find(some, "m_gps_mag_var")->value == Approx(degrees(-1.5).si()).epsilon(1e-12));
  CHECK_FALSE(some.waypoint);
}

TEST_CASE("while the final current is awaited the initial one is printed for it") {
  Glider g{setup(), {kUniform, kUniform}, kOpen};
  REQUIRE_FALSE(g.take_fixes());
  REQUIRE_FALSE(g.dive(g.fix_s() + 900).accident);
  REQUIRE_FALSE(g.take_fixes());
  const auto all = report_of(g, g.fix_s() + 45, 700);
  REQUIRE(find(all, "m_water_vx")->value != find(all, "m_initial_water_vx")->value);
  auto r = all;
  tell_only({{}, {}, true, true}, r);
  CHECK_FALSE(r.water_final);
  CHECK(find(r, "m_water_vx")->value == find(all, "m_initial_water_vx")->value);
  CHECK(find(r, "m_water_vy")->value == find(all, "m_initial_water_vy")->value);
  CHECK(find(r, "m_final_water_vx") == nullptr);
  const auto block = simulator::dialog::at_surface_block(r);
  CHECK(block.find("Water Velocity Calculations waiting for final gps fix(ideally -57 secs)") != std::string::npos);
}
