#include "core/planning/astar.hpp"

#include <string>
#include <utility>

#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/lattice_search.hpp"
#include "core/planning/path_keeping.hpp"
#include "core/planning/purse.hpp"
#include "core/planning/way_headings.hpp"

namespace glidehelm::planning {

namespace {

std::string reason_for(const LatticeWay& way) {
  if (!way.exhausted) return "the search was stopped before it came to the goal";
  std::string text;
  const auto add = [&text](bool holds, const char* part) {
    if (holds) text += std::string{text.empty() ? "" : ", "} + part;
  };
  add(way.stopped.horizon, "the horizon");
  add(way.stopped.forecast_end, "the end of the forecast");
  add(way.stopped.too_strong, "currents in which no course of the lattice can be held");
  add(way.stopped.margin, "the margin to land and areas");
  add(way.stopped.no_water, "land, missing data or the edge of the forecast's area");
  return text.empty() ? "no segment leads out of the start"
                      : "no way over the lattice reaches the goal; ways end at: " + text;
}

/// A search and the flight along what it found.
struct Attempt {
  LatticeWay way;
  Plan plan;
  bool grounded{};  ///< the way arrives, its flight does not
};

Attempt attempt(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Purse& purse,
                Metres spare) {
  Attempt a{search_lattice(problem, ocean, chart, purse.rest(), spare), {}, false};
  purse.take(a.way.statistics, a.way.cut_at != 0);
  const auto headings = headings_along(a.way.points, problem, ocean, chart, problem.coast_margin + spare);
  // Without an arrival the flight ends with the last heading: steering on to the goal is what the search found impossible.
  const auto stints = static_cast<int>(headings.size());
  const double end = stints == 0 ? 0.0 : problem.schedule.surfacing_time(stints - 1).count();
  const double until_s = a.way.arrives ? problem.horizon_s : problem.start.fix_s + end + 1.0;  // a second: times round
  a.plan = plan_from("astar", fly_path(headings, problem, ocean, chart, until_s), problem, {});
  a.grounded = a.way.arrives && !a.plan.reaches_goal();
  if (!a.way.arrives && !a.plan.reaches_goal()) a.plan.reason = reason_for(a.way);
  return a;
}

}  // namespace

Expected<Plan, PlanFailure> AStar::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                        const Budget& budget, const std::function<void(const Plan&)>& better) const {
  if (members.empty()) return unexpected(PlanFailure{NoPlan::no_forecast, "no forecast is given"});
  const auto& ocean = members.front();
  if (auto wrong = check_ends(problem, ocean, chart)) return unexpected(*wrong);

  Purse purse{budget};
  const Metres spare = allowance(problem);
  auto best = attempt(problem, ocean, chart, purse, spare);
  // What the chart's margin stopped may be mended by another allowance.
  const bool mendable = best.grounded || (!best.plan.reaches_goal() && best.way.exhausted);
  if (mendable && best.way.stopped.margin && purse.cut_at() == 0) {
    auto again = attempt(problem, ocean, chart, purse, best.grounded ? 3 * spare : Metres{});
    if (better_than(again.plan, best.plan)) best = std::move(again);
  }
  if (!best.plan.reaches_goal() && best.plan.stints.empty()) {
    if (!best.way.exhausted)
      return unexpected(PlanFailure{NoPlan::out_of_budget, "the search was stopped before its first stint"});
    return unexpected(PlanFailure{NoPlan::boxed_in, "no stint leads nearer to the goal: " + best.plan.reason});
  }
  best.plan.statistics = purse.spent();
  best.plan.cut_at = purse.cut_at();
  if (better) better(best.plan);
  return std::move(best.plan);
}

}  // namespace glidehelm::planning
