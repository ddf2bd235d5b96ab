#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/local_metric.hpp"
#include "core/ocean/bilinear.hpp"

namespace glidehelm::ocean {

/// The inverse radii of LocalMetric, tabulated over an interval of latitude: an integrator asks for them at every stage,
/// and a sine and a cosine would cost it more than the current.
///
/// Linear between entries h = 2.5e-4 rad apart, so the relative error is at most h²/8 · (1 + 2 tan²φ): below 5.2e-7 to
/// 80°. Beyond 80° the exact formula is used.
class MetricTable {
 public:
  MetricTable() = default;
  /// For latitudes in [south, north], radians; a margin of one entry on both sides.
  MetricTable(double south, double north) {
    south = std::max(south, -kExactBeyond) - 2 * kSpacing;
    north = std::max(std::min(north, kExactBeyond), south) + 2 * kSpacing;
    first_ = south;
    const auto count = static_cast<std::size_t>((north - south) / kSpacing) + 2;
    entries_.reserve(count);
    for (std::size_t k = 0; k < count; ++k) entries_.push_back(exact(south + static_cast<double>(k) * kSpacing));
  }

  /// (1/(N cos φ), 1/M): radians of longitude per metre of east, of latitude per metre of north. Precondition: lat within
  /// the interval of the constructor.
  [[nodiscard]] Double2 at(double lat) const {
    if (lat > kExactBeyond || lat < -kExactBeyond) return exact(lat);
    const double place = (lat - first_) * (1.0 / kSpacing);
    const int k = static_cast<int>(place);
    const Double2* const entry = entries_.data() + k;
    return entry[0] + (place - static_cast<double>(k)) * (entry[1] - entry[0]);
  }
  static Double2 exact(double lat) {
    const auto metric = LocalMetric::at(lat);
    return Double2{1.0 / metric.parallel_radius, 1.0 / metric.meridian_radius};
  }

  static constexpr double kSpacing = 2.5e-4;
  static constexpr double kExactBeyond = 80.0 * kPi / 180.0;

 private:
  std::vector<Double2> entries_;
  double first_{};
};

}  // namespace glidehelm::ocean
