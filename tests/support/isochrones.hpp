#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/base/local_metric.hpp"
#include "core/planning/lower_bound.hpp"

/// What lies inside an isochrone, told without the front's own geometry.
namespace glidehelm::test {

/// Calls `edge(from, to)` for every edge of the isochrone's closed lines.
template <class Edge>
void for_each_edge_of(const planning::Isochrone& isochrone, const Edge& edge) {
  for (const auto& line : isochrone.lines)
    for (std::size_t i = 0; i < line.size(); ++i) edge(line[i], line[i + 1 == line.size() ? 0 : i + 1]);
}

/// Whether its lines wind about a place: crossings of the parallel to the west of it.
inline bool encloses(const planning::Isochrone& isochrone, GeoPoint at) {
  int winds = 0;
  for_each_edge_of(isochrone, [&](GeoPoint from, GeoPoint to) {
    const double a = from.lat.radians() - at.lat.radians(), b = to.lat.radians() - at.lat.radians();
    if ((a <= 0) == (b <= 0)) return;
    const double lon = from.lon.radians() + (to.lon.radians() - from.lon.radians()) * a / (a - b);
    if (lon < at.lon.radians()) winds += a <= 0 ? 1 : -1;
  });
  return winds != 0;
}

/// Metres from a place to the nearest of its edges.
inline double distance_to(const planning::Isochrone& isochrone, GeoPoint at) {
  double nearest = std::numeric_limits<double>::infinity();
  for_each_edge_of(isochrone, [&](GeoPoint from, GeoPoint to) {
    const auto place = [&](GeoPoint p) {
      return local_offset(at.lat.radians(), at.lon.radians(), p.lat.radians(), p.lon.radians());
    };
    const Offset a = place(from), b = place(to), way{b.east - a.east, b.north - a.north};
    const double l2 = way.east * way.east + way.north * way.north;
    const double share = l2 > 0 ? std::clamp(-(a.east * way.east + a.north * way.north) / l2, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, Offset{a.east + share * way.east, a.north + share * way.north}.length());
  });
  return nearest;
}

}  // namespace glidehelm::test
