#include "core/planning/refined_cts.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/path_keeping.hpp"
#include "core/planning/purse.hpp"
#include "core/planning/refinement.hpp"

namespace glidehelm::planning {

namespace {

/// How the other searches differ from the first.
struct Variant {
  double cell;      ///< times the usual one
  double headings;  ///< times the problem's
};
constexpr std::array<Variant, 2> kVariants{{{2.0, 2.0}, {3.0, 1.0}}};

/// Refinement under one purse and one chart.
class Polish {
 public:
  Polish(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Purse& purse)
      : problem_{problem}, ocean_{ocean}, chart_{chart}, purse_{purse} {}

  /// The allowance that a searched plan has beside the margin, or as much of it as the way itself keeps.
  [[nodiscard]] Refined polish(const std::vector<Heading>& headings) {
    for (const double share : {1.0, 0.5, 0.0}) {
      if (purse_.is_empty() || headings.empty()) break;
      auto tried = refine(headings, problem_, ocean_, chart_, problem_.coast_margin + share * allowance(problem_),
                          purse_.rest());
      purse_.take(tried.statistics, tried.cut);
      if (tried.kept_margin) return tried;
    }
    return {};
  }
  [[nodiscard]] CtsSearch search_variant(const Variant& variant) {
    Problem other = problem_;
    other.headings = static_cast<int>(std::lround(variant.headings * problem_.headings));
    auto found =
        search(other, ocean_, chart_, purse_.rest(), {allowance(problem_), variant.cell * cell_of(problem_), 1e18});
    purse_.take(found.statistics, found.cut_at != 0);
    return found;
  }

 private:
  const Problem& problem_;
  const ocean::Ocean& ocean_;
  const chart::Chart& chart_;
  Purse& purse_;
};

}  // namespace

Plan refined(std::span<const Plan> plans, const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart,
             Purse& purse) {
  Polish polish{problem, ocean, chart, purse};
  Plan best = plans.front();
  for (const auto& plan : plans.subspan(1))
    if (better_than(plan, best)) best = plan;
  const Plan given = best;
  const auto offer = [&](const Refined& way, const std::string& method, double until_s) {
    if (way.headings.empty()) return;
    auto flown = plan_from(method, fly_path(way.headings, problem, ocean, chart, until_s), problem, {});
    if (!flown.reaches_goal()) flown.reason = given.reason;
    if (better_than(flown, best)) best = std::move(flown);
  };
  for (const auto& plan : plans) {
    if (purse.is_empty()) break;
    // Without an arrival the flight ends with the last heading. A second: times are rounded.
    const double until_s =
        plan.reaches_goal() || plan.stints.empty() ? problem.horizon_s : plan.stints.back().surface_s + 1.0;
    offer(polish.polish(headings_of(plan, problem, ocean, chart)), plan.method + "-refined", until_s);
  }
  for (const auto& variant : kVariants) {
    if (!best.reaches_goal() || purse.is_empty()) break;
    const auto found = polish.search_variant(variant);
    if (!std::isnan(found.arrival_s)) offer(polish.polish(found.headings), "cts-astar-refined", problem.horizon_s);
  }
  return best;
}

Expected<Plan, PlanFailure> RefinedCts::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                             const Budget& budget,
                                             const std::function<void(const Plan&)>& better) const {
  auto searched = CtsAStar{}.plan(problem, members, chart, budget, better);
  if (!searched) return searched;
  Purse purse{budget};
  purse.take(searched->statistics, searched->cut_at != 0);
  if (purse.is_empty()) return searched;
  auto plan = refined({&*searched, 1}, problem, members.front(), chart, purse);
  plan.statistics = purse.spent();
  plan.cut_at = purse.cut_at();
  if (better) better(plan);
  return plan;
}

}  // namespace glidehelm::planning
