#pragma once

#include "core/planning/optimized_way.hpp"
#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// `optimization`: the headings of a fixed number of stints, all of them at once, for the least distance to the goal at the end
/// (Thesis 4.6, eqs. 4.21–4.28).
///
/// Idea: the end of the flight is a function of the headings, f(x_0, B); a general kernel of NLopt minimises its squared
/// distance to the goal. Derivatives come from lanes flown side by side (flight_end.hpp); land is a constraint
/// (optimization_kernel.hpp). A kernel finds the best way of the valley that it begins in, so it begins twice, with the
/// straight way and with that of a coarse CTS-A* (4.6.2), and the better flown plan counts.
///
/// - **MinDistanceAt** is its own problem: as many stints as surface by then (3.3), one run.
/// - **MinTime**: the number of stints is that of the first way, and the instant that counts is its arrival. Bringing down the distance at
///   that instant makes the way earlier; so again at the new instant, until that no longer pays. A first way that does not
///   arrive is optimised for least distance at the horizon.
///
/// Unlike the Thesis the result is flown as the lists that will be emitted (path_keeping.hpp), with an allowance beside the coastal margin, and
/// stands or falls by that flight. Where the way arrives and its flight misses the disc, it is optimised for half the radius.
///
/// Complexity: one evaluation with slopes is seven lanes over all stints; `sqp` solves a dense problem of n headings, O(n³), at each. `Budget::work` counts evaluations of kernels and
/// expansions of the search together; the clock is asked at every evaluation.
class Optimization final : public Planner {
 public:
  explicit Optimization(OptimizationSettings settings = {}) : settings_{settings} {}
  [[nodiscard]] std::string_view name() const noexcept override { return "optimization"; }
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.time_varying = true, .obstacles = true};
  }
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;

 private:
  OptimizationSettings settings_;
};

/// `iterative-optimization`: the earliest arrival by a growing number of stints (Thesis 4.6.1, Algorithm 4.4, with its erratum;
/// WayOptimizer::grow).
///
/// The straight first way grows from an optimistic number of stints; the searched one is long enough already and is made shorter, as the
/// Thesis does with its intelligent initialization. MinTime only: with a given instant the number of stints is known, and
/// the answer is that `optimization` is the method. Else as `Optimization`.
class IterativeOptimization final : public Planner {
 public:
  explicit IterativeOptimization(OptimizationSettings settings = {}) : settings_{settings} {}
  [[nodiscard]] std::string_view name() const noexcept override { return "iterative-optimization"; }
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.time_varying = true, .obstacles = true};
  }
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;

 private:
  OptimizationSettings settings_;
};

}  // namespace glidehelm::planning
