#include "core/planning/to_go.hpp"

#include "core/planning/flight.hpp"

namespace glidehelm::planning {

Envelope reach_of(const Problem& problem, const ocean::Ocean& ocean) {
  return {problem.glider.horizontal_speed.si() + ocean.dive.fastest().si(), ocean.surface.fastest().si(),
          problem.schedule.stint.count(), problem.schedule.surface.count()};
}

ToGo::ToGo(const Problem& problem, const ocean::Ocean& ocean)
    : schedule_{problem.schedule}, radius_{disc_of(problem).radius.si()}, descent_{reach_of(problem, ocean)} {
  if (problem.guidance.heuristic == Heuristic::straight_line)
    descent_.dive = descent_.drift = std::max(descent_.dive, descent_.drift);
}

}  // namespace glidehelm::planning
