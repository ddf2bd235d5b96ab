#include "daemon/session.hpp"

#include <spdlog/sinks/ostream_sink.h>

#include <catch2/catch.hpp>
#include <sstream>

#include "config/mission.hpp"
#include "daemon/event_json.hpp"
#include "tests/support/manual_world.hpp"
#include "tests/support/pilot_desk.hpp"

using namespace glidehelm;
using test::PilotDesk;

namespace {

constexpr const char* kFolder = "/dock/sim01/to-glider";
constexpr const char* kFile = "/dock/sim01/to-glider/goto_l10.ma";
constexpr const char* kMission =
    "schema: glidehelm/mission/v1\n"
    "name: leg-2\n"
    "glider: sim01\n"
    "glider_mission: glide.mi\n"
    "goal: {lat_deg: 29.1667, lon_deg: -15.5}\n"
    "currents: {analytic: {kind: constant, origin: {lat_deg: 28, lon_deg: -15}, length_scale_m: 1, "
    "speed_scale_m_per_s: 1, params: {u: 0, v: 0}}}\n"
    "approval: {mode: auto}\n";

/// A daemon's session of one glider that comes back with what a pilot's desk went through, in a world that the test moves.
struct Watch {
  test::ManualWorld world;
  std::ostringstream text;
  std::shared_ptr<spdlog::logger> sink{
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text))};
  daemon::Log log{sink, world.clock};
  std::unique_ptr<world::Folder> state;
  std::unique_ptr<daemon::Journal> journal;
  daemon::PlanningWorker worker;
  std::unique_ptr<daemon::Session> session;

  explicit Watch(PilotDesk& desk) {
    for (const char* folder : {"/dock", "/dock/sim01", kFolder, "/state", "/state/grids"})
      world.files.make_folder_at(folder);
    state = std::move(world.files.open_folder("/state")).value();
    journal =
        std::move(daemon::Journal::open(*state, world.clock.utc(), world.clock.tick(), {}, {1U << 20, 4096})).value();
    config::GliderEntry entry;
    entry.name = "sim01";
    entry.to_glider = kFolder;
    session = std::make_unique<daemon::Session>(
        entry, daemon::Desk{world.world(), log, *journal, worker, "/state/grids", [] {},
                            [](const std::string&, std::uint64_t) {}, [](const std::string& why) { FAIL(why); }});
    REQUIRE(session->open(10));
    const auto unreadable = [](const std::string& path) -> glidehelm::Expected<std::string, config::Unreadable> {
      return unexpected(config::Unreadable{path});
    };
    auto& chain = std::get<mission::MissionChanged>(desk.events.front().what).chain;
    chain = {{config::read_mission(kMission, "leg-2.yaml", unreadable).value(), kMission, "sha-1"}};
    std::vector<daemon::JournalRecord> past;
    for (const auto& event : desk.events) {
      daemon::JournalRecord record;
      record.type = daemon::RecordType::event;
      record.payload = daemon::event_json("sim01", event);
      past.push_back(std::move(record));
    }
    session->recover(past);
    world.net.settle();
  }

  [[nodiscard]] bool said(std::string_view words) {
    sink->flush();
    return text.str().find(words) != std::string::npos;
  }
  [[nodiscard]] std::size_t records() { return journal->all().value().size(); }
};

}  // namespace

TEST_CASE("a human's file in the place of ours is heard of within a second, also while the glider is under water") {
  PilotDesk desk;
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  Watch watch{desk};
  REQUIRE(watch.session->pilot().stage() == mission::Stage::dived);
  REQUIRE(watch.session->pilot().file().state() == mission::Delivery::queued);
  watch.world.files.put(kFile, "a pilot's own list");
  CHECK_FALSE(watch.said("standing down"));
  watch.world.pass(Seconds{1});
  CHECK(watch.said("standing down for this surfacing, somebody put another file in the place of ours: goto_l10.ma"));
  CHECK(watch.session->pilot().file().state() == mission::Delivery::overruled);
}

TEST_CASE("a human's file in an open window is heard of within a second, and another name is left alone") {
  PilotDesk desk;
  desk.step(mission::SurfacingHeard{PilotDesk::at_surface(desk.heard(28.5, -15.3)), std::nullopt});
  desk.answer("2 land");
  Watch watch{desk};
  REQUIRE(watch.session->pilot().stage() == mission::Stage::kept);
  watch.world.files.put(std::string{kFolder} + "/goto_l11.ma", "of another behaviour");
  watch.world.pass(Seconds{2});
  CHECK_FALSE(watch.said("standing down"));
  watch.world.files.put(std::string{kFolder} + "/GOTO_L10.MA", "DOS knows no case");
  watch.world.pass(Seconds{1});
  CHECK(watch.said("standing down"));
  CHECK(watch.session->pilot().stage() == mission::Stage::stood_down);
}

TEST_CASE("a file that was taken is said to be gone at the next look, and looking writes no journal") {
  PilotDesk desk;
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  Watch watch{desk};
  watch.world.pass(Seconds{1});
  CHECK(watch.said("goto_l10.ma is gone from to-glider"));
  CHECK(watch.session->pilot().file().state() == mission::Delivery::gone);
  CHECK_FALSE(watch.session->pilot().watches_folder());  // under water, and nothing of ours lies there
  const auto before = watch.records();
  watch.world.pass(Seconds{30});
  CHECK(watch.records() == before);
}
