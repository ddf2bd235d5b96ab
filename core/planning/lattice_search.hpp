#pragma once

#include <cstddef>
#include <vector>

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// A place of a way and when it is passed.
struct WayPoint {
  double lat{}, lon{};  ///< radians; longitudes run on
  double t_s{};         ///< epoch seconds
};

/// What the search over nodes found, before it is flown.
struct LatticeWay {
  std::vector<WayPoint> points;  ///< from the first dive to the goal's disc, or to the node nearest to it
  bool arrives{};
  double arrival_s{};  ///< by the search's own times; NaN when the goal was not reached
  Statistics statistics;
  std::uint64_t cut_at{};  ///< as in Plan
  bool exhausted{};        ///< ended by itself
  struct Stopped {
    bool horizon{}, forecast_end{}, no_water{}, margin{}, too_strong{};
    friend bool operator==(const Stopped&, const Stopped&) = default;
  } stopped;  ///< what ended ways
  double spacing_m{};
};

/// One search (Thesis Algorithm 4.1, Garau): nodes of `Problem::lattice`, segments at the times of segment_time.hpp, each at least
/// `allowance` beyond the coastal margin from land. `spacing` 0: cell_of(problem).
///
/// - **Start and goal.** The start is the place of the first dive, and a node. The goal is a disc and lies on no node: a node within reach
///   has one more neighbour, straight on to the goal, and a segment that enters the disc arrives there.
/// - **Heuristic** 4.1: distance to the disc over the greatest speed over ground, with the bound of the whole field and period (erratum: a
///   patch around the node is not admissible), and a lower bound of the distance (erratum: not its square).
/// - **Re-opening.** A node that is reached earlier after it was expanded is opened again; ways are never rewired.
/// - **Land.** Segments keep the margin in force, as in CtsAStar; water without data is a wall.
/// - Ties of f go to the label created first. At most `kMostLabels` labels.
///
/// O(nodes · neighbours) segments, each some 3 to 15 samples of both currents. Memory: 4 bytes per node, 48 per label.
LatticeWay search_lattice(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart,
                          const Budget& budget, Metres allowance, Metres spacing = Metres{0});

}  // namespace glidehelm::planning
