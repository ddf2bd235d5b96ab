#include "core/planning/winding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include "core/base/local_metric.hpp"

namespace glidehelm::planning {

namespace {

/// Winding numbers of cell middles, by counting along each row the edges that cross it west of a cell.
class Raster {
 public:
  Raster(const std::vector<Marker>& polygon, const Squares& lattice) : lattice_{lattice} {
    double south = 1e9, west = 1e9, north = -1e9, east = -1e9;
    for (const auto& m : polygon) {
      south = std::min(south, row_of(m));
      north = std::max(north, row_of(m));
      west = std::min(west, column_of(m));
      east = std::max(east, column_of(m));
    }
    south_ = static_cast<std::int64_t>(std::floor(south)) - 1;
    west_ = static_cast<std::int64_t>(std::floor(west)) - 1;
    rows_ = static_cast<std::int64_t>(std::floor(north)) + 2 - south_;
    columns_ = static_cast<std::int64_t>(std::floor(east)) + 2 - west_;
    winds_.assign(static_cast<std::size_t>(rows_ * columns_), 0);
    for (std::size_t i = 0; i < polygon.size(); ++i) cross(polygon[i], polygon[i + 1 == polygon.size() ? 0 : i + 1]);
    for (std::int64_t row = 0; row < rows_; ++row)
      for (std::int64_t column = 1; column < columns_; ++column)
        wind(row, column) = static_cast<std::int16_t>(wind(row, column) + wind(row, column - 1));
  }

  template <class Blocked>
  [[nodiscard]] bool deep(const Marker& m, const Blocked& blocked) {
    const auto row = static_cast<std::int64_t>(std::floor(row_of(m))) - south_;
    const auto column = static_cast<std::int64_t>(std::floor(column_of(m))) - west_;
    if (wind(row, column) == 0 && !m.stuck) return false;
    for (std::int64_t j = row - 1; j <= row + 1; ++j)
      for (std::int64_t i = column - 1; i <= column + 1; ++i)
        if (wind(j, i) == 0 && !blocked(j + south_, i + west_)) return false;
    return true;
  }

 private:
  [[nodiscard]] double row_of(const Marker& m) const { return (m.lat - lattice_.lat) * lattice_.per_lat; }
  [[nodiscard]] double column_of(const Marker& m) const { return (m.lon - lattice_.lon) * lattice_.per_lon; }
  std::int16_t& wind(std::int64_t row, std::int64_t column) {
    return winds_[static_cast<std::size_t>(row * columns_ + column)];
  }
  /// Counts an edge in the first cell of each row whose middle lies east of it; upwards is +1: a clockwise
  /// polygon has +1 inside.
  void cross(const Marker& a, const Marker& b) {
    const double ya = row_of(a) - static_cast<double>(south_) - 0.5, yb = row_of(b) - static_cast<double>(south_) - 0.5;
    if (ya == yb) return;
    const double xa = column_of(a) - static_cast<double>(west_) - 0.5;
    const double xb = column_of(b) - static_cast<double>(west_) - 0.5;
    const double low = std::min(ya, yb), high = std::max(ya, yb);  // rows in (low, high]: each vertex counts once
    for (auto row = static_cast<std::int64_t>(std::floor(low)) + 1; static_cast<double>(row) <= high; ++row) {
      const double x = xa + (xb - xa) * (static_cast<double>(row) - ya) / (yb - ya);
      auto& w = wind(row, static_cast<std::int64_t>(std::floor(x)) + 1);
      w = static_cast<std::int16_t>(w + (yb > ya ? 1 : -1));
    }
  }

  Squares lattice_;
  std::int64_t south_{}, west_{}, rows_{}, columns_{};
  std::vector<std::int16_t> winds_;
};

/// Winding numbers of places near some of a polygon's markers: the edges by the rows that they cross.
class Rows {
 public:
  /// `near`: the markers; places up to `kReach` cells from them may be asked for.
  Rows(const std::vector<Marker>& polygon, const Squares& lattice, const std::vector<bool>& near) : lattice_{lattice} {
    double south = 1e18, north = -1e18;
    for (const auto& m : polygon) {
      south = std::min(south, row_of(m.lat));
      north = std::max(north, row_of(m.lat));
    }
    south_ = std::floor(south);
    const auto rows = static_cast<std::size_t>(std::floor(north) - south_) + 1;
    std::vector<char> wanted(rows);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      if (!near[i]) continue;
      const double row = row_of(polygon[i].lat) - south_, reach = kReach * kPerCell;
      const auto last = std::min(rows - 1, static_cast<std::size_t>(row + reach));
      for (auto k = static_cast<std::size_t>(std::max(0.0, row - reach)); k <= last; ++k) wanted[k] = 1;
    }
    const auto for_rows = [&](const auto& touch) {
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Marker &from = polygon[i], &to = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        const double f = row_of(from.lat) - south_, t = row_of(to.lat) - south_;
        const auto last = static_cast<std::size_t>(std::max(f, t));
        for (auto row = static_cast<std::size_t>(std::min(f, t)); row <= last; ++row)
          if (wanted[row] != 0) touch(row, from, to);
      }
    };
    first_.assign(rows + 1, 0);
    for_rows([&](std::size_t row, const Marker&, const Marker&) { ++first_[row + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    edges_.resize(first_.back());
    auto next = first_;
    for_rows([&](std::size_t row, const Marker& from, const Marker& to) {
      const double rise = to.lat - from.lat;
      edges_[next[row]++] = {from.lat, to.lat, from.lon, rise == 0 ? 0.0 : (to.lon - from.lon) / rise};
    });
  }
  [[nodiscard]] bool winds_about(double lat, double lon) const {
    const double row = row_of(lat) - south_;
    if (!(row >= 0 && row < static_cast<double>(first_.size() - 1))) return false;
    const auto k = static_cast<std::size_t>(row);
    int winds = 0;
    for (auto e = first_[k]; e < first_[k + 1]; ++e) {
      const Edge& edge = edges_[e];
      const int crosses = static_cast<int>(edge.from <= lat) - static_cast<int>(edge.to <= lat);  // upwards +1
      winds += edge.lon + edge.slope * (lat - edge.from) < lon ? crosses : 0;
    }
    return winds != 0;
  }
  static constexpr double kReach = 0.25;

 private:
  struct Edge {
    double from, to;    ///< latitudes
    double lon, slope;  ///< where it begins; longitude per latitude
  };
  static constexpr double kPerCell = 8;  ///< narrow rows: beside coasts edges are short
  [[nodiscard]] double row_of(double lat) const { return kPerCell * (lat - lattice_.lat) * lattice_.per_lat; }

  Squares lattice_;
  double south_{};
  std::vector<std::size_t> first_;  ///< of each row's edges in `edges_`, and one past the last
  std::vector<Edge> edges_;         ///< by row
};

/// Beside a coast: see deep_inside.
bool deep_beside_coast(const Marker& m, const Rows& rows, const Squares& lattice, const Surroundings& around) {
  constexpr std::array kParts{1.0 / 64, Rows::kReach};
  const double s = std::sqrt(0.5);
  const std::array<std::array<double, 2>, 8> turns{
      {{1, 0}, {s, s}, {s, -s}, {0, 1}, {0, -1}, {-s, s}, {-s, -s}, {-1, 0}}};
  for (const double part : kParts)
    for (const auto& [ahead, right] : turns) {
      const double lat = m.lat + part * (ahead * m.north - right * m.east) / lattice.per_lat;
      const double lon = m.lon + part * (ahead * m.east + right * m.north) / lattice.per_lon;
      if (!rows.winds_about(lat, lon) && around.is_open_to(m, lat, lon)) return false;
    }
  return true;
}

}  // namespace

Squares Squares::about(double lat, double lon, double cell_m) {
  const auto metric = LocalMetric::at(lat);
  return {lat, lon, metric.meridian_radius / cell_m, metric.parallel_radius / cell_m};
}

std::vector<bool> deep_inside(const std::vector<Marker>& polygon, const Squares& lattice, const Surroundings& around,
                              const std::vector<bool>& asked) {
  std::vector<bool> deep(polygon.size()), beside(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) beside[i] = asked[i] && around.beside_coast(polygon[i]);
  std::optional<Raster> raster;
  std::optional<Rows> rows;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (!asked[i]) continue;
    if (beside[i]) {
      if (!rows) rows.emplace(polygon, lattice, beside);
      deep[i] = deep_beside_coast(polygon[i], *rows, lattice, around);
    } else {
      if (!raster) raster.emplace(polygon, lattice);
      deep[i] = raster->deep(polygon[i], around.blocked);
    }
  }
  return deep;
}

}  // namespace glidehelm::planning
