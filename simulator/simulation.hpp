#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/chart/chart.hpp"
#include "core/ocean/field.hpp"
#include "simulator/dockserver/call.hpp"
#include "simulator/fault_plan.hpp"
#include "simulator/glider/behaviours.hpp"

/// A simulated glider, its dockserver and its ocean. Not here: our motion, planners, pilot, protocol.
namespace glidehelm::simulator {

/// What goes wrong with a glider's line beside the older four faults: one plan per flag of CallFaults.
struct LineFaultPlan {
  FaultPlan cut, half_open, call_back, late_script, transfer_cut, science_files, wrong_keys, chatter, garbled, injected,
      injected_lossily, duplicated, slow;
  LineSetup setup;
};

/// One glider of a simulation.
struct GliderPlan {
  GliderSetup setup;
  GeoPoint goal;
  Metres goal_radius{2000};
  CallSetup call;
  FaultPlan lost_calls, not_taken, no_connection_block, redial;
  LineFaultPlan line;
};

/// When a glider's run is over beside an accident or the end of its mission.
struct EndPlan {
  bool at_goal{true};             ///< after the surface interval of the first surfacing that follows the arrival
  std::optional<int> surfacings;  ///< after so many
  std::optional<double> days;     ///< after so long
};

/// One surface interval, when it is over.
struct SurfacingRecord {
  std::size_t glider{};
  int number{};  ///< from 1
  double surfaced_s{}, fix_s{}, dive_s{};
  GeoPoint fix;
  std::optional<Current> water;  ///< measured, true frame
  Metres to_goal;
  int target{};  ///< index of the waypoint steered to at the dive
  CallFaults faults;
  CallOutcome call;
  std::uint64_t bytes{};  ///< that left on the line
  int whole_fixes{};      ///< `GPS Location:` lines that left undamaged, reprints included
  int connections{};
  Because because;          ///< what brought the glider up
  bool fix_is_fresh{true};  ///< false: no valid fix here, `fix` is an older one
  Energy energy;            ///< of the surface interval before and the dive that ended here
};

enum class RunEnd { running, arrived, accident, behaviour_error, mission_over, aborted, surfacings, days };
const char* word(RunEnd end);

/// How one glider fared.
struct GliderResult {
  RunEnd end{RunEnd::running};
  std::string reason;               ///< in words; empty while running
  std::optional<double> arrived_s;  ///< first instant inside the goal radius
  double started_s{}, ended_s{};
  int surfacings{}, lists_taken{}, behaviour_errors{};
  Metres closest;  ///< to the goal
  Energy energy;   ///< of the whole run
};

/// Bytes of one glider's line.
struct LineOutput {
  std::size_t glider{};
  LineEvent event;
};

/// Gliders, dockserver scripts and folders in one ocean, stepped from event to event. No socket, no clock: what happens
/// next is a value, so that tests and rehearsals run the real pilot against it in one process:
///
///   while (auto next = sim.next_event()) { …let the daemon's timers before *next fire…; for (auto& o : sim.step()) feed(o); }
///
/// A slow line passes its bytes second by second; what is still under way when the glider dives is lost.
/// Gliders do not interact. Events are in order of time, then of glider. Same plans, same seeds: the same bytes.
class Simulation {
 public:
  struct Member {
    GliderPlan plan;
    ToGlider* folder{};  ///< must outlive the simulation
  };
  /// Truth and chart must outlive the simulation. `seed` feeds faults; each glider's own seed is in its setup.
  Simulation(std::vector<Member> members, ocean::Ocean truth, const chart::Chart& chart, EndPlan end,
             std::uint64_t seed);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// When the next event happens, rounded up to the millisecond; none when every glider's run is over.
  [[nodiscard]] std::optional<Instant> next_event() const;
  /// Lets the next event happen and returns what came over the lines. Precondition: there is one.
  std::vector<LineOutput> step();

  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] const Glider& glider(std::size_t i) const;
  [[nodiscard]] const GliderPlan& plan(std::size_t i) const;
  [[nodiscard]] const std::vector<SurfacingRecord>& surfacings(std::size_t i) const;
  [[nodiscard]] const std::vector<DiveRecord>& dives(std::size_t i) const;
  [[nodiscard]] const GliderResult& result(std::size_t i) const;
  /// Every glider was inside its goal radius, and none came to grief afterwards.
  [[nodiscard]] bool all_arrived() const;

 private:
  struct Life;
  [[nodiscard]] std::optional<std::size_t> next_glider() const;
  std::vector<std::unique_ptr<Life>> lives_;
  EndPlan end_;
};

}  // namespace glidehelm::simulator
