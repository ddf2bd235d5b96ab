#pragma once

#include <vector>

#include "core/planning/lattice_search.hpp"

namespace glidehelm::planning {

/// Eichhorn's four searches in a time-varying environment (TVE), over a sector grid (sector_grid.hpp) with his travel time of edges
/// (travel_time.hpp).
///
/// | name | paper | what it does |
/// |---|---|---|
/// | `tve` | 2.2 | Dijkstra's algorithm; the time of an edge is worked out during the search, from the arrival at its beginning |
/// | `astar-tve` | 2.2.1, Table 1 | and the nodes nearest to the goal first: h is the straight way at the greatest speed (eq. 1) |
/// | `ztve` | 2.2.2 | `tve` with only those edges that agree with Zermelo's formula (optimal_course.hpp) |
/// | `zastar-tve` | 2.2.3, Table 2 | both |
///
/// The first two find the fastest way over the grid as long as no edge is passed sooner by waiting for it. Where currents are stronger than the
/// vehicle that can fail: an edge which is closed now may open later, and an earlier arrival at its beginning is then the worse one. The
/// Z-methods need beside that that the fastest way bends, at each node, by less than Δφ_max beyond what the formula says. Where they find
/// none at all the search is repeated without the cone, and the plan is labelled `tve` or `astar-tve`.
///
/// The way is smoothed (smoothing.hpp), and both ways, the found one and the smooth one, are followed on the dive schedule and flown as lists, like
/// those of `astar` (docs/decisions/023); the earlier flight is the plan. So smoothing never makes a plan later. Counts of the plan's statistics:
/// `cost_evaluations` are Eichhorn's cost function calls, of search and smoothing, `current_evaluations` his current model calls (each of
/// both currents).
///
/// `Problem::sector_grid` chooses the grid. `Budget::work` counts expansions; `expired` is asked every 64.
class Tve final : public Planner {
 public:
  enum class Method { tve, astar_tve, ztve, zastar_tve };
  explicit Tve(Method method) : method_{method} {}

  [[nodiscard]] std::string_view name() const noexcept override;
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.time_varying = true, .obstacles = true};
  }
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;

 private:
  Method method_;
};

/// The rules of such a search on a grid.
LatticeRules rules_of(Tve::Method method, const SectorGrid& grid);
/// A found way smoothed under the same times and margins; `statistics` are added to.
std::vector<WayPoint> smooth_way(const std::vector<WayPoint>& way, const Problem& problem, const ocean::Ocean& ocean,
                                 const chart::Chart& chart, Statistics& statistics);

}  // namespace glidehelm::planning
