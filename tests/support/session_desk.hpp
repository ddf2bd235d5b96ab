#pragma once

#include <spdlog/sinks/ostream_sink.h>

#include <catch2/catch.hpp>
#include <ctime>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "config/mission.hpp"
#include "daemon/event_json.hpp"
#include "daemon/session.hpp"
#include "daemon/verify/dossier_json.hpp"
#include "tests/support/manual_world.hpp"
#include "tests/support/verdict.hpp"

namespace glidehelm::test {

/// A daemon's session of one glider in a world that the test moves: the test is dockserver and verifier, and reads folder, log
/// and journal. Planning is the real one.
struct SessionDesk {
  static constexpr const char* kFolder = "/dock/sim01/to-glider";
  static constexpr const char* kFile = "/dock/sim01/to-glider/goto_l10.ma";
  static constexpr const char* kMission =
      "schema: glidehelm/mission/v1\n"
      "name: leg-2\n"
      "glider: sim01\n"
      "glider_mission: glide.mi\n"
      "goal: {lat_deg: 29.1667, lon_deg: -15.5}\n"
      "currents: {analytic: {kind: constant, origin: {lat_deg: 28, lon_deg: -15}, length_scale_m: 1, "
      "speed_scale_m_per_s: 1, params: {u: 0, v: 0}}}\n"
      "planning: {method: direct}\n"
      "approval: {mode: auto}\n";

  ManualWorld world;
  std::ostringstream text;
  std::shared_ptr<spdlog::logger> sink{
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text))};
  daemon::Log log{sink, world.clock};
  std::unique_ptr<world::Folder> state;
  std::unique_ptr<daemon::Journal> journal;
  std::unique_ptr<daemon::PlanningWorker> worker{std::make_unique<daemon::PlanningWorker>()};
  std::unique_ptr<daemon::Session> session;
  std::shared_ptr<world::Stream> line;  ///< the dockserver's end
  std::uint64_t handled{};              ///< bytes that the session said it has handled
  std::string ended;                    ///< why the line was closed by the session

  explicit SessionDesk(protocol::DialogWords words = {}) {
    for (const char* folder : {"/dock", "/dock/sim01", kFolder, "/state", "/state/grids"})
      world.files.make_folder_at(folder);
    sink->set_pattern("%v");
    world.procs.play("glidehelm-verify", [](const world::ProcessRequest& asked) {
      const auto request = verify::request_from_json(asked.input).value();
      const auto& d = request.dossier;
      return world::ProcessResult{world::ProcessResult::End::exited, 0,
                                  verify::to_json(verdict_on(d.file_name, d.file_bytes)), ""};
    });
    open(std::move(words));
  }
  ~SessionDesk() { session.reset(); }

  static mission::MissionText mission(const std::string& yaml = kMission) {
    const auto unreadable = [](const std::string& path) -> glidehelm::Expected<std::string, config::Unreadable> {
      return unexpected(config::Unreadable{path});
    };
    return {config::read_mission(yaml, "leg-2.yaml", unreadable).value(), yaml, "sha-1"};
  }

  /// A process begins: journal, folder and session; what the journal holds is not replayed yet.
  void open(protocol::DialogWords words = {}) {
    session.reset();
    journal.reset();
    state.reset();
    state = std::move(world.files.open_folder("/state")).value();
    journal =
        std::move(daemon::Journal::open(*state, world.clock.utc(), world.clock.tick(), {}, {1U << 20, 4096})).value();
    config::GliderEntry entry;
    entry.name = "sim01";
    entry.to_glider = kFolder;
    entry.line = config::Listen{config::Endpoint{"127.0.0.1", 6500}, {}};
    entry.dialog = std::move(words);
    session = std::make_unique<daemon::Session>(
        entry, daemon::Desk{world.world(), log, *journal, *worker, "/state/grids", [] {},
                            [this](const std::string&, std::uint64_t total) { handled = total; },
                            [](const std::string& why) { FAIL(why); }});
    REQUIRE(session->open(10));
  }
  /// The mission begins and the line is open.
  void fly() {
    session->fly({mission()}, "start");
    REQUIRE(session->start());
    dial();
  }
  void dial() {
    world.net.connect_tcp("127.0.0.1", 6500, [this](auto stream) {
      line = std::move(stream).value();
      line->start({[](std::string_view) {}, [this](std::string_view why) { ended = std::string{why}; }});
    });
    settle();
  }
  void hang_up() {
    line->close();
    settle();
  }
  /// What the dockserver pipes to us; returns when everything that follows from it at this instant has happened.
  void say(const std::string& dialog) {
    line->write(dialog);
    settle();
  }
  void settle() {
    world.net.settle();
    while (!session->quiet() && world.net.turn(std::chrono::seconds{60})) world.net.settle();
    REQUIRE(session->quiet());
  }
  void pass(Seconds dt) {
    world.pass(dt);
    settle();
  }

  /// `Curr Time` of a dialog, by our clock.
  [[nodiscard]] std::string curr_time() const {
    const std::time_t now = std::chrono::floor<std::chrono::seconds>(world.clock.utc().time_since_epoch()).count();
    char text_of_it[64];
    std::strftime(text_of_it, sizeof text_of_it, "Curr Time: %a %b %e %H:%M:%S %Y MT:    9000\r\n", std::gmtime(&now));
    return text_of_it;
  }
  /// A fix at whole thousandths of a minute of 28° N and 15° W, `age_s` old.
  [[nodiscard]] std::string fix(double minutes_north, double age_s) const {
    char line_of_it[128];
    std::snprintf(line_of_it, sizeof line_of_it, "%-13s %9.3f N %9.3f E measured %10.6g secs ago\r\n",
                  "GPS Location:", 2800 + minutes_north, -1518.0, age_s);
    return curr_time() + line_of_it;
  }
  [[nodiscard]] std::string connection_block(double minutes_north) const {
    return "Connection Event: Carrier Detect found.  9000    Iridium console active and ready...\r\n"
           "Vehicle Name: sim01\r\n" +
           fix(minutes_north, 48.25) + "  9000    No login script found for processing.\r\n";
  }
  /// `waypoint`: the whole line, or nothing.
  [[nodiscard]] std::string at_surface_block(double minutes_north, int segment,
                                             const std::string& waypoint = "") const {
    char name[96];
    std::snprintf(name, sizeof name, "MissionName:GLIDE.MI MissionNum:sim01-2026-122-4-%d (0112.%04d)\r\n", segment,
                  segment);
    return "\r\nGlider sim01 at surface.\r\n"
           "Because:pitch not commanded [behavior surface_4 start_when = 2.0]\r\n" +
           std::string{name} + "Vehicle Name: sim01\r\n" + fix(minutes_north, 48.25) + waypoint +
           "Time until diving is: 600 secs\r\n";
  }

  /// Lines of the log so far.
  [[nodiscard]] std::vector<std::string> lines() {
    sink->flush();
    std::vector<std::string> result;
    std::istringstream in{text.str()};
    for (std::string one; std::getline(in, one);) result.push_back(one);
    return result;
  }
  /// How many lines have these words.
  [[nodiscard]] int said(std::string_view words) {
    int count = 0;
    for (const auto& one : lines()) count += one.find(words) != std::string::npos ? 1 : 0;
    return count;
  }
  /// Records of one type whose payload has these words.
  [[nodiscard]] int recorded(daemon::RecordType type, std::string_view words) {
    int count = 0;
    const auto all = journal->all().value();
    for (const auto& record : all)
      count += record.type == type && record.payload.find(words) != std::string::npos ? 1 : 0;
    return count;
  }
  [[nodiscard]] std::size_t records() { return journal->all().value().size(); }
  [[nodiscard]] mission::Delivery delivery() const { return session->pilot().file().state(); }
};

}  // namespace glidehelm::test
