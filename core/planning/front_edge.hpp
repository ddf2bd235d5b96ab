#pragma once

#include <cmath>

#include "core/base/local_metric.hpp"
#include "core/planning/winding.hpp"

/// The geometry of a front between two neighbours. Planar: edges are short against the Earth. Metres, radians.
namespace glidehelm::planning {

/// Turned clockwise.
Offset turned(double east, double north, double clockwise);
/// Clockwise from a's normal to b's.
double turn_between(const Marker& a, const Marker& b);
Offset from_to(const Marker& a, const Marker& b);
/// Distance of the origin from a segment.
double segment_distance(double x0, double y0, double x1, double y1);

/// The front between a marker and the next.
class FrontEdge {
 public:
  enum class Shape {
    smooth,  ///< the cubic that has both normals; its error is of fourth order
    corner,  ///< a straight line whose normals turn evenly: a cusp
    chord    ///< a straight line with its own normal: one end lies at a wall, and its normal is not the front's
  };
  static constexpr double kSmoothTurn = 1.0;    ///< radians between the normals: beyond it an edge is a cusp
  static constexpr double kSmoothCorner = 2.2;  ///< the same beside a coast, where a corner makes an arc of a circle

  FrontEdge(const Marker& a, const Marker& b);
  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] double turn() const { return turn_; }
  [[nodiscard]] Shape shape() const { return shape_; }
  /// The marker at a share of the way: free, with no mark of its neighbours.
  [[nodiscard]] Marker at(double share) const;

 private:
  const Marker &a_, &b_;
  Offset way_;
  double length_, turn_;
  Shape shape_;
  double bow_{1};  ///< length of the cubic's end tangents over that of the chord: with it a circle's arc is one
};

}  // namespace glidehelm::planning
