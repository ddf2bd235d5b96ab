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

}  // namespace glidehelm::ocean
