#pragma once

#include <algorithm>
#include <cstdint>

#include "core/planning/potential.hpp"

namespace glidehelm::planning {

/// The least time that is left to the goal, from everywhere: a potential on a fine lattice around start and goal, whose rim is told by one on a
/// lattice three times as coarse that reaches four times as far beyond start and goal, whose rim is told by the distance over U + |c|max
/// (docs/decisions/032). O(n log n) in the nodes, some 10^4 of them.
class CostToGo {
 public:
  CostToGo(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart);

  /// V, s; 0 where nothing is known. Radians.
  [[nodiscard]] double at(double lat, double lon) const {
    auto left = near_.at(lat, lon);
    if (!left) left = far_.at(lat, lon);
    return std::max(0.0, left.value_or(0));
  }
  /// How much V falls per second at most, below and at the surface: s/s.
  [[nodiscard]] double dive_rate() const { return std::max(near_.dive_rate(), far_.dive_rate()); }
  [[nodiscard]] double drift_rate() const { return drift_rate_; }
  [[nodiscard]] std::uint64_t current_evaluations() const {
    return near_.current_evaluations() + far_.current_evaluations();
  }
  [[nodiscard]] const TriangleLattice& lattice() const { return near_.lattice(); }

 private:
  Potential far_, near_;
  double drift_rate_{};
};

}  // namespace glidehelm::planning
