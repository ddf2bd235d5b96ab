#include "daemon/ingest/even_depths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace glidehelm::ingest {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_even(const std::vector<double>& axis) {
  const double step = (axis.back() - axis.front()) / static_cast<double>(axis.size() - 1);
  for (std::size_t k = 0; k < axis.size(); ++k)
    if (!(std::abs(axis.front() + step * static_cast<double>(k) - axis[k]) <= 0.01 * step)) return false;
  return true;
}

struct Span {
  double low{kInfinity}, high{-kInfinity};
  void take(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

/// A mesh with a rim of unknown points around it, so that its outer cells have an end.
struct Rimmed {
  std::size_t rows, columns;
  std::vector<double> lats, lons, depths;
  explicit Rimmed(const DepthMesh& mesh)
      : rows{mesh.rows + 2},
        columns{mesh.columns + 2},
        lats(rows * columns),
        lons(rows * columns),
        depths(rows * columns, std::numeric_limits<double>::quiet_NaN()) {
    // Outside lies what the two outermost points say.
    const auto value = [&](const std::vector<double>& of, std::size_t row, std::size_t column) {
      const auto inner = [&](std::size_t k, std::size_t n) { return k == 0 ? 0 : k > n ? n - 1 : k - 1; };
      const auto next = [&](std::size_t k, std::size_t n) { return k == 0 ? 1 : k > n ? n - 2 : k - 1; };
      const auto at = [&](std::size_t r, std::size_t c) { return of[r * mesh.columns + c]; };
      const auto r0 = inner(row, mesh.rows), r1 = next(row, mesh.rows);
      const auto c0 = inner(column, mesh.columns), c1 = next(column, mesh.columns);
      return at(r0, c0) + (at(r0, c0) - at(r1, c0)) + (at(r0, c0) - at(r0, c1));
    };
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = 0; column < columns; ++column) {
        lats[row * columns + column] = value(mesh.lats, row, column);
        lons[row * columns + column] = value(mesh.lons, row, column);
      }
    for (std::size_t row = 0; row < mesh.rows; ++row)
      for (std::size_t column = 0; column < mesh.columns; ++column)
        depths[(row + 1) * columns + column + 1] = mesh.depths[row * mesh.columns + column];
  }

  /// The box around the cell of a point: the middles of the up to four quadrangles at it.
  [[nodiscard]] bool cell(std::size_t row, std::size_t column, Span& lat, Span& lon) const {
    const std::size_t here = row * columns + column;
    if (!std::isfinite(lats[here]) || !std::isfinite(lons[here])) return false;
    lat.take(lats[here]);
    lon.take(lons[here]);
    for (const int dr : {-1, 0})
      for (const int dc : {-1, 0}) {
        const auto r = static_cast<std::ptrdiff_t>(row) + dr, c = static_cast<std::ptrdiff_t>(column) + dc;
        if (r < 0 || c < 0 || r + 1 >= static_cast<std::ptrdiff_t>(rows) ||
            c + 1 >= static_cast<std::ptrdiff_t>(columns))
          continue;
        const std::size_t k = static_cast<std::size_t>(r) * columns + static_cast<std::size_t>(c);
        const double y = 0.25 * (lats[k] + lats[k + 1] + lats[k + columns] + lats[k + columns + 1]);
        const double x = 0.25 * (lons[k] + lons[k + 1] + lons[k + columns] + lons[k + columns + 1]);
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        lat.take(y);
        lon.take(x);
      }
    return true;
  }
};

}  // namespace

Result<chart::DepthGrid> even_depths(const std::vector<double>& lats, const std::vector<double>& lons,
                                     const std::vector<double>& depths) {
  if (lats.size() < 2 || lons.size() < 2) return fault("a grid of depths has at least 2 by 2 points");
  if (!is_even(lats) || !is_even(lons)) {
    DepthMesh mesh{lats.size(), lons.size(), {}, {}, depths};
    for (const double lat : lats)
      for (const double lon : lons) {
        mesh.lats.push_back(lat);
        mesh.lons.push_back(lon);
      }
    return even_depths(mesh);
  }
  chart::DepthGrid grid;
  grid.west_deg = lons.front();
  grid.south_deg = lats.front();
  grid.lon_step_deg = (lons.back() - lons.front()) / static_cast<double>(lons.size() - 1);
  grid.lat_step_deg = (lats.back() - lats.front()) / static_cast<double>(lats.size() - 1);
  grid.columns = lons.size();
  grid.rows = lats.size();
  // Around the Earth the first column comes again, so that there is no seam.
  const bool around = std::abs(grid.lon_step_deg * static_cast<double>(grid.columns) - 360) < 0.5 * grid.lon_step_deg;
  grid.columns += around ? 1 : 0;
  grid.depths_m.reserve(grid.columns * grid.rows);
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column)
      grid.depths_m.push_back(static_cast<float>(depths[row * lons.size() + column % lons.size()]));
  return grid;
}

Result<chart::DepthGrid> even_depths(const DepthMesh& mesh) {
  if (mesh.rows < 2 || mesh.columns < 2) return fault("a grid of depths has at least 2 by 2 points");
  Span lat, lon;
  for (std::size_t n = 0; n < mesh.lats.size(); ++n)
    if (std::isfinite(mesh.lats[n]) && std::isfinite(mesh.lons[n])) lat.take(mesh.lats[n]), lon.take(mesh.lons[n]);
  if (!(lat.high > lat.low && lon.high > lon.low && lon.high - lon.low <= 360))
    return fault("the positions of the depths span no area");
  chart::DepthGrid grid;
  // As many nodes as the box would hold if the points filled it evenly.
  const double ratio = (lon.high - lon.low) * std::cos(0.5 * (lat.low + lat.high) * kPi / 180) / (lat.high - lat.low);
  const double points = static_cast<double>(mesh.rows * mesh.columns);
  grid.rows = static_cast<std::size_t>(std::clamp(std::round(std::sqrt(points / ratio)), 2.0, points));
  grid.columns = static_cast<std::size_t>(std::clamp(std::round(std::sqrt(points * ratio)), 2.0, points));
  grid.west_deg = lon.low;
  grid.south_deg = lat.low;
  grid.lon_step_deg = (lon.high - lon.low) / static_cast<double>(grid.columns - 1);
  grid.lat_step_deg = (lat.high - lat.low) / static_cast<double>(grid.rows - 1);
  std::vector<double> least(grid.rows * grid.columns, kInfinity);
  const Rimmed rimmed{mesh};
  const auto range = [](const Span& span, double from, double step, std::size_t n) {
    const double top = static_cast<double>(n - 1);
    return std::pair{std::clamp(std::floor((span.low - from) / step), 0.0, top + 1),
                     std::clamp(std::ceil((span.high - from) / step), -1.0, top)};
  };
  for (std::size_t row = 0; row < rimmed.rows; ++row)
    for (std::size_t column = 0; column < rimmed.columns; ++column) {
      Span y, x;
      if (!rimmed.cell(row, column, y, x)) continue;
      const double depth = rimmed.depths[row * rimmed.columns + column];
      const auto [r0, r1] = range(y, grid.south_deg, grid.lat_step_deg, grid.rows);
      const auto [c0, c1] = range(x, grid.west_deg, grid.lon_step_deg, grid.columns);
      for (double r = r0; r <= r1; ++r)
        for (double c = c0; c <= c1; ++c) {
          double& node = least[static_cast<std::size_t>(r) * grid.columns + static_cast<std::size_t>(c)];
          node = std::min(node, std::isnan(depth) ? -kInfinity : depth);
        }
    }
  grid.depths_m.reserve(least.size());
  for (const double depth : least)
    grid.depths_m.push_back(std::isfinite(depth) ? static_cast<float>(depth) : std::numeric_limits<float>::quiet_NaN());
  return grid;
}

}  // namespace glidehelm::ingest
