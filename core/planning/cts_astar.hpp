#pragma once

#include <vector>

#include "core/planning/heading_sampling.hpp"
#include "core/planning/planner.hpp"

namespace glidehelm::planning {

class ToGo;
class SharedToGo;

/// CTS-A*: A* over surfacings at constant time (Thesis 4.4, Algorithm 4.2, with the errata).
///
/// Idea: instead of asking which heading leads to a neighbouring grid node, fly a stint on each of M headings and see where
/// it ends. The end is kept as it is and only *labelled* by the grid cell it falls into; a cell keeps its best label. So
/// strong currents are used instead of being infeasible, and surfacings stay a constant time apart.
///
/// Symbols: M headings ψ_g, stint time t_s, multiples s, g(n) time from the fix to the surfacing n, h(n) lower bound from
/// there to the goal (docs/notation.md).
///
/// What Algorithm 4.2 leaves open, and how it is settled here:
///
///  - **Cost.** g is the time of the surfacing on the dive schedule, first stint and surface intervals included, so it
///    depends on the number of stints alone. d(x, m) of lines 16–18 is h: a label gives way to one with fewer stints, or
///    with as many and a smaller h.
///  - **Re-opening.** A cell that gets a better label is open again, also after it was expanded: under currents that
///    change with time, and because labels of one cell lie at different places, an earlier label is a new beginning.
///    What was reached from the old one stays valid: every label keeps its own parent, paths are never rewired. With a
///    consistent h a re-opening must save at least one stint, so a cell is re-opened at most as often as its diameter is
///    long in stints against the heuristic: seldom more than once.
///  - **Multiples s·t_s.** After a stint that ends in its parent's cell the glider drifts for the surface interval and
///    dives again on the same heading, `kMostRepeats` stints in all. The integration goes on from where it is (the printed
///    algorithm starts again at x_n). A heading that never leaves the cell is dropped.
///  - **Drift.** The surface interval before a stint is integrated once per expansion, for all M dives together.
///  - **Goal.** Looked for on the chord of every integration step, dives and drifts, also in repeated stints: arrival is
///    the crossing of the radius. The search ends when no open label can arrive before the best arrival found.
///  - **Headings.** M uniform ones, the first of them the direction to the goal from each node (4.4.2). `abs-cts-astar`
///    draws them instead (abs_cts_astar.hpp).
///  - **Heuristic.** h(n) is one of to_go.hpp, by `Problem::guidance`. By default it is the least time in which a vehicle covers the
///    distance to the goal radius when it drifts with |c|max of the surface field in the surface intervals and dives with
///    U + |c|max of the dive field between them, on this schedule. *Admissible*: from a surfacing on, any flight spends the same
///    instants drifting and diving, its distance to the goal shrinks no faster than those speeds at each instant,
///    `FieldRef::fastest` bounds every current that can be sampled, and the distance used is a lower bound of the geodesic
///    (chords on a sphere of WGS84's smallest radius of curvature). Surface intervals that must pass are thereby part of the bound.
///    *Consistent*: let D be what one drift and dive cover at most; h(d) = (surface + t_s) + h(d − D) for d ≥ D, and a stint's
///    child lies no nearer than d − D.
///  - **Weighting.** f = g + (1 + ε·ω)·h (guidance.hpp): arrivals up to (1 + ε) times later than among the same labels without, for
///    fewer expansions. The horizon is told by g + h alone. Labels of one cell and as many stints have the same weight, so which
///    of them is kept does not depend on it.
///  - **Ties** of f go to the label created first.
///  - **Land.** Every step keeps the margin, plus an allowance for what the list's flight differs from held headings: the
///    early share of a stint's way plus 0.5 % (chords). When that finds no way, the search is done again without it;
///    when the flight grounds nevertheless, with three times as much. Clearance is kept per label and lane and spent by
///    the distance flown, so the chart is only asked near land. A start inside the margin may only move outwards. Water without data and the edges of field and chart are walls.
///  - **Short ways.** A cell of half a stint is coarse for a way of a few stints: merging then costs several percent. As
///    long as all searches together took fewer than `kCheapExpansions`, and the problem names no cell of its own, the
///    search is done again with cells of half the size (`kMostHalvings` times), only for arrivals earlier than the one it
///    has. The earliest arrival counts.
///  - **Integration.** Classical Runge–Kutta on all headings in lockstep, with the step of vehicle::lane_step.
///
/// After the search its headings are flown again by fly_path (path_keeping.hpp): as the lists that will be emitted, with
/// fine steps, each heading corrected for what law and integration differ. That flight is the plan.
///
/// When the goal is not reached the plan is a closest approach: the way to the label nearest to the goal, and the reason
/// names what stopped the search: the horizon, the end of the forecast, or walls. Labels from which the goal cannot be
/// reached in time are not expanded, unless that is true of the start already; when the goal turns out not to be reached within
/// the horizon, the search is done once more with them, for the nearest of all.
///
/// **MinDistanceAt**: the nearest label at the last surfacing by then, or the earliest arrival before it. The search goes layer by layer, a
/// cell has a label for each number of stints (the one nearest to the goal), and a stint may end in the cell that it began in: waiting
/// is a choice like others. It sees all cells that can be reached: expansions go with cells times stints.
///
/// Complexity: at most one expansion per cell and re-opening; each costs M·4·steps current evaluations. No allocation, no
/// virtual call and no text per expansion beyond the growth of two vectors; one indirect call per integration step of all
/// headings. Memory: 4 bytes per cell, 56 per expanded or open label, 16 per open entry. At most `kMostLabels` labels; the
/// search then stops as if its work were done.
///
/// Loss: without refinement the discretisation costs 2–4.5 % against the best constant-heading plan (product.md 10).
class CtsAStar final : public Planner {
 public:
  static constexpr int kMostRepeats = 4;
  static constexpr std::size_t kMostLabels = 8'000'000;
  static constexpr std::uint64_t kCheapExpansions = 2000;
  static constexpr int kMostHalvings = 4;

  [[nodiscard]] std::string_view name() const noexcept override { return "cts-astar"; }
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.time_varying = true, .obstacles = true};
  }
  /// `Budget::work` counts the expansions of all searches; `expired` is asked every 64.
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;
};

/// What `CtsAStar::plan` does, for either way of sampling headings; `method` is the name that the plan gets. `shared`: of the same problem within
/// its objective, for other searches too; null: its own.
Expected<Plan, PlanFailure> plan_by_cts(const std::string& method, HeadingSampling sampling, const Problem& problem,
                                        Members members, const chart::Chart& chart, const Budget& budget,
                                        const std::function<void(const Plan&)>& better, SharedToGo* shared = nullptr);

/// What the search itself found, before it is flown: for `CtsAStar::plan`, tests and benchmarks.
struct CtsSearch {
  std::vector<Heading> headings;  ///< to the goal, or to the label nearest to it when it was not reached
  double arrival_s{};             ///< by the search's own integration; NaN when the goal was not reached
  Statistics statistics;
  std::uint64_t cut_at{};  ///< as in Plan
  bool exhausted{};  ///< ended by itself: best arrival proven among labels (to the weight), or nothing left to expand
  struct Stopped {
    bool horizon{}, forecast_end{};
    bool no_water{};  ///< land by the mask, water without data, the edge of the field
    bool margin{};    ///< the chart's margin
    friend bool operator==(const Stopped&, const Stopped&) = default;
  } stopped;        ///< what ended ways on the search
  double step_s{};  ///< integration step used
  std::size_t labels{}, cells{};
  double nearest_m{};          ///< lower bound of the distance from the nearest label to the goal's centre
  double cell_m{};             ///< cell size used: the wanted one unless the grid had to be coarser
  std::size_t memory_bytes{};  ///< labels, cells and open list
};
struct CtsSettings {
  Metres allowance;             ///< clearance beyond the margin
  Metres cell;                  ///< 0: cell_of(problem)
  double earlier_than_s{1e18};  ///< epoch second: only earlier arrivals are of interest
  HeadingSampling sampling{HeadingSampling::uniform};
  /// As near to the goal as can be: labels from which it cannot be reached in time are expanded as well.
  bool nearest{};
  const ToGo* to_go{};  ///< of the same problem, made before; null: the search makes its own
};
/// One search at one cell size.
CtsSearch search(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, const Budget& budget,
                 const CtsSettings& settings = {});
/// Clearance beyond the margin that a way of held headings keeps, because its list's flight differs from it: the early share of a
/// stint's way plus 0.5 % (chords).
Metres allowance(const Problem& problem);
/// The merging cell of a problem: the wanted one, else half a stint through still water.
Metres cell_of(const Problem& problem);

}  // namespace glidehelm::planning
