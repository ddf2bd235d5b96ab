#include "core/planning/optimization.hpp"

#include <optional>
#include <string>
#include <utility>

#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/path_keeping.hpp"

namespace glidehelm::planning {

namespace {

/// Both methods; they differ in what is made of the straight way.
class Answer {
 public:
  Answer(std::string method, bool grows, const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart,
         const OptimizationSettings& settings, const Budget& budget)
      : method_{std::move(method)},
        grows_{grows},
        problem_{problem},
        ocean_{ocean},
        chart_{chart},
        settings_{settings},
        purse_{budget} {}

  Expected<Plan, PlanFailure> plan() {
    if (purse_.is_empty()) return unexpected(out_of_budget());
    for (const Metres spare : {allowance(problem_), Metres{0}}) {
      if (best_ && (best_->reaches_goal() || !met_land_)) break;
      if (settings_.first != FirstWay::searched) offer(FirstWay::straight, spare);
      if (settings_.first != FirstWay::straight) offer(FirstWay::searched, spare);
    }
    if (!best_) return unexpected(out_of_budget());
    if (!best_->reaches_goal() && best_->stints.empty())
      return unexpected(
          PlanFailure{NoPlan::boxed_in, "no stint leads out of the start that keeps clear of land: " + best_->reason});
    best_->statistics = purse_.spent();
    best_->cut_at = purse_.cut_at();
    return *std::move(best_);
  }

 private:
  [[nodiscard]] PlanFailure out_of_budget() const {
    return {NoPlan::out_of_budget, "the work ended before " + method_ + " had flown a way"};
  }

  void offer(FirstWay first, Metres spare) {
    if (purse_.is_empty()) return;
    WayOptimizer optimizer{problem_, ocean_, chart_, spare, settings_, purse_};
    OptimizedWay way;
    if (first == FirstWay::straight && grows_)
      way = optimizer.grow();
    else
      way = optimizer.improve(first == FirstWay::straight ? optimizer.straight() : optimizer.searched());
    met_land_ = met_land_ || !way.safe;
    auto plan = flown(way);
    if (way.arrives() && !plan.reaches_goal() && !purse_.is_empty()) {
      met_land_ = true;
      Problem inner = problem_;
      auto& goal = std::get<PointGoal>(inner.goal);
      goal.radius = 0.5 * goal.radius;
      WayOptimizer inwards{inner, ocean_, chart_, spare, settings_, purse_};
      auto again = flown(inwards.improve(inwards.measured(way.headings)));
      if (better_than(again, plan)) plan = std::move(again);
    }
    if (!best_ || better_than(plan, *best_)) best_ = std::move(plan);
  }

  [[nodiscard]] Plan flown(const OptimizedWay& way) const {
    std::vector<Heading> headings;
    for (const double h : way.headings) headings.emplace_back(Radians{h});
    // Without an arrival the flight ends with the last heading. A second: times are rounded.
    const double until_s = way.arrives() ? problem_.horizon_s : way.end_s + 1.0;
    return plan_from(method_, fly_path(headings, problem_, ocean_, chart_, until_s), problem_, {});
  }

  std::string method_;
  bool grows_;
  const Problem& problem_;
  const ocean::Ocean& ocean_;
  const chart::Chart& chart_;
  const OptimizationSettings& settings_;
  Purse purse_;
  std::optional<Plan> best_;
  bool met_land_{};  ///< another allowance may mend that
};

Expected<Plan, PlanFailure> plan_by(std::string method, bool grows, const OptimizationSettings& settings,
                                    const Problem& problem, Members members, const chart::Chart& chart,
                                    const Budget& budget, const std::function<void(const Plan&)>& better) {
  if (members.empty()) return unexpected(PlanFailure{NoPlan::no_forecast, "no forecast is given"});
  const auto& ocean = members.front();
  if (auto wrong = check_ends(problem, ocean, chart)) return unexpected(*wrong);
  const Problem within = within_objective(problem);
  auto plan = Answer{std::move(method), grows, within, ocean, chart, settings, budget}.plan();
  if (plan && better) better(*plan);
  return plan;
}

}  // namespace

Expected<Plan, PlanFailure> Optimization::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                               const Budget& budget,
                                               const std::function<void(const Plan&)>& better) const {
  return plan_by("optimization", false, settings_, problem, members, chart, budget, better);
}

Expected<Plan, PlanFailure> IterativeOptimization::plan(const Problem& problem, Members members,
                                                        const chart::Chart& chart, const Budget& budget,
                                                        const std::function<void(const Plan&)>& better) const {
  if (wants_least_distance(problem)) return unexpected(only_least_time("iterative-optimization"));
  return plan_by("iterative-optimization", true, settings_, problem, members, chart, budget, better);
}

}  // namespace glidehelm::planning
