#pragma once

#include <algorithm>
#include <cstdint>

namespace glidehelm::planning {

/// h(n) of CTS-A*: what the time from a surfacing to the goal cannot be less than (to_go.hpp). From the weakest to the strongest;
/// each is admissible and consistent (the last one as far as its lattice resolves the currents: docs/decisions/032).
enum class Heuristic : std::uint8_t {
  straight_line,  ///< Thesis 4.1: the distance over U + |c|max
  envelope,       ///< the same on the dive schedule: dives at U + |c|max, drifts at |c|max of the surface
  cost_to_go      ///< the least time through the water that there is, on the dive schedule (cost_to_go.hpp)
};

/// What h(n) is multiplied by in f(n) = g(n) + (1 + ε·ω)·h(n).
enum class Weighting : std::uint8_t {
  none,      ///< nothing: ω = 0
  constant,  ///< Thesis 4.9 (Pohl 1969), `static` in a mission: ω = 1
  by_depth  ///< Thesis 4.10–4.11 (Pohl 1973), `dynamic` in a mission: ω falls from 1 at the start to 0 at the depth of the goal
};

/// How CTS-A* is led to the goal.
///
/// A weighted search arrives at most (1 + ε) times later than the best arrival among its labels: as long as the best one is not
/// found an ancestor of it is open, whose f is at most g + (1 + ε)·h ≤ (1 + ε)·(g + h), and g + h is not later than that arrival.
/// Both ω lie in [0, 1]; more is not needed of them. What the weighted f says of the horizon is no proof: that is told by g + h.
struct Guidance {
  Heuristic heuristic{Heuristic::cost_to_go};
  Weighting weighting{Weighting::none};
  double weight{0.1};  ///< ε ≥ 0

  /// 1 + ε·ω after `stints` of `anticipated` > 0 (N, the expected length of the solution).
  [[nodiscard]] double factor(int stints, double anticipated) const {
    switch (weighting) {
      case Weighting::none:
        return 1.0;
      case Weighting::constant:
        return 1.0 + weight;
      case Weighting::by_depth:
        return 1.0 + weight * std::max(0.0, 1.0 - stints / anticipated);
    }
    return 1.0;
  }
  friend bool operator==(const Guidance&, const Guidance&) = default;
};

}  // namespace glidehelm::planning
