#pragma once

#include <cstdint>
#include <vector>

#include "core/planning/planner.hpp"
#include "core/planning/triangle_lattice.hpp"

namespace glidehelm::planning {

/// How a glider can move in one triangle, at any time of a problem: over ground with `(east, north)` plus up to `speed` in any
/// direction when it dives, with `(drift_east, drift_north)` plus up to `drift_spread` when it drifts. m/s.
///
/// Currents are the means over the triangle; what they change with time, and by how much a jet of the curvature seen may be faster, is in
/// `speed` and `drift_spread`.
struct TriangleWater {
  double east{}, north{}, speed{};
  double drift_east{}, drift_north{}, drift_spread{};
  bool open{};  ///< false: no way keeps its clearance inside, or there is no water
};

/// The water of all triangles.
struct LatticeWater {
  std::vector<TriangleWater> triangles;
  std::uint64_t current_evaluations{};
};

/// Samples both fields at the nodes and in the middles of the triangles: once where the field is the same for ever, else from the fix to
/// the horizon at up to `kMostInstants` instants, hourly where that is enough.
///
/// Closed are triangles inside land or areas, also where every place has less clearance than a way, its start and its goal keep, and
/// those without current in all of them and in all that touch them. O(nodes · instants).
LatticeWater water_of(const TriangleLattice& lattice, const Problem& problem, const ocean::Ocean& ocean,
                      const chart::Chart& chart);
inline constexpr int kMostInstants = 25;

}  // namespace glidehelm::planning
