#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace glidehelm::planning {

/// A point of a front: where an extremal is, and the outward normal of the front there, which is also its heading.
struct Marker {
  double lat{}, lon{};      ///< radians; the longitude runs on
  double east{}, north{1};  ///< unit normal
  double turn{};            ///< clockwise rate of the normal over the last step, rad/s
  bool stuck{};             ///< lies at a wall: land, an area's border, the end of the data
  bool coast{};             ///< the wall is a border of the chart, on which it can walk
  bool landed{};            ///< came to the coast in this step
  bool forward{}, back{};   ///< walks along the coast towards the next marker, towards the one before
  bool done{};              ///< of a coast: lies deep inside, and walks no more
  bool fanned{};            ///< its wall has sent headings to all sides
  double behind{};          ///< metres that a current has carried a walker back along the coast
  double left{};            ///< seconds of the step that were left at the wall
  bool idle{};              ///< can be of no more use, and stays
  bool joins{};             ///< the edge to the next marker closes a gap inside the reached set: no front
  bool skirts{};            ///< joins, along a wall
  bool closes{};            ///< joins, and not the next marker but the first of its loop: the next one begins another

  void cut() {
    joins = true;
    skirts = false;
  }
  void skirt() { joins = skirts = true; }
  /// Begins nothing and ends nothing: for a copy of a marker in the middle of its piece of the front.
  void unjoin() { joins = skirts = closes = false; }
  [[nodiscard]] bool ends_piece() const { return joins && !skirts; }
};

/// Calls `edge(from, to)` for all edges of the loops that a front consists of.
template <class Edge>
void for_each_edge(const std::vector<Marker>& front, const Edge& edge) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const bool last = front[i].closes || i + 1 == front.size();
    edge(front[i], front[last ? first : i + 1]);
    if (last) first = i + 1;
  }
}

/// Cells in rows and columns about an origin, in radians: of one size in metres at the origin's latitude.
struct Squares {
  double lat{}, lon{};          ///< a corner of cell (0, 0)
  double per_lat{}, per_lon{};  ///< cells per radian
  static Squares about(double lat, double lon, double cell_m);
};

/// What lies around a marker.
struct Surroundings {
  std::function<bool(std::int64_t row, std::int64_t column)> blocked;  ///< nothing can go to the middle of this cell
  std::function<bool(const Marker&)> beside_coast;                     ///< a wall of the chart is as near as two cells
  std::function<bool(const Marker&, double lat, double lon)> is_open_to;  ///< the straight way there is open
};

/// For each marker of a front's loops whether it lies deep inside: one of
/// - the front winds about the middle of the marker's cell, and each of the eight cells around it has that too or is `blocked`. Not beside
///   a coast, where cells are too coarse;
/// - it winds about each of 16 places around the marker that are open to it, at distances of 1/4 and 1/64 cell: so a front in a narrow
///   strait is not inside. Not of what lies at other walls;
/// - in its shadow: another sheet runs less than 1/4 cell before it, or beside it, and the same way. Two sheets that came round an
///   island at nearly the same time stay that near for long, and where one of them was cut, its end would find no other. Told only from where a
///   piece ends or was cut onwards, so that of two sheets that pass each other both are cut at one place.
///
/// Time: edges × the rows they cross, plus one pass over the cells of the polygon's box (2 bytes each), plus for each marker on the
/// outside 16 times the edges in a row.
/// Only of those that are `asked` after; of the others it is false.
std::vector<bool> deep_inside(const std::vector<Marker>& polygon, const Squares& lattice, const Surroundings& around,
                              const std::vector<bool>& asked);

}  // namespace glidehelm::planning
