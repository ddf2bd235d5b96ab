#include "core/planning/triangle_lattice.hpp"

#include <algorithm>

#include "core/base/local_metric.hpp"

namespace glidehelm::planning {

TriangleLattice::TriangleLattice(double seed_lat, double seed_lon, double side, double south, double north, double west,
                                 double east)
    : side_{side} {
  const auto metric = LocalMetric::at(seed_lat);
  per_row_ = side * std::sqrt(0.75) / metric.meridian_radius;
  per_column_ = side / metric.parallel_radius;
  const double row = side * std::sqrt(0.75);
  seed_row_ = static_cast<int>(std::ceil(south / row));
  seed_column_ = static_cast<int>(std::ceil(west / side));
  rows_ = seed_row_ + static_cast<int>(std::ceil(north / row)) + 1;
  columns_ = seed_column_ + static_cast<int>(std::ceil(east / side)) + 2;  // one for the shift of half a column
  south_ = seed_lat - seed_row_ * per_row_;
  west_ = seed_lon - (seed_column_ + shift(seed_row_)) * per_column_;
  for (int i = 0; i + 1 < rows_; ++i) {
    const double lat = south_ + i * per_row_;
    const double lower = LocalMetric::at(lat).parallel_radius, upper = LocalMetric::at(lat + per_row_).parallel_radius;
    const auto middle = LocalMetric::at(lat + 0.5 * per_row_);
    strips_.push_back({per_column_ * middle.parallel_radius, per_row_ * middle.meridian_radius,
                       std::min(lower, upper) / middle.parallel_radius,
                       std::max(lower, upper) / middle.parallel_radius});
  }
}

TriangleLattice::Triangle TriangleLattice::triangle(std::size_t index) const {
  const bool down = index % 2 == 1;
  const int cell = static_cast<int>(index / 2), row = cell / (columns_ - 1), column = cell % (columns_ - 1);
  const Strip& strip = strips_[static_cast<std::size_t>(row)];
  // The upper row lies half a column to the east of an even row, half a column to the west of an odd one.
  const bool even = row % 2 == 0;
  if (down)
    return {node(row + 1, column),
            node(row + 1, column + 1),
            node(row, column + (even ? 1 : 0)),
            strip.base,
            -strip.height,
            strip.narrowest,
            strip.widest};
  return {node(row, column), node(row, column + 1), node(row + 1, column + (even ? 0 : 1)), strip.base, strip.height,
          strip.narrowest,   strip.widest};
}

TriangleLattice::Around TriangleLattice::around(std::size_t of) const {
  const int row = static_cast<int>(of) / columns_, column = static_cast<int>(of) % columns_;
  Around all;
  const auto add = [&](int strip, int first, bool down) {
    if (strip < 0 || strip >= rows_ - 1 || first < 0 || first >= columns_ - 1) return;
    all.triangle[static_cast<std::size_t>(all.count++)] = static_cast<std::uint32_t>(index(strip, first, down));
  };
  add(row, column - 1, false);
  add(row, column, false);
  add(row, column - (row % 2 == 0 ? 1 : 0), true);
  add(row - 1, column - 1, true);
  add(row - 1, column, true);
  add(row - 1, column - ((row - 1) % 2 == 0 ? 0 : 1), false);
  return all;
}

bool TriangleLattice::locate(double lat, double lon, Within& found) const {
  const double y = (lat - south_) / per_row_;
  double lon_from_middle = lon - (west_ + 0.5 * columns_ * per_column_);
  if (!(std::abs(lon_from_middle) <= kPi)) lon_from_middle = std::remainder(lon_from_middle, 2 * kPi);
  const double x = 0.5 * columns_ + lon_from_middle / per_column_;
  if (!(y >= 0 && y < rows_ - 1)) return false;
  const int row = static_cast<int>(y);
  const bool even = row % 2 == 0;
  const double up = y - row, along = x - shift(row) - (even ? 0.5 : -0.5) * up;
  if (!(along >= 0 && along < columns_ - 1)) return false;
  const int column = static_cast<int>(along);
  const double part = along - column;
  const bool upright = even ? part <= 1 - up : part >= up;
  found.index = index(row, column, !upright);
  found.apex = upright ? up : 1 - up;
  found.right = even ? (upright ? part : part - (1 - up)) : (upright ? part - up : part);
  found.left = 1 - found.apex - found.right;
  return true;
}

}  // namespace glidehelm::planning
