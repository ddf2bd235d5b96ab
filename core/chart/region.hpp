#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/chart/barrier.hpp"
#include "core/chart/even_odd.hpp"
#include "core/chart/outline.hpp"

namespace glidehelm::chart {

/// The inside of closed rings by the even-odd rule (islands, lakes, islands in lakes), with distances to its border.
/// Land, the area of a coast file, an operating area: each is one region. Immutable; const calls are safe from several
/// threads.
class Region {
 public:
  Region() = default;
  explicit Region(Outline outline);

  /// Even-odd over all rings. A position on the border may count as either.
  [[nodiscard]] bool contains(double lat, double lon) const;
  /// Distance to the nearest edge that is no cut edge, or `at_most` when none is nearer. Infinite bounds are allowed.
  [[nodiscard]] double distance(const Space& p, double at_most) const;
  /// True when an edge that is no cut edge crosses the piece or comes nearer to it than `margin` (≥ 0). The piece is at
  /// most `longest_piece` long; it runs straight in latitude and longitude.
  [[nodiscard]] bool touches(double lat0, double lon0, double lat1, double lon1, double margin) const;

  [[nodiscard]] const Outline& outline() const { return outline_; }

 private:
  Outline outline_;
  EvenOdd even_odd_;
  Barrier barrier_;
};

}  // namespace glidehelm::chart
