#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glidehelm::ocean {

/// Where a coordinate lies on an axis: between `cell` and `cell + 1`, at `fraction` in [0, 1].
struct AxisPlace {
  std::size_t cell{};
  double fraction{};
};

/// One ascending axis of a grid (latitudes or longitudes, radians), with constant-time search.
///
/// An axis whose nodes lie on a straight line to within the rounding of a float in degrees is taken as that line: files
/// store 1/12° steps as floats, and the wobble of the last digit is theirs, not the model's (it is at most 2e-4 of a
/// cell, else the axis counts as uneven). An uneven axis is searched through a table of equal bins, at most a few nodes
/// per bin.
class GridAxis {
 public:
  GridAxis() = default;
  /// Precondition: at least two nodes, ascending, finite, in degrees.
  explicit GridAxis(const std::vector<double>& degrees);

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] double first() const { return first_; }
  [[nodiscard]] double last() const { return last_; }
  [[nodiscard]] bool contains(double x) const { return x >= first_ && x <= last_; }
  [[nodiscard]] bool uniform() const { return uniform_; }
  /// Cells per radian of a uniform axis.
  [[nodiscard]] double cells_per_radian() const { return cells_per_radian_; }
  [[nodiscard]] double node(std::size_t k) const { return nodes_[k]; }

  /// Precondition: contains(x).
  [[nodiscard]] AxisPlace place(double x) const { return uniform_ ? uniform_place(x) : uneven_place(x); }
  [[nodiscard]] AxisPlace uniform_place(double x) const {
    const double at = (x - first_) * cells_per_radian_;
    auto cell = static_cast<std::size_t>(static_cast<std::int64_t>(at));
    if (cell > cells_ - 1) cell = cells_ - 1;
    return {cell, at - static_cast<double>(static_cast<std::int64_t>(cell))};
  }
  [[nodiscard]] AxisPlace uneven_place(double x) const {
    auto bin = static_cast<std::size_t>(static_cast<std::int64_t>((x - first_) * bins_per_radian_));
    if (bin >= bins_.size()) bin = bins_.size() - 1;
    std::size_t cell = bins_[bin];
    while (cell + 1 < cells_ && x >= nodes_[cell + 1]) ++cell;
    return {cell, (x - nodes_[cell]) * per_width_[cell]};
  }

 private:
  std::vector<double> nodes_, per_width_;
  std::vector<std::uint32_t> bins_;  ///< bin → the last node at or below its start
  double first_{}, last_{}, cells_per_radian_{}, bins_per_radian_{};
  std::size_t cells_{};
  bool uniform_{};
};

}  // namespace glidehelm::ocean
