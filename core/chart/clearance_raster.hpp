#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "core/chart/space.hpp"

namespace glidehelm::chart {

/// The box that a raster covers, radians; `west` + `width` may exceed π.
struct RasterBox {
  double west{}, width{}, south{}, height{};
};

/// Lower bounds of a clearance on a grid of cells, and upper bounds of distances that go with them.
///
/// The clearance grows by at most one metre per metre (it is a minimum of signed distances), so that inside a cell it is
/// nowhere less than at the centre minus the distance to the farthest corner. Cells are filled by halving: a block whose
/// own radius is small against the clearance at its centre takes one value. So most of a sea costs few evaluations, and
/// a bound lies below the truth by at most the larger of twice a cell's radius and a quarter of the clearance.
class ClearanceRaster {
 public:
  static constexpr std::size_t kMostCells = std::size_t{1} << 20;
  static constexpr double kSmallestCell = 250.0;  ///< metres
  static constexpr std::size_t kBlock = 64;       ///< cells of the side of the largest block
  /// Clearance at a latitude and longitude, exact up to the third argument (clamped to ± that).
  using Clearance = std::function<double(double lat, double lon, double at_most)>;

  /// A raster of one value, everywhere.
  explicit ClearanceRaster(double everywhere) : outside_{everywhere} {}
  /// `outside` is the bound outside the box; values are clamped to ±`horizon`.
  ClearanceRaster(const RasterBox& box, double outside, double horizon, const Clearance& clearance);

  /// Lower bound of the clearance. One array read.
  [[nodiscard]] double at_least(double lat, double lon) const {
    const double row = (lat - box_.south) * rows_per_radian_;
    double x = lon - box_.west;
    if (!(x >= 0 && x < 2 * kPi)) x -= 2 * kPi * std::floor(x / (2 * kPi));
    const double column = x * columns_per_radian_;
    // Written so that a NaN fails it.
    if (!(row >= 0 && row < rows_ && column >= 0 && column < columns_))
      return std::isfinite(lat) && std::isfinite(lon) ? outside_ : -std::numeric_limits<double>::infinity();
    return values_[static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(column)];
  }

  /// Upper bound of the length of the straight way (in latitude and longitude) by `dlat` and `dlon` that begins at `lat`.
  [[nodiscard]] static double length_at_most(double lat, double dlat, double dlon) {
    // Parallels are widest at the latitude nearest to the equator.
    const double end = lat + dlat;
    const double nearest = lat * end <= 0 ? 0.0 : std::min(std::abs(lat), std::abs(end));
    const double north = dlat * kLargestRadius, east = dlon * (kLargestRadius * cosine_at_most(nearest));
    return std::sqrt(north * north + east * east);
  }

  [[nodiscard]] double cell_height() const { return rows_per_radian_ > 0 ? 1 / rows_per_radian_ : 0; }  ///< radians
  [[nodiscard]] std::size_t cells() const { return values_.size(); }
  /// How many clearances were computed for it.
  [[nodiscard]] std::size_t evaluations() const { return evaluations_; }

 private:
  static constexpr double kLargestRadius = 6'399'594.0;  ///< M and N at the poles, metres
  /// cos φ by its series up to φ⁸: the next term is negative, and below 1e-4 up to the pole.
  static double cosine_at_most(double lat) {
    const double s = lat * lat;
    return 1 - s * (1.0 / 2 - s * (1.0 / 24 - s * (1.0 / 720 - s * (1.0 / 40320))));
  }
  void fill(std::size_t row, std::size_t column, std::size_t size, double horizon, const Clearance& clearance);

  RasterBox box_;
  double outside_{};
  double rows_{}, columns_{};  ///< as doubles, for the comparison
  double rows_per_radian_{}, columns_per_radian_{};
  std::size_t stride_{};
  std::vector<float> values_;
  std::size_t evaluations_{};
};

}  // namespace glidehelm::chart
