#pragma once

#include "config/yaml_reader/fields.hpp"
#include "simulator/scenario.hpp"

namespace glidehelm::simulator {

/// A scenario as it stands in its file: optional where the file may leave something out. scenario.cpp makes values of it.
struct CurrentDraft {
  std::optional<double> east, north;
};
struct PlaceDraft {
  std::optional<double> lat_deg, lon_deg;
};
struct GoalDraft : PlaceDraft {
  Metres radius{2000};
};
struct LineDraft {
  std::string connect, listen;
};
struct GliderDraft {
  std::string name, initial_list, folder;
  PlaceDraft start;
  GoalDraft goal;
  Metres initial_radius{500};
  LineDraft line;
  MetresPerSecond speed{0.3};
  std::optional<MetresPerSecond> believed_speed;
  Radians glide_angle{degrees(26)}, heading_bias{};
  Metres dive_depth{200}, climb_to{20};
  int correction{1};
  double stint_s{4 * 3600.0}, jitter{0}, cycle_s{4};
  SurfaceTimes times;
  std::optional<double> variation_deg, rotation_deg;
  CurrentDraft prior, leeway;
  std::string mission_file{"sim.mi"};
  int mission_number{1}, slot{10};
  CallSetup call;
  double clock_skew_s{0};
  FaultPlan lost_calls, not_taken, no_connection_block, redial;
  LineFaultPlan line_faults;
};
struct AnalyticDraft : ocean::AnalyticSpec {
  PlaceDraft origin_deg;
};
struct CoastalDraft {
  CoastalSpec spec;
  std::optional<std::uint64_t> seed;
  std::optional<double> west_deg, east_deg, south_deg, north_deg;
  PlaceDraft from, to;
  Variant variant{Variant::truth};
};
struct TruthDraft {
  std::string grid;
  std::vector<AnalyticDraft> analytic;
  CoastalDraft coastal;
  bool still{};
};
struct ScenarioDraft {
  std::uint64_t seed{1};
  std::optional<Instant> start;
  std::string coast, clock;
  bool charge_computing{};
  double daemon_wait_s{60};
  TruthDraft truth;
  EndPlan end;
  std::vector<GliderDraft> gliders;
};

// Keys of the line, in scenario_line_fields.cpp.
config::Fields<FaultPlan> fault_fields();
/// `faults`: what goes wrong with calls and their bytes.
config::Fields<GliderDraft> faults_fields();
/// `dialog`: which generation prints.
config::Fields<CallSetup> dialog_fields();

/// Every key of a scenario: name, meaning, range, default.
const config::Fields<ScenarioDraft>& scenario_fields();

}  // namespace glidehelm::simulator
