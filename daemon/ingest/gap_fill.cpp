#include "daemon/ingest/gap_fill.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/local_metric.hpp"
#include "core/base/text.hpp"

namespace glidehelm::ingest {

namespace {

/// Where values around a node lie, and their weighted sum.
struct Neighbours {
  std::array<bool, 8> sectors{};
  double weight{}, east{}, north{};

  void add(double dx, double dy, const float* value) {
    const auto sector = static_cast<std::size_t>(std::floor((std::atan2(dy, dx) + kPi) / (kPi / 4))) % 8;
    sectors[sector] = true;
    const double w = 1 / (dx * dx + dy * dy);
    weight += w;
    east += w * static_cast<double>(value[0]);
    north += w * static_cast<double>(value[1]);
  }
  [[nodiscard]] bool on_both_sides() const {
    for (std::size_t s = 0; s < 4; ++s)
      if (sectors[s] && sectors[s + 4]) return true;
    return false;
  }
};

/// Nodes of an ascending axis within `reach` of value k: [first, last].
std::pair<std::size_t, std::size_t> near(const std::vector<double>& axis, std::size_t k, double reach) {
  const auto first = std::lower_bound(axis.begin(), axis.end(), axis[k] - reach);
  const auto behind = std::upper_bound(axis.begin(), axis.end(), axis[k] + reach);
  return {static_cast<std::size_t>(first - axis.begin()), static_cast<std::size_t>(behind - axis.begin()) - 1};
}

}  // namespace

std::size_t fill_gaps(ocean::Grid& grid, double distance_m) {
  const auto& axes = grid.axes;
  const std::size_t rows = axes.lats_deg.size(), columns = axes.lons_deg.size(), plane = rows * columns;
  const std::vector<float> original = grid.values;
  std::vector<bool> filled(axes.nodes(), false);
  std::size_t count = 0;
  for (std::size_t t = 0; t < axes.nodes() / plane; ++t)
    for (std::size_t j = 0; j < rows; ++j) {
      const auto metric = LocalMetric::at(axes.lats_deg[j] * kDegree);
      const auto [first_row, last_row] = near(axes.lats_deg, j, distance_m / metric.meridian_radius / kDegree);
      for (std::size_t i = 0; i < columns; ++i) {
        const std::size_t node = t * plane + j * columns + i;
        if (!std::isnan(original[2 * node])) continue;
        const auto [first, last] = near(axes.lons_deg, i, distance_m / metric.parallel_radius / kDegree);
        Neighbours around;
        for (std::size_t row = first_row; row <= last_row; ++row)
          for (std::size_t column = first; column <= last; ++column) {
            const float* value = original.data() + 2 * (t * plane + row * columns + column);
            if (std::isnan(value[0])) continue;
            const double dy = (axes.lats_deg[row] - axes.lats_deg[j]) * kDegree * metric.meridian_radius;
            const double dx = (axes.lons_deg[column] - axes.lons_deg[i]) * kDegree * metric.parallel_radius;
            if (dx * dx + dy * dy <= distance_m * distance_m) around.add(dx, dy, value);
          }
        if (!around.on_both_sides()) continue;
        grid.values[2 * node] = static_cast<float>(around.east / around.weight);
        grid.values[2 * node + 1] = static_cast<float>(around.north / around.weight);
        filled[node] = true;
        ++count;
      }
    }
  grid.filled = ocean::runs_of(filled);
  return count;
}

double two_cells(const ocean::GridAxes& axes) {
  const auto step = [](const std::vector<double>& axis) {
    return (axis.back() - axis.front()) / static_cast<double>(axis.size() - 1) * kDegree;
  };
  const auto metric = LocalMetric::at(0.5 * (axes.lats_deg.front() + axes.lats_deg.back()) * kDegree);
  return 2 * std::max(step(axes.lats_deg) * metric.meridian_radius, step(axes.lons_deg) * metric.parallel_radius);
}

bool is_radar(const NetcdfFile& file) {
  const auto says = [](const std::string& text) {
    const std::string plain = lower(text);
    for (const char* word :
         {"hf radar", "hf-radar", "hfradar", "high frequency radar", "high-frequency radar", "codar"})
      if (plain.find(word) != std::string::npos) return true;
    return false;
  };
  return std::any_of(file.attributes().begin(), file.attributes().end(),
                     [&](const Attribute& attribute) { return says(attribute.text); }) ||
         std::any_of(file.variables().begin(), file.variables().end(),
                     [&](const Variable& variable) { return says(variable.text("long_name")); });
}

}  // namespace glidehelm::ingest
