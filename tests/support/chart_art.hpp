#pragma once

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/chart/chart.hpp"
#include "core/chart/coast.hpp"

namespace glidehelm::test {

/// A chart drawn in characters: `#` land, `~` water; any letter is a marked point in water (`S` start, `G` goal). The first
/// line is the northernmost; each character is a square cell of `cell_deg` degrees of latitude and of longitude. Blanks
/// and empty lines are skipped, so that a drawing can be indented.
///
///     const ChartArt art{R"(
///         ~~~~~~~
///         ~S##~G~
///         ~~~~~~~)", 28.0, -16.0, 0.1};
///     art.chart.is_land(geo_point(28.15, -15.75));   art.at('S');
///
/// Every land cell is a square ring of shore along the boundary between land and water only: cells that touch make one
/// piece of land. Land on the border of the drawing goes on outside (a cut edge).
struct ChartArt {
  /// `south_deg` and `west_deg` are the south-west corner of the drawing.
  ChartArt(const std::string& drawing, double south_deg, double west_deg, double cell_deg,
           std::vector<chart::Area> keep_in = {}, std::vector<chart::Area> keep_out = {})
      : coast{draw(drawing, south_deg, west_deg, cell_deg)},
        chart{chart::ChartSources{coast, std::move(keep_in), std::move(keep_out)}} {}

  /// The centre of the cell with this letter.
  [[nodiscard]] GeoPoint at(char letter) const {
    const auto found = marks.find(letter);
    if (found == marks.end()) throw std::invalid_argument(std::string{"no mark "} + letter);
    return found->second;
  }

  std::map<char, GeoPoint> marks;
  std::shared_ptr<const chart::Coast> coast;
  chart::Chart chart;

 private:
  using Corner = std::pair<int, int>;  ///< column, row from the south-west corner

  std::shared_ptr<const chart::Coast> draw(const std::string& drawing, double south_deg, double west_deg,
                                           double cell_deg) {
    const auto rows = rows_of(drawing);
    const int height = static_cast<int>(rows.size()), width = static_cast<int>(rows.front().size());
    const auto land = [&](int column, int row) {
      return rows[static_cast<std::size_t>(height - 1 - row)][static_cast<std::size_t>(column)] == '#';
    };
    const auto inside = [&](int column, int row) { return column >= 0 && row >= 0 && column < width && row < height; };
    // Each side of a land cell that does not lie between two land cells, with the land on its left.
    std::multimap<Corner, Corner> sides;
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column) {
        const char c = rows[static_cast<std::size_t>(height - 1 - row)][static_cast<std::size_t>(column)];
        if (c != '#' && c != '~')
          marks.emplace(c, geo_point(south_deg + (row + 0.5) * cell_deg, west_deg + (column + 0.5) * cell_deg));
        if (c != '#') continue;
        const Corner a{column, row}, b{column + 1, row}, d{column + 1, row + 1}, e{column, row + 1};
        const auto side = [&](int to_column, int to_row, Corner from, Corner to) {
          if (!inside(to_column, to_row) || !land(to_column, to_row)) sides.emplace(from, to);
        };
        side(column, row - 1, a, b);
        side(column + 1, row, b, d);
        side(column, row + 1, d, e);
        side(column - 1, row, e, a);
      }
    std::vector<chart::CoastRing> rings;
    const auto units = [](double deg) {
      return static_cast<std::int64_t>(deg * chart::kCoastUnitsPerDegree + (deg < 0 ? -0.5 : 0.5));
    };
    const chart::CoastArea area{units(west_deg), units(west_deg + width * cell_deg), units(south_deg),
                                units(south_deg + height * cell_deg)};
    const auto point = [&](const Corner& c) {
      return chart::CoastPoint{
          static_cast<std::int32_t>(c.first == width ? area.width() : units(c.first * cell_deg)),
          static_cast<std::int32_t>(c.second == height ? area.north : area.south + units(c.second * cell_deg))};
    };
    while (!sides.empty()) {
      chart::CoastRing ring;
      auto side = sides.begin();
      while (side != sides.end()) {
        const auto [from, to] = *side;
        const auto along = [&](int v, int w, int border) { return v == w && v == border; };
        ring.points.push_back(point(from));
        ring.cut.push_back(along(from.first, to.first, 0) || along(from.first, to.first, width) ||
                           along(from.second, to.second, 0) || along(from.second, to.second, height));
        sides.erase(side);
        side = sides.find(to);
      }
      rings.push_back(std::move(ring));
    }
    auto made = chart::Coast::make(area, "drawn by a test", std::move(rings));
    if (!made) throw std::invalid_argument(made.error().message());
    return *made;
  }

  static std::vector<std::string> rows_of(const std::string& drawing) {
    std::vector<std::string> rows;
    std::string row;
    for (const char c : drawing + "\n") {
      if (c == '\n') {
        if (!row.empty()) rows.push_back(row);
        row.clear();
      } else if (c != ' ') {
        row += c;
      }
    }
    if (rows.empty()) throw std::invalid_argument("an empty drawing");
    for (const auto& r : rows)
      if (r.size() != rows.front().size()) throw std::invalid_argument("the lines of a drawing differ in length: " + r);
    return rows;
  }
};

}  // namespace glidehelm::test
