#include "core/planning/member_plans.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/local_metric.hpp"
#include "core/base/quantile.hpp"

namespace glidehelm::planning {

namespace {

std::vector<GeoPoint> way_of(const Plan& plan, GeoPoint fix) {
  std::vector<GeoPoint> way{fix};
  for (const auto& stint : plan.stints) way.insert(way.end(), {stint.dive, stint.surface});
  return way;
}

/// The place of the segment from `a` to `b` that is nearest to `p` in the plane of the metric at `p`, and its distance there.
struct Foot {
  double distance;
  GeoPoint at;
};
Foot foot_on(GeoPoint a, GeoPoint b, GeoPoint p) {
  const auto metric = LocalMetric::at(p.lat.radians());
  const double dlon = std::remainder(b.lon.radians() - a.lon.radians(), 2 * kPi);
  const double ax = metric.parallel_radius * std::remainder(a.lon.radians() - p.lon.radians(), 2 * kPi);
  const double ay = metric.meridian_radius * (a.lat.radians() - p.lat.radians());
  const double dx = metric.parallel_radius * dlon;
  const double dy = metric.meridian_radius * (b.lat.radians() - a.lat.radians());
  const double length2 = dx * dx + dy * dy;
  const double share = length2 > 0 ? std::clamp(-(ax * dx + ay * dy) / length2, 0.0, 1.0) : 0.0;
  return {std::hypot(ax + share * dx, ay + share * dy),
          GeoPoint::from_kernel(a.lat.radians() + share * (b.lat.radians() - a.lat.radians()),
                                a.lon.radians() + share * dlon)};
}

Metres distance_to_way(GeoPoint p, const std::vector<GeoPoint>& way) {
  Foot nearest{std::numeric_limits<double>::infinity(), way.front()};
  for (std::size_t k = 1; k < way.size(); ++k) {
    const auto foot = foot_on(way[k - 1], way[k], p);
    if (foot.distance < nearest.distance) nearest = foot;
  }
  return distance(p, nearest.at);
}

}  // namespace

MemberPlan member_plan(const Plan& plan, const Plan& control, const Problem& problem) {
  MemberPlan member;
  if (plan.reaches_goal()) member.travel = Seconds{plan.arrival_s - problem.start.fix_s};
  member.remaining = plan.remaining;
  if (plan.stints.empty()) return member;
  member.first = plan.stints.front().heading;
  if (control.stints.empty()) return member;
  member.turn = *member.first - control.stints.front().heading;
  const auto way = way_of(control, problem.start.fix);
  Metres apart{0};
  for (const auto p : way_of(plan, problem.start.fix)) apart = std::max(apart, distance_to_way(p, way));
  member.apart = apart;
  return member;
}

PlansSummary summary_of(std::span<const MemberPlan> plans) {
  PlansSummary summary;
  std::vector<double> times, turns, apart;
  for (const auto& plan : plans) {
    if (plan.travel) times.push_back(plan.travel->count());
    if (plan.turn) turns.push_back(plan.turn->si());
    if (plan.apart) apart.push_back(plan.apart->si());
  }
  const auto at = [](const auto& values, double share, auto unit) -> std::optional<decltype(unit)> {
    const auto value = quantile(values, share);
    return value ? std::optional{decltype(unit){*value}} : std::nullopt;
  };
  summary.plans = plans.size();
  summary.arrived = times.size();
  summary.median = at(times, 0.5, Seconds{});
  summary.tenth = at(times, 0.1, Seconds{});
  summary.ninetieth = at(times, 0.9, Seconds{});
  summary.turned_left = at(turns, 0.1, Radians{});
  summary.turned_right = at(turns, 0.9, Radians{});
  summary.apart_median = at(apart, 0.5, Metres{});
  summary.apart_most = at(apart, 1.0, Metres{});
  return summary;
}

}  // namespace glidehelm::planning
