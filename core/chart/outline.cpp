#include "core/chart/outline.hpp"

namespace glidehelm::chart {

std::size_t pieces_of(const Plane& a, const Plane& b) {
  const double lat = std::max(std::abs(a.y), std::abs(b.y));
  // The wider parallel of the two, and the largest meridian radius: never fewer pieces than needed.
  const bool across = (a.y < 0) != (b.y < 0);
  const double east =
      (b.x - a.x) * LocalMetric::at(across ? 0.0 : std::min(std::abs(a.y), std::abs(b.y))).parallel_radius;
  const double north = (b.y - a.y) * LocalMetric::at(lat).meridian_radius;
  return 1 + static_cast<std::size_t>(std::hypot(east, north) / longest_piece(lat));
}

void Outline::add_point(Plane at, Edge next) {
  plane.push_back(at);
  space.push_back(Space::at(at.y, middle + at.x));
  edge.push_back(next);
}

void Outline::add_ring(std::span<const Plane> ring, const std::vector<bool>& cut) {
  if (ring.empty()) return;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Plane a = ring[i], b = ring[i + 1 < ring.size() ? i + 1 : 0];
    const bool is_cut = !cut.empty() && cut[i];
    add_point(a, is_cut ? Edge::cut : Edge::barrier);
    const std::size_t pieces = is_cut ? 1 : pieces_of(a, b);
    for (std::size_t k = 1; k < pieces; ++k) {
      const double t = static_cast<double>(k) / static_cast<double>(pieces);
      add_point({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}, Edge::barrier);
    }
  }
  add_point(ring.front(), Edge::none);
}

}  // namespace glidehelm::chart
