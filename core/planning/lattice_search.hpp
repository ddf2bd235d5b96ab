#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// A place of a way and when it is passed.
struct WayPoint {
  double lat{}, lon{};  ///< radians; longitudes run on
  double t_s{};         ///< epoch seconds
  double margin_m{};    ///< clearance to keep from here
};

/// How a search over nodes goes about it.
struct LatticeRules {
  LatticeChoice grid;
  Metres spacing{0};        ///< 0: cell_of(problem)
  Metres allowance{0};      ///< clearance beyond the coastal margin
  bool estimates{true};     ///< A*; false: Dijkstra's algorithm, h = 0
  bool beyond_goal{false};  ///< goes on until every node has its time (Eichhorn's Table 4 counts TVE so)
  std::optional<Radians>
      cone{};  ///< Δφ_max around the optimal course within which edges are examined (ZTVE); none: all are
  bool step_control{false};  ///< times of edges by travel_time (Eichhorn), else by segment_time (Garau)
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

/// One search in time-varying currents (Thesis Algorithm 4.1, Garau; Eichhorn Tables 1 and 2): nodes of `grid`, edges at the times of
/// segment_time.hpp or travel_time.hpp, each at least `allowance` beyond the coastal margin from land.
///
/// - **Time** is that of the arrival at the node that an edge begins at: d_v = wfunc(u, v, d[u]) + d[u] (erratum of Eichhorn's Table 2). An
///   edge to a node that is already reached earlier than its beginning is not examined.
/// - **Start and goal.** The start is the place of the first dive, and a node. The goal is a disc and lies on no node: a node within reach
///   has one more neighbour, straight on to the goal, and a segment that enters the disc arrives there.
/// - **Heuristic** 4.1, Eichhorn eq. 1: distance to the disc over the greatest speed over ground, with the bound of the whole field and period
///   (erratum: a patch around the node is not admissible), and a lower bound of the distance (erratum: not its square).
/// - **Cone.** Behind the first node only edges within Δφ_max of optimal_course are examined, |wrap(φ_opt − φ_path)| < Δφ_max (erratum).
///   Zermelo's formula does not hold along land: within an edge of the margin, and towards the goal's disc, all are.
/// - **Re-opening.** A node that is reached earlier after it was expanded is opened again; ways are never rewired.
/// - **Land.** Segments keep the margin in force, as in CtsAStar; water without data is a wall.
/// - Ties of f go to the label created first. At most `kMostLabels` labels.
///
/// O(nodes · neighbours) segments, each some 3 to 15 samples of both currents. Memory: 4 bytes per node, 48 per label.
LatticeWay search_lattice(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart,
                          const Budget& budget, const LatticeRules& rules);
/// Why a way does not arrive, in words.
std::string reason_for(const LatticeWay& way);

}  // namespace glidehelm::planning
