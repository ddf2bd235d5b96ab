#include "core/ocean/interpolation.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::ocean {

namespace {

double slope(Interpolation how, std::span<const double> x, std::span<const double> v, std::size_t k) {
  const auto secant = [&](std::size_t i) { return (v[i + 1] - v[i]) / (x[i + 1] - x[i]); };
  const std::size_t last = x.size() - 1;
  if (k == 0) return secant(0);
  if (k == last) return secant(last - 1);
  const double before = secant(k - 1), behind = secant(k);
  if (how == Interpolation::cubic) {
    const double h0 = x[k] - x[k - 1], h1 = x[k + 1] - x[k];
    return (before * h1 + behind * h0) / (h0 + h1);
  }
  const double far_before = k >= 2 ? secant(k - 2) : before;
  const double far_behind = k + 2 <= last ? secant(k + 1) : behind;
  const double weight_before = std::abs(far_behind - behind), weight_behind = std::abs(before - far_before);
  const double sum = weight_before + weight_behind;
  return sum > 0 ? (weight_before * before + weight_behind * behind) / sum : 0.5 * (before + behind);
}

}  // namespace

double interpolate(Interpolation how, std::span<const double> x, std::span<const double> v, std::size_t k,
                   double fraction) {
  if (how == Interpolation::nearest) return fraction < 0.5 ? v[k] : v[k + 1];
  if (how == Interpolation::linear) return v[k] + fraction * (v[k + 1] - v[k]);
  const double h = x[k + 1] - x[k], s = fraction;
  const double m0 = slope(how, x, v, k) * h, m1 = slope(how, x, v, k + 1) * h;
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * v[k] + (s3 - 2 * s2 + s) * m0 + (3 * s2 - 2 * s3) * v[k + 1] + (s3 - s2) * m1;
}

double step_ratio(std::span<const double> axis) {
  double ratio = 1;
  for (std::size_t k = 2; k < axis.size(); ++k) {
    const double r = (axis[k] - axis[k - 1]) / (axis[k - 1] - axis[k - 2]);
    ratio = std::max({ratio, r, 1 / r});
  }
  return ratio;
}

double overshoot_bound(Interpolation how, double step_ratio) {
  if (how == Interpolation::nearest || how == Interpolation::linear) return 1.0;
  return 1.0 + std::sqrt(2.0) * (8.0 / 27.0) * 2.0 * step_ratio;
}

}  // namespace glidehelm::ocean
