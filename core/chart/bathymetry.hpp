#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/geo.hpp"

namespace glidehelm::chart {

/// Depths of water on nodes that lie evenly in longitude and latitude, from the south-west eastwards.
struct DepthGrid {
  std::string source;   ///< one line: where the depths come from
  std::string decided;  ///< one line: why they are positive down
  double west_deg{}, south_deg{};
  double lon_step_deg{}, lat_step_deg{};
  std::size_t columns{}, rows{};
  std::vector<float> depths_m;  ///< positive down, land negative; NaN: unknown. rows · columns of them
  /// What is wrong with it, or nothing: at least 2 by 2 nodes, at most kMostNodes, between the poles, at most 360° wide.
  [[nodiscard]] std::optional<std::string> problem() const;
};

/// The depth of the sea as a surface: bilinear between the nodes of a DepthGrid. What is unknown (no node, a node without
/// a value at any corner of the cell) is shallower than everything: `kUnknown`. Immutable; const calls are safe from
/// several threads. Radians and metres; any finite longitude; what is not finite is unknown.
///
/// A pyramid of minima (4/3 of the grid's memory) answers for large boxes. A bilinear patch has its minimum over a
/// rectangle at a corner, so the minimum over a box is that of the nodes in it, of its corners, and of the places where
/// its sides cross grid lines.
///
/// A `.depth` file, which `glidehelm-ingest --bathymetry` writes, is a head of text lines, little-endian 32-bit floats,
/// and a last line:
///
///     # glidehelm depth v1
///     source ANY WORDS
///     decided ANY WORDS
///     grid WEST SOUTH LON_STEP LAT_STEP COLUMNS ROWS
///     values                          then rows · columns floats, metres, positive down, NaN unknown
///     end crc32c XXXXXXXX             of all bytes before this line
class Bathymetry {
 public:
  static constexpr double kUnknown = -std::numeric_limits<double>::infinity();
  static constexpr std::size_t kMostNodes = std::size_t{1} << 27;
  static constexpr std::size_t kLargestFile = 4 * kMostNodes + 4096;

  /// The surface over a grid; the error says what is wrong with the grid. O(nodes).
  static Expected<std::shared_ptr<const Bathymetry>, std::string> make(DepthGrid grid);
  /// Reads a `.depth` file. Safe on hostile bytes: memory is bounded by their number.
  static Expected<std::shared_ptr<const Bathymetry>, std::string> parse(std::string_view bytes);
  /// The bytes of the file; parse(text_of(grid)) gives the same nodes, bit for bit.
  [[nodiscard]] static std::string text_of(const DepthGrid& grid);

  [[nodiscard]] const DepthGrid& grid() const { return grid_; }
  /// The surface at a position, or kUnknown.
  [[nodiscard]] double depth(double lat, double lon) const;
  /// The shoalest water of the box, exactly (to rounding). Precondition: lat0 ≤ lat1, lon0 ≤ lon1. O(nodes of its rim).
  [[nodiscard]] double shoalest_in_box(double lat0, double lat1, double lon0, double lon1) const;
  /// A lower bound of the shoalest water within `radius` metres: the shoalest in the box around that disc (so nothing
  /// farther than √2 · radius, and 1 % for the Earth's shape, is blamed). Poleward of 89° unknown.
  [[nodiscard]] double shoalest_within(GeoPoint p, Metres radius) const;
  /// A lower bound of the shoalest water along the segment, straight in latitude and longitude: the shoalest in boxes
  /// around pieces of it no longer than half a cell, so nothing farther from it than half a cell is blamed.
  [[nodiscard]] double shoalest_along(double lat0, double lon0, double lat1, double lon1) const;
  /// True when shoalest_along() is at least `least`. Four array reads where the water around is deep; pieces are looked at
  /// only near the limit.
  [[nodiscard]] bool is_deep_along(double lat0, double lon0, double lat1, double lon1, double least) const;

 private:
  /// A box in steps of the grid, from its south-west node.
  struct Box {
    double x0, x1, y0, y1;
  };
  struct Level {
    std::size_t columns{}, rows{};
    std::vector<float> least;
  };
  explicit Bathymetry(DepthGrid grid);
  [[nodiscard]] double x_of(double lon) const;
  [[nodiscard]] double y_of(double lat) const;
  [[nodiscard]] bool holds(const Box& box) const;
  [[nodiscard]] double at(double x, double y) const;
  [[nodiscard]] double node(std::size_t column, std::size_t row) const;
  [[nodiscard]] double bound(const Box& box) const;
  [[nodiscard]] double shoalest(const Box& box) const;
  void least_of_nodes(std::size_t level, std::size_t column, std::size_t row, const std::size_t (&span)[4],
                      double& least) const;
  [[nodiscard]] double along(double x0, double y0, double x1, double y1, double enough) const;

  DepthGrid grid_;
  std::vector<Level> pyramid_;  ///< level 0 are the nodes; unknown is -infinity
};

}  // namespace glidehelm::chart
