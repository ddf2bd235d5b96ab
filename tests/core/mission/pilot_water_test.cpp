#include <catch2/catch.hpp>

#include "tests/support/pilot_desk.hpp"

// The pilot of a body that is weighed in the forecast's water.

using namespace glidehelm;
using namespace glidehelm::mission;
using test::PilotDesk;

namespace {

const ForecastWater kWarm{{{Metres{0}, 26, 36}, {Metres{1000}, 6, 35}}, "temp and salt"};
const ForecastWater kCold{{{Metres{0}, 5, 33}, {Metres{1000}, 4, 35}}, "temp and salt, a day later"};

Mission with_body() {
  auto m = PilotDesk::mission_to_goal();
  m.frame_rotation = Radians{0};
  m.flight_model.emplace();
  return m;
}
Mission in(const ForecastWater& water) { return in_water(with_body(), water.layers).mission; }

int water_said(const Effects& effects, std::string_view words) {
  int count = 0;
  for (const auto& say : PilotDesk::all<Say>(effects)) count += say.text.find(words) != std::string::npos ? 1 : 0;
  return count;
}

}  // namespace

TEST_CASE("a forecast that is read while a plan waits for it gives the plan its water's speed and angle") {
  PilotDesk desk{with_body()};
  CHECK(desk.pilot.mission()->horizontal_speed == in({}).horizontal_speed);  // the climatological profile
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
  const auto first = desk.last<BeginPlanning>();
  REQUIRE(first.size() == 1);
  CHECK(first[0].request.problem.glider.horizontal_speed == in({}).horizontal_speed);
  desk.step(kWarm);
  CHECK(water_said(desk.effects.back(), "in the forecast's water (temp and salt)") == 1);
  const auto again = desk.last<BeginPlanning>();
  REQUIRE(again.size() == 1);
  CHECK(again[0].request.problem.glider.horizontal_speed == in(kWarm).horizontal_speed);
  CHECK(again[0].request.problem.glider.glide_angle == in(kWarm).glide_angle);
  REQUIRE(desk.last<StopPlanning>().size() == 1);
  CHECK(desk.last<StopPlanning>()[0].request == first[0].request.id);
  desk.step(kWarm);  // nothing new
  CHECK(desk.effects.back().empty());
}

TEST_CASE("a plan that has candidates keeps its vehicle, and the next surfacing has the new water's") {
  PilotDesk desk{with_body()};
  desk.step(kWarm);
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3), "0007.0003"), std::nullopt});
  const auto begun = desk.last<BeginPlanning>().front().request;
  desk.step(CandidateFound{desk.candidate(begun.id, 1, "direct")});
  desk.step(kCold);
  CHECK(desk.effects.back().empty());
  const auto verify = PilotDesk::all<Verify>(desk.step(CandidateFound{desk.candidate(begun.id, 2, "best")}));
  CHECK(desk.pilot.forecast_water() == kCold);
  CHECK(desk.pilot.mission()->horizontal_speed == in(kWarm).horizontal_speed);
  desk.step(DiveBegan{});
  desk.wait(Seconds{4 * 3600.0});
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.55, -15.3), "0007.0004"), std::nullopt});
  const auto next = desk.last<BeginPlanning>();
  REQUIRE(next.size() == 1);
  CHECK(next[0].request.problem.glider.glide_angle == in(kCold).glide_angle);
  CHECK(desk.pilot.mission()->horizontal_speed == in(kCold).horizontal_speed);
}

TEST_CASE("a forecast without water is said with its reason, and the climatological profile stays") {
  PilotDesk desk{with_body()};
  desk.step(ForecastWater{{}, "temp and salt are not used: they are of one depth only"});
  CHECK(water_said(desk.effects.back(),
                   "climatological profile, for want of the forecast's water (temp and salt are not used") == 1);
  CHECK(desk.pilot.mission()->horizontal_speed == in({}).horizontal_speed);
  CHECK(desk.last<BeginPlanning>().empty());
}

TEST_CASE("water in which the body does not fly is an alert, and the climatological profile is taken") {
  auto m = with_body();
  m.flight_model->hull.mass_kg =
      ocean::WaterColumn::climatological().density(Metres{100}) * m.flight_model->hull.volume_m3;
  PilotDesk desk{m};
  desk.step(ForecastWater{{{Metres{0}, 10, 0}, {Metres{300}, 8, 0}}, "a river"});
  REQUIRE_FALSE(desk.last<Say>().empty());
  CHECK(desk.last<Say>().front().level == Level::alert);
  CHECK(desk.last<Say>().front().text.find("does not fly in the forecast's water (a river)") != std::string::npos);
  CHECK(desk.pilot.mission()->horizontal_speed == in_water(m, {}).mission.horizontal_speed);
}

TEST_CASE("a mission that takes over flies in the water that is known, one with a configured speed does not") {
  PilotDesk desk{with_body()};
  desk.step(kWarm);
  auto deeper = with_body();
  deeper.dive_depth = Metres{500};
  desk.step(MissionChanged{{{deeper, "yaml 2", "sha-2"}}, false, "SIGHUP"});
  CHECK(*desk.pilot.mission() == in_water(deeper, kWarm.layers).mission);
  desk.step(MissionChanged{{{PilotDesk::mission_to_goal(), "yaml 3", "sha-3"}}, false, "SIGHUP"});
  CHECK(*desk.pilot.mission() == PilotDesk::mission_to_goal());
  desk.step(kCold);
  CHECK(desk.effects.back().empty());
  CHECK(*desk.pilot.mission() == PilotDesk::mission_to_goal());
}

TEST_CASE("events with water replay to the same effects") {
  PilotDesk desk{with_body()};
  desk.step(kWarm);
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  desk.step(kCold);
  desk.wait(Seconds{4 * 3600.0});
  desk.surface_and_dive(28.6, -15.3, "0007.0004");
  Pilot again{"sim01"};
  for (std::size_t k = 0; k < desk.events.size(); ++k) CHECK(again.step(desk.events[k]) == desk.effects[k]);
  CHECK(again.learned() == desk.pilot.learned());
}

TEST_CASE("what the glider has shown of its speed overrules the body in another water") {
  PilotDesk desk{with_body()};
  desk.step(kWarm);
  const double body = in(kWarm).horizontal_speed.si(), other = in(kCold).horizontal_speed.si();
  REQUIRE(std::abs(other - body) > 1e-4);
  // Dives on a turning way at 1.08 times the body's speed in still water, which the forecast says too: the displacement of each is what a glider of that
  // speed makes, and the measured current is none.
  GeoPoint at = geo_point(28.5, -15.3);
  for (int k = 0; k < 14; ++k) {
    auto s = PilotDesk::at_surface(desk.heard(at.lat.degrees(), at.lon.degrees()), fmt::format("0007.{:04}", k + 3));
    // No two alike to the bit: an equal one was not measured anew.
    s.water = model::LocalVelocity{MetresPerSecond{1e-5 * k}, MetresPerSecond{0}};
    s.water_is_final = true;
    s.believed_speed = MetresPerSecond{1.08 * body};
    desk.step(SurfacingHeard{s, std::nullopt, Current{}});
    desk.wait(Seconds{600});
    desk.step(DiveBegan{});
    desk.wait(Seconds{4 * 3600.0});
    at = destination(at, Bearing{degrees(75.0 * k)}, Metres{1.08 * body * (4 * 3600 - 60)});
  }
  const double shown = desk.pilot.learned().speed.si();
  CHECK(shown > body);
  const auto spread = desk.pilot.learned().speed_spread;
  desk.step(kCold);
  const double after = desk.pilot.learned().speed.si();
  // It moves with the body, by the part of the first guess that is left in it, less than half of the body's change.
  CHECK((after - shown) * (other - body) > 0);
  CHECK(std::abs(after - shown) < 0.5 * std::abs(other - body));
  CHECK(desk.pilot.learned().speed_spread == spread);  // nothing is forgotten
}
