#include "simulator/dockserver/call.hpp"

#include <catch2/catch.hpp>
#include <cmath>

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
