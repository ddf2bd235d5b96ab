#pragma once

#include "core/safety/rules.hpp"

namespace glidehelm::safety {

// The rules on the re-flown track ("2 …"); what they find and allow stands in rules.hpp.
Margin judge_flight(const Evidence& evidence);
Margin judge_land(const Evidence& evidence);
Margin judge_depth(const Evidence& evidence);
Margin judge_areas(const Evidence& evidence);
Margin judge_tail(const Evidence& evidence);

/// A distance in metres that must not fall below a margin along a track.
struct Kept {
  bool holds{true};
  double found{};       ///< smallest distance once outside the margin; the last one when never outside
  std::size_t where{};  ///< index of the track point that decided
};
enum class Distance { coast, clearance };
/// Follows track points [first, last). A track that starts inside the margin may only increase the distance (to within
/// 10 m, five times the chart's error at 1 km) until it is outside; from then on every point keeps the margin. Between
/// neighbours at most L apart the distance is at most L²/(8·margin) smaller: 1 m at the usual 140 m and 2 km; for a
/// margin of 0 the segments are asked as well.
Kept keeps_margin(std::span<const TrackPoint> track, std::size_t first, std::size_t last, double margin, Distance kind,
                  const chart::Chart& chart);

}  // namespace glidehelm::safety
