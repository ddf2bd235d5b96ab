#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/chart/outline.hpp"

namespace glidehelm::chart {

/// The even-odd rule with edges sorted into bands of latitude: a ray along the parallel meets only the edges of its own
/// band. Half-open comparisons count a corner once, so the answer is exact for the points as stored. Built in O(edges);
/// a query looks at the edges that cross one band, typically some hundreds for a detailed coast. At most 8 entries per
/// edge are kept, whatever the edges.
class EvenOdd {
 public:
  EvenOdd() = default;
  explicit EvenOdd(const Outline& outline);
  /// `outline` is the one that this was built for.
  [[nodiscard]] bool contains(const Outline& outline, Plane p) const;

 private:
  [[nodiscard]] std::size_t band(double y) const;
  double south_{}, north_{-1}, west_{}, east_{-1}, bands_per_radian_{};
  std::vector<std::uint32_t> first_;  ///< per band the index into edges_, one more at the end
  std::vector<std::uint32_t> edges_;  ///< first points of edges
};

}  // namespace glidehelm::chart
