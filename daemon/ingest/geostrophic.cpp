#include "daemon/ingest/geostrophic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/local_metric.hpp"

namespace glidehelm::ingest {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The slope at a node from its neighbours at the distances `back` (towards smaller) and `ahead`, NaN when neither has a
/// height.
double slope(double before, double here, double behind, double back, double ahead) {
  const double down = (here - before) / back, up = (behind - here) / ahead;
  if (std::isnan(down)) return up;
  if (std::isnan(up)) return down;
  return (down * ahead + up * back) / (back + ahead);
}

bool closes_around_globe(const std::vector<double>& lons) {
  double widest = 0;
  for (std::size_t i = 1; i < lons.size(); ++i) widest = std::max(widest, lons[i] - lons[i - 1]);
  return 360.0 - (lons.back() - lons.front()) <= 1.001 * widest;
}

/// The current from the heights of one time; `at` are the heights of that time.
struct Plane {
  const ocean::GridAxes& axes;
  const std::vector<double>& heights;
  bool around_globe;

  [[nodiscard]] std::size_t rows() const { return axes.lats_deg.size(); }
  [[nodiscard]] std::size_t columns() const { return axes.lons_deg.size(); }
  [[nodiscard]] double height(std::size_t j, std::size_t i) const { return heights[j * columns() + i]; }

  [[nodiscard]] double northward(std::size_t j, std::size_t i) const {
    const auto& lats = axes.lats_deg;
    const double before = j > 0 ? height(j - 1, i) : kNone, behind = j + 1 < rows() ? height(j + 1, i) : kNone;
    const double back = j > 0 ? lats[j] - lats[j - 1] : 1, ahead = j + 1 < rows() ? lats[j + 1] - lats[j] : 1;
    return slope(before, height(j, i), behind, back * kDegree, ahead * kDegree);
  }
  [[nodiscard]] double eastward(std::size_t j, std::size_t i) const {
    const auto& lons = axes.lons_deg;
    const std::size_t last = columns() - 1;
    const double seam = lons.front() + 360 - lons.back();
    const double before = i > 0 ? height(j, i - 1) : around_globe ? height(j, last) : kNone;
    const double behind = i < last ? height(j, i + 1) : around_globe ? height(j, 0) : kNone;
    const double back = i > 0 ? lons[i] - lons[i - 1] : seam, ahead = i < last ? lons[i + 1] - lons[i] : seam;
    return slope(before, height(j, i), behind, back * kDegree, ahead * kDegree);
  }
};

}  // namespace

double normal_gravity(double lat_rad) {
  const double s2 = std::sin(lat_rad) * std::sin(lat_rad);
  return 9.7803253359 * (1 + 0.00193185265241 * s2) / std::sqrt(1 - LocalMetric::kEccentricity2 * s2);
}

double coriolis(double lat_rad) { return 2 * 7.292115e-5 * std::sin(lat_rad); }

std::size_t geostrophic_currents(ocean::Grid& grid, double equator_band_deg) {
  const auto& axes = grid.axes;
  const std::size_t rows = axes.lats_deg.size(), columns = axes.lons_deg.size(), level = rows * columns;
  const std::size_t slices = axes.nodes() / level;
  const bool around_globe = closes_around_globe(axes.lons_deg);
  std::size_t left_out = 0;
  std::vector<double> heights(level);
  for (std::size_t k = 0; k < slices; ++k) {
    float* values = grid.values.data() + 2 * k * level;
    for (std::size_t n = 0; n < level; ++n) heights[n] = static_cast<double>(values[2 * n]);
    const Plane plane{axes, heights, around_globe};
    for (std::size_t j = 0; j < rows; ++j) {
      const double lat = axes.lats_deg[j] * kDegree;
      const bool near_equator = std::abs(axes.lats_deg[j]) < equator_band_deg || axes.lats_deg[j] == 0;
      const auto metric = LocalMetric::at(lat);
      const double factor = near_equator ? kNone : normal_gravity(lat) / coriolis(lat);
      for (std::size_t i = 0; i < columns; ++i) {
        const std::size_t n = j * columns + i;
        const bool has_height = !std::isnan(heights[n]);
        if (near_equator && has_height && k == 0) ++left_out;
        const double east = has_height ? -factor * plane.northward(j, i) / metric.meridian_radius : kNone;
        const double north = has_height ? factor * plane.eastward(j, i) / metric.parallel_radius : kNone;
        const bool known = std::isfinite(east) && std::isfinite(north);
        values[2 * n] = static_cast<float>(known ? east : kNone);
        values[2 * n + 1] = static_cast<float>(known ? north : kNone);
      }
    }
  }
  return left_out;
}

}  // namespace glidehelm::ingest
