#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/current.hpp"
#include "core/base/geo.hpp"
#include "core/base/time.hpp"
#include "simulator/glider/dynamics.hpp"
#include "simulator/glider/energy.hpp"
#include "simulator/glider/frame.hpp"
#include "simulator/glider/navigation.hpp"
#include "simulator/glider/rules.hpp"
#include "simulator/glider/surroundings.hpp"
#include "simulator/random.hpp"

namespace glidehelm::simulator {

/// When things happen around one surfacing, in seconds. The interval that a pilot's schedule calls "surface" runs from
/// the last fix (the one that is printed) to the dive.
struct SurfaceTimes {
  double first_fix{25};  ///< from the surfacing
  double last_fix{60};   ///< from the surfacing; between the two fixes the glider measures its surface drift
  double surface{900};   ///< from the last fix to the dive
  double post_fix{60};   ///< from the end of the keystroke window to the dive (gps_postfix_wait_time)
  friend bool operator==(const SurfaceTimes&, const SurfaceTimes&) = default;
};

/// What a glider is and how its mission is set up.
struct GliderSetup {
  std::string name{"sim01"};
  std::string mission_file{"sim.mi"};
  int mission_number{1};  ///< MMMM of MMMM.SSSS
  int slot{10};           ///< args_from_file of its goto_list: NN of goto_lNN.ma
  GeoPoint start;
  double start_s{};  ///< epoch seconds: on the surface, ready to call
  Hull hull;
  Belief belief;
  std::optional<Current> prior_water;  ///< measured before the run; none: never measured
  LocalFrame frame;
  double stint_s{4 * 3600.0};
  double stint_jitter{};  ///< each stint is stint·(1 ± jitter), evenly spread
  double cycle_s{4};      ///< of navigation
  SurfaceTimes times;
  double clock_skew_s{};  ///< added to what the glider takes for UTC
  GotoList list;          ///< what it starts with
  std::uint64_t seed{1};
  SurfaceRules surfacing;
  AbortRules aborts;
  GpsSetup gps;
  WindSetup wind;
  EnergySpec energy;
  FaultPlan altimeter_silent;  ///< in the dive after a surfacing
  bool speed_by_depth_rate{};  ///< the glider learns its speed from depth rate and angle (slocum.md 4.1) …
  Radians angle_error{};       ///< … with an angle that is this much too steep
};

/// One dive, as it truly was.
struct DiveRecord {
  GeoPoint dive, surface;
  double dive_s{}, surface_s{};
  DiveTruth truth;
  Metres deepest;
  int hits{};  ///< waypoints hit in this dive
  int half_cycles{}, touched_floor{};
  Energy energy;    ///< of this dive and of the surface interval before it
  Because because;  ///< what brought it up
  std::optional<Accident> accident;
};

/// The glider's goto_list and surface behaviours: it dives for a stint, comes up, takes two fixes, measures the
/// current, waits for its window to end, and dives again.
///
/// The measured current follows slocum.md 4.3. With `used` the current that dead reckoning used, T the time of the dive
/// and x the reckoned end of it:
///
///   m_initial = used + (first fix − x)/T
///   m_final   = used + (surfacing − x)/T,  surfacing = first fix − drift velocity·(time from surfacing to first fix)
///
/// m_final is complete once the second fix has shown the drift velocity, both are clipped at 2.8 m/s a component. With
/// correction 0 the current is measured but not used.
///
/// Without a valid fix nothing is measured, the older fix stays, and dead reckoning goes on from where it was; T of the
/// next measurement is then the time of all dives since the last valid fix. After an
/// abort the glider stays on the surface in `lastgasp.mi`: `dive` then only drifts to the next call.
class Glider {
 public:
  Glider(GliderSetup setup, ocean::Ocean truth, const chart::Chart& chart);

  /// Dives at epoch second `at_s` after drifting there, and flies the whole stint. Afterwards the glider is at the
  /// surfacing: `surfaced_s()` tells when that is. An accident leaves it where it happened.
  DiveRecord dive(double at_s);
  /// Drifts to the two fixes and measures. Call once after each surfacing (and once at the start).
  std::optional<Accident> take_fixes();
  /// Ctrl-F: the list in hand is read, from its initial_wpt. An error ends the mission.
  Expected<Done, BehaviourError> read_list(std::string_view bytes, double now_s);
  /// Ctrl-F without a file on board: the list it started with begins again.
  void restart_list(double now_s);

  [[nodiscard]] const GliderSetup& setup() const { return setup_; }
  [[nodiscard]] const Navigator& navigator() const { return navigator_; }
  [[nodiscard]] double surfaced_s() const { return surfaced_s_; }
  [[nodiscard]] GeoPoint fix() const { return fix_; }
  [[nodiscard]] double fix_s() const { return fix_s_; }
  /// When the receiver was through, with or without a fix: calls and the surface interval count from here.
  [[nodiscard]] double fixes_done_s() const { return fixes_done_s_; }
  /// This surfacing's fix is valid.
  [[nodiscard]] bool fix_is_fresh() const { return fresh_; }
  /// The last fix that the receiver flagged invalid.
  [[nodiscard]] std::optional<GeoPoint> invalid_fix() const { return invalid_fix_; }
  /// Dead-reckoned position; on the surface it follows the fixes.
  [[nodiscard]] GeoPoint reckoned() const { return fresh_ ? fix_ : navigator_.reckoned(); }
  [[nodiscard]] GeoPoint position() const { return dynamics_.position(); }
  /// Last measured currents; none before the first dive of the run unless the setup has a prior one.
  [[nodiscard]] std::optional<Current> water() const { return water_; }
  [[nodiscard]] std::optional<Current> initial_water() const { return initial_water_; }
  [[nodiscard]] double water_s() const { return water_s_; }
  [[nodiscard]] int segment() const { return segment_; }
  /// A list with end_action 0 was finished and heading idle ends the mission.
  [[nodiscard]] bool mission_over() const {
    return navigator_.quit() && setup_.surfacing.heading_idle == SurfaceRules::Idle::quit && !abort_;
  }
  [[nodiscard]] const Because& because() const { return because_; }
  /// The mission was aborted; it stays so.
  [[nodiscard]] const std::optional<Abort>& abort() const { return abort_; }
  /// After an abort: nothing more is to come.
  [[nodiscard]] bool fallback_is_over() const { return abort_ && fallback_calls_ >= setup_.aborts.fallback_calls; }
  /// A list that Ctrl-F could not read aborts too, when a fallback follows; else the caller ends the run.
  void abort_by_behaviour_error(const BehaviourError& error, double now_s);
  /// A call came through and lasted so long.
  void called(double at_s, double seconds);
  /// Used since the start of the run.
  [[nodiscard]] Energy energy() const;
  /// Share of battery_wh that is left, in [0, 1]; none when no battery is watched.
  [[nodiscard]] std::optional<double> battery_left() const;
  /// First instant of the run with a true position inside `radius` of `goal`; watched from now on.
  void watch(GeoPoint goal, Metres radius);
  [[nodiscard]] std::optional<double> arrived_s() const { return arrived_s_; }
  [[nodiscard]] Metres closest() const { return closest_; }

 private:
  void look_at_goal();
  std::optional<Accident> drift(double until_s);
  void fly(DiveRecord& record);
  [[nodiscard]] double stint_limit();
  [[nodiscard]] std::optional<Because> reason_to_surface(int hits_before);
  void look_for_abort();
  [[nodiscard]] std::optional<MetresPerSecond> speed_by_depth_rate();
  void account_for_dive(DiveRecord& record);

  GliderSetup setup_;
  Dynamics dynamics_;
  Navigator navigator_;
  Random random_;
  Gps gps_;
  Wind wind_;
  Random luck_;
  double dived_s_{}, surfaced_s_{}, fix_s_{}, fixes_done_s_{}, water_s_{}, heard_s_{};
  bool fresh_{true}, measurable_{}, idle_told_{};
  std::optional<GeoPoint> invalid_fix_;
  Because because_{because::kYoIsOver};
  std::optional<Abort> abort_;
  int fallback_calls_{};
  Energy before_, since_surfacing_;
  double speed_sum_{}, speed_time_{};
  double reckoned_s_{};  ///< under water since the last valid fix (m_dr_time)
  GeoPoint fix_;
  std::optional<Current> water_, initial_water_;
  int segment_{};
  std::optional<GeoPoint> goal_;
  Metres goal_radius_, closest_{1e9};
  double previous_distance_{1e9}, previous_s_{};
  std::optional<double> arrived_s_;
};

}  // namespace glidehelm::simulator
