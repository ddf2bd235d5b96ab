#include "core/vehicle/yo_field.hpp"

#include <algorithm>
#include <cmath>

#include "core/vehicle/yo.hpp"

namespace glidehelm::vehicle {

double YoField::depth(double t_s) const {
  const double since_fix = t_s - fix_s_;
  const double period = (schedule_.stint + schedule_.surface).count(), second_dive = schedule_.dive_time(1).count();
  const double k = since_fix < second_dive ? 0 : 1 + std::floor((since_fix - second_dive) / period);
  const double dive = k < 1 ? schedule_.dive_time(0).count() : second_dive + (k - 1) * period;
  const double length = schedule_.stint_length(k < 1 ? 0 : 1).count();
  return yo_depth(glider_, std::clamp(since_fix - dive, 0.0, length), length);
}

Expected<ocean::Sample, ocean::NoCurrent> YoField::sample(GeoPoint p, Depth, double t_s) const {
  return current_above_bottom(full_, p, depth(t_s), t_s);
}

}  // namespace glidehelm::vehicle
