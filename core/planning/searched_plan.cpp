#include "core/planning/searched_plan.hpp"

#include <utility>

#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/path_keeping.hpp"

namespace glidehelm::planning {

namespace {

/// A search and the best flight of what it found.
struct Attempt {
  Found found;
  Plan plan;
  [[nodiscard]] bool grounded() const { return found.arrives && !plan.reaches_goal(); }
};

Attempt attempt(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Purse& purse,
                const Search& search, Metres allowance) {
  Attempt a{search(purse, allowance), {}};
  bool flown = false;
  for (const auto& headings : a.found.ways) {
    // Without an arrival the flight ends with the last heading: steering on to the goal is what the search found impossible.
    const auto stints = static_cast<int>(headings.size());
    const double end = stints == 0 ? 0.0 : problem.schedule.surfacing_time(stints - 1).count();
    const double until_s =
        a.found.arrives ? problem.horizon_s : problem.start.fix_s + end + 1.0;  // a second: times round
    auto plan = plan_from(a.found.method, fly_path(headings, problem, ocean, chart, until_s), problem, {});
    if (!flown || better_than(plan, a.plan)) a.plan = std::move(plan);
    flown = true;
  }
  if (!a.found.arrives && !a.plan.reaches_goal()) a.plan.reason = a.found.reason;
  return a;
}

}  // namespace

Expected<Plan, PlanFailure> plan_by_search(const Problem& problem, Members members, const chart::Chart& chart,
                                           const Budget& budget, const std::function<void(const Plan&)>& better,
                                           const std::function<Search(const ocean::Ocean&)>& search_in) {
  if (members.empty()) return unexpected(PlanFailure{NoPlan::no_forecast, "no forecast is given"});
  const auto& ocean = members.front();
  if (auto wrong = check_ends(problem, ocean, chart)) return unexpected(*wrong);

  Purse purse{budget};
  const auto search = search_in(ocean);
  const Metres spare = allowance(problem);
  auto best = attempt(problem, ocean, chart, purse, search, spare);
  // What the chart's margin stopped may be mended by another allowance.
  const bool mendable = best.grounded() || (!best.plan.reaches_goal() && best.found.exhausted);
  if (mendable && best.found.met_margin && purse.cut_at() == 0) {
    auto again = attempt(problem, ocean, chart, purse, search, best.grounded() ? 3 * spare : Metres{});
    if (better_than(again.plan, best.plan)) best = std::move(again);
  }
  if (!best.plan.reaches_goal() && best.plan.stints.empty()) {
    if (!best.found.exhausted)
      return unexpected(PlanFailure{NoPlan::out_of_budget, "the search was stopped before its first stint"});
    return unexpected(PlanFailure{NoPlan::boxed_in, "no stint leads nearer to the goal: " + best.plan.reason});
  }
  best.plan.statistics = purse.spent();
  best.plan.cut_at = purse.cut_at();
  if (better) better(best.plan);
  return std::move(best.plan);
}

}  // namespace glidehelm::planning
