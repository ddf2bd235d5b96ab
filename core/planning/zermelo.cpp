#include "core/planning/zermelo.hpp"

#include <utility>

#include "core/planning/cts_astar.hpp"
#include "core/planning/extremal.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/path_keeping.hpp"
#include "core/planning/way_headings.hpp"

namespace glidehelm::planning {

Expected<Plan, PlanFailure> Zermelo::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                          const Budget& budget, const std::function<void(const Plan&)>& better) const {
  if (wants_least_distance(problem)) return unexpected(only_least_time("zermelo"));
  if (members.empty()) return unexpected(PlanFailure{NoPlan::no_forecast, "no forecast is given"});
  const auto& ocean = members.front();
  if (auto wrong = check_ends(problem, ocean, chart)) return unexpected(*wrong);
  const auto goal = disc_of(problem);
  const auto waters = waters_of(problem, ocean, chart);
  const auto fix = vehicle::state_at(problem.start.fix, problem.start.fix_s, waters);
  const auto drift = vehicle::move(waters, ocean.surface, fix, problem.schedule.time_to_dive.count(), {}, nullptr);
  const WayPoint dive{drift.end.lat, drift.end.lon, drift.end.t_s};

  std::uint64_t cut_at = 0;
  const auto may_go_on = [&](std::uint64_t shots) {
    if (shots >= budget.work) return false;
    if (cut_at == 0 && budget.expired && budget.expired()) cut_at = shots;
    return cut_at == 0;
  };
  const ExtremalFlow flow{problem, ocean};
  Extremal way;
  // Inside the goal's disc already, nothing has to be aimed.
  if (distance(problem.start.fix, goal.centre) > goal.radius) {
    way = shoot(flow, dive, goal, problem.horizon_s, may_go_on);
    if (way.shots == 0 && !way.complete) return unexpected(PlanFailure{NoPlan::out_of_budget, "no extremal was tried"});
    if (way.complete && !way.arrives)
      if (auto other = collocate(flow, dive, goal, problem.horizon_s); other && other->arrives) {
        other->shots = way.shots;
        way = std::move(*other);
      }
  }
  const auto headings = headings_along(way.way, problem, ocean, chart, problem.coast_margin + allowance(problem));
  // Without an arrival the flight ends with the last heading, as for astar.
  const auto stints = static_cast<int>(headings.size());
  const double end = stints == 0 ? 0.0 : problem.schedule.surfacing_time(stints - 1).count();
  const bool arrives = way.arrives || way.shots == 0;
  const double until_s = arrives ? problem.horizon_s : problem.start.fix_s + end + 1.0;  // a second: times round
  auto plan = plan_from("zermelo", fly_path(headings, problem, ocean, chart, until_s), problem, {});
  if (!plan.reaches_goal()) {
    if (!way.complete)
      plan.reason = "the shooting was stopped before it came to an end";
    else if (!way.arrives)
      plan.reason = "no extremal was found that reaches the goal: zermelo is for weak currents";
    else
      plan.reason =
          "the flight along the extremal does not reach the goal: zermelo knows no land, and is for weak currents";
    if (plan.stints.empty() && !way.complete) return unexpected(PlanFailure{NoPlan::out_of_budget, plan.reason});
    if (plan.stints.empty())
      return unexpected(PlanFailure{NoPlan::boxed_in, "no stint leads nearer to the goal: " + plan.reason});
  }
  plan.statistics.expansions = way.shots;
  plan.statistics.current_evaluations = 2 * flow.evaluations();
  plan.cut_at = cut_at;
  if (better) better(plan);
  return plan;
}

}  // namespace glidehelm::planning
