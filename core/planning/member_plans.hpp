#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/planning/planner.hpp"

/// How plans differ that were made for one problem in the members of an ensemble.
namespace glidehelm::planning {

/// The plan of one member.
struct MemberPlan {
  std::optional<Seconds> travel;  ///< from the fix to the goal's radius; none: it does not arrive
  Metres remaining;               ///< as Plan::remaining
  std::optional<Heading> first;   ///< heading of the first stint; none: the plan has no stint
  std::optional<Radians> turn;    ///< from the control's first heading to this one's, clockwise, in (−π, π]
  /// The greatest distance of this plan's dives and surfacings from the control's way: never less than it is, and less than 1 % more for ways
  /// that lie within 300 km of each other at latitudes to 60°.
  std::optional<Metres> apart;
  friend bool operator==(const MemberPlan&, const MemberPlan&) = default;
};

/// `plan` beside `control`, which was made for the same problem. The ways go from the fix over all dives and surfacings, straight in latitude
/// and longitude between them. The nearest place of the way is looked for in the plane of the metric at each dive and surfacing, the distance to
/// it is geodesic. O(stints of one · stints of the other).
MemberPlan member_plan(const Plan& plan, const Plan& control, const Problem& problem);

/// All plans together. Quantiles are interpolated between values; none where nothing has one.
struct PlansSummary {
  std::size_t plans{}, arrived{};
  std::optional<Seconds> median, tenth, ninetieth;   ///< travel times of those that arrive
  std::optional<Radians> turned_left, turned_right;  ///< 10 and 90 % of `turn`
  std::optional<Metres> apart_median, apart_most;
  friend bool operator==(const PlansSummary&, const PlansSummary&) = default;
};
PlansSummary summary_of(std::span<const MemberPlan> plans);

}  // namespace glidehelm::planning
