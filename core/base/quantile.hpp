#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace glidehelm {

/// The share q (0 to 1) of values, with linear interpolation between the two nearest; none of nothing. O(n log n).
inline std::optional<double> quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const double at = q * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at), high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

}  // namespace glidehelm
