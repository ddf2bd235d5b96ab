#include <cmath>
#include <filesystem>

#include "tests/system/processes/sea.hpp"

using namespace glidehelm;
using namespace glidehelm::test;

namespace {

constexpr Place kFirst{41.4, 4.3}, kSecond{40.6, 5.3};

bool leads_to(const std::string& file, Place goal) {
  const auto points = waypoints_of(file);
  // A goto list counts in 1e-4 minutes (slocum.md 2.5): half of that is 8e-7 degrees.
  return !points.empty() && std::abs(points.back().lat_deg - goal.lat_deg) < 1e-6 &&
         std::abs(points.back().lon_deg - goal.lon_deg) < 1e-6;
}

/// A flight that stands still while the test changes files: without its simulator a daemon on a simulated clock has no time.
class HeldFlight {
 public:
  HeldFlight() : daemon_{sea.start_daemon()}, simulator_{sea.start_simulator()} {}

  /// Lets time go on until `count` surfacings are in the daemon's log, then holds it. Returns how many there are.
  int fly_until(int count) {
    simulator_->send(SIGCONT);
    REQUIRE(wait_until([&] { return heard() >= count || !daemon_->running(); }, kFlightLimit));
    simulator_->send(SIGSTOP);
    settle();
    REQUIRE(daemon_->running());
    return heard();
  }
  /// Sends SIGHUP and waits for the daemon's answer in the log.
  std::string reload() {
    const auto before = sea.daemon_log().size();
    daemon_->send(SIGHUP);
    REQUIRE(wait_until(
        [&] { return !lines_with(sea.daemon_log().substr(before), "reloaded|missions?/.*:|reload refused").empty(); },
        kStepLimit));
    settle();
    return sea.daemon_log().substr(before);
  }
  void fly_to_the_end() {
    simulator_->send(SIGCONT);
    REQUIRE(simulator_->wait(kFlightLimit).in_time);
    REQUIRE(daemon_->wait(kStepLimit).code == 0);
  }
  [[nodiscard]] int heard() const {
    return static_cast<int>(lines_with(sea.daemon_log(), " surfacing [0-9]+: ").size());
  }

  Sea sea{{kFirst, "surfacings: 16"}};

 private:
  /// The daemon ends what it has begun: its log stands still.
  void settle() const {
    auto size = sea.daemon_log().size();
    for (int calm = 0; calm < 4;) {
      std::this_thread::sleep_for(std::chrono::milliseconds{50});
      const auto now = sea.daemon_log().size();
      calm = now == size ? calm + 1 : 0;
      size = now;
    }
  }
  std::unique_ptr<Program> daemon_, simulator_;
};

}  // namespace

TEST_CASE(
    "SIGHUP: the next file leads to the new goal, a broken file changes nothing and is named by line and column") {
  HeldFlight flight;
  auto& sea = flight.sea;
  flight.fly_until(1);

  const auto unchanged = flight.reload();
  CAPTURE(unchanged);
  CHECK(lines_with(unchanged, "info  - +reloaded").size() == 1);
  CHECK(lines_with(unchanged, "mission leg: goal").empty());  // nothing new to say
  CHECK(lines_with(unchanged, "ALERT|PAGE").empty());

  const int before = flight.fly_until(3);
  sea.write_mission(kSecond);
  const auto changed = flight.reload();
  CAPTURE(changed);
  CHECK(lines_with(changed, "mission leg: goal 40\\.6000,5\\.3000.*in force at the next surfacing").size() == 1);
  CHECK(lines_with(changed, "reloaded").size() == 1);

  const int broken_after = flight.fly_until(before + 2);
  sea.write_mission(kFirst, "safety: {min_distanse_to_coast_m: 2000}\n");
  const auto broken = flight.reload();
  CAPTURE(broken);
  CHECK(lines_with(broken, "ALERT - +reload refused, nothing changed: 1 error").size() == 1);
  // The key stands in line 9, column 10 of what write_mission wrote.
  CHECK(lines_with(broken, "ALERT - +.*missions\\.d/leg\\.yaml:9:10: .*min_distanse_to_coast_m").size() == 1);

  flight.fly_to_the_end();
  INFO(sea.daemon_log() << sea.simulator_log());
  const auto files = sea.taken();
  REQUIRE(static_cast<int>(files.size()) == flight.heard());
  REQUIRE(static_cast<int>(files.size()) > broken_after);  // some files are from after the broken reload
  for (int i = 0; i < static_cast<int>(files.size()); ++i) {
    CAPTURE(i, before, files[static_cast<std::size_t>(i)]);
    CHECK(leads_to(files[static_cast<std::size_t>(i)], i < before ? kFirst : kSecond));
  }
}

TEST_CASE("SIGHUP brings a glider in and lets one go, all or nothing") {
  HeldFlight flight;
  auto& sea = flight.sea;
  flight.fly_until(1);
  const auto one = sea.folder.read("glidehelm.yaml");
  // The second glider's folder is made as glidersim makes one: with the marker beside to-glider.
  std::filesystem::create_directories(sea.path("run/sim02/to-glider"));
  sea.folder.write("run/sim02/.glidersim", "");
  const auto with_second = [&](int port, const std::string& folder) {
    return one + "  - {name: sim02, line: {listen: \"127.0.0.1:" + std::to_string(port) +
           "\"}, to_glider: " + sea.path(folder) + "}\n";
  };

  sea.folder.write("glidehelm.yaml", with_second(free_port(), "run/nowhere/to-glider"));
  const auto refused = flight.reload();
  CAPTURE(refused);
  CHECK(lines_with(refused, "ALERT sim02 +reload refused, nothing changed: to_glider .*nowhere").size() == 1);
  CHECK(lines_with(refused, "info  - +reloaded").empty());

  sea.folder.write("glidehelm.yaml", with_second(free_port(), "run/sim02/to-glider"));
  const auto added = flight.reload();
  CAPTURE(added);
  CHECK(lines_with(added, "note  sim02 +no mission names this glider").size() == 1);
  CHECK(lines_with(added, "info  - +reloaded").size() == 1);

  sea.folder.write("glidehelm.yaml", one);
  CHECK(lines_with(flight.reload(), "info  - +reloaded").size() == 1);
  // Gone means gone: its folder's lock is free for another process, here the same one again.
  sea.folder.write("glidehelm.yaml", with_second(free_port(), "run/sim02/to-glider"));
  CHECK(lines_with(flight.reload(), "info  - +reloaded").size() == 1);

  flight.fly_to_the_end();
  CHECK(sea.taken().size() == sea.surfacings().size());
}

TEST_CASE("a keep-out area that a reload moves is kept out of from the next surfacing on") {
  const auto area = [](double south, double north) {
    std::string text = "safety:\n  keep_out:\n    -";
    for (const Place corner : {Place{south, 4.2}, Place{south, 4.4}, Place{north, 4.4}, Place{north, 4.2}})
      text += std::string{text.back() == '-' ? " " : "      "} + "- {lat_deg: " + std::to_string(corner.lat_deg) +
              ", lon_deg: " + std::to_string(corner.lon_deg) + "}\n";
    return text;
  };
  HeldFlight flight;
  auto& sea = flight.sea;
  sea.write_mission(kFirst, area(43.0, 43.1));  // far behind the goal
  flight.fly_until(1);
  static_cast<void>(flight.reload());
  flight.fly_until(3);
  constexpr double kSouth = 40.85, kNorth = 40.95;  // across the straight way, 15 km ahead
  sea.write_mission(kFirst, area(kSouth, kNorth));
  CHECK(lines_with(flight.reload(), "reloaded").size() == 1);
  flight.fly_to_the_end();

  int beside = 0;
  for (const auto& line : sea.surfacings()) {
    const auto at = line.find(": fix ") + 6;
    const double lat = std::stod(line.substr(at)), lon = std::stod(line.substr(line.find(',', at) + 1));
    CAPTURE(line);
    CHECK_FALSE((lat > kSouth && lat < kNorth && lon > 4.2 && lon < 4.4));
    beside += lat > kSouth;
  }
  CHECK(beside > 0);
}
