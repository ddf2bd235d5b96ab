#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/yaml_reader.hpp"
#include "core/base/expected.hpp"
#include "core/ocean/analytic.hpp"
#include "simulator/coastal.hpp"
#include "simulator/forecast_feed.hpp"
#include "simulator/ocean_error.hpp"
#include "simulator/simulation.hpp"

/// What glidersim is asked to play: one YAML file, `schema: glidehelm/scenario/v1`. Paths in it are meant from the folder
/// of the file. simulator/README.md lists every key.
namespace glidehelm::simulator {

inline constexpr const char* kScenarioSchema = "glidehelm/scenario/v1";

/// `truth.coastal`: the made-up sea of coastal.hpp; `from` and `to` default to the first glider's start and goal.
struct CoastalTruth {
  CoastalSpec spec;
  Variant variant{Variant::truth};
};

/// `truth`: exactly one of a grid file, analytic fields (added), a made-up sea, or still water; and how the water differs
/// from it.
struct TruthPlan {
  std::string grid;
  std::vector<ocean::AnalyticSpec> analytic;
  std::optional<CoastalTruth> coastal;
  bool still{};
  std::optional<OceanError> error;
};

/// Where a glider's dialog goes.
struct LineAddress {
  bool connect{true};  ///< we dial the daemon's `listen`; otherwise it dials us
  std::string host;
  std::uint16_t port{};
  friend bool operator==(const LineAddress&, const LineAddress&) = default;
};

struct ScenarioGlider {
  GliderPlan plan;           ///< setup.list is empty when initial_list names a file: glidersim reads it
  std::string initial_list;  ///< path; empty: one waypoint, the goal, with `initial_radius_m`
  std::string folder;        ///< of its dockserver: to-glider and archive are made inside
  LineAddress line;
};

struct Scenario {
  std::uint64_t seed{1};
  Instant start;
  std::string coast;         ///< path of a .coast file; empty: the truth's own land
  std::string clock;         ///< path of the Unix socket on which time is handed out
  bool charge_computing{};   ///< compute_time: measured
  double daemon_wait_s{60};  ///< how long a missing daemon is waited for
  TruthPlan truth;
  ForecastPlan forecasts;
  EndPlan end;
  std::vector<ScenarioGlider> gliders;  ///< those of `gliders`, then those of `fleet`
};

/// The scenario of a file's text, or every error in it. `seed`, when given, replaces the file's (and with it those of
/// gliders and made-up seas, which follow from it).
Expected<Scenario, std::vector<config::ConfigError>> read_scenario(std::string_view text, const std::string& file,
                                                                   std::optional<std::uint64_t> seed = std::nullopt);

/// The keys as a Markdown table, for simulator/README.md and its test.
std::string scenario_key_table();

}  // namespace glidehelm::simulator
