#include "core/planning/flight.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace glidehelm::planning {

std::string_view word(NoPlan reason) {
  switch (reason) {
    case NoPlan::start_on_land:
      return "start_on_land";
    case NoPlan::goal_on_land:
      return "goal_on_land";
    case NoPlan::start_outside_field:
      return "start_outside_field";
    case NoPlan::goal_outside_field:
      return "goal_outside_field";
    case NoPlan::no_forecast:
      return "no_forecast";
    case NoPlan::boxed_in:
      return "boxed_in";
    case NoPlan::out_of_budget:
      return "out_of_budget";
    case NoPlan::unsuited_method:
      return "unsuited_method";
  }
  return "?";
}

vehicle::Disc disc_of(const Problem& problem) {
  const auto& goal = std::get<PointGoal>(problem.goal);
  return {goal.at, goal.radius};
}

vehicle::Flight flight_of(const Problem& problem) {
  return {problem.glider,           problem.schedule, problem.start.fix, problem.start.fix_s,
          problem.believed_current, disc_of(problem), problem.horizon_s};
}

vehicle::Waters waters_of(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart) {
  return {ocean, chart, problem.coast_margin};
}

namespace {

std::string at(GeoPoint p) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4f,%.4f", p.lat.degrees(), p.lon.degrees());
  return text;
}

std::string kilometres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f km", metres / 1000);
  return text;
}

/// The complaint about one end of the way; nothing when it lies in charted water with a current.
std::optional<PlanFailure> check_end(const char* what, GeoPoint p, double t_s, NoPlan on_land, NoPlan outside,
                                     const ocean::Ocean& ocean, const chart::Chart& chart) {
  const std::string name = std::string{"the "} + what + " " + at(p);
  if (chart.has_coast() && !chart.is_charted(p)) return PlanFailure{outside, name + " lies outside the coast file"};
  if (chart.is_land(p))
    return PlanFailure{on_land,
                       name + " is on land, " + kilometres(-chart.distance_to_coast(p).si()) + " inside the coast"};
  if (chart.clearance(p).si() < 0)
    return PlanFailure{outside,
                       name + " lies outside the allowed area, " + kilometres(-chart.clearance(p).si()) + " from it"};
  const auto current = ocean.dive.sample(p, t_s);
  if (current) return std::nullopt;
  switch (current.error()) {
    case ocean::NoCurrent::land:
      return PlanFailure{on_land, name + " is on land by the mask of the forecast"};
    case ocean::NoCurrent::outside_time:
      return PlanFailure{NoPlan::no_forecast, "the forecast does not cover the time at which the glider is at " + name};
    case ocean::NoCurrent::outside_area:
      return PlanFailure{outside, name + " lies outside the area of the forecast"};
    case ocean::NoCurrent::no_data:
    case ocean::NoCurrent::below_bottom:
      return PlanFailure{outside, name + " has no current data within the coastal fill"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<PlanFailure> check_ends(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart) {
  if (auto wrong = check_end("start", problem.start.fix, problem.start.fix_s, NoPlan::start_on_land,
                             NoPlan::start_outside_field, ocean, chart))
    return wrong;
  return check_end("goal", disc_of(problem).centre, problem.start.fix_s, NoPlan::goal_on_land,
                   NoPlan::goal_outside_field, ocean, chart);
}

Plan plan_from(std::string method, const vehicle::FlownList& flown, const Problem& problem,
               const Statistics& statistics) {
  Plan plan;
  plan.method = std::move(method);
  plan.stints = flown.stints;
  plan.statistics = statistics;
  plan.arrival_s = flown.arrival_s.value_or(std::numeric_limits<double>::quiet_NaN());
  const auto goal = disc_of(problem);
  plan.remaining = std::min(distance(problem.start.fix, goal.centre), distance(flown.closest, goal.centre));
  if (flown.arrival_s) {
    plan.status = PlanStatus::reaches_goal;
    plan.remaining = std::min(plan.remaining, goal.radius);
    return plan;
  }
  if (wants_least_distance(problem))
    plan.remaining = distance(plan.stints.empty() ? problem.start.fix : plan.stints.back().surface, goal.centre);
  if (flown.lost)
    plan.reason = "the way ends after " + std::to_string(plan.stints.size()) +
                  " stints: " + std::string{vehicle::word(*flown.lost)};
  else
    plan.reason = wants_least_distance(problem) ? "the goal is not reached by the time of the objective"
                                                : "the goal is not reached before the horizon";
  return plan;
}

bool better_than(const Plan& a, const Plan& b) {
  if (a.reaches_goal() != b.reaches_goal()) return a.reaches_goal();
  return a.reaches_goal() ? a.arrival_s < b.arrival_s : a.remaining < b.remaining;
}

bool wants_least_distance(const Problem& problem) { return std::holds_alternative<MinDistanceAt>(problem.objective); }

Objective objective_at(std::optional<double> epoch_s, const Problem& problem) {
  const double first_s = problem.start.fix_s + problem.schedule.surfacing_time(0).count();
  if (!epoch_s || *epoch_s < first_s) return MinTime{};
  return MinDistanceAt{*epoch_s};
}

Problem within_objective(const Problem& problem) {
  Problem within = problem;
  if (const auto* least = std::get_if<MinDistanceAt>(&problem.objective))
    within.horizon_s = std::min(within.horizon_s, least->epoch_s);
  return within;
}

int stints_within(const Problem& problem) {
  const double seconds = problem.horizon_s - problem.start.fix_s;
  int n = 0;
  while (n < vehicle::kMostStints && problem.schedule.surfacing_time(n).count() <= seconds) ++n;
  return n;
}

PlanFailure only_least_time(std::string_view method) {
  return {NoPlan::unsuited_method, std::string{method} + " looks for the earliest arrival only, not for the least " +
                                       "distance at a given time: use optimization, cts-astar or best"};
}

Seconds still_water_time(const Problem& problem) {
  const auto goal = disc_of(problem);
  const double way = std::max(0.0, (distance(problem.start.fix, goal.centre) - goal.radius).si());
  return problem.schedule.travel_time(Seconds{way / problem.glider.horizontal_speed.si()});
}

Seconds automatic_horizon(const Problem& problem) {
  return std::max(3.0 * still_water_time(problem), problem.schedule.surfacing_time(kLeastHorizonStints - 1));
}

}  // namespace glidehelm::planning
