#include "core/ocean/time_axis.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glidehelm::ocean {

namespace {

/// `t` folded into [start, start + cycle).
double folded(double t, double start) {
  double phase = std::fmod(t - start, kTidalCycle);
  if (phase < 0) phase += kTidalCycle;
  return start + phase;
}

double slope(Interpolation how, std::span<const double> t, std::span<const double> v, std::size_t k) {
  const auto secant = [&](std::size_t i) { return (v[i + 1] - v[i]) / (t[i + 1] - t[i]); };
  const std::size_t last = t.size() - 1;
  if (k == 0) return secant(0);
  if (k == last) return secant(last - 1);
  const double before = secant(k - 1), behind = secant(k);
  if (how == Interpolation::cubic) {
    const double h0 = t[k] - t[k - 1], h1 = t[k + 1] - t[k];
    return (before * h1 + behind * h0) / (h0 + h1);
  }
  const double far_before = k >= 2 ? secant(k - 2) : before;
  const double far_behind = k + 2 <= last ? secant(k + 1) : behind;
  const double weight_before = std::abs(far_behind - behind), weight_behind = std::abs(before - far_before);
  const double sum = weight_before + weight_behind;
  return sum > 0 ? (weight_before * before + weight_behind * behind) / sum : 0.5 * (before + behind);
}

}  // namespace

TimeAxis::TimeAxis(std::vector<double> times_s, bool meaningful, OutsideTime policy)
    : times_{std::move(times_s)}, meaningful_{meaningful}, policy_{policy} {}

std::optional<TimeBracket> TimeAxis::bracket(double t_s) const {
  if (!meaningful_) return TimeBracket{};
  if (std::isnan(t_s)) return std::nullopt;
  const double first = times_.front(), last = times_.back();
  double t = t_s;
  if (t < first || t > last) {
    if (policy_ == OutsideTime::forbid) return std::nullopt;
    if (policy_ == OutsideTime::cycle && last - first >= kTidalCycle)
      t = t > last ? folded(t, last - kTidalCycle) : folded(t, first);
    t = std::clamp(t, first, last);
  }
  const auto above = std::upper_bound(times_.begin(), times_.end(), t);
  const auto k = static_cast<std::size_t>(above - times_.begin()) - 1;
  if (k + 1 == times_.size() || t == times_[k]) return TimeBracket{k, k, 0.0};
  return TimeBracket{k, k + 1, (t - times_[k]) / (times_[k + 1] - times_[k])};
}

double TimeAxis::step_ratio() const {
  double ratio = 1;
  for (std::size_t k = 2; k < times_.size(); ++k) {
    const double r = (times_[k] - times_[k - 1]) / (times_[k - 1] - times_[k - 2]);
    ratio = std::max({ratio, r, 1 / r});
  }
  return ratio;
}

double interpolate_in_time(Interpolation how, std::span<const double> t, std::span<const double> v, std::size_t k,
                           double fraction) {
  if (how == Interpolation::nearest) return fraction < 0.5 ? v[k] : v[k + 1];
  if (how == Interpolation::linear) return v[k] + fraction * (v[k + 1] - v[k]);
  const double h = t[k + 1] - t[k], s = fraction;
  const double m0 = slope(how, t, v, k) * h, m1 = slope(how, t, v, k + 1) * h;
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * v[k] + (s3 - 2 * s2 + s) * m0 + (3 * s2 - 2 * s3) * v[k + 1] + (s3 - s2) * m1;
}

double overshoot_bound(Interpolation how, double step_ratio) {
  if (how == Interpolation::nearest || how == Interpolation::linear) return 1.0;
  return 1.0 + std::sqrt(2.0) * (8.0 / 27.0) * 2.0 * step_ratio;
}

}  // namespace glidehelm::ocean
