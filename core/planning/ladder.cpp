#include "core/planning/ladder.hpp"

#include <array>
#include <optional>

#include "core/planning/cts_astar.hpp"
#include "core/planning/direct_to_goal.hpp"
#include "core/planning/flight.hpp"

namespace glidehelm::planning {

Expected<Plan, PlanFailure> Ladder::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                         const Budget& budget, const std::function<void(const Plan&)>& better) const {
  const DirectToGoal direct;
  const CtsAStar cts;
  const std::array<const Planner*, 2> stages{&direct, &cts};
  std::optional<Plan> best;
  std::optional<PlanFailure> failure;
  Statistics total;
  for (const auto* stage : stages) {
    auto answer = stage->plan(problem, members, chart, budget, {});
    if (!answer) {
      failure = answer.error();
      continue;
    }
    total += answer->statistics;
    if (best && !better_than(*answer, *best)) {
      best->cut_at = answer->cut_at;
      continue;
    }
    best = std::move(answer).value();
    if (better) better(*best);
  }
  if (!best) return unexpected(*failure);
  best->statistics = total;
  if (better) better(*best);
  return *best;
}

}  // namespace glidehelm::planning
