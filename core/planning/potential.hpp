#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/planning/lattice_water.hpp"
#include "core/planning/planner.hpp"
#include "core/planning/triangle_lattice.hpp"

namespace glidehelm::planning {

/// A potential V over a lattice of triangles, linear in each of them: a lower bound, in seconds, of the time to the goal's disc, where it is zero at
/// most (docs/decisions/032).
///
/// What makes it a bound is not how it was computed but what it is: with velocities c + w, |w| ≤ U, V falls by U·|∇V| − c·∇V per second at
/// most. That is evaluated in every triangle where a glider can be, and the greatest of all is `dive_rate`: nobody's V falls faster, whatever
/// the heading and whenever it is. `drift_rate` is the same for a drift. Currents count with their means over the triangle and with all that they
/// change until the horizon (lattice_water.hpp). At the rim V is at most what the place beyond is said to be worth.
///
/// Computed from the goal and the rim inwards, each node from two others of a triangle between which the soonest way leads, as often as that makes it
/// sooner; then lowered where V falls by more than 1.005 s/s. What was not reached has more than the horizon. O(n log n) in the nodes where currents
/// are slower than the glider, several times that in others; deterministic.
class Potential {
 public:
  /// `beyond(lat, lon)`: seconds, a lower bound at a place on the rim.
  Potential(TriangleLattice lattice, const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart,
            const std::function<double(double lat, double lon)>& beyond);

  /// V, s; may be negative; 0 in a triangle where nobody can be; none outside the lattice. Radians.
  [[nodiscard]] std::optional<double> at(double lat, double lon) const;
  [[nodiscard]] double dive_rate() const { return dive_rate_; }    ///< s/s, at least 1
  [[nodiscard]] double drift_rate() const { return drift_rate_; }  ///< s/s, not negative
  [[nodiscard]] std::uint64_t current_evaluations() const { return water_.current_evaluations; }
  [[nodiscard]] const TriangleLattice& lattice() const { return lattice_; }

 private:
  void bring_outwards(const vehicle::Disc& goal, const std::function<double(double lat, double lon)>& beyond);
  [[nodiscard]] bool is_swept(std::size_t node) const;
  void level();
  void lower(const TriangleLattice::Triangle& t, const TriangleWater& water, double rate,
             std::vector<std::size_t>& lowered);
  void sink_below(const vehicle::Disc& goal);
  void count_rates();

  TriangleLattice lattice_;
  LatticeWater water_;
  std::vector<double> left_;  ///< V of the nodes
  double dive_rate_{1}, drift_rate_{0};
};

}  // namespace glidehelm::planning
