#pragma once

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// The quickest way as a boundary value problem (Thesis 4.7), for validation where currents are weak.
///
/// The extremal is found by shooting, and by collocation when no shot arrives (extremal.hpp). It is followed with one heading for each stint
/// and flown as the lists that will be emitted, like `astar` (docs/decisions/023, 029). It knows no land: an extremal that leads across it is
/// flown as far as the margin allows, and the plan is a closest approach whose reason says so. Where currents are stronger than the glider,
/// extremals part too fast to be aimed, or none arrives; the reason says that.
///
/// `Budget::work` counts extremals; `expired` is asked before each.
class Zermelo final : public Planner {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "zermelo"; }
  [[nodiscard]] Capabilities capabilities() const noexcept override { return {.time_varying = true}; }
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;
};

}  // namespace glidehelm::planning
