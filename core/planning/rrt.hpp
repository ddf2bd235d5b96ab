#pragma once

#include "core/planning/lattice_search.hpp"
#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// `rrt`: two rapidly-exploring random trees, one from the start and one from the goal (Slides, `RRT_Glider`; Thesis 4.5, after Rao and
/// Williams 2009).
///
/// Idea: draw a place, let the nodes nearest to it grow towards it, keep the new node that comes nearest; the tree from the goal
/// grows in reverse. Where the trees meet, a way is found; the quickest of several is taken. Growth says what is possible and asks
/// little of what is good: it is fast, and its ways are crooked. It is here to be compared with.
///
///  - **Segments** are straight and at most as long as a stint through still water (a sixth of the way when that is less), at the times
///    of the constrained motion model (segment_time.hpp); courses that cannot be held, land, and water without data end them.
///  - **Random(Destination)** is the other tree's root once in ten times (the bias of Thesis 4.5), else anywhere in a box round start and goal
///    that is half the way wider on all sides.
///  - **GenerateSuccessors** asks the five nearest nodes (k-nearest RRT), so that one that cannot move against a current does not stop the
///    growth there.
///  - **GetNewTrajectory** joins the two new nodes to all nodes of the other tree within one segment.
///  - **Static currents only** (Thesis 4.5): the tree from the goal knows no times. Where currents change with time within the horizon, the
///    answer is `unsuited_method` with where and by how much. That is looked for at 25 places and four times.
///
/// The generator is its own, seeded with `Problem::seed`: same seed, same trees. The way of nodes is followed with one heading for each stint and
/// flown as the lists that will be emitted, as that of `astar` is (searched_plan.hpp, docs/decisions/023); the best flight of the three
/// quickest ways counts. `Budget::work` counts rounds of growth, at most `kMostRounds`. MinTime only.
///
/// Complexity: O(n) per round for the nearest of n nodes; 48 bytes a node.
class Rrt final : public Planner {
 public:
  static constexpr std::uint64_t kMostRounds = 10'000;
  static constexpr int kWays = 20;  ///< TRAJ_TO_BE_FOUND

  [[nodiscard]] std::string_view name() const noexcept override { return "rrt"; }
  [[nodiscard]] Capabilities capabilities() const noexcept override { return {.obstacles = true}; }
  [[nodiscard]] Expected<Plan, PlanFailure> plan(const Problem& problem, Members members, const chart::Chart& chart,
                                                 const Budget& budget,
                                                 const std::function<void(const Plan&)>& better) const override;
};

/// What the trees found, before it is flown.
struct RrtWays {
  std::vector<std::vector<WayPoint>>
      ways;  ///< the quickest first; without a meeting the way to the node nearest to the goal
  bool arrives{};
  Statistics statistics;
  std::uint64_t cut_at{};  ///< as in Plan
  bool exhausted{};        ///< ended by itself
  bool met_margin{};
};
/// Grows both trees, with segments `allowance` beyond the coastal margin.
RrtWays grow_trees(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, const Budget& budget,
                   Metres allowance);

}  // namespace glidehelm::planning
