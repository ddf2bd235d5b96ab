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
    for_each_edge(polygon, [this](const Marker& a, const Marker& b) { cross(a, b); });
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
      for_each_edge(polygon, [&](const Marker& from, const Marker& to) {
        const double f = row_of(from.lat) - south_, t = row_of(to.lat) - south_;
        const auto last = static_cast<std::size_t>(std::max(f, t));
        for (auto row = static_cast<std::size_t>(std::min(f, t)); row <= last; ++row)
          if (wanted[row] != 0) touch(row, from, to);
      });
    };
    first_.assign(rows + 1, 0);
    for_rows([&](std::size_t row, const Marker&, const Marker&) { ++first_[row + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    edges_.resize(first_.back());
    auto next = first_;
    for_rows([&](std::size_t row, const Marker& from, const Marker& to) {
      const double rise = to.lat - from.lat;
      edges_[next[row]++] = {from.lat, to.lat, from.lon, rise == 0 ? 0.0 : (to.lon - from.lon) / rise, &from, &to};
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
  /// Calls `touch(from, to)` for the edges that may be within `kReach` cells of a marker, until one answers true. Some come twice.
  template <class Touch>
  [[nodiscard]] bool any_near(const Marker& m, const Touch& touch) const {
    const double row = row_of(m.lat) - south_, reach = kReach * kPerCell;
    const auto last = std::min(first_.size() - 2, static_cast<std::size_t>(row + reach));
    for (auto k = static_cast<std::size_t>(std::max(0.0, row - reach)); k <= last; ++k)
      for (auto e = first_[k]; e < first_[k + 1]; ++e)
        if (touch(*edges_[e].begin, *edges_[e].end)) return true;
    return false;
  }

 private:
  struct Edge {
    double from, to;    ///< latitudes
    double lon, slope;  ///< where it begins; longitude per latitude
    const Marker *begin, *end;
  };
  static constexpr double kPerCell = 8;  ///< narrow rows: beside coasts edges are short
  [[nodiscard]] double row_of(double lat) const { return kPerCell * (lat - lattice_.lat) * lattice_.per_lat; }

  Squares lattice_;
  double south_{};
  std::vector<std::size_t> first_;  ///< of each row's edges in `edges_`, and one past the last
  std::vector<Edge> edges_;         ///< by row
};

/// All places around it: see deep_inside.
bool deep_all_round(const Marker& m, const Rows& rows, const Squares& lattice, const Surroundings& around) {
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

/// Markers in the shadow of another sheet: see deep_inside.
class Shadows {
 public:
  Shadows(const std::vector<Marker>& front, const Rows& rows, const Squares& lattice, const Surroundings& around)
      : front_{front}, rows_{rows}, lattice_{lattice}, around_{around}, along_(front.size()) {
    for (std::size_t i = 1; i < front.size(); ++i)
      along_[i] =
          along_[i - 1] + (front[i - 1].joins ? kElsewhere : way(front[i - 1], front[i].lat, front[i].lon).length());
  }
  /// Adds to the markers that are deep inside those in a shadow.
  void add(std::vector<bool>& deep, const std::vector<bool>& asked) const {
    const auto look = [&](std::size_t i) {
      const Marker& m = front_[i];
      if (asked[i] && !deep[i] && !m.stuck && !m.idle) deep[i] = is_shadowed(i, deep);
    };
    for (std::size_t i = 1; i < front_.size(); ++i)
      if (front_[i - 1].ends_piece() || deep[i - 1]) look(i);
    for (std::size_t i = front_.size() - 1; i-- > 0;)
      if (front_[i].ends_piece() || deep[i + 1]) look(i);
  }

 private:
  static constexpr double kSame = 0.02;      ///< cells: sheets as near as this are one
  static constexpr double kAlike = 0.95;     ///< cosine between normals of sheets that go the same way
  static constexpr double kApart = 4;        ///< cells along the front between a marker and another sheet
  static constexpr double kElsewhere = 1e9;  ///< the same, in another piece

  [[nodiscard]] Offset way(const Marker& from, double lat, double lon) const {  // in cells
    return {(lon - from.lon) * lattice_.per_lon, (lat - from.lat) * lattice_.per_lat};
  }
  [[nodiscard]] bool is_shadowed(std::size_t i, const std::vector<bool>& deep) const {
    const Marker& m = front_[i];
    const auto alike = [&m](const Marker& other) { return other.east * m.east + other.north * m.north >= kAlike; };
    const auto is_other_sheet = [&](const Marker& other) {
      const auto k = static_cast<std::size_t>(&other - front_.data());
      return !other.stuck && !other.idle && !deep[k] && std::abs(along_[k] - along_[i]) > kApart;
    };
    return rows_.any_near(m, [&](const Marker& a, const Marker& b) {
      if (a.joins || !alike(a) || !alike(b) || !is_other_sheet(a) || !is_other_sheet(b)) return false;
      const auto edge = way(a, b.lat, b.lon), to = way(a, m.lat, m.lon);
      const double length = edge.length(), along = to.east * edge.east + to.north * edge.north;
      if (!(length > 0 && along >= 0 && along <= length * length)) return false;
      const double share = along / (length * length);
      const Offset off{to.east - share * edge.east, to.north - share * edge.north};
      if (off.length() > Rows::kReach || off.east * m.east + off.north * m.north > kSame) return false;
      return around_.is_open_to(m, a.lat + share * (b.lat - a.lat), a.lon + share * (b.lon - a.lon));
    });
  }

  const std::vector<Marker>& front_;
  const Rows& rows_;
  const Squares& lattice_;
  const Surroundings& around_;
  std::vector<double> along_;  ///< cells along the front up to each marker
};

}  // namespace

Squares Squares::about(double lat, double lon, double cell_m) {
  const auto metric = LocalMetric::at(lat);
  return {lat, lon, metric.meridian_radius / cell_m, metric.parallel_radius / cell_m};
}

std::vector<bool> deep_inside(const std::vector<Marker>& polygon, const Squares& lattice, const Surroundings& around,
                              const std::vector<bool>& asked) {
  std::vector<bool> deep(polygon.size());
  std::optional<Raster> raster;
  std::optional<Rows> rows;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (!asked[i]) continue;
    if (!rows) rows.emplace(polygon, lattice, asked);
    const bool beside = around.beside_coast(polygon[i]);
    if (!beside) {
      if (!raster) raster.emplace(polygon, lattice);
      deep[i] = raster->deep(polygon[i], around.blocked);
    }
    if (!deep[i] && (beside || !polygon[i].stuck)) deep[i] = deep_all_round(polygon[i], *rows, lattice, around);
  }
  if (rows) Shadows{polygon, *rows, lattice, around}.add(deep, asked);
  return deep;
}

}  // namespace glidehelm::planning
