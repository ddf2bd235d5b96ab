#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/chart/outline.hpp"

namespace glidehelm::chart {

/// A piece of a track: straight on the plane of its outline, and its ends in space.
struct Piece {
  Plane a, b;
  Space from, to;
};

/// The barrier edges of an outline under a tree of boxes in space (runs of neighbouring edges at the leaves, split at the
/// median of the longest side). Built in O(n log n); a query visits O(log n) boxes plus the edges that compete.
class Barrier {
 public:
  Barrier() = default;
  explicit Barrier(const Outline& outline);

  /// Distance to the nearest barrier edge, or `at_most` when none is nearer. `outline` is the one this was built for.
  [[nodiscard]] double distance(const Outline& outline, const Space& p, double at_most) const;
  /// True when a barrier edge crosses the piece or is nearer to it than `margin`.
  [[nodiscard]] bool touches(const Outline& outline, const Piece& piece, double margin) const;

 private:
  struct Run {
    Space low, high;
    std::uint32_t first, count;
  };
  /// A box that holds everything below it, rounded outwards. `count` edges from point `next`, or, with count 0, the
  /// children: the node after this one and the node `next`.
  struct Node {
    std::array<float, 3> low, high;
    std::uint32_t next, count;
  };
  [[nodiscard]] static std::vector<Run> runs_of(const Outline& outline);
  void build(std::vector<Run>& runs, std::size_t begin, std::size_t end);
  std::vector<Node> nodes_;
};

}  // namespace glidehelm::chart
