#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/planning/planner.hpp"
#include "core/vehicle/steering.hpp"

/// From headings to a Plan: what every planner ends with.
namespace glidehelm::planning {

/// The goal of a problem as a disc.
vehicle::Disc disc_of(const Problem& problem);
/// The problem as the steering room takes it. `believed`: ĉ of the first stint.
vehicle::Flight flight_of(const Problem& problem);
vehicle::Waters waters_of(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart);

/// Why nothing can be planned at all: a start or goal on land or outside the field or the chart, no forecast at the
/// start's time. A start inside the coastal margin is fine, a goal inside it too.
std::optional<PlanFailure> check_ends(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart);

/// A plan from what was flown. When the goal is not reached, `reason` says why and `remaining` is the geodesic distance from
/// the goal's centre at the nearest position of the way.
Plan plan_from(std::string method, const vehicle::FlownList& flown, const Problem& problem,
               const Statistics& statistics);

/// True when `a` is the better answer: arriving beats not arriving, then earlier, then nearer; a tie is not better.
bool better_than(const Plan& a, const Plan& b);

/// True under MinDistanceAt.
bool wants_least_distance(const Problem& problem);
/// MinDistanceAt that time, or MinTime when there is none or no stint of the problem surfaces by then: that time has passed.
Objective objective_at(std::optional<double> epoch_s, const Problem& problem);
/// The problem with its horizon at the instant of MinDistanceAt where that is earlier; as it is under MinTime.
Problem within_objective(const Problem& problem);
/// How many stints surface by the horizon.
int stints_within(const Problem& problem);
/// The answer of a method that knows MinTime alone.
PlanFailure only_least_time(std::string_view method);

/// Still-water travel time of a problem, surface intervals included: (geodesic − radius)/U on the dive schedule.
Seconds still_water_time(const Problem& problem);

/// How far ahead a plan looks where nobody says: three times the still-water time, and at least `kLeastHorizonStints`
/// stints: near its goal a glider may have to wait for an eddy to pass, or go round it (docs/decisions/010).
Seconds automatic_horizon(const Problem& problem);
inline constexpr int kLeastHorizonStints = 12;

}  // namespace glidehelm::planning
