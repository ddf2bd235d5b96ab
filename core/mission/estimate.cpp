#include "core/mission/estimate.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::mission {

namespace {
constexpr std::size_t kNewest = 7, kEnough = 5;
constexpr int kGuessCountsAs = 2, kForSpread = 3;
constexpr double kNormal = 1.4826;  // standard deviation of a normal sample by its median distance
}  // namespace

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

void Estimate::see(double observed) {
  if (!std::isfinite(observed)) return;
  ++count_;
  newest_.push_back(observed);
  if (newest_.size() > kNewest) newest_.erase(newest_.begin());
}

double Estimate::value() const {
  auto values = newest_;
  if (values.size() < kEnough) values.insert(values.end(), kGuessCountsAs, guess_);
  return median_of(std::move(values));
}

double Estimate::spread() const {
  if (count_ < kForSpread) return guess_spread_;
  std::vector<double> off;
  const double middle = value();
  for (const double v : newest_) off.push_back(std::abs(v - middle));
  return std::max(floor_, kNormal * median_of(std::move(off)));
}

}  // namespace glidehelm::mission
