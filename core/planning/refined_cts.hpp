#pragma once

#include <span>

#include "core/planning/planner.hpp"
#include "core/planning/purse.hpp"

namespace glidehelm::planning {

class SharedToGo;

/// CTS-A* with its plan polished (refinement.hpp): what service emits.
///
/// The search is good at choosing the valley (which side of an eddy or an island) and loses 0.5 to 4 % to its cells and
/// headings; refinement is good at the rest. So the searched plan is refined, and so are the ways of two other searches, with
/// coarser cells and more headings, which now and then choose another valley. The earliest arrival counts.
///
/// The refined way is flown as the lists that will be emitted (path_keeping.hpp) and that flight is refined once more under the glider's own law
/// (flown_refinement.hpp). The plan is never worse than the searched one: where it would be, that one is the answer under its own name.
class RefinedCts final : public Planner {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "cts-astar-refined"; }
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.time_varying = true, .obstacles = true};
  }
  /// `Budget::work` counts expansions of searches and rounds of refinement together.
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;
};

/// What `refined` made of plans.
struct RefinedPlan {
  Plan plan;
  /// Epoch second at which the earliest of the refined ways arrives as it was polished, each heading held for its whole stint; NaN when none
  /// does. The plan is later by what the glider's law loses in the last minutes of each stint, when it steers to the next point of its list.
  double held_arrival_s{};
  /// The other searches did not all end in the same valley: one does not arrive, or arrives, refined, more than `kSameValley` later or earlier
  /// than the best. Then yet another valley may be better still.
  bool in_doubt{};
};
inline constexpr double kSameValley = 0.01;  ///< of the travel time
/// The best of the plans (at least one), of what refinement makes of each, and, where one reaches the goal, of the refined ways of
/// other searches, within what the purse still holds. A plan that was polished is called after the one that it began as:
/// "cts-astar-refined", "direct-refined". `to_go`: of the same problem.
RefinedPlan refined(std::span<const Plan> plans, const Problem& problem, const ocean::Ocean& ocean,
                    const chart::Chart& chart, Purse& purse, SharedToGo& to_go);

}  // namespace glidehelm::planning
