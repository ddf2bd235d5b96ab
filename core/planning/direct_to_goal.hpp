#pragma once

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// `direct`: at every surfacing the heading is the bearing to the goal, whatever the currents (Thesis 4.2). What the glider does
/// by itself when its list is the goal alone, and the answer that everything else is measured against.
///
/// Complexity: one flight, a few milliseconds. Sees time-varying currents only by drifting in them; grounding ends it.
class DirectToGoal final : public Planner {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "direct"; }
  [[nodiscard]] Capabilities capabilities() const noexcept override { return {}; }
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;
};

}  // namespace glidehelm::planning
