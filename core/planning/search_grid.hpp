#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ocean/field.hpp"

namespace glidehelm::planning {

/// The cells that merge surfacings of a search: about square, of a given size in metres at every latitude, in rows of equal
/// latitude steps. Longitudes run on, so the antimeridian is no seam; the box ends where the field does.
///
/// A row has its own number of columns (its parallel is shorter near the poles), so cells keep their size to 80° and beyond.
/// Memory: 4 bytes per cell in the search; the box is the part of `coverage` within `reach` of the middle of the way. When that
/// would be more than `kMostCells`, the cells are enlarged and `cell_size` says so.
class SearchGrid {
 public:
  static constexpr std::int64_t kMostCells = 8'000'000;

  /// `middle`: of start and goal, radians, longitude unwrapped from the start; `reach` in metres.
  SearchGrid(double middle_lat, double middle_lon, double reach, double cell_size, const ocean::Coverage& coverage);

  /// Index of the cell of a position, or −1 outside the box.
  [[nodiscard]] std::int32_t cell(double lat, double lon) const {
    const double row = (lat - south_) * per_lat_;
    if (!(row >= 0) || row >= static_cast<double>(rows_.size())) return -1;
    const auto& r = rows_[static_cast<std::size_t>(row)];
    const double column = (lon - west_) * r.per_lon;
    if (!(column >= 0) || column >= r.columns) return -1;
    return r.first + static_cast<std::int32_t>(column);
  }
  [[nodiscard]] std::size_t cells() const { return cells_; }
  [[nodiscard]] double cell_size() const { return cell_size_; }

 private:
  struct Row {
    std::int32_t first{};
    double columns{};
    double per_lon{};  ///< cells per radian
  };
  void lay_out(double north, double east);

  double south_{}, west_{}, per_lat_{}, cell_size_{};
  std::vector<Row> rows_;
  std::size_t cells_{};
};

}  // namespace glidehelm::planning
