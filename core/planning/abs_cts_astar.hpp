#pragma once

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// CTS-A* with adaptive bearing sampling (Thesis 4.4.3): the search of cts_astar.hpp, with the M headings of each surfacing drawn
/// where the current helps and where the goal lies (AdaptiveHeadings) instead of spread evenly. What the Thesis wants of it is a
/// smaller M at the same quality; docs/performance.md has what it gives here.
///
/// `Problem::headings` is M, `Problem::seed` the seed: the same seed gives the same plan, others differ. A closest approach,
/// land, budgets and cells are as in CtsAStar. Beyond it an expansion costs one current sample, 72 square roots and M arc sines,
/// and 8 bytes per label.
class AbsCtsAStar final : public Planner {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "abs-cts-astar"; }
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.time_varying = true, .obstacles = true};
  }
  /// `Budget::work` counts the expansions of all searches.
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;
};

}  // namespace glidehelm::planning
