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
/// The glider's motion, behaviours and instruments beyond the older keys.
struct FlightDraft {
  bool force_balance{};
  Body body;
  double fouling_per_day{};
  Metres target_altitude{5}, altimeter_range{100};
  bool speed_by_depth_rate{};
  Radians angle_error{};
  SurfaceRules surfacing;
  AbortRules aborts;
  GpsSetup gps;
  WindSetup wind;
  Radians wind_from{};
  EnergySpec energy;
  FaultPlan altimeter_silent;
};
struct SeabedDraft {
  SeabedSpec::Kind kind{SeabedSpec::Kind::none};
  Metres depth{100}, hump_height{0}, hump_radius{5000};
  double slope{};
  Radians deepens{};
  PlaceDraft origin;
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
  FlightDraft flight;
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
struct ErrorDraft : OceanError {
  std::optional<std::uint64_t> own_seed;
};
struct ForecastDraft : ForecastPlan {
  std::optional<double> west_deg, east_deg, south_deg, north_deg;
  double step_deg{0.05};
};
struct FleetDraft {
  int count{};
  std::string name{"g"}, folder{"run"}, connect;
  std::optional<double> west_deg, east_deg, south_deg, north_deg;
  Metres leg{100e3}, goal_radius{2000};
  double spread_h{4};
  bool mixed_firmware{true};
  GliderDraft each;
};
struct TruthDraft {
  ErrorDraft error;
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
  ForecastDraft forecasts;
  EndPlan end;
  std::vector<GliderDraft> gliders;
  FleetDraft fleet;
  SeabedDraft seabed;
};

// Keys of the line, in scenario_line_fields.cpp.
config::Fields<FaultPlan> fault_fields();
/// `faults`: what goes wrong with calls and their bytes.
config::Fields<GliderDraft> faults_fields();
/// `dialog`: which generation prints.
config::Fields<CallSetup> dialog_fields();

// Keys of flight, behaviours and instruments, in scenario_glider_fields.cpp.
/// `vehicle`: what the force balance, growth, altimeter and the estimated speed add to it.
void add_vehicle_keys(config::Fields<GliderDraft>& f);
/// `surfacing`, `aborts`, `gps`, `wind`, `energy`.
void add_behaviour_keys(config::Fields<GliderDraft>& f);
/// Faults of the glider's own instruments, in `faults`.
void add_instrument_faults(config::Fields<GliderDraft>& f);
config::Fields<SeabedDraft> seabed_fields();
/// Complains about what contradicts itself.
void check_flight(const GliderDraft& g, const std::string& path, config::Reading& reading);
/// Fills what those keys decide.
void put_flight(const GliderDraft& d, GliderSetup& s);
SeabedSpec seabed_of(const SeabedDraft& d, GeoPoint otherwise);

// Keys of the ocean's error, of forecasts and of fleets, in scenario_fleet_fields.cpp.
config::Fields<ErrorDraft> ocean_error_fields();
config::Fields<ForecastDraft> forecast_fields();
config::Fields<FleetDraft> fleet_fields(const config::Fields<GliderDraft>& each);

/// Every key of a scenario: name, meaning, range, default.
const config::Fields<ScenarioDraft>& scenario_fields();

}  // namespace glidehelm::simulator
