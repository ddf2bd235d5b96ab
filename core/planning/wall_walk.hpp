#pragma once

#include <vector>

#include "core/chart/chart.hpp"
#include "core/ocean/field.hpp"
#include "core/planning/winding.hpp"

namespace glidehelm::planning {

/// The way along the border of what a chart allows: the arc of a best way that lies on an obstacle.
///
/// A best way past land is a chain of free extremals and of arcs on the border of the land, grown by the margin; it leaves an
/// arc along its tangent (in still water: the string pulled taut). So the end of a front at a wall goes along the border as fast as
/// a vehicle can: with ν the normal of the border into the water, τ its tangent and c the current, the heading −(c·ν)/U·ν +
/// √(1 − (c·ν)²/U²)·τ holds it on the border with the speed c·τ + √(U² − (c·ν)²). That heading is the front's normal there.
/// Where the current presses it against the wall more than it can steer, it goes along with c·τ (early, never late); where the
/// current takes it off, it stays.
///
/// Where the border bends away from the water the way can leave it on every tangent: a marker is sent off each `kSend` of the
/// bend. At a sharp corner they are a fan. Ground that a current has carried the walker back over sends nothing a second time: what
/// was sent off there is in the water, and between it and the walker the front is refined.
///
/// The border is the level line of the clearance, followed by the midpoint rule and brought back to the level after each
/// stride; ν is a difference of clearances. Strides are halved until the border turns by less than `kMostBend` in half of one, or are
/// `kShortestStride`: so sharp corners cost at most that way each. Six clearances for each stride.
///
/// Radians, metres, seconds, m/s.
class WallWalk {
 public:
  static constexpr double kMostBend = 0.1, kLongestStride = 500.0, kShortestStride = 4.0;  ///< rad, m, m
  static constexpr double kSend = 0.2;                                                     ///< rad
  static constexpr double kOff = 2.0;    ///< metres beyond the clearance at which the border is followed
  static constexpr double kMeet = 15.0;  ///< metres: as near as this two on the same wall have met

  /// `clearance` ≥ 0; the chart outlives this.
  WallWalk(const chart::Chart& chart, double clearance) : chart_{chart}, level_{clearance + kOff} {}

  /// Brings a marker from within some metres onto the border. False, and nothing is changed, when no border is there.
  [[nodiscard]] bool settle(Marker& m) const;

  enum class Way { forward, back };  ///< with the land to the left, to the right
  enum class End { under_way, met, no_water, no_border };
  /// Walks for `seconds` from epoch second `t_s` and gives the marker its new normal (unless `speed` is 0). `met`: it came to
  /// `towards` (if not null) and stays there; `no_water`: the field has no current on its way, or it is too shallow;
  /// `no_border`: the clearance has no slope: two walls are a few metres apart. `sent`: what left the
  /// border on the way, in order, with what was `left` of the seconds.
  End walk(Marker& m, Way way, const Marker* towards, ocean::FieldRef field, double speed, double t_s, double seconds,
           std::vector<Marker>& sent);
  [[nodiscard]] std::size_t evaluations() const { return evaluations_; }  ///< of the current

 private:
  struct Border {
    double above;        ///< clearance beyond the level
    double east, north;  ///< ν
    bool found;
  };
  [[nodiscard]] Border border(double lat, double lon) const;

  const chart::Chart& chart_;
  double level_;
  std::size_t evaluations_{};
};

}  // namespace glidehelm::planning
