#pragma once

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// CTS-A*: A* over surfacings at constant time (Thesis 4.4, Algorithm 4.2, with the errata).
///
/// Idea: instead of asking which heading leads to a neighbouring grid node, fly a stint on each of M headings and see where it ends. The
/// end is kept as it is and only *labelled* by the grid cell it falls into; a cell keeps its best label. So strong currents are used
/// instead of being infeasible, and surfacings stay a constant time apart.
///
/// What Algorithm 4.2 leaves open, and how it is settled here:
///  - **Cost.** g of a label is the time of its surfacing on the dive schedule, surface intervals included: it depends on the number of
///    stints alone. A label replaces another of the same cell when it has fewer stints, or as many and a smaller heuristic. A cell that gets
///    a better label is opened again, also after it was expanded: with time-varying currents a later, better label is a new problem.
///  - **Between stints** the glider drifts for the surface interval; the drift is integrated once per expansion and then the M dives start
///    from one place. The goal may be crossed in a drift.
///  - **Multiples s·t_s.** A stint that ends in its parent's cell flies on with the same heading, surface interval included, up to
///    `kMostRepeats` stints in all; one that never leaves is dropped. (The printed algorithm restarts each repetition and does not end.)
///  - **Goal test** along the stint: arrival is when the goal radius is crossed, on the chord of an integration step; the search stops when no
///    open label can arrive earlier than the best arrival found.
///  - **Headings** are M uniform ones centred on the direction to the goal from each node.
///  - **Heuristic.** The least time in which a vehicle covers the distance to the goal radius when every dive runs at U + |c|max and
///    every drift at |c|max of the surface field, on the same schedule from a surfacing on. No vehicle in this field can do better, the distance
///    is a lower bound of the geodesic, and |c|max holds over all of the field: it is admissible, and consistent by the triangle inequality.
///  - **Ties** of f are broken by the order of creation.
///  - **Land**: every integration step keeps the margin (plus 0.5 % of a stint's way, since chords and steering deviate); a start inside the
///    margin may only move outwards. No data and the edges of the field are walls.
///
/// The search integrates with Runge–Kutta steps chosen by vehicle::lane_step. Its headings are then flown exactly, as the list that will be
/// emitted; the plan is that flight, so it may differ from the search by the integration tolerance.
///
/// Complexity: expansions ≤ labels ≤ cells times re-openings; each costs M·4·steps current evaluations. Memory 4 bytes per cell and 56 per
/// label. Without refinement the discretisation costs 2–4.5 % against the best constant-heading plan (product.md 10).
class CtsAStar final : public Planner {
 public:
  static constexpr int kMostRepeats = 4;

  [[nodiscard]] std::string_view name() const noexcept override { return "cts-astar"; }
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.time_varying = true, .obstacles = true};
  }
  /// `Budget::work` counts expansions.
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;
};

/// What the search itself found, before it is flown: for tests and benchmarks.
struct CtsSearch {
  std::vector<Heading> headings;  ///< to the goal, or to the nearest label when it was not reached
  double arrival_s{};             ///< by the search's own integration; NaN when the goal was not reached
  Statistics statistics;
  std::uint64_t cut_at{};
  bool exhausted{};  ///< every label within the horizon was expanded
  double step_s{};   ///< integration step used
  std::size_t labels{}, cells{};
};
CtsSearch search(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, const Budget& budget);

}  // namespace glidehelm::planning
