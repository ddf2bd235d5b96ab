#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/expected.hpp"
#include "core/chart/coast.hpp"

/// From pieces of shoreline, in no order and cut anywhere, to the closed rings of a coast file. Pure geometry in whole
/// coast units (chart::kCoastUnitsPerDegree): no program, no file.
namespace glidehelm::cli {

/// A point in coast units: `x` east of the area's west edge (it may lie outside the area), `y` north of the equator.
struct ShorePoint {
  std::int64_t x{}, y{};
  friend auto operator<=>(const ShorePoint&, const ShorePoint&) = default;
};
using ShoreLine = std::vector<ShorePoint>;

/// Appends the lines of GMT multi-segment text (`>` begins a segment, `#` a comment, else longitude and latitude in
/// degrees); longitudes are folded to within 270° east and 90° west of the area's west edge. The error names line and text.
Expected<Done, std::string> read_shore_lines(std::string_view text, const chart::CoastArea& area,
                                             std::vector<ShoreLine>& lines);

/// Joins lines that end where others begin, whichever way round; a closed line has its first point at both ends. Where
/// more than two meet they are joined two by two: the even-odd rule gives every choice the same land.
std::vector<ShoreLine> joined(const std::vector<ShoreLine>& pieces);

/// A stretch of the area's border between two crossings of the shore, along which it is either all land or all water.
struct BorderStretch {
  std::int64_t from{}, length{};  ///< coast units along the border, counter-clockwise from the south-west corner
};

/// A shoreline cut to an area, its border not yet told apart into land and water.
///
/// The shore crosses the border an even number of times, and land and water alternate along it. So one answer about one
/// stretch decides all of them, and any second one is a check.
class CoastCut {
 public:
  /// `lines` must be closed or end outside the area (on its border at least); the error names a loose end.
  static Expected<CoastCut, std::string> make(const chart::CoastArea& area, const std::vector<ShoreLine>& lines);

  /// The stretches in order; one that goes all round when no shore crosses the border. Even ones are of one kind, odd ones
  /// of the other.
  [[nodiscard]] const std::vector<BorderStretch>& stretches() const { return stretches_; }
  /// A point of the border, moved `inwards` units into the area.
  [[nodiscard]] ShorePoint border_point(std::int64_t along, std::int64_t inwards) const;
  [[nodiscard]] std::int64_t border_length() const { return 2 * (area_.width() + area_.height()); }
  /// The rings, closed along the border where it is land. Rings come in the order of the lines; rings of no area are left
  /// out.
  [[nodiscard]] std::vector<chart::CoastRing> rings(bool even_stretches_are_land) const;

 private:
  /// Where an inner line meets the border: at its first point or its last.
  struct Crossing {
    std::int64_t along;
    std::size_t line;
    bool at_end;
  };
  struct Builder;
  explicit CoastCut(const chart::CoastArea& area) : area_{area} {}
  void add(const ShoreLine& line);
  void add_edge(const ShorePoint& a, const ShorePoint& b, ShoreLine& current);
  void sort_crossings();
  [[nodiscard]] bool inside(const ShorePoint& p) const;
  [[nodiscard]] std::int64_t along(const ShorePoint& p) const;

  chart::CoastArea area_;
  std::vector<ShoreLine> closed_;    ///< within the area
  std::vector<ShoreLine> lines_;     ///< within it, from border to border
  std::vector<Crossing> crossings_;  ///< by place along the border
  std::vector<BorderStretch> stretches_;
};

}  // namespace glidehelm::cli
