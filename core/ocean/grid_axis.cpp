#include "core/ocean/grid_axis.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/units.hpp"

namespace glidehelm::ocean {

namespace {

constexpr double kFloatRounding = 1.1920929e-7;  // 2^-23: one unit in the last place of a float, relative
constexpr double kWobbleAtMost = 2e-4;           // of a cell

bool on_a_line(const std::vector<double>& degrees) {
  const double first = degrees.front(), last = degrees.back();
  const double step = (last - first) / static_cast<double>(degrees.size() - 1);
  const double allowed = std::min(kFloatRounding * std::max(std::abs(first), std::abs(last)), kWobbleAtMost * step);
  for (std::size_t k = 0; k < degrees.size(); ++k)
    if (std::abs(degrees[k] - (first + static_cast<double>(k) * step)) > allowed) return false;
  return true;
}

}  // namespace

GridAxis::GridAxis(const std::vector<double>& degrees) : cells_{degrees.size() - 1}, uniform_{on_a_line(degrees)} {
  constexpr double kRadians = kPi / 180.0;
  first_ = degrees.front() * kRadians;
  last_ = degrees.back() * kRadians;
  cells_per_radian_ = static_cast<double>(cells_) / (last_ - first_);
  nodes_.resize(degrees.size());
  for (std::size_t k = 0; k < degrees.size(); ++k)
    nodes_[k] = uniform_ ? first_ + static_cast<double>(k) / cells_per_radian_ : degrees[k] * kRadians;
  nodes_.back() = last_;
  per_width_.resize(cells_);
  for (std::size_t k = 0; k < cells_; ++k) per_width_[k] = 1.0 / (nodes_[k + 1] - nodes_[k]);
  if (uniform_) return;

  const std::size_t bins = 4 * cells_;
  bins_per_radian_ = static_cast<double>(bins) / (last_ - first_);
  bins_.resize(bins);
  std::size_t cell = 0;
  for (std::size_t b = 0; b < bins; ++b) {
    // One bin early, so that rounding in the bin's number never starts the search beyond the node.
    const double start = first_ + (static_cast<double>(b) - 1.0) / bins_per_radian_;
    while (cell + 1 < cells_ && nodes_[cell + 1] <= start) ++cell;
    bins_[b] = static_cast<std::uint32_t>(cell);
  }
}

}  // namespace glidehelm::ocean
