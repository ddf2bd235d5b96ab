#include "core/model/dive_schedule.hpp"

#include <cmath>

namespace glidehelm::model {

Seconds DiveSchedule::dive_time(int k) const {
  if (k == 0) return time_to_dive;
  return time_to_dive + first_stint + surface + (k - 1) * (stint + surface);
}

Seconds DiveSchedule::travel_time(Seconds underwater) const {
  if (underwater <= first_stint) return time_to_dive + underwater;
  const double full = std::ceil((underwater - first_stint) / stint);  // stints after the first that are begun
  return time_to_dive + underwater + full * surface;
}

}  // namespace glidehelm::model
