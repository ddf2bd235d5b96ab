#include "core/planning/sector_grid.hpp"

#include <cmath>

namespace glidehelm::planning {

Radians SectorGrid::cone() const { return Radians{2 * std::atan(1.0 / sectors)}; }

}  // namespace glidehelm::planning
