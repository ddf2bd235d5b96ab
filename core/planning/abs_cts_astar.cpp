#include "core/planning/abs_cts_astar.hpp"

#include "core/planning/cts_astar.hpp"

namespace glidehelm::planning {

Expected<Plan, PlanFailure> AbsCtsAStar::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                              const Budget& budget,
                                              const std::function<void(const Plan&)>& better) const {
  return plan_by_cts("abs-cts-astar", HeadingSampling::adaptive, problem, members, chart, budget, better);
}

}  // namespace glidehelm::planning
