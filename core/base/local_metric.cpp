#include "core/base/local_metric.hpp"

#include <algorithm>

namespace glidehelm {

double distance_lower_bound(double lat0, double lon0, double lat1, double lon1) {
  constexpr double kSmallestRadius = LocalMetric::kEquatorialRadius * (1.0 - LocalMetric::kEccentricity2);
  const double sin_dlat = std::sin(0.5 * (lat1 - lat0));
  const double sin_dlon = std::sin(0.5 * (lon1 - lon0));
  const double h = sin_dlat * sin_dlat + std::cos(lat0) * std::cos(lat1) * sin_dlon * sin_dlon;
  return 2.0 * kSmallestRadius * std::asin(std::sqrt(std::clamp(h, 0.0, 1.0)));
}

}  // namespace glidehelm
