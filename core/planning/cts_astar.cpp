#include "core/planning/cts_astar.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/planning/flight.hpp"
#include "core/planning/path_keeping.hpp"
#include "core/planning/purse.hpp"

namespace glidehelm::planning {

namespace {

std::string hours(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
  return text;
}

std::string reason_for(const CtsSearch& found, const Problem& problem) {
  if (!found.exhausted) return "the search was stopped before it came to the goal";
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (found.stopped.horizon)
    add("no way found reaches the goal within the horizon of " + hours(problem.horizon_s - problem.start.fix_s));
  if (found.stopped.forecast_end) add("the forecast ends before the goal is reached");
  if (found.stopped.margin || found.stopped.no_water)
    add(std::string{found.stopped.margin ? "the margin to land and areas" : ""} +
        (found.stopped.margin && found.stopped.no_water ? ", and " : "") +
        (found.stopped.no_water ? "land, missing data or the edge of the forecast's area" : "") +
        (text.empty() ? " close every way found" : " close others"));
  return text.empty() ? "no heading leads out of the reach of the start" : text;
}

bool arrives(const CtsSearch& found) { return !std::isnan(found.arrival_s); }

/// The search at the problem's cell, and again with finer cells while that is cheap.
CtsSearch search_finely(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Purse& purse,
                        CtsSettings settings) {
  auto best = search(problem, ocean, chart, purse.rest(), settings);
  purse.take(best.statistics, best.cut_at != 0);
  if (problem.cell.si() > 0) return best;
  bool finished = best.exhausted;
  Metres cell{best.cell_m};
  for (int i = 0; i < CtsAStar::kMostHalvings && finished; ++i) {
    if (purse.spent().expansions >= CtsAStar::kCheapExpansions) break;
    cell = 0.5 * cell;
    settings.cell = cell;
    if (arrives(best)) settings.earlier_than_s = best.arrival_s;
    auto finer = search(problem, ocean, chart, purse.rest(), settings);
    purse.take(finer.statistics, finer.cut_at != 0);
    finished = finer.exhausted;
    if (arrives(finer) || (!arrives(best) && finer.nearest_m < best.nearest_m)) best = std::move(finer);
  }
  return best;
}

/// Searches and the flight of what they found.
struct Attempt {
  CtsSearch found;
  Plan plan;
  bool grounded{};  ///< the search arrives, its flight does not
};

Attempt attempt(const std::string& method, const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart,
                Purse& purse, const CtsSettings& settings) {
  Attempt a{search_finely(problem, ocean, chart, purse, settings), {}, false};
  if (!arrives(a.found) && a.found.exhausted && a.found.stopped.horizon) {
    CtsSettings farther = settings;
    farther.cell = Metres{a.found.cell_m};
    farther.nearest = true;
    auto nearer = search(problem, ocean, chart, purse.rest(), farther);
    purse.take(nearer.statistics, nearer.cut_at != 0);
    if (nearer.nearest_m < a.found.nearest_m) a.found = std::move(nearer);
  }
  const bool reaches = arrives(a.found);
  // Without an arrival the flight ends with the last heading: steering on to the goal is what the search found impossible.
  const auto stints = static_cast<int>(a.found.headings.size());
  const double end = stints == 0 ? 0.0 : problem.schedule.surfacing_time(stints - 1).count();
  const double until_s = reaches ? problem.horizon_s : problem.start.fix_s + end + 1.0;  // a second: times round
  const auto flown = fly_path(a.found.headings, problem, ocean, chart, until_s);
  a.plan = plan_from(method, flown, problem, {});
  a.grounded = reaches && !a.plan.reaches_goal();
  if (!reaches && !a.plan.reaches_goal()) a.plan.reason = reason_for(a.found, problem);
  return a;
}

}  // namespace

Metres allowance(const Problem& problem) {
  const Metres way = problem.glider.horizontal_speed * problem.schedule.stint;
  return (vehicle::usual_early_share(problem.glider.current_correction) + 0.005) * way;
}

Expected<Plan, PlanFailure> CtsAStar::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                           const Budget& budget, const std::function<void(const Plan&)>& better) const {
  return plan_by_cts("cts-astar", HeadingSampling::uniform, problem, members, chart, budget, better);
}

Expected<Plan, PlanFailure> plan_by_cts(const std::string& method, HeadingSampling sampling, const Problem& problem,
                                        Members members, const chart::Chart& chart, const Budget& budget,
                                        const std::function<void(const Plan&)>& better) {
  if (members.empty()) return unexpected(PlanFailure{NoPlan::no_forecast, "no forecast is given"});
  const auto& ocean = members.front();
  if (auto wrong = check_ends(problem, ocean, chart)) return unexpected(*wrong);

  Purse purse{budget};
  const Metres spare = allowance(problem);
  CtsSettings settings;
  settings.allowance = spare;
  settings.sampling = sampling;
  auto best = attempt(method, problem, ocean, chart, purse, settings);
  // What the chart's margin stopped may be mended by another allowance.
  const bool mendable = best.grounded || (!best.plan.reaches_goal() && best.found.exhausted);
  if (mendable && best.found.stopped.margin && purse.cut_at() == 0) {
    settings.allowance = best.grounded ? 3 * spare : Metres{};
    auto again = attempt(method, problem, ocean, chart, purse, settings);
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
