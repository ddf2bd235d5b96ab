#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/chart/space.hpp"

namespace glidehelm::chart {

/// What the edge from one point of an outline to the next is.
enum class Edge : std::uint8_t {
  none,    ///< the point ends its ring
  cut,     ///< runs along the border of a cut: bounds the inside, but there is nothing to keep clear of
  barrier  ///< a border to keep clear of
};

/// Closed rings as arrays. `plane[i]`, `space[i]` and `edge[i]` belong together; a ring ends with its first point repeated.
struct Outline {
  double middle{};  ///< the longitude of x = 0; all x lie within ±π of it as long as the outline is less than 360° wide
  std::vector<Plane> plane;
  std::vector<Space> space;
  std::vector<Edge> edge;

  /// Adds a ring; the last point joins the first. Barrier edges are divided into pieces no longer than `longest_piece`.
  /// `cut` is empty or says of each point whether the edge that it begins is a cut edge.
  void add_ring(std::span<const Plane> ring, const std::vector<bool>& cut = {});
  [[nodiscard]] std::size_t size() const { return plane.size(); }

 private:
  void add_point(Plane at, Edge next);
};

/// Into how many pieces add_ring divides a barrier edge.
std::size_t pieces_of(const Plane& a, const Plane& b);

}  // namespace glidehelm::chart
