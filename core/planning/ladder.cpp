#include "core/planning/ladder.hpp"

#include <array>
#include <optional>
#include <vector>

#include "core/planning/cts_astar.hpp"
#include "core/planning/direct_to_goal.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/optimization.hpp"
#include "core/planning/purse.hpp"
#include "core/planning/refined_cts.hpp"
#include "core/planning/to_go.hpp"

namespace glidehelm::planning {

namespace {

/// Where the goal is not reached the distance left counts, and each of them ends behind other islands now and then. On a dozen stints they cost about
/// as much as refinement; on sixty they doubled the time of an answer and won a tenth of a kilometre at most.
constexpr std::array kSlopeKernels{Kernel::quasi_newton, Kernel::least_squares, Kernel::sqp};
constexpr std::size_t kFewStints = 24;

}  // namespace

Expected<Plan, PlanFailure> Ladder::plan(const Problem& asked, Members members, const chart::Chart& chart,
                                         const Budget& budget, const std::function<void(const Plan&)>& better) const {
  const Problem problem = within_objective(asked);
  Purse purse{budget};
  std::vector<Plan> found;
  std::optional<Plan> best;
  std::optional<PlanFailure> failure;
  const auto offer = [&](Plan plan) {
    if (best && !better_than(plan, *best)) return;
    best = std::move(plan);
    best->statistics = purse.spent();
    best->cut_at = purse.cut_at();
    if (better) better(*best);
  };
  const auto take = [&](Expected<Plan, PlanFailure> answer) {
    if (!answer) {
      failure = answer.error();
      return;
    }
    purse.take(answer->statistics, answer->cut_at != 0);
    found.push_back(*answer);
    offer(std::move(answer).value());
  };
  SharedToGo to_go{problem, members, chart};
  take(DirectToGoal{}.plan(problem, members, chart, purse.rest(), {}));
  take(plan_by_cts("cts-astar", HeadingSampling::uniform, problem, members, chart, purse.rest(), {}, &to_go));
  if (!best) return unexpected(*failure);
  // A straight way that does not arrive where the search does has nothing to give.
  if (best->reaches_goal() && found.size() > 1 && !found.front().reaches_goal()) found.erase(found.begin());
  if (!purse.is_empty()) {
    auto polished = refined(found, problem, members.front(), chart, purse, to_go);
    offer(std::move(polished.plan));
    if (polished.in_doubt && !wants_least_distance(problem) && !purse.is_empty())
      take(IterativeOptimization{}.plan(problem, members, chart, purse.rest(), {}));
    for (const auto kernel : kSlopeKernels)
      if (!best->reaches_goal() && best->stints.size() <= kFewStints && !purse.is_empty())
        take(Optimization{OptimizationSettings{.kernel = kernel}}.plan(problem, members, chart, purse.rest(), {}));
  }
  best->statistics = purse.spent();
  best->cut_at = purse.cut_at();
  if (better) better(*best);
  return *best;
}

}  // namespace glidehelm::planning
