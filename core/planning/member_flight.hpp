#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/planning/planner.hpp"

/// What becomes of one plan when the ocean is another member of an ensemble.
namespace glidehelm::planning {

/// One flight of a plan in one member.
struct MemberFlight {
  std::optional<Seconds> travel;      ///< from the fix to the goal's radius; none: the goal is not reached
  Metres remaining;                   ///< geodesic distance from the goal's centre at the closest position
  std::optional<Metres> coast;        ///< nearest shore of the way, up to Chart::kHorizon; none without a coastline
  std::optional<vehicle::Lost> lost;  ///< why it ended early; none: it arrived or the horizon came
  friend bool operator==(const MemberFlight&, const MemberFlight&) = default;
};

/// Flies the plan's headings in `ocean` as the pilot keeps a plan: at each surfacing a new list aims along the next of them
/// from where the glider really is, after the last one at the goal itself (vehicle::fly_headings). The way that the coast is
/// measured from is straight from dive to surfacing and from there to the next dive, looked at every 500 m at most, so a
/// shore is at most 250 m nearer than is said.
MemberFlight fly_in_member(const Plan& plan, const Problem& problem, const ocean::Ocean& ocean,
                           const chart::Chart& chart);

/// All flights of one plan together.
struct MemberSummary {
  std::size_t flights{}, arrived{};
  std::optional<Seconds> median, tenth, ninetieth;  ///< travel times of those that arrive, between values interpolated
  std::optional<Metres> coast;                      ///< the nearest of all
  /// Share of the members in which the plan arrives, 0 to 1. Precondition: there are flights.
  [[nodiscard]] double share() const { return static_cast<double>(arrived) / static_cast<double>(flights); }
  friend bool operator==(const MemberSummary&, const MemberSummary&) = default;
};
MemberSummary summary_of(std::span<const MemberFlight> flights);

}  // namespace glidehelm::planning
