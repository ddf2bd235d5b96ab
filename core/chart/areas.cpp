#include "core/chart/areas.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace glidehelm::chart {

namespace {

constexpr double kFarthestNorth = 85 * kPi / 180;

/// The corners with longitudes that run on from one to the next.
std::vector<Plane> unrolled(const std::vector<GeoPoint>& corners) {
  std::vector<Plane> result;
  result.reserve(corners.size());
  for (const auto& p : corners) {
    const double lon = p.lon.radians();
    result.push_back({result.empty() ? lon : result.back().x + folded(lon - result.back().x), p.lat.radians()});
  }
  return result;
}

struct Extent {
  double low, high;
};
Extent longitudes(const std::vector<Plane>& points) {
  const auto [low, high] =
      std::minmax_element(points.begin(), points.end(), [](const Plane& a, const Plane& b) { return a.x < b.x; });
  return {low->x, high->x};
}

bool between(const Plane& a, const Plane& b, const Plane& p) {
  return p.x >= std::min(a.x, b.x) && p.x <= std::max(a.x, b.x) && p.y >= std::min(a.y, b.y) &&
         p.y <= std::max(a.y, b.y);
}

/// Crossing, touching or overlapping.
bool meet(const Plane& a, const Plane& b, const Plane& c, const Plane& d) {
  const double s = turn(a, b, c), t = turn(a, b, d), u = turn(c, d, a), v = turn(c, d, b);
  if (((s > 0) != (t > 0)) && ((u > 0) != (v > 0)) && s != 0 && t != 0 && u != 0 && v != 0) return true;
  return (s == 0 && between(a, b, c)) || (t == 0 && between(a, b, d)) || (u == 0 && between(c, d, a)) ||
         (v == 0 && between(c, d, b));
}

struct EdgePair {
  std::size_t first, second;
};

/// The first two edges in order of longitude that meet elsewhere than at a shared corner.
std::optional<EdgePair> meeting_edges(const std::vector<Plane>& p) {
  const auto n = p.size();
  const auto to = [&](std::size_t i) { return p[i + 1 < n ? i + 1 : 0]; };
  const auto west = [&](std::size_t i) { return std::min(p[i].x, to(i).x); };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return west(a) < west(b); });
  for (std::size_t k = 0; k < n; ++k) {
    const auto i = order[k];
    const double east = std::max(p[i].x, to(i).x);
    for (std::size_t m = k + 1; m < n && west(order[m]) <= east; ++m) {
      const auto j = order[m];
      const auto low = std::min(i, j), high = std::max(i, j);
      const bool follows = high == low + 1, closes = low == 0 && high == n - 1;
      bool bad = false;
      if (follows || closes) {
        // Neighbours share a corner; they overlap when the second folds back onto the first.
        const auto& corner = follows ? p[high] : p[0];
        const auto& before = follows ? p[low] : p[high];
        const Plane after = follows ? to(high) : p[1];
        const double along =
            (before.x - corner.x) * (after.x - corner.x) + (before.y - corner.y) * (after.y - corner.y);
        bad = turn(before, corner, after) == 0 && along > 0;
      } else {
        bad = meet(p[low], to(low), p[high], to(high));
      }
      if (bad) return EdgePair{low, high};
    }
  }
  return std::nullopt;
}

}  // namespace

std::string AreaProblem::message() const {
  const auto corner = [](std::size_t i) { return std::to_string(i + 1); };
  std::string text = "area \"" + area + "\": ";
  switch (what) {
    case What::too_few_corners:
      return text + "fewer than three corners";
    case What::too_many_corners:
      return text + "more than " + std::to_string(kMostCorners) + " corners";
    case What::repeated_corner:
      return text + "corner " + corner(edge) + " and the next are the same";
    case What::crosses_itself:
      return text + "the edges from corner " + corner(edge) + " and from corner " + corner(other) + " cross or touch";
    case What::too_wide:
      return text + "180 degrees of longitude or wider";
    case What::too_far_north:
      return text + "corner " + corner(edge) + " lies beyond 85 degrees north or south";
  }
  return text;
}

Expected<Area, AreaProblem> checked_area(std::string name, std::vector<GeoPoint> corners) {
  using What = AreaProblem::What;
  const auto problem = [&](What what, std::size_t edge = 0, std::size_t other = 0) {
    return unexpected(AreaProblem{what, name, edge, other});
  };
  if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  const auto n = corners.size();
  if (n < 3) return problem(What::too_few_corners);
  if (n > kMostCorners) return problem(What::too_many_corners);
  for (std::size_t i = 0; i < n; ++i) {
    if (std::abs(corners[i].lat.radians()) > kFarthestNorth) return problem(What::too_far_north, i);
    if (corners[i] == corners[i + 1 < n ? i + 1 : 0]) return problem(What::repeated_corner, i);
  }
  const auto plane = unrolled(corners);
  // A polygon around a pole does not come back to its first longitude: its ends differ by a turn.
  const auto [low, high] = longitudes(plane);
  if (high - low >= kPi || std::abs(plane.back().x - plane.front().x) >= kPi) return problem(What::too_wide);
  if (const auto pair = meeting_edges(plane)) return problem(What::crosses_itself, pair->first, pair->second);
  return Area{std::move(name), std::move(corners)};
}

Region region_of(const Area& area) {
  Outline outline;
  if (area.vertices.size() < 3) return Region{std::move(outline)};
  const auto corners = unrolled(area.vertices);
  const auto [low, high] = longitudes(corners);
  outline.middle = 0.5 * (low + high);
  std::vector<Plane> ring;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto& from = area.vertices[i];
    const auto& to = area.vertices[i + 1 < corners.size() ? i + 1 : 0];
    const Plane a = corners[i];
    ring.push_back({a.x - outline.middle, a.y});
    const auto way = geodesic(from, to);
    const double lat = std::max(std::abs(from.lat.radians()), std::abs(to.lat.radians()));
    const auto pieces = 1 + static_cast<std::size_t>(way.length.si() / longest_piece(lat));
    for (std::size_t k = 1; k < pieces; ++k) {
      const auto p =
          destination(from, way.departing, way.length * (static_cast<double>(k) / static_cast<double>(pieces)));
      ring.push_back({a.x + folded(p.lon.radians() - a.x) - outline.middle, p.lat.radians()});
    }
  }
  outline.add_ring(ring);
  return Region{std::move(outline)};
}

}  // namespace glidehelm::chart
