#include "core/planning/direct_to_goal.hpp"

#include "core/planning/flight.hpp"

namespace glidehelm::planning {

Expected<Plan, PlanFailure> DirectToGoal::plan(const Problem& asked, Members members, const chart::Chart& chart,
                                               const Budget&, const std::function<void(const Plan&)>& better) const {
  if (members.empty()) return unexpected(PlanFailure{NoPlan::no_forecast, "no forecast is given"});
  const Problem problem = within_objective(asked);
  if (auto wrong = check_ends(problem, members.front(), chart)) return unexpected(*wrong);
  const auto goal = disc_of(problem);
  const auto flown = vehicle::fly_helm(
      [&](int, GeoPoint dive, double) -> std::optional<Heading> {
        return Heading{geodesic(dive, goal.centre).departing.from_north()};
      },
      flight_of(problem), waters_of(problem, members.front(), chart));
  auto plan = plan_from("direct", flown, problem, {0, flown.stints.size(), 0});
  if (better) better(plan);
  return plan;
}

}  // namespace glidehelm::planning
