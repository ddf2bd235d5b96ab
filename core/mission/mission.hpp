#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/geo.hpp"
#include "core/base/time.hpp"
#include "core/chart/chart.hpp"
#include "core/mission/ensemble.hpp"
#include "core/model/waypoint_list.hpp"
#include "core/ocean/analytic.hpp"
#include "core/ocean/time_axis.hpp"
#include "core/planning/guidance.hpp"
#include "core/planning/lattice_choice.hpp"
#include "core/planning/sector_grid.hpp"
#include "core/vehicle/force_balance.hpp"
#include "core/vehicle/yo_field.hpp"

/// What a pilot wants, and the machine that carries it out.
namespace glidehelm::mission {

/// `approval.mode`: who lets a file out.
enum class Approval { manual, auto_if_safe, automatic };

using ocean::AnalyticSpec;
using ocean::Interpolation;
using ocean::OutsideTime;

/// Files of currents and how they are read.
struct CurrentFiles {
  std::vector<std::string> files;  ///< shell patterns, addresses
  OutsideTime outside_time{OutsideTime::hold};
  Interpolation interpolation{Interpolation::linear};
  std::string east_variable, north_variable;  ///< empty: recognised
  std::optional<Instant> time_epoch;          ///< for files whose time axis has no units
  enum class Heights { when_needed, always, never };
  Heights heights{Heights::when_needed};  ///< heights: currents from the slope of the sea surface
  Radians equator_band{degrees(5)};       ///< equator_band_deg: latitude below which that slope says nothing
  std::optional<Metres> fill_gaps;        ///< fill_gaps_km; none: two cells of HF radar files
  std::string grid_file;                  ///< grid_file: positions, masks, angle and depth of a model; empty: none
  enum class Rotation { recognised, angle, grid, none };
  Rotation rotation{Rotation::recognised};  ///< rotation: how velocities along a model's axes become east and north
  /// s_levels: the stretching of ROMS levels that the files do not describe.
  struct SLevels {
    int vtransform{}, vstretching{};
    double theta_s{}, theta_b{};
    Metres critical_depth{};  ///< hc_m
    friend bool operator==(const SLevels&, const SLevels&) = default;
  };
  std::optional<SLevels> s_levels;
  double coastal_fill_cells{1.5};
  friend bool operator==(const CurrentFiles&, const CurrentFiles&) = default;
};

/// One of `currents.sources`.
struct CurrentSource : CurrentFiles {
  std::string name;
  std::vector<GeoPoint> region;  ///< corners; empty: everywhere
  std::optional<Seconds>
      from;                   ///< from_h: of the reference time (the first field where none is named); none: its begin
  std::optional<Seconds> to;  ///< to_h; none: its end
  friend bool operator==(const CurrentSource&, const CurrentSource&) = default;
};

/// `currents`: files, or sources in order of trust, and a sum of analytic fields.
struct Currents : CurrentFiles {
  std::vector<CurrentSource> sources;  ///< most trusted first; then `files` is empty
  Metres blend{20'000};                ///< blend_km
  Seconds join{6 * 3600.0};            ///< join_h
  std::vector<AnalyticSpec> analytic;
  bool local_correction{true};           ///< local_correction: measured currents correct the forecast near the glider
  Metres correction_length{30'000};      ///< correction_length_km: by exp(−d²/2L²) …
  Seconds correction_time{24 * 3600.0};  ///< correction_time_h: … and exp(−|t|/T)
  std::optional<Ensemble> ensemble;      ///< ensemble; `files` are then those of the control; none: one forecast
  /// There is something to read, not only formulas.
  [[nodiscard]] bool has_files() const { return !files.empty() || !sources.empty(); }
  friend bool operator==(const Currents&, const Currents&) = default;
};

/// One mission as its YAML file says it, defaults filled in (product.md 5). Units are in the types; keys in the comments.
struct Mission {
  std::string name;                   ///< name
  std::string glider;                 ///< glider, lower case
  std::string slocum_mission;         ///< glider_mission: the .mi file that must be running; empty: any
  GeoPoint goal;                      ///< goal.lat_deg, goal.lon_deg
  Metres goal_radius{2000};           ///< goal.radius_m
  std::optional<Instant> nearest_at;  ///< objective.min_distance_at; none: the earliest arrival
  std::optional<GeoPoint> start;      ///< start.lat_deg, start.lon_deg (plan and rehearse only)
  std::optional<Instant> start_time;  ///< start.time

  MetresPerSecond horizontal_speed{0.30};            ///< vehicle.horizontal_speed_m_per_s
  Radians glide_angle{degrees(26)};                  ///< vehicle.glide_angle_deg
  Metres dive_depth{200};                            ///< vehicle.dive_depth_m
  Metres climb_to{20};                               ///< vehicle.climb_to_m
  vehicle::MotionModel motion{};                     ///< vehicle.motion
  std::optional<vehicle::FlightModel> flight_model;  ///< vehicle.force_balance: then speed and angle are its means
  int current_correction{1};                         ///< vehicle.current_correction
  std::optional<Radians> frame_rotation;             ///< vehicle.local_frame_rotation_deg; none: learned, 0 until then

  Seconds stint{4 * 3600.0};        ///< schedule.stint_h, or from schedule.half_cycles
  Seconds first_stint{4 * 3600.0};  ///< schedule.first_stint_h
  Seconds surface{15 * 60.0};       ///< schedule.surface_min
  std::optional<int> half_cycles;   ///< schedule.half_cycles

  Currents currents;

  std::string method{"best"};      ///< planning.method
  int headings{18};                ///< planning.headings
  std::optional<Metres> cell;      ///< planning.cell_km; none: half a stint through still water
  Seconds budget{20};              ///< planning.budget_s
  std::optional<Seconds> horizon;  ///< planning.horizon_h; none: 3 × the still-water time
  planning::Heuristic heuristic{planning::Guidance{}.heuristic};  ///< planning.heuristic
  planning::Weighting weighting{planning::Guidance{}.weighting};  ///< planning.weighting
  double weight{planning::Guidance{}.weight};                     ///< planning.weight
  std::uint64_t seed{1};                                          ///< planning.seed
  planning::LatticeChoice lattice;                                ///< planning.astar
  planning::SectorGrid sector_grid;                               ///< planning.tve

  std::string coast_file;                 ///< safety.coast; empty: the model's mask, with a warning
  Metres min_distance_to_coast{2000};     ///< safety.min_distance_to_coast_m
  std::string bathymetry_file;            ///< safety.bathymetry; empty: depths of water are not judged
  std::optional<Metres> min_water_depth;  ///< safety.min_water_depth_m
  Metres depth_margin{20};                ///< safety.depth_margin_m: the glider turns this far above the bottom
  /// The shallowest water that a track may cross: the glider must be able to climb to `climb_to` and turn `depth_margin`
  /// above the bottom.
  [[nodiscard]] Metres least_depth() const { return min_water_depth.value_or(climb_to + depth_margin); }
  std::vector<chart::Area> keep_in, keep_out;  ///< safety.keep_in, safety.keep_out
  std::optional<Metres> max_wpt_distance;      ///< safety.max_wpt_distance_m: the abend limit of the glider's mission

  int slot{10};                             ///< list.slot: NN of goto_lNN.ma
  int max_waypoints{8};                     ///< list.max_waypoints
  std::optional<Metres> list_radius;        ///< list.radius_m; none: 10 % of the median leg
  model::AtEnd at_end{model::AtEnd::loop};  ///< list.at_end

  Seconds window_max{15 * 60.0};  ///< window.max_min
  Seconds dockzr_after{120};      ///< window.dockzr_after_s
  bool emit_on_connection{};      ///< window.emit_on: connection (true) or at_surface

  Approval approval{Approval::manual};  ///< approval.mode
  std::string after_goal;               ///< after_goal: "" stays at the goal, "next NAME" hands over

  friend bool operator==(const Mission&, const Mission&) = default;
};

}  // namespace glidehelm::mission
