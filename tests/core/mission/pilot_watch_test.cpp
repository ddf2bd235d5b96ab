#include <catch2/catch.hpp>

#include <map>

#include "tests/support/pilot_desk.hpp"

using namespace glidehelm;
using namespace glidehelm::mission;
using test::PilotDesk;

namespace {

const GeoPoint kAimedAt = geo_point(28.7, -15.2);

/// The timers that a late call would fire, as they were asked for last.
std::map<Timer, SetTimer> late_timers(const PilotDesk& desk) {
  std::map<Timer, SetTimer> timers;
  for (const auto& effects : desk.effects)
    for (const auto& effect : effects) {
      const auto* set = std::get_if<SetTimer>(&effect);
      if (set != nullptr && set->timer >= Timer::late_note) timers[set->timer] = *set;
      const auto* cancelled = std::get_if<CancelTimer>(&effect);
      if (cancelled != nullptr) timers.erase(cancelled->timer);
    }
  return timers;
}

/// Lets the timer fire at its time and returns what was said.
std::vector<Say> fire(PilotDesk& desk, const SetTimer& timer) {
  desk.wait(Seconds{timer.at - desk.now.tick});
  desk.step(TimerFired{timer.timer, timer.serial});
  return desk.last<Say>();
}

/// Hours from the last fix to a timer.
double hours_after_fix(const PilotDesk& desk, const SetTimer& timer) {
  const auto at = after(desk.now.utc, Seconds{timer.at - desk.now.tick});
  return between(desk.pilot.last()->fix_taken, at).count() / 3600;
}

bool heard(const std::vector<Say>& says, Level level, std::string_view code) {
  return std::any_of(says.begin(), says.end(), [&](const Say& s) { return s.level == level && s.code == code; });
}

mission::Mission with_stint(double stint_h) {
  auto m = PilotDesk::mission_to_goal();
  m.stint = m.first_stint = Seconds{stint_h * 3600};
  return m;
}

/// A surfacing whose emitted file promises the next one at `promised`, and the dive.
void promise(PilotDesk& desk, double lat, const std::string& segment, GeoPoint promised) {
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(lat, -15.3), segment), std::nullopt});
  const auto request = desk.last<BeginPlanning>().at(0).request;
  auto c = desk.candidate(request.id, 1, "direct");
  c.list.points = {{kAimedAt, model::WaypointRole::aim}, {geo_point(29.1667, -15.5), model::WaypointRole::goal}};
  c.promise.next_surfacing = promised;
  const auto verify = PilotDesk::all<Verify>(desk.step(CandidateFound{c}));
  desk.step(PlanningEnded{request.id, ""});
  desk.step(Judged{request.id, 1, test::verdict_on("goto_l10.ma", verify.at(0).dossier.file_bytes), ""});
  REQUIRE(desk.last<Emit>().size() == 1);
  desk.step(EmissionEnded{EmissionEnded::Outcome::queued, desk.pilot.surfacing_key(), "goto_l10.ma is queued"});
  desk.wait(Seconds{300});
  desk.step(DiveBegan{});
}

/// The file went to the glider, and the glider is where it was expected to be in time.
void picked_up_and_flown(PilotDesk& desk) {
  desk.step(FolderSeen{FolderSeen::Found::nothing, ""});
  desk.wait(Seconds{4 * 3600.0 + 900 - 300});
}

model::Surfacing steering_to(model::Surfacing s, GeoPoint aim) {
  s.aim = model::AimLine{aim, Metres{9000}, 20};
  return s;
}

}  // namespace

TEST_CASE("a call is noted at 10 %, alerted at the second miss and paged at 2.5 intervals, and an all-clear follows") {
  PilotDesk desk{with_stint(4)};
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  const auto timers = late_timers(desk);
  REQUIRE(timers.size() == 3);
  // One interval is 4 h of stint and 15 min of surface. 2.5 of them are 10.6 h, less than 14 h.
  const double interval = 4.25;
  CHECK(hours_after_fix(desk, timers.at(Timer::late_note)) == Approx(1.1 * interval).margin(0.001));
  CHECK(hours_after_fix(desk, timers.at(Timer::late_alert)) == Approx(2.1 * interval).margin(0.001));
  CHECK(hours_after_fix(desk, timers.at(Timer::late_page)) == Approx(2.5 * interval).margin(0.001));
  CHECK(heard(fire(desk, timers.at(Timer::late_note)), Level::note, "late"));
  CHECK(heard(fire(desk, timers.at(Timer::late_alert)), Level::alert, "late"));
  CHECK(heard(fire(desk, timers.at(Timer::late_page)), Level::page, "late"));
  desk.step(SurfacingHeard{desk.heard(28.53, -15.3), std::nullopt});
  CHECK(heard(desk.last<Say>(), Level::clear, "late"));
  desk.step(TimerFired{Timer::late_page, timers.at(Timer::late_page).serial});  // of before: nobody is called
  CHECK(desk.effects.back().empty());
}

TEST_CASE("after 14 h without a call somebody is paged, but never before the call is late at all") {
  struct Row {
    double stint_h, page_h;
  };
  // 8 h: 14 h is before 2.5 intervals. 24 h: at 14 h the glider is where it should be; the note comes at 26.675 h.
  const auto row = GENERATE(values<Row>({{4, 10.625}, {8, 14}, {24, 26.675 + 1.0 / 60}}));
  PilotDesk desk{with_stint(row.stint_h)};
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  const auto timers = late_timers(desk);
  CHECK(hours_after_fix(desk, timers.at(Timer::late_page)) == Approx(row.page_h).margin(0.001));
  CHECK(timers.at(Timer::late_note).at < timers.at(Timer::late_page).at);
}

TEST_CASE("a surfacing is watched from its first fix on, however it ends") {
  auto m = with_stint(4);
  SECTION("the line falls at once") {
    PilotDesk desk{m};
    desk.step(SurfacingHeard{desk.heard(28.5, -15.3), std::nullopt});
    CHECK(late_timers(desk).size() == 3);
  }
  SECTION("a proposal waits for a human when the line falls") {
    m.approval = Approval::manual;
    PilotDesk desk{m};
    desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
    desk.answer();
    REQUIRE(desk.pilot.stage() == Stage::proposed);
    const auto timers = late_timers(desk);
    REQUIRE(timers.size() == 3);
    CHECK(heard(fire(desk, timers.at(Timer::late_note)), Level::note, "late"));
  }
  SECTION("a human's file lies there") {
    PilotDesk desk{m};
    desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
    desk.step(FolderSeen{FolderSeen::Found::foreign, "goto_l10.ma of uid 1000"});
    REQUIRE(desk.pilot.stage() == Stage::stood_down);
    const auto timers = late_timers(desk);
    REQUIRE(timers.size() == 3);
    CHECK(heard(fire(desk, timers.at(Timer::late_note)), Level::note, "late"));
  }
}

TEST_CASE("a glider without a mission is not awaited: nobody said when it calls") {
  PilotDesk desk;
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  REQUIRE(late_timers(desk).size() == 3);
  desk.step(MissionChanged{{}, false, "reload"});
  desk.wait(Seconds{4 * 3600.0});
  desk.step(SurfacingHeard{desk.heard(28.53, -15.3), std::nullopt});
  CHECK(late_timers(desk).empty());
}

TEST_CASE("after a restart the call is awaited at the same time") {
  PilotDesk desk{with_stint(4)};
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  const auto before = hours_after_fix(desk, late_timers(desk).at(Timer::late_alert));
  desk.wait(Seconds{3600});
  desk.now.tick = Tick{std::chrono::seconds{7}};  // of another boot
  desk.step(Restarted{});
  const auto timers = late_timers(desk);
  CHECK(hours_after_fix(desk, timers.at(Timer::late_alert)) == Approx(before).margin(0.001));
  CHECK(heard(fire(desk, timers.at(Timer::late_note)), Level::note, "late"));
}

TEST_CASE("a glider far outside its ellipse raises an alert once its Waypoint: line proves that it flew our list") {
  PilotDesk desk{with_stint(4)};
  promise(desk, 28.5, "0007.0003", geo_point(28.54, -15.3));
  picked_up_and_flown(desk);
  // 0.1 m/s over 4 h are 1.4 km, the speed's spread adds less than 1 km: 20 km are far outside whatever was learned.
  const auto fix = desk.heard(28.54 + 20.0 / 111.0, -15.3);
  desk.step(SurfacingHeard{fix, std::nullopt});
  CHECK_FALSE(heard(desk.last<Say>(), Level::alert, "far-off"));  // whose list it flew is not known yet
  auto block = steering_to(PilotDesk::at_surface(fix, "0007.0004"), kAimedAt);
  SECTION("ours") {
    desk.step(SurfacingHeard{block, std::nullopt});
    CHECK(heard(desk.last<Say>(), Level::alert, "far-off"));
    desk.step(SurfacingHeard{block, std::nullopt});
    CHECK_FALSE(heard(desk.last<Say>(), Level::alert, "far-off"));  // once
  }
  SECTION("another one: it is where that list leads") {
    block.aim->at = geo_point(28.9, -15.9);
    desk.step(SurfacingHeard{block, std::nullopt});
    CHECK_FALSE(heard(desk.last<Say>(), Level::alert, "far-off"));
  }
}

TEST_CASE(
    "a far-off glider is told at its first fix when the re-read of our list was heard, and the all-clear follows") {
  PilotDesk desk{with_stint(4)};
  promise(desk, 28.5, "0007.0003", geo_point(28.54, -15.3));
  desk.step(FolderSeen{FolderSeen::Found::nothing, ""});
  desk.step(ListReread{});
  desk.wait(Seconds{4 * 3600.0 + 900 - 300});
  const double far = 28.54 + 20.0 / 111.0;
  const auto& says = PilotDesk::all<Say>(desk.step(SurfacingHeard{desk.heard(far, -15.3), std::nullopt}));
  CHECK(heard(says, Level::alert, "far-off"));
  desk.wait(Seconds{60});
  desk.step(DiveBegan{});
  desk.wait(Seconds{4 * 3600.0});
  // Nothing was promised at the far-off surfacing, so nothing can be cleared at the next.
  promise(desk, far + 0.03, "0007.0005", geo_point(far + 0.07, -15.3));
  bool cleared = false;
  for (const auto& effects : desk.effects)
    cleared = cleared || heard(PilotDesk::all<Say>(effects), Level::clear, "far-off");
  CHECK_FALSE(cleared);
  picked_up_and_flown(desk);
  desk.step(SurfacingHeard{desk.heard(far + 0.075, -15.3), std::nullopt});
  CHECK(heard(desk.last<Say>(), Level::clear, "far-off"));
}

TEST_CASE("a call that ended another dive than the one promised is not compared with it") {
  const double hours = GENERATE(1.0, 8.5);  // brought up early by an abort; a call was missed between
  PilotDesk desk{with_stint(4)};
  promise(desk, 28.5, "0007.0003", geo_point(28.54, -15.3));
  desk.step(FolderSeen{FolderSeen::Found::nothing, ""});
  desk.step(ListReread{});
  desk.wait(Seconds{hours * 3600});
  desk.step(SurfacingHeard{desk.heard(28.54 + 9.0 / 111.0, -15.3), std::nullopt});
  CHECK_FALSE(heard(desk.last<Say>(), Level::alert, "far-off"));
  for (const auto& say : desk.last<Say>()) CHECK(say.text.find("from where it was expected") == std::string::npos);
}

TEST_CASE("a file that did not go out promises nothing") {
  PilotDesk desk{with_stint(4)};
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3), "0007.0003", "OTHER.MI"), std::nullopt});
  desk.answer();
  desk.wait(Seconds{300});
  desk.step(DiveBegan{});
  REQUIRE(desk.pilot.stage() == Stage::dived);
  desk.wait(Seconds{4 * 3600.0});
  desk.step(SurfacingHeard{desk.heard(28.7, -15.3), std::nullopt});
  for (const auto& say : desk.last<Say>()) CHECK(say.text.find("from where it was expected") == std::string::npos);
}
