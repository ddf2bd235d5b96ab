#include "core/mission/pilot.hpp"

#include <catch2/catch.hpp>

#include "tests/support/pilot_desk.hpp"

using namespace glidehelm;
using namespace glidehelm::mission;
using test::PilotDesk;

namespace {

bool said(const Effects& effects, std::string_view code) {
  for (const auto& say : PilotDesk::all<Say>(effects))
    if (say.code == code) return true;
  return false;
}

model::Surfacing printed_again(const PilotDesk& desk, model::Surfacing s, int seconds_later) {
  s.heard = desk.now.utc;
  s.fix_age += Seconds{static_cast<double>(seconds_later)};
  s.curr_time += std::chrono::seconds{seconds_later};
  return s;
}

}  // namespace

TEST_CASE("a fix of the connection block starts planning, the at-surface block lets the file out") {
  PilotDesk desk;
  const auto s = desk.heard(28.5, -15.3);
  desk.step(SurfacingHeard{s, std::nullopt});
  REQUIRE(desk.last<BeginPlanning>().size() == 1);
  CHECK(desk.last<BeginPlanning>()[0].request.problem.start.fix == s.fix);
  CHECK(desk.last<Say>()[0].text.find("surfacing 1: fix 28.5000,-15.3000") == 0);
  desk.answer();
  CHECK(desk.last<Emit>().empty());
  CHECK(desk.pilot.stage() == Stage::planning);

  desk.wait(Seconds{15});
  desk.step(SurfacingHeard{PilotDesk::at_surface(printed_again(desk, s, 15)), std::nullopt});
  REQUIRE(desk.last<Emit>().size() == 1);
  CHECK(desk.last<Emit>()[0].file.bytes() == "bytes of 1 1");
  CHECK_FALSE(desk.last<Emit>()[0].replaces);
  desk.step(EmissionEnded{EmissionEnded::Outcome::queued, desk.pilot.surfacing_key(), "goto_l10.ma is queued"});
  CHECK(desk.pilot.stage() == Stage::queued);
}

TEST_CASE("the same fix printed again, or after a call-back, never makes a second file") {
  PilotDesk desk;
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  const auto first = std::get<SurfacingHeard>(desk.events[1].what).surfacing;
  for (int later : {300, 600, 900}) {
    desk.wait(Seconds{300});
    desk.step(SurfacingHeard{PilotDesk::at_surface(printed_again(desk, first, later)), std::nullopt});
    CHECK(desk.last<BeginPlanning>().empty());
    CHECK(desk.last<Emit>().empty());
  }
  CHECK(desk.pilot.surfacings() == 1);
}

TEST_CASE("emit_on: connection lets the file out without the at-surface block") {
  auto m = PilotDesk::mission_to_goal();
  m.emit_on_connection = true;
  PilotDesk desk{m};
  desk.step(SurfacingHeard{desk.heard(28.5, -15.3), std::nullopt});
  desk.answer();
  CHECK(desk.last<Emit>().size() == 1);
}

TEST_CASE("another mission than the configured one keeps the file back and says which runs") {
  PilotDesk desk;
  const auto s = desk.heard(28.5, -15.3);
  desk.step(SurfacingHeard{PilotDesk::at_surface(s, "0007.0003", "lastgasp.mi"), std::nullopt});
  desk.answer();
  CHECK(desk.last<Emit>().empty());
  desk.wait(Seconds{210});  // 235 s until diving, less than 30 s are left
  const auto timers = PilotDesk::all<SetTimer>(desk.effects[1]);
  std::uint64_t serial = 0;
  for (const auto& t : timers)
    if (t.timer == Timer::deadline) serial = t.serial;
  desk.step(TimerFired{Timer::deadline, serial});
  CHECK(desk.pilot.stage() == Stage::kept);
  CHECK(desk.last<Say>()[0].text.find("lastgasp.mi") != std::string::npos);
}

TEST_CASE("manual approval proposes and emits nothing") {
  auto m = PilotDesk::mission_to_goal();
  m.approval = Approval::manual;
  PilotDesk desk{m};
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  for (const auto& effects : desk.effects) CHECK(PilotDesk::all<Emit>(effects).empty());
  bool proposed = false;
  for (const auto& effects : desk.effects) proposed = proposed || said(effects, "proposed");
  CHECK(proposed);
}

TEST_CASE("auto-if-safe emits, but only proposes when there was an alert") {
  for (const bool alert : {false, true}) {
    auto m = PilotDesk::mission_to_goal();
    m.approval = Approval::auto_if_safe;
    PilotDesk desk{m};
    desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
    const auto id = desk.last<BeginPlanning>()[0].request.id;
    if (alert) desk.step(FolderSeen{FolderSeen::Found::unreadable, "EIO"});
    const auto verify = PilotDesk::all<Verify>(desk.step(CandidateFound{desk.candidate(id, 1, "direct")}));
    desk.step(PlanningEnded{id, ""});
    desk.step(Judged{id, 1, test::verdict_on("goto_l10.ma", verify[0].dossier.file_bytes), ""});
    CHECK(desk.last<Emit>().size() == (alert ? 0 : 1));
    CHECK(said(desk.effects.back(), "proposed") == alert);
  }
}

TEST_CASE("a refused fix is said once, however often it is printed") {
  PilotDesk desk;
  const model::Refusal refusal{
      "S3", "the fix is 1500 s old; allowed is 1200 s", "sim01", desk.now.utc, "2830.000", "-1518.000"};
  desk.step(FixRefused{refusal});
  CHECK(desk.last<Say>().size() == 1);
  desk.step(FixRefused{refusal});
  CHECK(desk.last<Say>().empty());
  CHECK(desk.last<Record>().size() == 1);
}

TEST_CASE("a refused file is not emitted, when nothing is left the reason is said") {
  PilotDesk desk;
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
  desk.answer("2 land");
  CHECK(desk.pilot.stage() == Stage::kept);
  CHECK(said(desk.effects.back(), "refused-file"));
  CHECK(said(desk.effects.back(), "no-plan"));
  for (const auto& effects : desk.effects) CHECK(PilotDesk::all<Emit>(effects).empty());
}

TEST_CASE("the better candidate wins, and the earlier one when the better is refused") {
  for (const bool better_passes : {true, false}) {
    PilotDesk desk;
    desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
    const auto id = desk.last<BeginPlanning>()[0].request.id;
    auto verify = PilotDesk::all<Verify>(desk.step(CandidateFound{desk.candidate(id, 1, "direct")}));
    REQUIRE(verify.size() == 1);
    desk.step(CandidateFound{desk.candidate(id, 2, "cts-astar")});
    CHECK(desk.last<Verify>().empty());  // one verdict at a time
    desk.step(PlanningEnded{id, ""});
    desk.step(Judged{id, 1, test::verdict_on("goto_l10.ma", verify[0].dossier.file_bytes), ""});
    verify = desk.last<Verify>();
    REQUIRE(verify.size() == 1);
    CHECK(desk.last<Emit>().empty());
    desk.step(Judged{id, 2,
                     test::verdict_on("goto_l10.ma", verify[0].dossier.file_bytes, better_passes ? "" : "2 land"), ""});
    REQUIRE(desk.last<Emit>().size() == 1);
    CHECK(desk.last<Emit>()[0].file.bytes() == (better_passes ? "bytes of 1 2" : "bytes of 1 1"));
  }
}

TEST_CASE("a verdict about other bytes is no proof") {
  PilotDesk desk;
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
  const auto id = desk.last<BeginPlanning>()[0].request.id;
  desk.step(CandidateFound{desk.candidate(id, 1, "direct")});
  desk.step(PlanningEnded{id, ""});
  desk.step(Judged{id, 1, test::verdict_on("goto_l10.ma", "other bytes"), ""});
  CHECK(desk.last<Emit>().empty());
  CHECK(desk.pilot.stage() == Stage::kept);
}

TEST_CASE("when the budget is over the best proven plan goes out, though the planner still works") {
  PilotDesk desk;
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
  const auto id = desk.last<BeginPlanning>()[0].request.id;
  std::uint64_t serial = 0;
  for (const auto& t : desk.last<SetTimer>())
    if (t.timer == Timer::budget) {
      serial = t.serial;
      CHECK(t.at == desk.now.tick + std::chrono::seconds{20});
    }
  const auto verify = PilotDesk::all<Verify>(desk.step(CandidateFound{desk.candidate(id, 1, "direct")}));
  desk.step(Judged{id, 1, test::verdict_on("goto_l10.ma", verify[0].dossier.file_bytes), ""});
  CHECK(desk.last<Emit>().empty());
  desk.wait(Seconds{20});
  desk.step(TimerFired{Timer::budget, serial - 1});
  CHECK(desk.last<Emit>().empty());  // an old timer is ignored
  desk.step(TimerFired{Timer::budget, serial});
  CHECK(desk.last<Emit>().size() == 1);
}

TEST_CASE("a human's file makes the pilot stand down for this surfacing and no longer") {
  PilotDesk desk;
  const auto s = PilotDesk::at_surface(desk.heard(28.5, -15.3));
  desk.step(SurfacingHeard{s, std::nullopt});
  desk.step(FolderSeen{FolderSeen::Found::foreign, "goto_l10.ma of uid 1000, written 09:58"});
  CHECK(desk.pilot.stage() == Stage::stood_down);
  CHECK(said(desk.effects.back(), "foreign-file"));
  CHECK(desk.last<StopPlanning>().size() == 1);
  desk.wait(Seconds{200});
  desk.step(DiveBegan{});
  desk.wait(Seconds{4 * 3600});
  desk.surface_and_dive(28.53, -15.3, "0007.0004");
  bool emitted = false;
  for (const auto& effects : desk.effects) emitted = emitted || !PilotDesk::all<Emit>(effects).empty();
  CHECK(emitted);
}

TEST_CASE("a jump farther than physics allows waits for a second fix that agrees") {
  PilotDesk desk;
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  desk.wait(Seconds{4 * 3600});
  desk.step(SurfacingHeard{desk.heard(33.5, -15.3), std::nullopt});
  CHECK(desk.last<BeginPlanning>().empty());
  REQUIRE(desk.last<Say>().size() == 1);
  CHECK(desk.last<Say>()[0].text.find("S5") != std::string::npos);
  desk.wait(Seconds{90});
  desk.step(SurfacingHeard{desk.heard(33.5001, -15.3001, 30), std::nullopt});
  CHECK(desk.last<BeginPlanning>().size() == 1);
}

TEST_CASE("fixes that are old, of another glider or far inside the land are refused with their rule") {
  PilotDesk desk;
  auto other = desk.heard(28.5, -15.3);
  other.glider = "sim02";
  desk.step(SurfacingHeard{other, std::nullopt});
  CHECK(desk.last<Say>()[0].text.find("S2") != std::string::npos);
  desk.step(SurfacingHeard{desk.heard(28.5, -15.3), Metres{-800}});
  CHECK(desk.last<Say>()[0].text.find("0.8 km inside the coastline") != std::string::npos);
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  desk.wait(Seconds{60});
  desk.step(SurfacingHeard{desk.heard(28.51, -15.31, 500), std::nullopt});  // from before the dive
  CHECK(desk.last<BeginPlanning>().empty());
  CHECK(desk.last<Say>()[0].text.find("S6") != std::string::npos);
}

TEST_CASE("a clock that differs by more than five minutes: planned, held, said, clock_skew_ok accepts it") {
  for (const bool ok : {false, true}) {
    PilotDesk desk;
    desk.step(MissionChanged{{{PilotDesk::mission_to_goal(), "yaml", "sha-2"}}, ok, "start"});
    desk.surface_and_dive(28.4, -15.3, "0007.0002");
    desk.wait(Seconds{4 * 3600});
    auto s = PilotDesk::at_surface(desk.heard(28.5, -15.3));
    s.curr_time += std::chrono::seconds{2904};
    desk.step(SurfacingHeard{s, std::nullopt});
    CHECK(desk.last<BeginPlanning>().size() == 1);
    CHECK(said(desk.effects.back(), "clock") == !ok);
    desk.answer();
    CHECK(desk.last<Emit>().size() == (ok ? 1 : 0));
  }
}

TEST_CASE("a new mission is in force at the next surfacing, not before") {
  PilotDesk desk;
  auto moved = PilotDesk::mission_to_goal();
  moved.goal = geo_point(29.5, -16);
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
  desk.step(MissionChanged{{{moved, "yaml 2", "sha-2"}}, false, "SIGHUP"});
  CHECK(desk.pilot.mission()->goal == PilotDesk::mission_to_goal().goal);
  desk.wait(Seconds{300});
  desk.step(DiveBegan{});
  desk.wait(Seconds{4 * 3600});
  desk.step(SurfacingHeard{desk.heard(28.53, -15.3), std::nullopt});
  const auto goal = std::get<planning::PointGoal>(desk.last<BeginPlanning>()[0].request.problem.goal);
  CHECK(goal.at == moved.goal);
}

TEST_CASE("inside the goal radius the mission has arrived and asks for the station list") {
  PilotDesk desk;
  desk.step(SurfacingHeard{desk.heard(29.16, -15.5), std::nullopt});
  CHECK(desk.pilot.arrived());
  CHECK(said(desk.effects.back(), "arrived"));
  CHECK(desk.last<BeginPlanning>()[0].request.purpose == PlanningRequest::Purpose::station);
}

TEST_CASE("at the goal the mission that follows takes over at once") {
  PilotDesk desk;
  auto onward = PilotDesk::mission_to_goal();
  onward.name = "leg-3";
  onward.goal = geo_point(29.9, -15.9);
  desk.step(
      MissionChanged{{{PilotDesk::mission_to_goal(), "yaml", "sha-1"}, {onward, "yaml 3", "sha-3"}}, false, "start"});
  desk.step(SurfacingHeard{desk.heard(29.16, -15.5), std::nullopt});
  CHECK(said(desk.effects.back(), "arrived"));
  CHECK_FALSE(desk.pilot.arrived());
  const auto request = desk.last<BeginPlanning>()[0].request;
  CHECK(request.purpose == PlanningRequest::Purpose::goal);
  CHECK(std::get<planning::PointGoal>(request.problem.goal).at == onward.goal);
}

TEST_CASE("a glider that drifted more than a kilometre while our file is queued gets a newly proven one") {
  PilotDesk desk;
  auto m = PilotDesk::mission_to_goal();
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
  desk.answer();
  desk.step(EmissionEnded{EmissionEnded::Outcome::queued, desk.pilot.surfacing_key(), "queued"});
  const auto key = desk.pilot.surfacing_key();
  desk.wait(Seconds{120});
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.504, -15.3)), std::nullopt});  // 440 m
  CHECK(desk.last<BeginPlanning>().empty());
  desk.wait(Seconds{120});
  desk.step(
      SurfacingHeard{PilotDesk::at_surface(desk.heard(28.512, -15.3)), std::nullopt});  // 1.3 km from the plan's fix
  REQUIRE(desk.last<BeginPlanning>().size() == 1);
  desk.answer();
  REQUIRE(desk.last<Emit>().size() == 1);
  CHECK(desk.last<Emit>()[0].replaces);
  CHECK(desk.last<Emit>()[0].surfacing == key);
}

TEST_CASE("after a transfer began nothing is exchanged") {
  PilotDesk desk;
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
  desk.answer();
  desk.step(EmissionEnded{EmissionEnded::Outcome::queued, desk.pilot.surfacing_key(), "queued"});
  desk.step(TransferHeard{"goto_l10.ma", false});
  desk.wait(Seconds{120});
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.52, -15.3)), std::nullopt});
  CHECK(desk.last<BeginPlanning>().empty());
}

TEST_CASE("another measured current in the at-surface block makes a new plan before anything goes out") {
  PilotDesk desk;
  auto s = desk.heard(28.5, -15.3);
  s.water = model::LocalVelocity{MetresPerSecond{0.10}, MetresPerSecond{0}};
  s.magnetic_variation = Radians{0};
  desk.step(SurfacingHeard{s, std::nullopt});
  desk.wait(Seconds{10});
  auto final = PilotDesk::at_surface(printed_again(desk, s, 10));
  final.water = model::LocalVelocity{MetresPerSecond{0.25}, MetresPerSecond{0}};
  final.water_is_final = true;
  desk.step(SurfacingHeard{final, std::nullopt});
  REQUIRE(desk.last<BeginPlanning>().size() == 1);
  CHECK(desk.last<BeginPlanning>()[0].request.problem.believed_current->speed().si() == Approx(0.25));
  CHECK(desk.last<StopPlanning>().size() == 1);
}

TEST_CASE("after a restart inside the window the surfacing is planned again, and never emitted twice") {
  PilotDesk desk;
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
  SECTION("killed while planning: a new plan") {
    desk.wait(Seconds{5});
    desk.step(Restarted{});
    CHECK(desk.last<BeginPlanning>().size() == 1);
  }
  SECTION("killed after the file became visible: it counts") {
    desk.answer();
    desk.wait(Seconds{5});
    desk.step(Restarted{EmissionEnded{EmissionEnded::Outcome::queued, desk.pilot.surfacing_key(), "recovered"}});
    CHECK(desk.last<BeginPlanning>().empty());
    CHECK(desk.pilot.stage() == Stage::queued);
  }
  SECTION("killed before the file became visible: a new plan") {
    desk.answer();
    desk.wait(Seconds{5});
    desk.step(Restarted{EmissionEnded{EmissionEnded::Outcome::aborted, desk.pilot.surfacing_key(), "crash"}});
    CHECK(desk.last<BeginPlanning>().size() == 1);
  }
  SECTION("killed and started after the window: nothing") {
    desk.wait(Seconds{3600});
    desk.step(Restarted{});
    CHECK(desk.last<BeginPlanning>().empty());
    CHECK(desk.pilot.stage() == Stage::kept);
  }
}

TEST_CASE("the same events give the same effects again, over a whole mission") {
  PilotDesk desk;
  for (int i = 0; i < 30; ++i) {
    desk.surface_and_dive(28.4 + 0.02 * i, -15.3, "0007." + std::to_string(1000 + i));
    desk.wait(Seconds{4 * 3600});
  }
  CHECK(desk.pilot.surfacings() == 30);
  Pilot again{"sim01"};
  for (std::size_t i = 0; i < desk.events.size(); ++i) CHECK(again.step(desk.events[i]) == desk.effects[i]);
}
