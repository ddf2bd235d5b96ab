#include "core/planning/cts_astar.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/planning/flight.hpp"
#include "core/planning/searched_plan.hpp"
#include "core/planning/to_go.hpp"

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

/// The searches of one allowance; where nothing arrives within the horizon, also one for the nearest place.
CtsSearch search_far(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Purse& purse,
                     const CtsSettings& settings) {
  auto found = search_finely(problem, ocean, chart, purse, settings);
  if (arrives(found) || !found.exhausted || !found.stopped.horizon || wants_least_distance(problem)) return found;
  CtsSettings farther = settings;
  farther.cell = Metres{found.cell_m};
  farther.nearest = true;
  auto nearer = search(problem, ocean, chart, purse.rest(), farther);
  purse.take(nearer.statistics, nearer.cut_at != 0);
  return nearer.nearest_m < found.nearest_m ? nearer : found;
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

Expected<Plan, PlanFailure> plan_by_cts(const std::string& method, HeadingSampling sampling, const Problem& asked,
                                        Members members, const chart::Chart& chart, const Budget& budget,
                                        const std::function<void(const Plan&)>& better, SharedToGo* shared) {
  const Problem problem = within_objective(asked);
  SharedToGo own{problem, members, chart};
  SharedToGo& to_go = shared ? *shared : own;
  return plan_by_search(problem, members, chart, budget, better, [&](const ocean::Ocean& ocean) -> Search {
    return [&](Purse& purse, Metres allowance) {
      CtsSettings settings;
      settings.to_go = &to_go.get(purse);
      settings.allowance = allowance;
      settings.sampling = sampling;
      auto found = search_far(problem, ocean, chart, purse, settings);
      return Found{method,          {std::move(found.headings)}, arrives(found),
                   found.exhausted, found.stopped.margin,        reason_for(found, problem)};
    };
  });
}

}  // namespace glidehelm::planning
