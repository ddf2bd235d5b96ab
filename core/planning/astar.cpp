#include "core/planning/astar.hpp"

#include "core/planning/flight.hpp"
#include "core/planning/lattice_search.hpp"
#include "core/planning/searched_plan.hpp"
#include "core/planning/way_headings.hpp"

namespace glidehelm::planning {

Expected<Plan, PlanFailure> AStar::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                        const Budget& budget, const std::function<void(const Plan&)>& better) const {
  if (wants_least_distance(problem)) return unexpected(only_least_time("astar"));
  return plan_by_search(problem, members, chart, budget, better, [&](const ocean::Ocean& ocean) -> Search {
    return [&](Purse& purse, Metres allowance) {
      const auto way =
          search_lattice(problem, ocean, chart, purse.rest(), {.grid = problem.lattice, .allowance = allowance});
      purse.take(way.statistics, way.cut_at != 0);
      return Found{"astar",
                   {headings_along(way.points, problem, ocean, chart, problem.coast_margin + allowance)},
                   way.arrives,
                   way.exhausted,
                   way.stopped.margin,
                   reason_for(way)};
    };
  });
}

}  // namespace glidehelm::planning
