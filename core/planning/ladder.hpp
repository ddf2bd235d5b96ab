#pragma once

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// `best`: stages from cheap to good, the best answer so far at every moment (product.md 4.4, 6).
///
/// direct → cts-astar → refinement of the better of the two and of other searches (refined_cts.hpp) → where those searches end in valleys that differ
/// by more than a hundredth, or do not arrive, `iterative-optimization`, which begins and moves otherwise → where the goal is not reached within
/// two dozen stints, `optimization`, whose native problem the least distance is, by each of its kernels with slopes. Each stage stops by work;
/// `Budget::expired` only cuts it short. A plan keeps the name of the stage that made it, and the answer is never worse than that of any single
/// stage: a later one replaces an earlier one only when it is better.
class Ladder final : public Planner {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "best"; }
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.time_varying = true, .obstacles = true};
  }
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;
};

}  // namespace glidehelm::planning
