#include "core/planning/envelope.hpp"

namespace glidehelm::planning {

Envelope reach_of(const Problem& problem, const ocean::Ocean& ocean) {
  return {problem.glider.horizontal_speed.si() + ocean.dive.fastest().si(), ocean.surface.fastest().si(),
          problem.schedule.stint.count(), problem.schedule.surface.count()};
}

}  // namespace glidehelm::planning
