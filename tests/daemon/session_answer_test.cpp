#include <catch2/catch.hpp>

#include "core/base/utc.hpp"
#include "protocol/goto_list.hpp"
#include "tests/support/forecast_shelf.hpp"
#include "tests/support/pilot_desk.hpp"
#include "tests/support/session_desk.hpp"

using namespace glidehelm;
using mission::Delivery;
using test::PilotDesk;
using test::SessionDesk;

namespace {

/// A session that comes back with what a pilot's desk went through.
struct Watch : SessionDesk {
  explicit Watch(PilotDesk& desk) {
    std::get<mission::MissionChanged>(desk.events.front().what).chain = {mission()};
    std::vector<daemon::JournalRecord> past;
    for (const auto& event : desk.events) {
      daemon::JournalRecord record;
      record.type = daemon::RecordType::event;
      record.payload = daemon::event_json("sim01", event);
      past.push_back(std::move(record));
    }
    session->recover(past);
    settle();
  }
};

constexpr const char* kToGlider = SessionDesk::kFolder;
constexpr const char* kFile = SessionDesk::kFile;

std::string sending() { return "Starting zModem transfer of goto_l10.ma to/from sim01 size is 812\r\n"; }

/// A surfacing up to the file in to-glider.
void surface(SessionDesk& desk, double minutes_north, int segment, const std::string& waypoint = "") {
  desk.say(desk.connection_block(minutes_north) + desk.at_surface_block(minutes_north, segment, waypoint));
}

/// The line in which a glider that took this file says what it steers to.
std::string waypoint_line(const std::string& file) {
  const auto list = protocol::read_goto_list(file).value();
  const auto ddmm = [](double degrees) { return std::trunc(degrees) * 100 + std::fmod(degrees, 1.0) * 60; };
  char text[128];
  std::snprintf(text, sizeof text, "Waypoint: (%.4f,%.4f) Range: 9000m, Bearing: 20deg, Age: 4:15h:m\r\n",
                ddmm(list.points.at(0).at.lat.degrees()), ddmm(list.points.at(0).at.lon.degrees()));
  return text;
}

}  // namespace

TEST_CASE("a human's file in the place of ours is heard of within a second, also while the glider is under water") {
  PilotDesk desk;
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  Watch watch{desk};
  REQUIRE(watch.session->pilot().stage() == mission::Stage::dived);
  REQUIRE(watch.session->pilot().file().state() == mission::Delivery::queued);
  watch.world.files.put(kFile, "a pilot's own list");
  CHECK(0 == watch.said("standing down"));
  watch.pass(Seconds{1});
  CHECK(watch.said("standing down for this surfacing, somebody put another file in the place of ours: goto_l10.ma"));
  CHECK(watch.session->pilot().file().state() == mission::Delivery::overruled);
}

TEST_CASE("a human's file in an open window is heard of within a second, and another name is left alone") {
  PilotDesk desk;
  desk.step(mission::SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
  desk.answer("2 land");
  Watch watch{desk};
  REQUIRE(watch.session->pilot().stage() == mission::Stage::kept);
  watch.world.files.put(std::string{kToGlider} + "/goto_l11.ma", "of another behaviour");
  watch.pass(Seconds{2});
  CHECK(0 == watch.said("standing down"));
  watch.world.files.put(std::string{kToGlider} + "/GOTO_L10.MA", "DOS knows no case");
  watch.pass(Seconds{1});
  CHECK(watch.said("standing down"));
  CHECK(watch.session->pilot().stage() == mission::Stage::stood_down);
}

TEST_CASE("a file that was taken is said to be gone at the next look, and looking writes no journal") {
  PilotDesk desk;
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  Watch watch{desk};
  watch.pass(Seconds{1});
  CHECK(watch.said("goto_l10.ma is gone from to-glider"));
  CHECK(watch.session->pilot().file().state() == mission::Delivery::gone);
  CHECK_FALSE(watch.session->pilot().watches_folder());  // under water, and nothing of ours lies there
  const auto before = watch.records();
  watch.pass(Seconds{30});
  CHECK(watch.records() == before);
}

TEST_CASE("however a look falls into the second, a human's file is heard of within one") {
  const double phase = GENERATE(0.0, 0.001, 0.4, 0.999);
  PilotDesk desk;
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  Watch watch{desk};
  watch.world.files.put(kFile, "not ours");
  watch.pass(Seconds{phase});
  const auto before = watch.world.clock.utc();
  watch.world.files.put(kFile, "a pilot's own list");
  watch.pass(Seconds{1});
  CHECK(watch.said("standing down for this surfacing") >= 1);
  CHECK(between(before, watch.world.clock.utc()) == Seconds{1});
}

TEST_CASE("bytes that a human changes in our own file are his: the daemon stands down within a second") {
  SessionDesk desk;
  desk.fly();
  surface(desk, 30, 3);
  REQUIRE(desk.delivery() == Delivery::queued);
  desk.world.files.put(kFile, *desk.world.files.get(kFile) + "# a comment\n");
  desk.pass(Seconds{1});
  CHECK(desk.delivery() == Delivery::overruled);
  CHECK(desk.said("standing down for this surfacing, somebody put another file in the place of ours") == 1);
  CHECK(desk.recorded(daemon::RecordType::keep, "foreign file") == 1);
}

TEST_CASE("folder and dialog take a file from queued to flying, through a transfer that fails") {
  SessionDesk desk;
  desk.fly();
  surface(desk, 30, 3);
  const auto file = desk.world.files.get(kFile);
  REQUIRE(file);
  CHECK(desk.delivery() == Delivery::queued);
  CHECK(desk.said("goto_l10.ma is queued") == 1);

  desk.say(sending());
  CHECK(desk.delivery() == Delivery::sending);
  CHECK(desk.said("the dockserver is sending goto_l10.ma") == 1);
  desk.say("zModem transfer FAILED for file goto_l10.ma\r\n");
  CHECK(desk.delivery() == Delivery::queued);
  CHECK(desk.said("ALERT sim01     the transfer of goto_l10.ma failed") == 1);
  CHECK(desk.recorded(daemon::RecordType::event, "transfer_failed") == 1);
  CHECK(desk.recorded(daemon::RecordType::emission, "the transfer of goto_l10.ma failed") == 1);

  desk.say(sending());
  CHECK(desk.delivery() == Delivery::sending);
  desk.say("zModem transfer DONE for file goto_l10.ma\r\n");
  desk.world.files.take(kFile);
  desk.pass(Seconds{1});
  CHECK(desk.delivery() == Delivery::gone);
  CHECK(desk.said("goto_l10.ma went to the glider") == 1);
  desk.say("^F  9124    behavior surface_4: MAFILES will be re-read\r\n");
  CHECK(desk.delivery() == Delivery::reread);
  CHECK(desk.said("the glider reads its lists again, goto_l10.ma with them") == 1);

  desk.say("RESUMING MISSION\r\n");
  CHECK(desk.session->pilot().stage() == mission::Stage::dived);
  desk.hang_up();
  desk.pass(Seconds{4 * 3600.0});
  CHECK(desk.delivery() == Delivery::reread);
  desk.dial();
  surface(desk, 32, 4, waypoint_line(*file));
  CHECK(desk.said("the glider flies our list: it steers to waypoint 1 of goto_l10.ma") == 1);
  CHECK(desk.said("ALERT") == 1);
}

TEST_CASE("a file whose transfer failed is judged again at the next surfacing and exchanged") {
  SessionDesk desk;
  desk.fly();
  surface(desk, 30, 3);
  const auto first = desk.world.files.get(kFile);
  REQUIRE(first);
  desk.say(sending() + "zModem transfer FAILED for file goto_l10.ma\r\nRESUMING MISSION\r\n");
  desk.pass(Seconds{4 * 3600.0});
  REQUIRE(desk.delivery() == Delivery::queued);
  surface(desk, 32, 4);
  CHECK(desk.said("still lies in to-glider: it missed its call and is judged again") == 1);
  CHECK(desk.said("was exchanged for this one") == 1);
  REQUIRE(desk.world.files.get(kFile));
  CHECK(*desk.world.files.get(kFile) != *first);
}

TEST_CASE("a file that is gone after its transfer failed is not called picked up") {
  SessionDesk desk;
  desk.fly();
  surface(desk, 30, 3);
  desk.say(sending() + "zModem transfer FAILED for file goto_l10.ma\r\n");
  desk.world.files.take(kFile);
  desk.pass(Seconds{1});
  CHECK(desk.delivery() == Delivery::unknown);
  CHECK(desk.said("is gone from to-glider, and its transfer failed") == 1);
  CHECK(desk.said("picked up, most likely") == 0);
  desk.say("MAFILES will be re-read\r\n");
  CHECK(desk.said("ALERT sim01     the glider reads its lists again after a transfer that failed") == 1);
}

TEST_CASE("while a transfer is open nothing is made visible, and after it failed the next surfacing may") {
  SessionDesk desk;
  desk.fly();
  desk.say(desk.connection_block(30));
  desk.say(sending());  // of a list that lay there before ours was ready
  desk.say(desk.at_surface_block(30, 3));
  CHECK_FALSE(desk.world.files.get(kFile));
  desk.say("zModem transfer FAILED for file goto_l10.ma\r\nRESUMING MISSION\r\n");
  desk.pass(Seconds{4 * 3600.0});
  surface(desk, 32, 4);
  CHECK(desk.world.files.get(kFile));
}

TEST_CASE("a verifier that gives no verdict refuses the file, with what became of it") {
  using End = world::ProcessResult::End;
  struct Row {
    world::ProcessResult result;
    const char* said;
  };
  const auto row = GENERATE(values<Row>({
      {{End::deadline, 9, "", ""}, "no verdict: glidehelm-verify took longer than 10 s"},
      {{End::not_started, 2, "", ""}, "no verdict: glidehelm-verify cannot be started"},
      {{End::signalled, 11, "", ""}, "no verdict: glidehelm-verify died of signal 11"},
      {{End::exited, 2, "", " no dossier \n"}, "no verdict: no dossier"},
      {{End::exited, 0, "{}", ""}, "no verdict: glidehelm-verify's answer cannot be read"},
  }));
  SessionDesk desk;
  desk.world.procs.script("glidehelm-verify", row.result);
  desk.fly();
  surface(desk, 30, 3);
  CHECK(desk.said(row.said) >= 1);
  CHECK_FALSE(desk.world.files.get(kFile));
  CHECK(desk.session->pilot().stage() == mission::Stage::kept);
}

TEST_CASE("a forecast in use is said to be old after 36 hours, and after 72 no plan is made on it") {
  SessionDesk desk;
  test::ForecastShelf shelf{desk.world};
  const double now = epoch_seconds(desk.world.clock.utc());
  shelf.publish("a.nc", {0.0, now, now, 200});
  std::string yaml = SessionDesk::kMission;
  const auto begin = yaml.find("currents:"), end = yaml.find('\n', begin);
  yaml.replace(begin, end - begin, "currents: {files: [/data/*.nc]}");
  desk.session->fly({SessionDesk::mission(yaml)}, "start");
  REQUIRE(desk.session->start());
  desk.settle();
  const auto surface = [&](int segment) {
    desk.dial();
    desk.say(desk.connection_block(0) + desk.at_surface_block(0, segment));
    desk.pass(Seconds{1200});
    desk.hang_up();
  };
  surface(0);
  CHECK(desk.said("the forecast is old") == 0);
  desk.pass(Seconds{40 * 3600.0});
  surface(1);
  CHECK(desk.said("the forecast is old: a.nc ") > 0);
  CHECK(desk.said("planned on are at most 72 h") == 0);
  desk.pass(Seconds{32 * 3600.0});
  surface(2);
  CHECK(desk.said("h old; planned on are at most 72 h") > 0);
}
