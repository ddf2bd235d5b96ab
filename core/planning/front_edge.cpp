#include "core/planning/front_edge.hpp"

#include <algorithm>

namespace glidehelm::planning {

Offset turned(double east, double north, double clockwise) {
  const double s = std::sin(clockwise), c = std::cos(clockwise);
  return {east * c + north * s, north * c - east * s};
}
double turn_between(const Marker& a, const Marker& b) {
  return std::atan2(b.east * a.north - b.north * a.east, a.east * b.east + a.north * b.north);
}
Offset from_to(const Marker& a, const Marker& b) {
  const auto metric = LocalMetric::at(0.5 * (a.lat + b.lat));
  return {(b.lon - a.lon) * metric.parallel_radius, (b.lat - a.lat) * metric.meridian_radius};
}
double segment_distance(double x0, double y0, double x1, double y1) {
  const double dx = x1 - x0, dy = y1 - y0, l2 = dx * dx + dy * dy;
  const double u = l2 > 0 ? std::clamp(-(x0 * dx + y0 * dy) / l2, 0.0, 1.0) : 0.0;
  return std::hypot(x0 + u * dx, y0 + u * dy);
}

FrontEdge::FrontEdge(const Marker& a, const Marker& b)
    : a_{a}, b_{b}, way_{from_to(a, b)}, length_{way_.length()}, turn_{turn_between(a, b)} {
  const bool wall = (a.stuck && !a.coast) || (b.stuck && !b.coast) || (a.coast && b.coast);
  const bool beside = a.coast || b.coast;
  // The front runs to the right of its normals: (north, −east).
  const bool along = a.north * way_.east - a.east * way_.north > 0 && b.north * way_.east - b.east * way_.north > 0;
  const bool smooth = !wall && along && std::abs(turn_) < (beside ? kSmoothCorner : kSmoothTurn);
  shape_ = smooth ? Shape::smooth : wall || beside ? Shape::chord : Shape::corner;
  if (beside && smooth && turn_ != 0) bow_ = 2 * std::tan(0.25 * turn_) / std::sin(0.5 * turn_);
}

Marker FrontEdge::at(double u) const {
  Marker m{a_.lat, a_.lon, 0, 1, (1 - u) * a_.turn + u * b_.turn};
  Offset by{u * way_.east, u * way_.north}, normal{};
  if (shape_ == Shape::smooth) {
    const double u2 = u * u, u3 = u2 * u, l = bow_ * length_;
    const double h10 = l * (u3 - 2 * u2 + u), h01 = 3 * u2 - 2 * u3, h11 = l * (u3 - u2);
    by = {h10 * a_.north + h01 * way_.east + h11 * b_.north, -h10 * a_.east + h01 * way_.north - h11 * b_.east};
    const double d10 = l * (3 * u2 - 4 * u + 1), d01 = 6 * u - 6 * u2, d11 = l * (3 * u2 - 2 * u);
    const Offset t{d10 * a_.north + d01 * way_.east + d11 * b_.north,
                   -d10 * a_.east + d01 * way_.north - d11 * b_.east};
    normal = {-t.north / t.length(), t.east / t.length()};
  } else if (shape_ == Shape::chord) {
    normal = {-way_.north / length_, way_.east / length_};
    m.turn = 0;
  } else {
    normal = turned(a_.east, a_.north, u * turn_);
  }
  m.east = normal.east;
  m.north = normal.north;
  const double lat = m.lat + by.north / LocalMetric::at(m.lat).meridian_radius;
  m.lon += by.east / LocalMetric::at(0.5 * (m.lat + lat)).parallel_radius;
  m.lat = lat;
  return m;
}

}  // namespace glidehelm::planning
