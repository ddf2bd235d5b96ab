#include "core/ocean/depth_average.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glidehelm::ocean {

namespace {

/// Adds ∫ density · (current between level k and k+1) over [from, to] to the two levels' weights. The current is linear,
/// so the mean over the interval is the value at its middle.
void add_interval(std::vector<double>& weights, std::span<const double> depths, std::size_t k, double from, double to,
                  double density) {
  if (!(to > from) || density == 0) return;
  const double fraction = (0.5 * (from + to) - depths[k]) / (depths[k + 1] - depths[k]);
  weights[k] += density * (to - from) * (1 - fraction);
  weights[k + 1] += density * (to - from) * fraction;
}

}  // namespace

DiveProfile DiveProfile::of_stint(Metres climb_to, Metres dive_depth, MetresPerSecond horizontal, Radians glide_angle,
                                  Seconds stint) {
  const double vertical = horizontal.si() * std::tan(glide_angle.si());
  const double way = 0.5 * vertical * stint.count();  // Δz_out + (n − 1) Δz_in of 2.14
  const double outer = dive_depth.si(), inner = dive_depth.si() - climb_to.si();
  if (way <= outer) return {Metres{std::min(climb_to.si(), way)}, Metres{way}, 1, 1};
  return {climb_to, dive_depth, 1, 1 + (way - outer) / inner};
}

DiveProfile DiveProfile::turned_at(Metres depth) const {
  if (depth >= lower) return *this;
  const double way = upper.si() * above + (lower.si() - upper.si()) * below;
  if (depth <= upper) {
    // Nothing is flown above `upper` of a plain mean either; at a bottom above it, the mean of what there is.
    return {depth, depth, way / depth.si(), 0};
  }
  return {upper, depth, above, (way - upper.si() * above) / (depth.si() - upper.si())};
}

std::vector<double> column_weights(std::span<const double> depths_m, std::size_t wet, const DiveProfile& profile) {
  std::vector<double> weights(depths_m.size(), 0.0);
  const double bottom = depths_m[wet - 1], upper = profile.upper.si(), lower = std::min(profile.lower.si(), bottom);
  if (bottom <= 0) {  // the only wet level lies at the surface: it stands for the whole column
    if (profile.above == 0 && upper > 0) return {};
    weights[wet - 1] = 1;
    return weights;
  }
  const auto over = [&](double from, double to, double density) {
    to = std::min(to, lower);
    // Above the first level its value holds.
    if (const double end = std::min(to, depths_m[0]); end > from) weights[0] += density * (end - from);
    for (std::size_t k = 0; k + 1 < wet; ++k)
      add_interval(weights, depths_m, k, std::max(from, depths_m[k]), std::min(to, depths_m[k + 1]), density);
  };
  over(0, upper, profile.above);
  over(upper, profile.lower.si(), profile.below);
  double sum = 0;
  for (const double weight : weights) sum += weight;
  if (!(sum > 0)) return {};
  for (double& weight : weights) weight /= sum;
  return weights;
}

Grid depth_average(const GridView& grid, const DiveProfile& profile, const TurningDepth& turning) {
  Grid mean{grid.axes, grid.facts, {}};
  const std::size_t levels = grid.axes.depths_m.size(), times = grid.axes.times_s.size();
  const std::size_t plane = grid.axes.lats_deg.size() * grid.axes.lons_deg.size();
  mean.axes.depths_m = {0.0};
  mean.axes.has_depth = false;
  mean.values.assign(2 * plane * times, std::numeric_limits<float>::quiet_NaN());
  if (levels == 1) {
    std::copy(grid.values, grid.values + mean.values.size(), mean.values.begin());
    mean.filled = grid.filled;
    return mean;
  }
  std::vector<std::vector<double>> weights(levels + 1);
  for (std::size_t wet = 1; wet <= levels; ++wet) weights[wet] = column_weights(grid.axes.depths_m, wet, profile);

  // Columns over a near bottom have weights of their own: index into `weights`, by the number of wet levels.
  std::vector<std::size_t> own(plane, 0);
  for (std::size_t n = 0; turning && n < plane; ++n) {
    const std::size_t row = n / grid.axes.lons_deg.size(), column = n % grid.axes.lons_deg.size();
    const double depth = turning(degrees(grid.axes.lats_deg[row]).si(), degrees(grid.axes.lons_deg[column]).si());
    if (!std::isfinite(depth) || depth <= 0 || depth >= profile.lower.si()) continue;
    own[n] = weights.size();
    for (std::size_t wet = 0; wet <= levels; ++wet)
      weights.push_back(wet == 0 ? std::vector<double>{}
                                 : column_weights(grid.axes.depths_m, wet, profile.turned_at(Metres{depth})));
  }

  // A mean is borrowed where a level of its column is.
  std::vector<bool> filled(grid.filled.empty() ? 0 : plane * times, false);
  for (const auto& run : grid.filled)
    for (auto n = run.first; n < run.first + run.length; ++n) filled[n / plane / levels * plane + n % plane] = true;

  std::vector<std::size_t> wet(plane);
  std::vector<double> sums(2 * plane);
  for (std::size_t t = 0; t < times; ++t) {
    const float* column = grid.values + t * levels * plane * 2;
    for (std::size_t n = 0; n < plane; ++n) {
      wet[n] = 0;
      while (wet[n] < levels && !std::isnan(column[2 * (wet[n] * plane + n)])) ++wet[n];
    }
    std::fill(sums.begin(), sums.end(), 0.0);
    // Level by level, so that memory is read in its order.
    for (std::size_t k = 0; k < levels; ++k)
      for (std::size_t n = 0; n < plane; ++n) {
        if (k >= wet[n] || weights[own[n] + wet[n]].empty()) continue;
        const double weight = weights[own[n] + wet[n]][k];
        sums[2 * n] += weight * static_cast<double>(column[2 * (k * plane + n)]);
        sums[2 * n + 1] += weight * static_cast<double>(column[2 * (k * plane + n) + 1]);
      }
    float* out = mean.values.data() + t * plane * 2;
    for (std::size_t n = 0; n < plane; ++n) {
      if (wet[n] == 0 || weights[own[n] + wet[n]].empty()) continue;
      out[2 * n] = static_cast<float>(sums[2 * n]);
      out[2 * n + 1] = static_cast<float>(sums[2 * n + 1]);
    }
  }
  for (std::size_t n = 0; n < filled.size(); ++n) filled[n] = filled[n] && !std::isnan(mean.values[2 * n]);
  mean.filled = runs_of(filled);
  return mean;
}

}  // namespace glidehelm::ocean
