#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "daemon/journal.hpp"
#include "daemon/world/real_files.hpp"
#include "tests/simulator/temp_folder.hpp"
#include "tests/support/processes.hpp"

// Whole programs: glidehelmd and glidersim on one simulated clock, in a folder of their own. GLIDEHELM_BIN is the folder of programs.

namespace glidehelm::test {

/// Long enough for a loaded machine and ThreadSanitizer: an idle one flies in two seconds.
inline constexpr std::chrono::seconds kFlightLimit{120}, kStepLimit{60};

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in{text};
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The lines in which `pattern` is found.
inline std::vector<std::string> lines_with(const std::string& text, const std::string& pattern) {
  std::vector<std::string> found;
  const std::regex wanted{pattern};
  for (const auto& line : lines_of(text))
    if (std::regex_search(line, wanted)) found.push_back(line);
  return found;
}

struct Place {
  double lat_deg{}, lon_deg{};
};

/// Waypoints of a goto list (slocum.md 2.5: longitude before latitude, DDMM.mmmm).
inline std::vector<Place> waypoints_of(const std::string& file) {
  const auto degrees = [](double ddmm) {
    const double whole = std::trunc(ddmm / 100);
    return whole + (ddmm - 100 * whole) / 60;
  };
  std::vector<Place> points;
  std::istringstream in{file.substr(file.find("<start:waypoints>") + 17)};
  for (double lon = 0, lat = 0; in >> lon >> lat;) points.push_back({degrees(lat), degrees(lon)});
  return points;
}

/// One glider, its dockserver, its daemon. The forecast is a constant current, the true ocean another one.
class Sea {
 public:
  struct Plan {
    Place goal{40.71, 4.37};  ///< 14 km from the start: five surfacings with the first and the last
    std::string end{"days: 5"};
  };

  explicit Sea(Plan plan) : plan_{std::move(plan)} {
    std::filesystem::create_directory(folder.path / "missions.d");
    write_mission(plan_.goal);
    std::ostringstream daemon, scenario;
    daemon << "schema: glidehelm/daemon/v1\n"
           << "clock: {simulated: " << path("run/clock.sock") << "}\n"
           << "state_dir: " << path("state") << "\n"
           << "control_socket: " << path("control.sock") << "\n"
           << "missions: [missions.d/*.yaml]\n"
           << "gliders:\n"
           << "  - {name: sim01, line: {listen: \"127.0.0.1:" << port
           << "\"}, to_glider: " << path("run/sim01/to-glider") << "}\n";
    folder.write("glidehelm.yaml", daemon.str());
    scenario << "schema: glidehelm/scenario/v1\n"
             << "seed: 7\n"
             << "start: 2026-03-01T00:00:00Z\n"
             << "clock: run/clock.sock\n"
             << "truth:\n"
             << "  analytic:\n"
             << "    - {kind: constant, origin: {lat_deg: 40.6, lon_deg: 4.3}, params: {u: 0.04, v: -0.03}}\n"
             << "end: {" << plan_.end << "}\n"
             << "gliders:\n"
             << "  - name: sim01\n"
             << "    start: {lat_deg: 40.6, lon_deg: 4.3}\n"
             << "    goal: {lat_deg: " << plan_.goal.lat_deg << ", lon_deg: " << plan_.goal.lon_deg
             << ", radius_m: 2000}\n"
             << "    folder: run/sim01\n"
             << "    line: {connect: \"127.0.0.1:" << port << "\"}\n";
    folder.write("scenario.yaml", scenario.str());
  }
  Sea() : Sea(Plan{}) {}

  /// `more`: further lines of the mission.
  void write_mission(Place goal, const std::string& more = "") const {
    std::ostringstream mission;
    mission << "schema: glidehelm/mission/v1\n"
            << "name: leg\n"
            << "glider: sim01\n"
            << "goal: {lat_deg: " << goal.lat_deg << ", lon_deg: " << goal.lon_deg << ", radius_m: 2000}\n"
            << "currents:\n"
            << "  - analytic: {kind: constant, origin: {lat_deg: 40.6, lon_deg: 4.3}, length_scale_m: 1, "
               "speed_scale_m_per_s: 1, params: {u: 0.05, v: -0.02}}\n"
            << "approval: {mode: auto}\n"
            << "vehicle: {horizontal_speed_m_per_s: 0.3}\n"
            << more;
    folder.write("missions.d/leg.yaml", mission.str());
  }

  /// `failpoint`: STEP or STEP@N at which the daemon kills itself; empty: never.
  std::unique_ptr<Program> start_daemon(const std::string& failpoint = "",
                                        const std::string& program = GLIDEHELM_BIN "/glidehelmd") const {
    Program::Order order{program, {"--config", path("glidehelm.yaml")}, path("daemon.log"), {}, false};
    if (!failpoint.empty()) order.environment.push_back("GLIDEHELM_FAILPOINT=" + failpoint);
    return std::make_unique<Program>(order);
  }
  [[nodiscard]] std::unique_ptr<Program> start_simulator() const {
    return std::make_unique<Program>(
        Program::Order{GLIDEHELM_BIN "/glidersim", {"run", path("scenario.yaml")}, path("sim.log"), {}, false});
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder.path / name).string(); }
  [[nodiscard]] std::string daemon_log() const { return folder.read("daemon.log"); }
  [[nodiscard]] std::string simulator_log() const { return folder.read("sim.log"); }
  /// What the glider surfaced for, as glidersim prints it.
  [[nodiscard]] std::vector<std::string> surfacings() const {
    return lines_with(simulator_log(), " surfacing [0-9]+: ");
  }
  /// The files that went to the glider, in order.
  [[nodiscard]] std::vector<std::string> taken() const {
    std::vector<std::string> names, files;
    for (const auto& entry : std::filesystem::directory_iterator{folder.path / "run/sim01/archive"})
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());  // they begin with the time
    for (const auto& name : names) files.push_back(folder.read("run/sim01/archive/" + name));
    return files;
  }
  /// The daemon's journal, when no daemon runs.
  [[nodiscard]] std::vector<daemon::JournalRecord> journal() const {
    world::RealFiles files;
    auto state = files.open_folder(path("state"));
    REQUIRE(state);
    auto journal = daemon::Journal::open(**state, {}, {});
    REQUIRE(journal);
    return (*journal)->past();
  }

  TempFolder folder;
  int port{free_port()};

 private:
  Plan plan_;
};

}  // namespace glidehelm::test
