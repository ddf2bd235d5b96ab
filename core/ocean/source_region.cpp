#include "core/ocean/source_region.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glidehelm::ocean {

SourceRegion::SourceRegion(std::vector<GeoPoint> corners) : corners_{std::move(corners)} {
  for (const auto& corner : corners_) {
    const double lon = corner.lon.radians();
    lons_.push_back(lons_.empty() ? lon : lons_.back() + std::remainder(lon - lons_.back(), 2 * kPi));
  }
  if (lons_.empty()) return;
  const auto [west, east] = std::minmax_element(lons_.begin(), lons_.end());
  middle_ = 0.5 * (*west + *east);
}

bool SourceRegion::contains(double lat, double lon) const {
  if (corners_.empty()) return true;
  lon = middle_ + std::remainder(lon - middle_, 2 * kPi);
  bool in = false;
  for (std::size_t k = 0, before = corners_.size() - 1; k < corners_.size(); before = k++) {
    const double lat0 = corners_[before].lat.radians(), lat1 = corners_[k].lat.radians();
    if ((lat0 > lat) == (lat1 > lat)) continue;
    if (lons_[before] + (lat - lat0) / (lat1 - lat0) * (lons_[k] - lons_[before]) > lon) in = !in;
  }
  return in;
}

}  // namespace glidehelm::ocean
