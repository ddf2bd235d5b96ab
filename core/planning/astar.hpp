#pragma once

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// The classical A* over a lattice of nodes (Thesis 4.3, Algorithm 4.1; Garau, "The path planner").
///
/// Idea: straight segments between neighbouring nodes, each at the time that a vehicle takes which holds its course against the
/// current (constrained motion model, core/vehicle/constrained_motion.hpp). What a lattice cannot offer is lost: directions between its
/// own, and courses that a strong current makes infeasible although drifting with it would lead on (Thesis Figure 4.5). It is here to
/// be compared with; CTS-A* is what service uses.
///
/// Parts: lattice.hpp (nodes and neighbours), segment_time.hpp (times with recursive splitting), lattice_search.hpp (the search),
/// way_headings.hpp.
///
/// **From nodes to stints.** A way of nodes knows no surfacings. So that plans can be compared, its times are those of a glider that
/// spends its schedule's shares of time below and at the surface (MeanMotion), and after the search the way is followed on
/// the schedule itself: one heading for each stint (headings_along), flown like every plan as the lists that will be emitted
/// (fly_path). That flight, surface drifts included, is the plan. It may be faster than the search says, because a stint cuts
/// the lattice's corners, and slower, because it meets the currents beside the way.
///
/// `Problem::lattice` chooses neighbours, radius and kind of grid, `Problem::cell` the spacing (0: half a stint through still water).
/// When the goal is not reached the plan is a closest approach, and its reason says what ended the ways. `Budget::work` counts
/// expansions; `expired` is asked every 64.
class AStar final : public Planner {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "astar"; }
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.time_varying = true, .obstacles = true};
  }
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;
};

}  // namespace glidehelm::planning
