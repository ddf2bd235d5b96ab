#include "simulator/dockserver/call.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "protocol/dialog.hpp"
#include "tests/simulator/support.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using simulator::Call;
using simulator::CallFaults;
using simulator::CallSetup;
using simulator::Glider;
using simulator::LineEvent;
using simulator::MemoryToGlider;

namespace {

const chart::Chart kOpen;

std::string list_text(const std::string& waypoint) {
  return "behavior_name=goto_list\n<start:b_arg>\nb_arg: num_legs_to_run(nodim) -1\nb_arg: list_when_wpt_dist(m) 300\n"
         "b_arg: initial_wpt(enum) 0\n<end:b_arg>\n<start:waypoints>\n" +
         waypoint + "\n<end:waypoints>\n";
}

/// A glider on the surface after one dive, and everything one call needs.
struct Scene {
  Scene() {
    simulator::GliderSetup s;
    s.start = geo_point(40.0, 5.0);
    s.start_s = 1.7e9;
    s.cycle_s = 60;
    s.list.waypoints = {geo_point(41, 5)};
    s.list.radius = Metres{200};
    s.list.initial = 0;
    s.frame.rotation = degrees(10);
    glider.emplace(s, ocean::Ocean{kUniform, kUniform}, kOpen);
    REQUIRE_FALSE(glider->take_fixes());
    REQUIRE_FALSE(glider->dive(glider->fix_s() + 900).accident);
    REQUIRE_FALSE(glider->take_fixes());
  }
  /// The whole call: (seconds after the fix, event).
  std::vector<std::pair<double, LineEvent>> run(CallFaults faults = {}, const CallSetup& setup = {}) {
    call.emplace(setup, faults, *glider, folder, on_board);
    std::vector<std::pair<double, LineEvent>> events;
    while (const auto t = call->next_s()) {
      if (before) before(*t - glider->fix_s());
      for (auto& e : call->step()) events.emplace_back(*t - glider->fix_s(), std::move(e));
    }
    return events;
  }
  std::optional<Glider> glider;
  MemoryToGlider folder;
  std::string on_board;
  std::optional<Call> call;
  std::function<void(double)> before;
};

std::string text_of(const std::vector<std::pair<double, LineEvent>>& events) {
  std::string s;
  for (const auto& [t, e] : events) s += e.bytes;
  return s;
}

int count_of(const std::string& text, const std::string& what) {
  int n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

/// Seconds after the fix when a text first came; negative when it never did.
double time_of(const std::vector<std::pair<double, LineEvent>>& events, const std::string& what) {
  for (const auto& [t, e] : events)
    if (e.bytes.find(what) != std::string::npos) return t;
  return -1;
}

}  // namespace

TEST_CASE("a call prints the connection block, at-surface blocks every minute, and the resume") {
  Scene scene;
  const auto events = scene.run();
  const auto text = text_of(events);
  CHECK(count_of(text, "Connection Event: Carrier Detect found.") == 1);
  CHECK(count_of(text, "Iridium console active and ready...") == 1);
  // From 60 s to 838 s after the fix: 60, 120, …, 780 make 13 blocks; none falls into a transfer, for none happens.
  CHECK(count_of(text, "Glider sim01 at surface.") == 13);
  CHECK(count_of(text, "Water Velocity Calculations COMPLETE") == 13);
  CHECK(time_of(events, "Iridium console active") == Approx(45));
  CHECK(time_of(events, "RESUMING MISSION") == Approx(900 - 60 - 2));
  CHECK(scene.call->dive_s() == Approx(scene.glider->fix_s() + 900));
}

TEST_CASE("the window that the dialog prints ends when the glider resumes") {
  Scene scene;
  const auto events = scene.run();
  for (const auto& [t, e] : events) {
    const auto at = e.bytes.find("Time until diving is: ");
    if (at == std::string::npos) continue;
    CHECK(std::atoi(e.bytes.c_str() + at + 22) == static_cast<int>(std::floor(840 - t + 1e-6)));
  }
}

TEST_CASE("all prints of one call carry the same fix, whose age grows") {
  Scene scene;
  const auto text = text_of(scene.run());
  std::vector<std::string> places;
  std::vector<double> ages;
  for (auto at = text.find("GPS Location:"); at != std::string::npos; at = text.find("GPS Location:", at + 1)) {
    places.push_back(text.substr(at, 39));
    ages.push_back(std::atof(text.c_str() + at + 46));
  }
  REQUIRE(places.size() == 14);
  for (std::size_t i = 1; i < places.size(); ++i) {
    CHECK(places[i] == places[0]);
    CHECK(ages[i] > ages[i - 1]);
  }
  CHECK(ages[0] == Approx(45).margin(1e-3));
}

TEST_CASE("currents and bearings are printed in the rotated frame") {
  Scene scene;
  const auto text = text_of(scene.run());
  const auto number_after = [&](const std::string& what) {
    const auto at = text.find(what);
    REQUIRE(at != std::string::npos);
    return std::atof(text.c_str() + at + what.size());
  };
  const double vx = number_after("sensor:m_water_vx(m/s)="), vy = number_after("sensor:m_water_vy(m/s)=");
  const double s = std::sin(degrees(10).si()), c = std::cos(degrees(10).si());
  // The glider measures the uniform current to 1e-4 (behaviours_test), more coarsely with its 60 s cycle: 2e-3.
  CHECK(vx * c + vy * s == Approx(0.12).margin(2e-3));
  CHECK(-vx * s + vy * c == Approx(-0.10).margin(2e-3));
  const double truth = geodesic(scene.glider->fix(), geo_point(41, 5)).departing.degrees();
  CHECK(number_after("Bearing: ") == std::floor(std::fmod(truth - 10 + 360, 360)));
}

TEST_CASE("a file that lies in to-glider when the script runs is taken, archived and read at Ctrl-F") {
  Scene scene;
  scene.folder.offer("goto_l10.ma", list_text("0600.0000 4000.0000"));
  scene.folder.offer("yo20.ma", "behavior_name=yo\n");
  const auto events = scene.run();
  CHECK(time_of(events, "!dockzr *") == Approx(165));
  CHECK(time_of(events, "Starting zModem transfer of goto_l10.ma to/from sim01 size is ") == Approx(165));
  const double done = time_of(events, "zModem transfer DONE for file goto_l10.ma");
  CHECK(done > 205);
  CHECK(time_of(events, "MAFILES will be re-read") == Approx(done + 5));
  CHECK(scene.call->outcome().list.has_value());
  CHECK(scene.call->outcome().sent == std::vector<std::string>{"goto_l10.ma", "yo20.ma"});
  CHECK(scene.call->outcome().reread);
  CHECK(scene.call->outcome().note.empty());
  CHECK(scene.folder.empty());
  CHECK(scene.folder.archive().size() == 2);
  CHECK(scene.glider->navigator().waypoint() == geo_point(40, 6));
  // What the glider flies is printed by the blocks after the re-read.
  CHECK(text_of(events).rfind("Waypoint: (4000.0000,600.0000)") != std::string::npos);
}

TEST_CASE("a file that comes after the script waits for the next surfacing") {
  Scene scene;
  scene.before = [&](double t) {
    if (t > 166 && scene.folder.empty()) scene.folder.offer("goto_l10.ma", list_text("0600.0 4000.0"));
  };
  const auto events = scene.run();
  CHECK(text_of(events).find("not found>*<") != std::string::npos);
  CHECK_FALSE(scene.call->outcome().list);
  CHECK(scene.call->outcome().note == "to-glider was empty");
  CHECK_FALSE(scene.folder.empty());
}

TEST_CASE("Ctrl-F without a new file starts the old list again") {
  Scene scene;
  const double before = scene.glider->navigator().waypoint_since_s();
  scene.run();
  CHECK(scene.call->outcome().reread);
  CHECK(scene.glider->navigator().waypoint_since_s() > before);
  Scene other;
  CallSetup careful;
  careful.reread_always = false;
  CHECK(text_of(other.run({}, careful)).find("re-read\r\n") == std::string::npos);
  CHECK_FALSE(other.call->outcome().reread);
}

TEST_CASE("a goto list of another slot reaches the glider and changes nothing") {
  Scene scene;
  scene.folder.offer("goto_l11.ma", list_text("0600.0 4000.0"));
  scene.run();
  CHECK_FALSE(scene.call->outcome().list);
  CHECK(scene.call->outcome().note == "no goto_l10.ma in to-glider");
  CHECK(scene.glider->navigator().waypoint() == geo_point(41, 5));
}

TEST_CASE("a bad file after Ctrl-F ends the mission, loudly") {
  Scene scene;
  scene.folder.offer("goto_l10.ma", list_text("4000.0 0600.0 1.0"));
  const auto events = scene.run();
  REQUIRE(scene.call->outcome().error);
  CHECK(scene.call->outcome().error->reason == "text after a waypoint: 1.0");
  const auto text = text_of(events);
  CHECK(text.find("Mission completed: MS_ABORT_BEH_ERROR(6)") != std::string::npos);
  CHECK(text.find("RESUMING") == std::string::npos);
}

TEST_CASE("a lost call says nothing and takes nothing") {
  Scene scene;
  scene.folder.offer("goto_l10.ma", list_text("0600.0 4000.0"));
  CHECK(scene.run({.lost = true}).empty());
  CHECK_FALSE(scene.folder.empty());
  CHECK(scene.call->dive_s() == Approx(scene.glider->fix_s() + 900));
  CHECK(scene.call->outcome().note == "no call");
}

TEST_CASE("a script that does not run leaves files and list alone") {
  Scene scene;
  scene.folder.offer("goto_l10.ma", list_text("0600.0 4000.0"));
  const auto text = text_of(scene.run({.not_taken = true}));
  CHECK(text.find("dockzr") == std::string::npos);
  CHECK(text.find("will be re-read") == std::string::npos);
  CHECK_FALSE(scene.folder.empty());
}

TEST_CASE("a call whose first block is lost still reprints") {
  Scene scene;
  const auto text = text_of(scene.run({.no_connection_block = true}));
  CHECK(text.find("Iridium console active") == std::string::npos);
  CHECK(text.find("Glider sim01 at surface.") == 0);
}

TEST_CASE("a redial drops the link in mid-line and comes back with the same fix, the script starts anew") {
  Scene scene;
  scene.folder.offer("goto_l10.ma", list_text("0600.0 4000.0"));
  const auto events = scene.run({.redial = true});
  int drops = 0;
  for (std::size_t i = 0; i < events.size(); ++i)
    if (events[i].second.kind == LineEvent::Kind::dropped) {
      ++drops;
      CHECK(events[i - 1].second.bytes.back() != '\n');
      CHECK(events[i + 1].second.bytes.rfind("Connection Event", 0) == 0);
    }
  CHECK(drops == 1);
  CHECK(count_of(text_of(events), "Connection Event") == 2);
  CHECK(count_of(text_of(events), "!dockzr *") == 1);
  CHECK(time_of(events, "!dockzr *") == Approx(60 + 20 + 45 + 120));
  CHECK(scene.call->outcome().list);
}

TEST_CASE("with resume at once the dive comes as soon as the script is through") {
  Scene scene;
  CallSetup setup;
  setup.resume_at_once = true;
  scene.run({}, setup);
  // Call 45 + script 120 + keys 10 + resume 2 + post-fix wait 60.
  CHECK(scene.call->dive_s() - scene.glider->fix_s() == Approx(237));
}

TEST_CASE("a transfer that outlasts the window delivers nothing") {
  Scene scene;
  CallSetup slow;
  slow.bytes_per_s = 0.1;
  scene.folder.offer("goto_l10.ma", list_text("0600.0 4000.0"));
  scene.run({}, slow);
  CHECK_FALSE(scene.call->outcome().list);
  CHECK_FALSE(scene.folder.empty());
  CHECK(scene.call->outcome().note == "the window ended during the transfer");
}

namespace {

/// What the daemon's reader makes of a dialog.
struct Heard {
  std::vector<protocol::SurfaceBlock> blocks;
  std::vector<int> windows;
  std::vector<std::string> started, done, keys;
  int rereads{}, resumed{}, names{};
  protocol::DialogCounts counts;
};

Heard heard(const std::vector<std::pair<double, LineEvent>>& events) {
  protocol::DialogReader reader;
  Heard h;
  const auto take = [&](const std::vector<protocol::DialogEvent>& said) {
    for (const auto& e : said) {
      if (const auto* block = std::get_if<protocol::BlockRead>(&e)) h.blocks.push_back(block->block);
      if (const auto* window = std::get_if<protocol::WindowHeard>(&e)) h.windows.push_back(window->seconds);
      if (const auto* file = std::get_if<protocol::TransferStarted>(&e)) h.started.push_back(file->file);
      if (const auto* file = std::get_if<protocol::TransferDone>(&e)) h.done.push_back(file->file);
      if (const auto* key = std::get_if<protocol::KeyHeard>(&e)) h.keys.push_back(key->key);
      if (std::holds_alternative<protocol::MafilesReread>(e)) ++h.rereads;
      if (std::holds_alternative<protocol::MissionResumed>(e)) ++h.resumed;
      if (std::holds_alternative<protocol::NameHeard>(e)) ++h.names;
    }
  };
  for (const auto& [t, e] : events)
    take(e.kind == LineEvent::Kind::bytes ? reader.append(e.bytes, instant_at(1.7e9 + t))
                                          : reader.end(instant_at(1.7e9 + t)));
  take(reader.end(instant_at(1.8e9)));
  h.counts = reader.counts();
  return h;
}

}  // namespace

TEST_CASE("the daemon's reader hears in a call of each generation what the glider said") {
  for (const auto firmware : {simulator::Firmware::g1, simulator::Firmware::g2, simulator::Firmware::g3}) {
    Scene scene;
    CallSetup setup;
    setup.firmware = firmware;
    setup.aborts = 2;
    scene.folder.offer("goto_l10.ma", list_text("0600.0000 4000.0000"));
    CallFaults harmless;
    harmless.chatter = harmless.wrong_keys = harmless.science_files = true;
    harmless.how = 0.1;
    const auto events = scene.run(harmless, setup);
    const auto text = text_of(events);
    const auto h = heard(events);
    CHECK(h.counts.connections == 1);
    CHECK(h.counts.at_surface_blocks == static_cast<std::uint64_t>(count_of(text, "Glider sim01 at surface.\r\n")));
    CHECK(h.counts.gps_lines == static_cast<std::uint64_t>(count_of(text, "\r\nGPS Location:")));
    CHECK(h.counts.sensor_lines == static_cast<std::uint64_t>(count_of(text, "   sensor:")));
    CHECK(h.counts.damaged_lines == 0);
    CHECK(h.names == 1);
    CHECK(h.rereads == 1);
    CHECK(h.resumed == 1);
    CHECK(h.windows.size() == h.counts.at_surface_blocks);
    const bool g3 = firmware == simulator::Firmware::g3;
    CHECK(h.started == std::vector<std::string>{g3 ? "00010001.scd" : "00010001.sbd",
                                                g3 ? "00010001.tcd" : "00010001.tbd", "goto_l10.ma"});
    CHECK(h.done == h.started);
    REQUIRE(h.blocks.size() >= 2);
    const auto fix = scene.glider->fix();
    for (const auto& block : h.blocks) {
      const auto accepted = protocol::accept_fix(block, "sim01");
      REQUIRE(accepted);
      // 0.001 minute is 1.9 m; rounding errs by half of it in each direction.
      CHECK(distance(accepted->fix, fix).si() < 1.4);
      CHECK(accepted->water);
      if (!accepted->at_surface) continue;
      CHECK(accepted->water_is_final);
      CHECK(accepted->mission == "sim.mi");
      CHECK(accepted->segment == "0001.0001");
      REQUIRE(accepted->aim);
      REQUIRE(accepted->because);
      CHECK(accepted->because->text == "pitch not commanded");
    }
  }
}

TEST_CASE("a dockserver block in mid-line costs nothing when no byte is lost, and at most lines when some are") {
  simulator::LineNoise noise{{}, simulator::Random{5}};
  for (int i = 0; i < 40; ++i) {
    Scene scene;
    auto events = scene.run();
    const auto whole = heard(events);
    const bool lossily = i % 2 == 1;
    CallFaults faults;
    (lossily ? faults.injected_lossily : faults.injected) = true;
    for (auto& [t, e] : events) e.bytes = noise.spoil(e.bytes, faults);
    const auto torn = heard(events);
    CAPTURE(i);
    if (!lossily) {
      CHECK(torn.counts.gps_lines == whole.counts.gps_lines);
      CHECK(torn.counts.at_surface_blocks == whole.counts.at_surface_blocks);
    }
    CHECK(torn.counts.gps_lines <= whole.counts.gps_lines);
    for (const auto& block : torn.blocks) {
      const auto accepted = protocol::accept_fix(block, "sim01");
      if (accepted) CHECK(distance(accepted->fix, scene.glider->fix()).si() < 1.4);
    }
  }
}

TEST_CASE("a call that is cut ends in mid-line and the script goes no further") {
  for (const double at : {0.05, 0.3, 0.6, 0.95}) {
    Scene scene;
    scene.folder.offer("goto_l10.ma", list_text("0600.0 4000.0"));
    CallFaults faults;
    faults.cut = true;
    faults.at = at;
    faults.how = 0.37;
    const auto events = scene.run(faults);
    REQUIRE_FALSE(events.empty());
    CHECK(events.back().second.kind == LineEvent::Kind::dropped);
    CHECK(events.back().first == Approx(45 + at * 240));
    CHECK(text_of(events).find("RESUMING") == std::string::npos);
    CHECK(scene.call->dive_s() == Approx(scene.glider->fix_s() + 900));
    CHECK(scene.call->outcome().list.has_value() == scene.folder.empty());
  }
}

TEST_CASE("half open the link falls unnoticed, and the new connection says what a redial says") {
  Scene scene, other;
  CallFaults half;
  half.half_open = true;
  const auto events = scene.run(half), redial = other.run({.redial = true});
  REQUIRE(events.size() == redial.size());
  int abandoned = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    CHECK(events[i].second.bytes == redial[i].second.bytes);
    if (events[i].second.kind == LineEvent::Kind::abandoned) ++abandoned;
  }
  CHECK(abandoned == 1);
}

TEST_CASE("a glider that hangs up calls again five minutes later with the fix that it had") {
  Scene scene;
  CallFaults faults;
  faults.call_back = true;
  const auto events = scene.run(faults);
  const auto text = text_of(events);
  CHECK(text.find("! succeeded:callback 5") != std::string::npos);
  CHECK(count_of(text, "Connection Event") == 2);
  const auto h = heard(events);
  CHECK(h.counts.connections == 2);
  for (std::size_t i = 1; i < h.blocks.size(); ++i) CHECK(h.blocks[i].gps->lat_text == h.blocks[0].gps->lat_text);
}

TEST_CASE("a late script picks the file up late or not at all") {
  for (const double how : {0.0, 0.5, 0.99}) {
    Scene scene;
    scene.folder.offer("goto_l10.ma", list_text("0600.0 4000.0"));
    CallFaults faults;
    faults.late_script = true;
    faults.how = how;
    const auto events = scene.run(faults);
    const double at = 165 + 60 + how * 600;
    CAPTURE(how);
    if (at + 60 < 838) {
      CHECK(time_of(events, "!dockzr *") == Approx(at));
      CHECK(scene.folder.empty());
    } else {
      CHECK_FALSE(scene.folder.empty());
      CHECK_FALSE(scene.call->outcome().list);
      CHECK_FALSE(scene.call->outcome().note.empty());
    }
  }
}

TEST_CASE(
    "a torn transfer leaves the first part on the glider and the whole file in the folder until the script is there "
    "again") {
  const auto list = list_text("0600.0000 4000.0000");
  for (const bool calls_again : {true, false}) {
    Scene scene;
    scene.folder.offer("goto_l10.ma", list);
    CallFaults faults;
    faults.transfer_cut = true;
    faults.at = 0.5;
    faults.how = calls_again ? 0.2 : 0.9;
    std::string part;
    scene.before = [&](double t) {
      if (t > 190 && part.empty()) part = scene.on_board;
    };
    const auto events = scene.run(faults);
    CHECK(scene.call->outcome().partial);
    if (calls_again) {
      CHECK(part == list.substr(0, list.size() / 2));
      CHECK(scene.on_board == list);
      CHECK(scene.folder.empty());
      CHECK(count_of(text_of(events), "!dockzr *") == 2);
    } else {
      CHECK(scene.on_board == list.substr(0, list.size() / 2));
      CHECK_FALSE(scene.folder.empty());
      CHECK_FALSE(scene.call->outcome().list);
      CHECK_FALSE(scene.call->outcome().reread);
    }
  }
}

TEST_CASE("science files come as binary noise and lie in from-glider afterwards") {
  Scene scene;
  CallFaults faults;
  faults.science_files = true;
  const auto text = text_of(scene.run(faults));
  REQUIRE(scene.folder.from_glider().size() == 2);
  for (const auto& file : scene.folder.from_glider()) {
    CHECK(file.bytes.size() >= 300);
    CHECK(text.find(file.bytes) != std::string::npos);
    CHECK(text.find("zModem transfer DONE for file " + file.name) != std::string::npos);
  }
}
