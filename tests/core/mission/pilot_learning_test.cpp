#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/pilot_desk.hpp"

using namespace glidehelm;
using namespace glidehelm::mission;
using test::PilotDesk;

namespace {

/// Surfacings of a glider whose stints take `stint` and whose surface interval takes 20 min, with a measured current of
/// `east` m/s where the forecast says nothing. Ends with an open surfacing.
void fly(PilotDesk& desk, int surfacings, Seconds stint, double east = 0.1) {
  for (int k = 0; k < surfacings; ++k) {
    if (k > 0) {
      desk.wait(Seconds{1140 - 60});  // since the block, a minute after the fix, to a minute before the dive
      desk.step(DiveBegan{});
      desk.wait(Seconds{60} + stint + Seconds{120});
    }
    auto s = PilotDesk::at_surface(desk.heard(28.5 + 0.04 * k, -15.3), fmt::format("0007.{:04}", k + 3));
    s.water = model::LocalVelocity{MetresPerSecond{east + 1e-4 * k}, MetresPerSecond{0}};
    s.water_is_final = true;
    s.believed_speed = MetresPerSecond{0.3};
    desk.step(SurfacingHeard{s, std::nullopt, Current{}});
  }
}

const BeginPlanning& last_plan(const PilotDesk& desk) {
  static BeginPlanning found;
  for (const auto& effects : desk.effects)
    for (const auto& b : PilotDesk::all<BeginPlanning>(effects)) found = b;
  return found;
}

Mission in_true_frame() {
  auto m = PilotDesk::mission_to_goal();
  m.frame_rotation = Radians{0};
  return m;
}

}  // namespace

TEST_CASE("the plan uses the learned stint and surface interval, the dossier the same ones and the same correction") {
  PilotDesk desk{in_true_frame()};
  fly(desk, 6, Seconds{4.5 * 3600});
  const auto& request = last_plan(desk).request;
  CHECK(request.problem.schedule.stint.count() == Approx(4.5 * 3600).margin(2));
  CHECK(request.problem.schedule.first_stint == request.problem.schedule.stint);
  CHECK(request.problem.schedule.surface.count() == Approx(1200).margin(2));
  REQUIRE(request.correction);
  CHECK(request.correction->added.east.si() > 0.05);
  const auto verify = PilotDesk::all<Verify>(desk.step(CandidateFound{desk.candidate(request.id, 1, "direct")}));
  REQUIRE(verify.size() == 1);
  const auto& d = verify[0].dossier;
  CHECK(d.correction == request.correction);
  CHECK(d.schedule == request.problem.schedule);
  CHECK(d.glider == request.problem.glider);
}

TEST_CASE("what is heard after a plan began does not change what its verdict is asked for") {
  PilotDesk desk{in_true_frame()};
  fly(desk, 4, Seconds{4 * 3600.0});
  const auto request = last_plan(desk).request;
  auto again = PilotDesk::at_surface(desk.heard(28.5 + 0.04 * 3, -15.3), "0007.0006");
  again.believed_speed = MetresPerSecond{0.33};
  again.curr_time = std::get<SurfacingHeard>(desk.events.back().what).surfacing.curr_time;
  desk.step(SurfacingHeard{again, std::nullopt, Current{}});
  const auto verify = PilotDesk::all<Verify>(desk.step(CandidateFound{desk.candidate(request.id, 1, "direct")}));
  REQUIRE(verify.size() == 1);
  CHECK(verify[0].dossier.glider == request.problem.glider);
}

TEST_CASE("a longer stint makes the call expected later, so that nobody is called for a glider that is on time") {
  PilotDesk desk{in_true_frame()};
  fly(desk, 6, Seconds{6 * 3600.0});  // configured are 4 h
  desk.answer();
  CHECK(desk.pilot.learned().stint.count() == Approx(6 * 3600).margin(2));
  std::optional<Tick> note;
  for (const auto& effects : desk.effects)
    for (const auto& t : PilotDesk::all<SetTimer>(effects))
      if (t.timer == Timer::late_note) note = t.at;
  desk.step(EmissionEnded{EmissionEnded::Outcome::queued, desk.pilot.surfacing_key(), "queued"});
  for (const auto& t : desk.last<SetTimer>())
    if (t.timer == Timer::late_note) note = t.at;
  REQUIRE(note);
  // 10 % after 6 h 20 min, counted from a fix a minute ago.
  CHECK(Seconds{*note - desk.now.tick}.count() == Approx(1.1 * (6 * 3600 + 1200) - 60).margin(10));
}

TEST_CASE("the configured first stint is the first of the mission, not of every plan") {
  auto m = in_true_frame();
  m.first_stint = Seconds{3600};
  PilotDesk desk{m};
  fly(desk, 1, Seconds{3600});
  CHECK(last_plan(desk).request.problem.schedule.first_stint.count() == 3600);
  fly(desk, 1, Seconds{3600});
  desk.step(DiveBegan{});
  desk.wait(Seconds{4 * 3600.0});
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.55, -15.3), "0007.0009"), std::nullopt});
  CHECK(last_plan(desk).request.problem.schedule.first_stint == last_plan(desk).request.problem.schedule.stint);
}

TEST_CASE("a configured rotation that the Waypoint: lines contradict is told once") {
  PilotDesk desk{in_true_frame()};
  int told = 0;
  for (int k = 0; k < 6; ++k) {
    auto s = PilotDesk::at_surface(desk.heard(28.5 + 0.04 * k, -15.3), fmt::format("0007.{:04}", k));
    const auto at = geo_point(28.9, -15.1 - 0.01 * k);
    s.aim = model::AimLine{at, distance(s.fix, at), std::floor(geodesic(s.fix, at).departing.degrees() - 9.5)};
    desk.step(SurfacingHeard{s, std::nullopt});
    for (const auto& say : desk.last<Say>()) told += say.text.find("the configured value is used") != std::string::npos;
    desk.step(DiveBegan{});
    desk.wait(Seconds{4 * 3600.0});
  }
  CHECK(told == 1);
}

TEST_CASE("a frame of which nothing tells is said once, at the second surfacing, one that is configured is not") {
  const auto said = [](const PilotDesk& desk) {
    int count = 0;
    for (const auto& effects : desk.effects)
      for (const auto& say : PilotDesk::all<Say>(effects))
        count += say.code == "frame" && say.text.find("nothing tells how the glider's frame") == 0 ? 1 : 0;
    return count;
  };
  PilotDesk desk;
  fly(desk, 1, Seconds{4 * 3600.0});
  CHECK(said(desk) == 0);
  fly(desk, 4, Seconds{4 * 3600.0});
  CHECK(said(desk) == 1);
  PilotDesk told{in_true_frame()};
  fly(told, 4, Seconds{4 * 3600.0});
  CHECK(said(told) == 0);
}

TEST_CASE("a surfacing without a measured current says so, and what a glider that steers by one is aimed for") {
  for (const int correction : {1, 0}) {
    auto m = in_true_frame();
    m.current_correction = correction;
    PilotDesk desk{m};
    desk.surface_and_dive(28.5, -15.3, "0007.0003");
    desk.wait(Seconds{4 * 3600.0});
    desk.step(SurfacingHeard{desk.heard(28.54, -15.3), std::nullopt});
    const auto says = desk.last<Say>();
    const auto greeting = std::find_if(says.begin(), says.end(), [](const Say& s) { return s.code == "surfacing"; });
    REQUIRE(greeting != says.end());
    CHECK(greeting->text.find("no measured current in the dialog") != std::string::npos);
    CHECK((greeting->text.find("(aimed as for still water)") != std::string::npos) == (correction == 1));
  }
}
