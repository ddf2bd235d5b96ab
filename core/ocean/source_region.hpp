#pragma once

#include <vector>

#include "core/base/geo.hpp"

namespace glidehelm::ocean {

/// Where a source counts, drawn with edges that are straight in latitude and longitude, so that a box is a box. Less than
/// 180° wide; empty: everywhere.
class SourceRegion {
 public:
  SourceRegion() = default;
  explicit SourceRegion(std::vector<GeoPoint> corners);
  [[nodiscard]] bool everywhere() const { return corners_.empty(); }
  /// Even-odd; a position on an edge may count as either. Radians. O(corners).
  [[nodiscard]] bool contains(double lat, double lon) const;
  [[nodiscard]] const std::vector<GeoPoint>& corners() const { return corners_; }
  friend bool operator==(const SourceRegion&, const SourceRegion&) = default;

 private:
  std::vector<GeoPoint> corners_;
  std::vector<double> lons_;  ///< of the corners, running on across the antimeridian
  double middle_{};           ///< between the westernmost and the easternmost
};

}  // namespace glidehelm::ocean
