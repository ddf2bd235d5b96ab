#include "core/planning/refined_cts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/flown_refinement.hpp"
#include "core/planning/path_keeping.hpp"
#include "core/planning/purse.hpp"
#include "core/planning/refinement.hpp"
#include "core/planning/to_go.hpp"

namespace glidehelm::planning {

namespace {

/// How the other searches differ from the first.
struct Variant {
  double cell;      ///< times the usual one
  double headings;  ///< times the problem's
};
constexpr std::array<Variant, 2> kVariants{{{2.0, 2.0}, {3.0, 1.0}}};
/// Where no flight comes near what the refined ways promise: at the goal a list may be carried past the disc that held headings meet, and other
/// ways come in otherwise.
constexpr std::array<Variant, 4> kOthers{{{1.0, 1.0}, {1.0, 2.0}, {1.4, 1.0}, {0.7, 1.0}}};

/// Of the travel time: a flight that is later than its way by more is worth other searches.
constexpr double kMuchLater = 3e-3;

void keep_earlier(vehicle::FlownList& flown, vehicle::FlownList other) {
  if (other.arrival_s && (!flown.arrival_s || *other.arrival_s < *flown.arrival_s)) flown = std::move(other);
}

/// The problem with a smaller disc to arrive in.
Problem with_radius(const Problem& problem, double share) {
  Problem inner = problem;
  auto& goal = std::get<PointGoal>(inner.goal);
  goal.radius = share * goal.radius;
  return inner;
}

/// Headings, and one more stint towards the goal, for a flight that is late.
std::vector<Heading> with_one_more(std::span<const Heading> headings, GeoPoint from, const Problem& problem) {
  std::vector<Heading> longer{headings.begin(), headings.end()};
  longer.emplace_back(geodesic(from, disc_of(problem).centre).departing.from_north());
  return longer;
}

/// Refinement and flights under one purse and one chart.
class Polish {
 public:
  Polish(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Purse& purse, SharedToGo& to_go)
      : problem_{problem}, ocean_{ocean}, chart_{chart}, purse_{purse}, to_go_{to_go} {}

  [[nodiscard]] Refined polish(const std::vector<Heading>& headings) { return polish(headings, problem_); }

  /// The polished way as the lists that will be emitted. Where the law carries the glider past the goal the rest of the way is polished again as
  /// it goes; and since the shortest way may only graze the goal's disc, ways to a smaller disc are flown where that does not help.
  [[nodiscard]] vehicle::FlownList fly(const Refined& way, double until_s) {
    auto flown = fly_path(way.headings, problem_, ocean_, chart_, until_s);
    if (flown.arrival_s || std::isnan(way.arrival_s)) return flown;
    keep_earlier(flown, fly(way.headings, until_s, problem_));
    for (const double share : {0.9, 0.5}) {
      if (flown.arrival_s || purse_.is_empty()) break;
      const auto inner = with_radius(problem_, share);
      const auto way_in = polish(with_one_more(way.headings, problem_.start.fix, problem_), inner);
      if (way_in.headings.empty() || std::isnan(way_in.arrival_s)) continue;
      keep_earlier(flown, fly(way_in.headings, until_s, inner));
    }
    return flown;
  }

  /// A plan that was flown to the goal, improved under the glider's own law.
  void improve_flown(Plan& plan) {
    if (!plan.reaches_goal() || purse_.is_empty()) return;
    const auto refined = refine_flown(plan, problem_, ocean_, chart_, purse_.rest());
    purse_.take(refined.statistics, refined.cut);
    if (refined.flown) plan = plan_from(plan.method, *refined.flown, problem_, {});
  }

  [[nodiscard]] CtsSearch search_variant(const Variant& variant) {
    Problem other = problem_;
    other.headings = static_cast<int>(std::lround(variant.headings * problem_.headings));
    CtsSettings settings{allowance(problem_), variant.cell * cell_of(problem_), 1e18};
    settings.to_go = &to_go_.get(purse_);
    auto found = search(other, ocean_, chart_, purse_.rest(), settings);
    purse_.take(found.statistics, found.cut_at != 0);
    return found;
  }

 private:
  /// With the allowance that a searched plan has beside the margin, or as much of it as the way itself keeps.
  [[nodiscard]] Refined polish(const std::vector<Heading>& headings, const Problem& problem) {
    for (const double share : {1.0, 0.5, 0.0}) {
      if (purse_.is_empty() || headings.empty()) break;
      auto tried =
          refine(headings, problem, ocean_, chart_, problem.coast_margin + share * allowance(problem), purse_.rest());
      purse_.take(tried.statistics, tried.cut);
      if (tried.kept_margin) return tried;
    }
    return {};
  }
  /// `aim`: the problem that headings are made anew for.
  [[nodiscard]] vehicle::FlownList fly(const std::vector<Heading>& headings, double until_s, const Problem& aim) {
    return fly_path(headings, problem_, ocean_, chart_, until_s,
                    [&](int k, GeoPoint dive, double dive_s, std::span<const Heading> rest) {
                      return polish_rest(k, dive, dive_s, rest, aim);
                    });
  }
  /// The rest of a way, from a dive. What does not arrive is left as it was.
  [[nodiscard]] std::vector<Heading> polish_rest(int k, GeoPoint dive, double dive_s, std::span<const Heading> rest,
                                                 const Problem& problem) {
    Problem left = problem;
    left.start = {dive, dive_s};
    left.schedule.time_to_dive = Seconds{0};
    left.schedule.first_stint = problem.schedule.stint_length(k);
    auto polished = polish(with_one_more(rest, dive, problem), left);
    if (polished.headings.empty() || std::isnan(polished.arrival_s)) return {rest.begin(), rest.end()};
    return std::move(polished.headings);
  }

  const Problem& problem_;
  const ocean::Ocean& ocean_;
  const chart::Chart& chart_;
  Purse& purse_;
  SharedToGo& to_go_;
};

}  // namespace

RefinedPlan refined(std::span<const Plan> plans, const Problem& problem, const ocean::Ocean& ocean,
                    const chart::Chart& chart, Purse& purse, SharedToGo& to_go) {
  Polish polish{problem, ocean, chart, purse, to_go};
  RefinedPlan answer{plans.front(), std::nan("")};
  Plan& best = answer.plan;
  for (const auto& plan : plans.subspan(1))
    if (better_than(plan, best)) best = plan;
  const auto reason = best.reason;
  const auto later = [&](double arrival_s, double share) {
    return arrival_s + share * (arrival_s - problem.start.fix_s);
  };
  const auto offer = [&](const Refined& way, const std::string& method, double until_s) {
    if (way.headings.empty()) return;
    if (!std::isnan(way.arrival_s) && !(way.arrival_s >= answer.held_arrival_s)) answer.held_arrival_s = way.arrival_s;
    if (best.reaches_goal()) {
      if (!(way.arrival_s < best.arrival_s)) return;  // a flight is hardly ever earlier than what it keeps to
      until_s = std::min(until_s, later(best.arrival_s, kSameValley));
    }
    auto flown = plan_from(method, polish.fly(way, until_s), problem, {});
    if (!flown.reaches_goal()) flown.reason = reason;
    polish.improve_flown(flown);
    if (better_than(flown, best)) best = std::move(flown);
  };
  for (const auto& plan : plans) {
    if (purse.is_empty()) break;
    // Without an arrival the flight ends with the last heading. A second: times are rounded.
    const double until_s =
        plan.reaches_goal() || plan.stints.empty() ? problem.horizon_s : plan.stints.back().surface_s + 1.0;
    offer(polish.polish(headings_of(plan, problem, ocean, chart)), plan.method + "-refined", until_s);
  }
  std::vector<double> others;  // epoch seconds of arrivals, NaN without
  const auto search_otherwise = [&](const Variant& variant) {
    const auto found = polish.search_variant(variant);
    double arrival_s = std::nan("");
    if (!std::isnan(found.arrival_s)) {
      const auto way = polish.polish(found.headings);
      offer(way, "cts-astar-refined", problem.horizon_s);
      arrival_s = way.arrival_s;
    }
    others.push_back(arrival_s);
  };
  const auto near_the_best = [&](double arrival_s) { return arrival_s <= later(answer.held_arrival_s, kSameValley); };
  for (const auto& variant : kVariants)
    if (!purse.is_empty()) search_otherwise(variant);
  answer.in_doubt = !std::all_of(others.begin(), others.end(), near_the_best);
  for (const auto& variant : kOthers)
    if (!std::isnan(answer.held_arrival_s) && !(best.arrival_s <= later(answer.held_arrival_s, kMuchLater)) &&
        !purse.is_empty())
      search_otherwise(variant);
  return answer;
}

Expected<Plan, PlanFailure> RefinedCts::plan(const Problem& asked, Members members, const chart::Chart& chart,
                                             const Budget& budget,
                                             const std::function<void(const Plan&)>& better) const {
  const Problem problem = within_objective(asked);
  SharedToGo to_go{problem, members, chart};
  auto searched = plan_by_cts("cts-astar", HeadingSampling::uniform, problem, members, chart, budget, better, &to_go);
  if (!searched) return searched;
  Purse purse{budget};
  purse.take(searched->statistics, searched->cut_at != 0);
  if (purse.is_empty()) return searched;
  auto plan = refined({&*searched, 1}, problem, members.front(), chart, purse, to_go).plan;
  plan.statistics = purse.spent();
  plan.cut_at = purse.cut_at();
  if (better) better(plan);
  return plan;
}

}  // namespace glidehelm::planning
