#include "core/planning/member_flight.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/quantile.hpp"
#include "core/planning/flight.hpp"

namespace glidehelm::planning {

namespace {

constexpr double kLook = 500.0;  // m

/// Nearest shore along the geodesic from `from` (not looked at again) to `to`.
void look_along(GeoPoint from, GeoPoint to, const chart::Chart& chart, Metres& nearest) {
  const auto way = geodesic(from, to);
  const double pieces = std::max(1.0, std::ceil(way.length.si() / kLook));
  for (double k = 1; k <= pieces; ++k)
    nearest = std::min(nearest,
                       chart.distance_to_coast(destination(from, way.departing, Metres{way.length.si() * k / pieces})));
}

std::optional<Metres> nearest_coast(GeoPoint fix, const std::vector<vehicle::Stint>& stints,
                                    const chart::Chart& chart) {
  if (!chart.has_coast()) return std::nullopt;
  Metres nearest = chart.distance_to_coast(fix);
  GeoPoint at = fix;
  for (const auto& stint : stints)
    for (const auto next : {stint.dive, stint.surface}) {
      look_along(at, next, chart, nearest);
      at = next;
    }
  return nearest;
}

}  // namespace

MemberFlight fly_in_member(const Plan& plan, const Problem& problem, const ocean::Ocean& ocean,
                           const chart::Chart& chart) {
  std::vector<Heading> headings;
  for (const auto& stint : plan.stints) headings.push_back(stint.heading);
  const auto within = within_objective(problem);
  const auto flown = vehicle::fly_headings(headings, flight_of(within), waters_of(within, ocean, chart));
  const auto as_plan = plan_from(plan.method, flown, problem, {});
  MemberFlight flight;
  if (as_plan.reaches_goal()) flight.travel = Seconds{as_plan.arrival_s - problem.start.fix_s};
  flight.remaining = as_plan.remaining;
  flight.coast = nearest_coast(problem.start.fix, flown.stints, chart);
  if (!flight.travel) flight.lost = flown.lost;
  return flight;
}

MemberSummary summary_of(std::span<const MemberFlight> flights) {
  MemberSummary summary;
  std::vector<double> times;
  for (const auto& flight : flights) {
    if (flight.travel) times.push_back(flight.travel->count());
    if (flight.coast) summary.coast = std::min(summary.coast.value_or(*flight.coast), *flight.coast);
  }
  const auto at = [&](double share) -> std::optional<Seconds> {
    const auto value = quantile(times, share);
    return value ? std::optional{Seconds{*value}} : std::nullopt;
  };
  summary.flights = flights.size();
  summary.arrived = times.size();
  summary.median = at(0.5);
  summary.tenth = at(0.1);
  summary.ninetieth = at(0.9);
  return summary;
}

}  // namespace glidehelm::planning
