#pragma once

#include <optional>

#include "core/base/units.hpp"
#include "core/planning/lattice_choice.hpp"

namespace glidehelm::planning {

/// Eichhorn's rectangular grids of 1, 2 and 3 sectors (section 2.1, Fig. 1): edges lead from a vertex to all that lie up to so
/// many rows and columns away and are not hidden behind a nearer one: 8, 16 and 32 directions. (The 31 successors that section 2.2.2
/// counts are the 32 less the one that the way comes from.)
struct SectorGrid {
  int sectors{3};                   ///< 1 to 3
  std::optional<Metres> spacing{};  ///< of rows and columns; none: the merging cell of the problem
  friend bool operator==(const SectorGrid&, const SectorGrid&) = default;

  /// The grid as a lattice: the ring of eight, and what more rings add in new directions (lattice.hpp).
  [[nodiscard]] LatticeChoice lattice() const { return {8, sectors, GridKind::regular}; }
  /// Δφ_max of ZTVE: twice the widest gap between neighbouring directions, which is atan(1/sectors): 90°, 53° and 37°. The paper gives no
  /// number; its Fig. 3 selects five edges of 31, which one and a half gaps do. But then the best way of one start in five is lost on
  /// Eichhorn's own jet (tests/bench/eichhorn.cpp); with two it is found from all.
  [[nodiscard]] Radians cone() const;
};

}  // namespace glidehelm::planning
