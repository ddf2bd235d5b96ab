#include "core/planning/mean_motion.hpp"

namespace glidehelm::planning {

MeanMotion::MeanMotion(const Problem& problem, const ocean::Ocean& ocean)
    : ocean_{ocean},
      under_{problem.schedule.stint.count() / (problem.schedule.stint + problem.schedule.surface).count()},
      speed_{under_ * problem.glider.horizontal_speed.si()},
      fastest_{speed_ + under_ * ocean.dive.fastest().si() + (1 - under_) * ocean.surface.fastest().si()} {}

Expected<Current, NoPassage> MeanMotion::current(double lat, double lon, double t_s) const {
  const auto at = GeoPoint::from_kernel(lat, lon);
  const auto dive = ocean_.dive.sample(at, t_s), surface = ocean_.surface.sample(at, t_s);
  for (const auto* sample : {&dive, &surface})
    if (!*sample)
      return unexpected(sample->error() == ocean::NoCurrent::outside_time ? NoPassage::forecast_end
                                                                          : NoPassage::no_current);
  return Current{under_ * dive->current.east + (1 - under_) * surface->current.east,
                 under_ * dive->current.north + (1 - under_) * surface->current.north};
}

}  // namespace glidehelm::planning
