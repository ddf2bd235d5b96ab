#include "daemon/ingest/water_mean.hpp"

#include <cmath>

#include "daemon/ingest/fault.hpp"

namespace glidehelm::ingest {

void WaterMean::add(std::span<const double> temperature_c, std::span<const double> salinity) {
  const auto wet = [&](std::size_t k) {
    const double t = temperature_c[k], s = salinity[k];
    return !std::isnan(t) && !std::isnan(s) && (t != 0 || s != 0);
  };
  std::size_t deepest = steps_.size();
  while (deepest > 0 && !wet(deepest - 1)) --deepest;
  if (deepest == 0) return;
  ++columns_;
  for (std::size_t k = 0; k < deepest; ++k) {
    if (!wet(k)) continue;
    const double t = temperature_c[k], s = salinity[k];
    if (!impossible_ && !ocean::plausible({Metres{0}, t, s}))
      impossible_ = printed("%.6g °C with salinity %.6g, allowed is -3 to 45 °C and 0 to 45", t, s);
    by_deepest_[deepest - 1][k].add(t, s);
    if (k > 0 && wet(k - 1)) steps_[k].add(t - temperature_c[k - 1], s - salinity[k - 1]);
  }
}

std::size_t WaterMean::reached_by_half() const {
  std::size_t level = by_deepest_.size(), reached = 0;
  while (level > 0 && 2 * reached < columns_) {
    --level;
    reached += by_deepest_[level][level].count;  // every column has water at its deepest level
  }
  return level;
}

std::vector<ocean::WaterLayer> WaterMean::layers(std::span<const double> depths_m) const {
  std::vector<ocean::WaterLayer> layers;
  if (columns_ == 0) return layers;
  const std::size_t half = reached_by_half();
  for (std::size_t k = 0; k <= half; ++k) {
    Sum sum;
    for (std::size_t deepest = half; deepest < by_deepest_.size(); ++deepest) sum.add(by_deepest_[deepest][k]);
    const auto n = static_cast<double>(sum.count);
    if (sum.count > 0) layers.push_back({Metres{depths_m[k]}, sum.temperature / n, sum.salinity / n});
  }
  for (std::size_t k = half + 1; k < steps_.size() && steps_[k].count > 0; ++k) {
    const auto& step = steps_[k];
    const auto n = static_cast<double>(step.count);
    const auto& above = layers.back();
    layers.push_back(
        {Metres{depths_m[k]}, above.temperature_c + step.temperature / n, above.salinity + step.salinity / n});
  }
  return layers;
}

}  // namespace glidehelm::ingest
