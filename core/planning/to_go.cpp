#include "core/planning/to_go.hpp"

#include "core/planning/flight.hpp"

namespace glidehelm::planning {

ToGo::ToGo(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart)
    : schedule_{problem.schedule},
      radius_{disc_of(problem).radius.si()},
      descent_{reach_of(problem, ocean)},
      water_descent_{descent_} {
  if (problem.guidance.heuristic == Heuristic::straight_line)
    descent_.dive = descent_.drift = std::max(descent_.dive, descent_.drift);
  // A search for the least distance at an instant is not led by time.
  if (problem.guidance.heuristic != Heuristic::cost_to_go || wants_least_distance(problem)) return;
  water_.emplace(problem, ocean, chart);
  water_descent_.dive = water_->dive_rate();
  water_descent_.drift = water_->drift_rate();
}

const ToGo& SharedToGo::get(Purse& purse) {
  if (!made_) {
    made_.emplace(problem_, members_.front(), chart_);
    Statistics cost;
    cost.current_evaluations = made_->current_evaluations();
    purse.take(cost, false);
  }
  return *made_;
}

}  // namespace glidehelm::planning
