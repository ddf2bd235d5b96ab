#include "core/planning/search_grid.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"

namespace glidehelm::planning {

SearchGrid::SearchGrid(double middle_lat, double middle_lon, double reach, double cell_size,
                       const ocean::Coverage& coverage)
    : cell_size_{cell_size} {
  // Radii of the sphere that makes the box the larger, so that nothing within reach falls out of it.
  const double lat_reach = reach / 6'335'439.0;
  south_ = std::max(middle_lat - lat_reach, coverage.south);
  const double north = std::min(middle_lat + lat_reach, coverage.north);
  // A circle of angular radius a around latitude φ spans asin(sin a / cos φ) of longitude, all of it when it holds a pole.
  const double ratio = std::sin(std::min(lat_reach, kPi / 2)) / std::max(1e-9, std::cos(middle_lat));
  const double lon_reach = lat_reach >= kPi / 2 || ratio >= 1 ? kPi : std::asin(ratio);
  west_ = middle_lon - lon_reach;
  double east = middle_lon + lon_reach;
  if (coverage.east - coverage.west < 2 * kPi - 1e-9) {
    // The coverage's longitudes are brought next to the middle's before the boxes are cut.
    double shift = 0;
    const double centre = 0.5 * (coverage.west + coverage.east);
    while (centre + shift < middle_lon - kPi) shift += 2 * kPi;
    while (centre + shift > middle_lon + kPi) shift -= 2 * kPi;
    west_ = std::max(west_, coverage.west + shift);
    east = std::min(east, coverage.east + shift);
  }
  lay_out(north, east);
  while (static_cast<std::int64_t>(cells_) > kMostCells) {
    cell_size_ *= 1.25 * std::sqrt(static_cast<double>(cells_) / static_cast<double>(kMostCells));
    lay_out(north, east);
  }
}

void SearchGrid::lay_out(double north, double east) {
  const auto rows = static_cast<std::int64_t>(std::max(1.0, std::ceil((north - south_) * 6'378'137.0 / cell_size_)));
  cells_ = 0;
  rows_.clear();
  if (rows > kMostCells) {
    cells_ = static_cast<std::size_t>(rows);
    return;
  }
  const double height = std::max(1e-12, (north - south_) / static_cast<double>(rows));
  per_lat_ = 1.0 / height;
  rows_.reserve(static_cast<std::size_t>(rows));
  for (std::int64_t i = 0; i < rows; ++i) {
    const double lat = south_ + (static_cast<double>(i) + 0.5) * height;
    const double width = std::max(0.0, east - west_);
    const double columns = std::max(1.0, std::ceil(width * LocalMetric::at(lat).parallel_radius / cell_size_));
    rows_.push_back({static_cast<std::int32_t>(std::min<std::size_t>(cells_, 1U << 30)), columns,
                     width > 0 ? columns / width : 0.0});
    cells_ += static_cast<std::size_t>(columns);
  }
}

}  // namespace glidehelm::planning
