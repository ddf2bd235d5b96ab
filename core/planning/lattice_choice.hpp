#pragma once

#include <cstdint>

namespace glidehelm::planning {

/// Kinds of grid for A* (lattice.hpp).
enum class GridKind : std::uint8_t { regular, irregular, triangular };

/// The nodes that A* goes over, and how many of them are neighbours (lattice.hpp).
struct LatticeChoice {
  int neighbours{16};  ///< 8, 16 or 24; on triangles 6, 12 or 18
  int radius{1};       ///< how often neighbours' neighbours are neighbours, in new directions; 1 to 4
  GridKind grid{GridKind::regular};
  friend bool operator==(const LatticeChoice&, const LatticeChoice&) = default;
};

}  // namespace glidehelm::planning
