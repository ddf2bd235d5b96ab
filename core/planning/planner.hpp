#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/geo.hpp"
#include "core/chart/chart.hpp"
#include "core/model/dive_schedule.hpp"
#include "core/model/glider.hpp"
#include "core/ocean/field.hpp"
#include "core/planning/guidance.hpp"
#include "core/planning/lattice_choice.hpp"
#include "core/planning/sector_grid.hpp"
#include "core/vehicle/motion.hpp"

/// The seam between a planner and its caller.
namespace glidehelm::planning {

/// Be within `radius` of `at`, under water or drifting.
struct PointGoal {
  GeoPoint at;
  Metres radius{2000};
  friend bool operator==(const PointGoal&, const PointGoal&) = default;
};
using GoalSpec = std::variant<PointGoal>;

/// Arrive as early as can be (Thesis 3.1.1).
struct MinTime {
  friend bool operator==(MinTime, MinTime) = default;
};
/// Be as near to the goal as can be at the last surfacing that is not later than an instant (Thesis 3.1.2): nothing is flown
/// beyond it. Where the goal can be reached before, the earliest arrival is best.
struct MinDistanceAt {
  double epoch_s{};
  friend bool operator==(MinDistanceAt, MinDistanceAt) = default;
};
using Objective = std::variant<MinTime, MinDistanceAt>;

/// Where and when the clock of a plan starts: the accepted fix.
struct Departure {
  GeoPoint fix;
  double fix_s{};  ///< epoch seconds
  friend bool operator==(const Departure&, const Departure&) = default;
};

/// What a planner may be asked. Everything that changes the answer is in here, in the Ocean or in the Chart.
struct Problem {
  Departure start;
  GoalSpec goal;
  Objective objective;
  model::Glider glider;
  model::DiveSchedule schedule;
  std::optional<Current> believed_current;  ///< ĉ of the first stint (correction 1): the measured DAC, true frame
  double horizon_s{};                       ///< epoch seconds after which no plan may run
  Metres coast_margin{2000};  ///< clearance that the track keeps; a start inside it may only move outwards
  int headings{18};           ///< M
  Metres cell{};              ///< merging cell of the search; 0 = half a stint through still water
  std::uint64_t seed{1};
  Guidance guidance;       ///< of cts-astar, abs-cts-astar and what begins with them
  LatticeChoice lattice;   ///< of astar
  SectorGrid sector_grid;  ///< of tve, astar-tve, ztve, zastar-tve
  friend bool operator==(const Problem&, const Problem&) = default;
};

/// One forecast is one member; an ensemble has several.
using Members = std::span<const ocean::Ocean>;

/// Counts of what a plan cost; part of every answer.
struct Statistics {
  std::uint64_t expansions{}, cost_evaluations{}, current_evaluations{};
  Statistics& operator+=(const Statistics& more) {
    expansions += more.expansions;
    cost_evaluations += more.cost_evaluations;
    current_evaluations += more.current_evaluations;
    return *this;
  }
  friend bool operator==(const Statistics&, const Statistics&) = default;
};

/// How much a planner may do. `work` counts expansions (or the method's equivalent) and makes a stop reproducible;
/// `expired` is asked now and then and only ever cuts a search short (then `Answer::cut_at` says where, so that a
/// replay with that work limit gives the same plan). No wall clock and no thread in here: both are handed in.
struct Budget {
  std::uint64_t work{std::numeric_limits<std::uint64_t>::max()};
  std::function<bool()> expired;  ///< empty = never
};

enum class PlanStatus { reaches_goal, closest_approach };

struct Plan {
  std::string method;  ///< honest: the stage that made these stints
  PlanStatus status{PlanStatus::closest_approach};
  std::vector<vehicle::Stint> stints;
  double arrival_s{};  ///< epoch seconds at which the goal radius is crossed; NaN when it is not
  /// Geodesic distance from the goal's centre: at the closest position reached, or, under MinDistanceAt, at the last surfacing.
  Metres remaining;
  std::string reason;  ///< in words, when the goal is not reached
  Statistics statistics;
  std::uint64_t cut_at{};  ///< work count at which `expired` stopped the search; 0 = it ran to its end
  friend bool operator==(const Plan&, const Plan&) = default;

  [[nodiscard]] bool reaches_goal() const { return status == PlanStatus::reaches_goal; }
};

enum class NoPlan {
  start_on_land,
  goal_on_land,
  start_outside_field,
  goal_outside_field,
  no_forecast,
  boxed_in,
  out_of_budget,
  unsuited_method  ///< the method does not answer problems of this kind: another one may
};
std::string_view word(NoPlan reason);
/// A failure with the facts a pilot needs: "the goal is on land (0.8 km inside the coast)".
struct PlanFailure {
  NoPlan what{};
  std::string message;
  friend bool operator==(const PlanFailure&, const PlanFailure&) = default;
};

struct Capabilities {
  bool time_varying{}, obstacles{}, ensemble{}, proves_unreachable{};
};

/// A method. Const and stateless: the same Planner may serve several threads.
class Planner {
 public:
  virtual ~Planner() = default;
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;  ///< as in YAML and JSON: "cts-astar"
  [[nodiscard]] virtual Capabilities capabilities() const noexcept = 0;
  /// Same input, same plan, on any thread count. `better` is called with every improvement on the way and once with
  /// the final plan before it is returned.
  [[nodiscard]] virtual Expected<Plan, PlanFailure> plan(const Problem& problem, Members members,
                                                         const chart::Chart& chart, const Budget& budget,
                                                         const std::function<void(const Plan&)>& better) const = 0;
};

}  // namespace glidehelm::planning
