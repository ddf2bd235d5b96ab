#include "core/chart/grown_land.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/base/local_metric.hpp"
#include "core/chart/space.hpp"

namespace glidehelm::chart {

namespace {

constexpr double kUnit = kPi / (180.0 * kCoastUnitsPerDegree);
/// The error of distances (chart.hpp), taken on the safe side.
double slack(double distance) { return 0.2 + 1e-4 * distance; }

/// Which cells of an area are land; rows from the south, columns from the west.
class Cells {
 public:
  Cells(const Coast& coast, double buffer, std::size_t columns, std::size_t rows)
      : coast_{coast}, buffer_{buffer}, columns_{columns}, rows_{rows}, land_(columns * rows, 0) {
    decide(0, columns, 0, rows);
  }
  [[nodiscard]] bool land(std::size_t column, std::size_t row) const { return land_[row * columns_ + column] != 0; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Sides of cells in coast units: east of the area's west edge, and north of the equator.
  [[nodiscard]] std::int64_t x(std::size_t column) const {
    return coast_.area().width() * static_cast<std::int64_t>(column) / static_cast<std::int64_t>(columns_);
  }
  [[nodiscard]] std::int64_t y(std::size_t row) const {
    return coast_.area().south +
           coast_.area().height() * static_cast<std::int64_t>(row) / static_cast<std::int64_t>(rows_);
  }

 private:
  void decide(std::size_t c0, std::size_t c1, std::size_t r0, std::size_t r1) {
    const double south = static_cast<double>(y(r0)) * kUnit, north = static_cast<double>(y(r1)) * kUnit;
    const double west = static_cast<double>(coast_.area().west + x(c0)) * kUnit;
    const double width = static_cast<double>(x(c1) - x(c0)) * kUnit;
    const double lat = 0.5 * (south + north), lon = west + 0.5 * width;
    const double half = half_diagonal(south, north, width);
    const bool inside = coast_.land().contains(lat, lon);
    const double reach = buffer_ + half + slack(buffer_ + half);
    const double distance = coast_.land().distance(Space::at(lat, lon), reach);
    const bool one = c1 == c0 + 1 && r1 == r0 + 1;
    if (inside ? one || distance >= half + slack(half) : distance >= reach) return fill(c0, c1, r0, r1, inside);
    if (one) return fill(c0, c1, r0, r1, true);
    const std::size_t c = c1 - c0 > 1 ? (c0 + c1) / 2 : c1, r = r1 - r0 > 1 ? (r0 + r1) / 2 : r1;
    for (const auto& [cf, ct] : {std::pair{c0, c}, std::pair{c, c1}})
      for (const auto& [rf, rt] : {std::pair{r0, r}, std::pair{r, r1}})
        if (cf < ct && rf < rt) decide(cf, ct, rf, rt);
  }
  /// Of the part of the sphere between two latitudes, from its middle to its farthest corner, at most. The wide side is the
  /// one nearer to the equator; the Earth's radius of curvature is at most 6 400 km.
  static double half_diagonal(double south, double north, double width) {
    const double widest = south <= 0 && north >= 0 ? 0.0 : std::min(std::abs(south), std::abs(north));
    return 0.5 * std::hypot(6.4e6 * (north - south), LocalMetric::at(widest).parallel_radius * width) * 1.0001;
  }
  void fill(std::size_t c0, std::size_t c1, std::size_t r0, std::size_t r1, bool land) {
    if (!land) return;
    for (std::size_t r = r0; r < r1; ++r)
      std::fill_n(land_.begin() + static_cast<std::ptrdiff_t>(r * columns_ + c0), c1 - c0, std::uint8_t{1});
  }

  const Coast& coast_;
  double buffer_;
  std::size_t columns_, rows_;
  std::vector<std::uint8_t> land_;
};

/// Follows the sides of land cells, land to the left.
class Tracer {
 public:
  explicit Tracer(const Cells& cells) : cells_{cells}, leaving_((cells.columns() + 1) * (cells.rows() + 1), 0) {
    const auto land = [&](std::size_t c, std::size_t r) {  // wraps below 0: no cell
      return c < cells.columns() && r < cells.rows() && cells.land(c, r);
    };
    for (std::size_t r = 0; r < cells.rows(); ++r)
      for (std::size_t c = 0; c < cells.columns(); ++c) {
        if (!cells.land(c, r)) continue;
        if (!land(c, r - 1)) leave(c, r, kEast);
        if (!land(c + 1, r)) leave(c + 1, r, kNorth);
        if (!land(c, r + 1)) leave(c + 1, r + 1, kWest);
        if (!land(c - 1, r)) leave(c, r + 1, kSouth);
      }
  }

  std::vector<CoastRing> rings() {
    std::vector<CoastRing> rings;
    for (std::size_t r = 0; r <= cells_.rows(); ++r)
      for (std::size_t c = 0; c <= cells_.columns(); ++c)
        while (leaving_[index(c, r)] != 0) rings.push_back(ring(c, r));
    return rings;
  }

 private:
  enum Direction : unsigned { kEast, kNorth, kWest, kSouth };
  [[nodiscard]] std::size_t index(std::size_t c, std::size_t r) const { return r * (cells_.columns() + 1) + c; }
  void leave(std::size_t c, std::size_t r, Direction d) {
    leaving_[index(c, r)] = static_cast<std::uint8_t>(leaving_[index(c, r)] | 1U << d);
  }

  /// One closed line from a corner; corners in the middle of a straight side are left out. Where two cells meet at a corner
  /// only, either way round gives the same land by the even-odd rule.
  CoastRing ring(std::size_t c0, std::size_t r0) {
    CoastRing ring;
    std::size_t c = c0, r = r0;
    unsigned before = 4;
    do {
      auto& ways = leaving_[index(c, r)];
      unsigned d = 0;
      while ((ways >> d & 1U) == 0) ++d;
      ways = static_cast<std::uint8_t>(ways & ~(1U << d));
      if (d != before) {
        ring.points.push_back({static_cast<std::int32_t>(cells_.x(c)), static_cast<std::int32_t>(cells_.y(r))});
        const bool on_border =
            d == kEast || d == kWest ? r == 0 || r == cells_.rows() : c == 0 || c == cells_.columns();
        ring.cut.push_back(on_border);
      }
      before = d;
      c = d == kEast ? c + 1 : d == kWest ? c - 1 : c;
      r = d == kNorth ? r + 1 : d == kSouth ? r - 1 : r;
    } while (c != c0 || r != r0);
    return ring;
  }

  const Cells& cells_;
  std::vector<std::uint8_t> leaving_;  ///< per corner, a bit for each direction in which a side leaves it
};

Unexpected<CoastError> refused(const std::string& what) { return unexpected(CoastError{0, 0, what}); }

std::string whole(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f m", metres);
  return text;
}

}  // namespace

Expected<std::shared_ptr<const Coast>, CoastError> grown_land(const Coast& coast, Metres buffer, Metres simplified_by) {
  if (!(buffer.si() >= 0 && buffer.si() <= 50'000)) return refused("land can be grown by 0 to 50000 m");
  if (!(simplified_by.si() >= 1 && simplified_by.si() <= 50'000))
    return refused("land can be simplified by 1 to 50000 m");
  const auto& area = coast.area();
  const double side = simplified_by.si() / std::sqrt(2.0) / 1.0001;  // of a square with that diagonal
  const double south = static_cast<double>(area.south) * kUnit, north = static_cast<double>(area.north) * kUnit;
  const double widest = south <= 0 && north >= 0 ? 0.0 : std::min(std::abs(south), std::abs(north));
  const double rows = std::ceil(6.4e6 * (north - south) / side);
  const double columns =
      std::ceil(LocalMetric::at(widest).parallel_radius * static_cast<double>(area.width()) * kUnit / side);
  if (!(rows * columns <= kMostCells))
    return refused(
        "land simplified by " + whole(simplified_by.si()) +
        " needs too many cells for this area; allowed are about 2.7e8: simplify more, or cut a smaller area");
  const Cells cells{coast, buffer.si(), static_cast<std::size_t>(columns), static_cast<std::size_t>(rows)};
  return Coast::make(area,
                     coast.source() + "; land grown by " + whole(buffer.si()) + " and simplified outwards by at most " +
                         whole(simplified_by.si()),
                     Tracer{cells}.rings());
}

}  // namespace glidehelm::chart
