#include "core/chart/clearance_raster.hpp"

#include <algorithm>
#include <limits>

namespace glidehelm::chart {

namespace {

/// The float at or below a value.
float rounded_down(double v) {
  const auto f = static_cast<float>(v);
  return f > v ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

}  // namespace

ClearanceRaster::ClearanceRaster(const RasterBox& box, double outside, double horizon, const Clearance& clearance)
    : box_{box}, outside_{outside} {
  const double north = box.south + box.height;
  const double widest = box.south * north <= 0 ? 0.0 : std::min(std::abs(box.south), std::abs(north));
  const auto metric = LocalMetric::at(widest);
  const double width_m = box.width * metric.parallel_radius, height_m = box.height * metric.meridian_radius;
  double cell = std::max(kSmallestCell, std::sqrt(width_m * height_m / static_cast<double>(kMostCells)));
  do {
    rows_ = std::max(1.0, std::ceil(height_m / cell));
    columns_ = std::max(1.0, std::ceil(width_m / cell));
    cell *= 1.01;  // rounding up may have added a row and a column too many
  } while (rows_ * columns_ > static_cast<double>(kMostCells));
  rows_per_radian_ = rows_ / box.height;
  columns_per_radian_ = columns_ / box.width;
  stride_ = static_cast<std::size_t>(columns_);
  values_.resize(static_cast<std::size_t>(rows_) * stride_);
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows_); row += kBlock)
    for (std::size_t column = 0; column < stride_; column += kBlock) fill(row, column, kBlock, horizon, clearance);
}

void ClearanceRaster::fill(std::size_t row, std::size_t column, std::size_t size, double horizon,
                           const Clearance& clearance) {
  const auto rows = static_cast<std::size_t>(rows_);
  if (row >= rows || column >= stride_) return;
  const auto last_row = std::min(row + size, rows), last_column = std::min(column + size, stride_);
  const double south = box_.south + static_cast<double>(row) / rows_per_radian_;
  const double half_height = 0.5 * static_cast<double>(last_row - row) / rows_per_radian_;
  const double half_width = 0.5 * static_cast<double>(last_column - column) / columns_per_radian_;
  const double lat = south + half_height;
  const double lon = box_.west + static_cast<double>(column) / columns_per_radian_ + half_width;
  // The way to a corner on the side of the equator is the longest.
  const double radius =
      std::max(length_at_most(lat, half_height, half_width), length_at_most(lat, -half_height, half_width));
  const double found = clearance(lat, lon, horizon + radius);
  ++evaluations_;
  if (size == 1 || (found > 0 ? 2 * radius <= 0.25 * found : radius <= -found)) {
    const float value = rounded_down(std::clamp(found - radius, -horizon, horizon));
    for (auto r = row; r < last_row; ++r)
      std::fill_n(values_.begin() + static_cast<std::ptrdiff_t>(r * stride_ + column), last_column - column, value);
    return;
  }
  const auto half = size / 2;
  fill(row, column, half, horizon, clearance);
  fill(row, column + half, half, horizon, clearance);
  fill(row + half, column, half, horizon, clearance);
  fill(row + half, column + half, half, horizon, clearance);
}

}  // namespace glidehelm::chart
