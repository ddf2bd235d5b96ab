#include "core/planning/zermelo.hpp"

#include <utility>

#include "core/planning/extremal.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/searched_plan.hpp"
#include "core/planning/way_headings.hpp"

namespace glidehelm::planning {

namespace {

/// The extremal from the first dive to the goal's disc: by shooting, and by collocation when no shot arrives.
Extremal extremal_of(const ExtremalFlow& flow, const Problem& problem, const ocean::Ocean& ocean,
                     const chart::Chart& chart, Purse& purse) {
  const auto goal = disc_of(problem);
  const auto waters = waters_of(problem, ocean, chart);
  const auto fix = vehicle::state_at(problem.start.fix, problem.start.fix_s, waters);
  const auto drift = vehicle::move(waters, ocean.surface, fix, problem.schedule.time_to_dive.count(), {}, nullptr);
  const WayPoint dive{drift.end.lat, drift.end.lon, drift.end.t_s};
  const Budget rest = purse.rest();
  bool cut = false;
  auto way = shoot(flow, dive, goal, problem.horizon_s, [&](std::uint64_t shots) {
    if (shots >= rest.work) return false;
    cut = cut || (rest.expired && rest.expired());
    return !cut;
  });
  if (way.complete && !way.arrives)
    if (auto other = collocate(flow, dive, goal, problem.horizon_s); other && other->arrives) {
      other->shots = way.shots;
      other->complete = true;
      way = std::move(*other);
    }
  purse.take({way.shots, 0, 2 * flow.evaluations()}, cut);
  return way;
}

}  // namespace

Expected<Plan, PlanFailure> Zermelo::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                          const Budget& budget, const std::function<void(const Plan&)>& better) const {
  if (wants_least_distance(problem)) return unexpected(only_least_time(name()));
  return plan_by_search(problem, members, chart, budget, better, [&](const ocean::Ocean& ocean) -> Search {
    return [&](Purse& purse, Metres allowance) {
      // Inside the goal's disc already, nothing has to be aimed.
      if (distance(problem.start.fix, disc_of(problem).centre) <= disc_of(problem).radius)
        return Found{std::string{name()}, {{}}, true, true, false, ""};
      const ExtremalFlow flow{problem, ocean};
      const auto way = extremal_of(flow, problem, ocean, chart, purse);
      return Found{std::string{name()},
                   {headings_along(way.way, problem, ocean, chart, problem.coast_margin + allowance)},
                   way.arrives,
                   way.complete,
                   false,  // it knows no land: another allowance leads to the same extremal
                   way.complete ? "no extremal was found that reaches the goal: zermelo is for weak currents"
                                : "the shooting was stopped before it came to an end"};
    };
  });
}

}  // namespace glidehelm::planning
