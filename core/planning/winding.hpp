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
  bool fanned{};            ///< its wall has sent headings to all sides
  double left{};            ///< seconds of the step that were left at the wall
  bool idle{};              ///< can be of no more use, and stays
  bool joins{};             ///< the edge to the next marker closes a gap inside the reached set: no front
};

/// Cells in rows and columns about an origin, in radians: of one size in metres at the origin's latitude.
struct Lattice {
  double lat{}, lon{};          ///< a corner of cell (0, 0)
  double per_lat{}, per_lon{};  ///< cells per radian
  static Lattice about(double lat, double lon, double cell_m);
};

/// For each marker of a closed polygon whether it lies deep inside: the polygon winds about the middle of the marker's cell, and
/// each of the eight cells around it has that too or is `blocked` (row, column), where nothing can go.
///
/// Time: edges × the rows they cross, plus one pass over the cells of the polygon's box (2 bytes each).
std::vector<bool> deep_inside(const std::vector<Marker>& polygon, const Lattice& lattice,
                              const std::function<bool(std::int64_t, std::int64_t)>& blocked);

}  // namespace glidehelm::planning
