#include "daemon/candidate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/utc.hpp"
#include "core/ocean/corrected.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/registry.hpp"
#include "core/vehicle/steering.hpp"
#include "core/vehicle/yo_field.hpp"
#include "daemon/world/workers.hpp"
#include "protocol/goto_list.hpp"

namespace glidehelm::daemon {

namespace {

/// The forecast as a request wants it: corrected by what the glider measured, where that is known.
class PlanningOcean {
 public:
  PlanningOcean(const OceanSource& source, const mission::PlanningRequest& request)
      : ocean_{source.forecast.ocean()}, full_{source.forecast.full()}, deep_{source.forecast.facts().levels > 1} {
    if (request.correction && request.correction->plausible()) {
      corrected_.emplace(ocean_, *request.correction);
      corrected_full_.emplace(full_, *request.correction);
    }
    if (request.motion == vehicle::MotionModel::yo_yo && deep_)
      yo_.emplace(*full(), request.problem.glider, request.problem.schedule, request.problem.start.fix_s);
  }
  PlanningOcean(const PlanningOcean&) = delete;
  PlanningOcean& operator=(const PlanningOcean&) = delete;
  [[nodiscard]] ocean::Ocean ocean() const {
    const auto waters = corrected_ ? corrected_->ocean() : ocean_;
    return yo_ ? ocean::Ocean{*yo_, waters.surface} : waters;
  }
  /// With its depths; none for a forecast that has none.
  [[nodiscard]] std::optional<ocean::FieldRef> full() const {
    if (!deep_) return std::nullopt;
    return corrected_full_ ? ocean::FieldRef{*corrected_full_} : full_;
  }

 private:
  ocean::Ocean ocean_;
  ocean::FieldRef full_;
  bool deep_;
  std::optional<ocean::CorrectedOcean> corrected_;
  std::optional<ocean::CorrectedField> corrected_full_;
  std::optional<vehicle::YoField> yo_;
};

safety::Promise promise_of(const model::WaypointList& list, const vehicle::FlownList& flown,
                           const planning::Problem& problem) {
  const auto goal = planning::disc_of(problem);
  safety::Promise promise;
  promise.points = list.points;
  promise.radius = list.radius;
  promise.at_end = list.at_end;
  promise.goal = goal.centre;
  promise.goal_radius = goal.radius;
  promise.next_surfacing = flown.stints.empty() ? problem.start.fix : flown.stints.front().surface;
  promise.list_arrival_s = flown.arrival_s;
  return promise;
}

mission::Candidate with_list(planning::Plan plan, const model::WaypointList& list,
                             const mission::PlanningRequest& request, const planning::Problem& problem,
                             const OceanSource& ocean, const chart::Chart& chart) {
  const PlanningOcean waters_ocean{ocean, request};
  // What is promised is what the verifier re-flies: with the depths.
  const vehicle::Waters waters{waters_ocean.ocean(), chart, problem.coast_margin, waters_ocean.full()};
  mission::Candidate candidate;
  candidate.request = request.id;
  candidate.plan = std::move(plan);
  candidate.list = list;
  candidate.promise = promise_of(list, vehicle::fly_list(list, planning::flight_of(problem), waters), problem);
  candidate.file_name = protocol::goto_list_name(request.slot);
  candidate.file_bytes = protocol::write_goto_list(list, {request.stamp, request.surfacing, candidate.plan.method});
  candidate.horizon_s = problem.horizon_s;
  candidate.forecast = ocean.label();
  return candidate;
}

/// One waypoint, the goal: the glider stays there (product.md 4.9).
mission::Candidate station(const mission::PlanningRequest& request, const planning::Problem& problem,
                           const OceanSource& ocean, const chart::Chart& chart) {
  const auto goal = planning::disc_of(problem);
  model::WaypointList list;
  list.points = {{goal.centre, model::WaypointRole::goal}};
  list.radius = Metres{std::ceil(std::max(50.0, 0.25 * goal.radius.si()))};
  list.at_end = model::AtEnd::loop;
  planning::Plan plan;
  plan.method = "station";
  plan.status = planning::PlanStatus::reaches_goal;
  plan.arrival_s = problem.start.fix_s;
  return with_list(std::move(plan), list, request, problem, ocean, chart);
}

/// The file that lies in to-glider since an earlier surfacing, as it is flown from this fix.
mission::Candidate queued(const mission::QueuedFile& file, const mission::PlanningRequest& request,
                          const planning::Problem& problem, const OceanSource& ocean, const chart::Chart& chart) {
  planning::Plan plan;
  plan.method = "queued";
  plan.arrival_s = std::nan("");
  plan.remaining = distance(problem.start.fix, planning::disc_of(problem).centre);
  plan.reason = "the list of an earlier surfacing";
  auto candidate = with_list(std::move(plan), file.list, request, problem, ocean, chart);
  if (const auto arrival = candidate.promise.list_arrival_s) {
    candidate.plan.status = planning::PlanStatus::reaches_goal;
    candidate.plan.arrival_s = *arrival;
    candidate.plan.remaining = Metres{0};
    candidate.plan.reason.clear();
  }
  candidate.file_name = file.name;
  candidate.file_bytes = file.bytes;
  return candidate;
}

/// What a proof over [from_s, to_s] assumes of times that the forecast does not have; nothing where it has them all.
std::string assumed_of_time(const OceanSource& ocean, double from_s, double to_s) {
  const auto c = ocean.forecast.ocean().dive.coverage();
  if (c.first_s <= from_s && to_s <= c.last_s) return "";
  const auto policy = ocean.sources.empty() ? ocean.options.outside_time : ocean.sources.front().options.outside_time;
  const bool one = std::all_of(ocean.sources.begin(), ocean.sources.end(),
                               [&](const auto& source) { return source.options.outside_time == policy; });
  const char* how = !one                                  ? "each source as its outside_time says"
                    : policy == ocean::OutsideTime::hold  ? "held before and after (outside_time: hold)"
                    : policy == ocean::OutsideTime::cycle ? "repeated as a tide before and after (outside_time: cycle)"
                                                          : "and none before and after (outside_time: forbid)";
  return ", with the currents of " + utc_text(instant_at(c.first_s)) + " to " + utc_text(instant_at(c.last_s)) + " " +
         how;
}

}  // namespace

double horizon_of(const mission::PlanningRequest& request) {
  const auto& p = request.problem;
  if (request.horizon_wanted.count() > 0) {
    const Seconds least = p.schedule.surfacing_time(1) + p.schedule.surface;
    return p.start.fix_s + std::max(request.horizon_wanted, least).count();
  }
  if (const auto* least = std::get_if<planning::MinDistanceAt>(&p.objective)) return least->epoch_s;
  return p.start.fix_s + planning::automatic_horizon(p).count();
}

mission::Candidate candidate_for(const planning::Plan& plan, const mission::PlanningRequest& request,
                                 const planning::Problem& problem, const OceanSource& ocean,
                                 const chart::Chart& chart) {
  const PlanningOcean waters_ocean{ocean, request};
  const vehicle::Waters waters{waters_ocean.ocean(), chart, problem.coast_margin};
  const auto list = vehicle::list_for(plan.stints, planning::flight_of(problem), waters,
                                      {request.max_waypoints, request.list_radius, request.at_end});
  return with_list(plan, list, request, problem, ocean, chart);
}

std::string answer(const mission::PlanningRequest& request, const OceanSource& ocean, const chart::Chart& chart,
                   const std::function<bool()>& expired, const std::function<void(mission::Candidate)>& found,
                   std::uint64_t work) {
  auto problem = request.problem;
  problem.horizon_s = horizon_of(request);
  std::uint64_t number = 0;
  const auto give = [&](mission::Candidate candidate) {
    candidate.number = ++number;
    found(std::move(candidate));
  };
  if (request.queued) give(queued(*request.queued, request, problem, ocean, chart));
  if (request.purpose == mission::PlanningRequest::Purpose::station) {
    give(station(request, problem, ocean, chart));
    return "";
  }
  const auto planner = planning::planner_named(request.method);
  if (!planner) return "there is no method " + request.method;
  const PlanningOcean waters{ocean, request};
  const std::array<ocean::Ocean, 1> members{waters.ocean()};
  const auto found_before = number;
  std::string last_method;
  const auto plan = planner->plan(problem, members, chart, {work, expired}, [&](const planning::Plan& p) {
    if (p.stints.empty() || p.method == last_method) return;  // the final call repeats the best plan
    last_method = p.method;
    give(candidate_for(p, request, problem, ocean, chart));
  });
  if (!plan) return plan.error().message;
  if (number == found_before) return plan->reason.empty() ? "the plan has no stint" : plan->reason;
  return "";
}

Expected<planning::Bound, planning::PlanFailure> certificate(const mission::PlanningRequest& request,
                                                             const OceanSource& ocean, const chart::Chart& chart,
                                                             double known_arrival_s,
                                                             const std::function<bool()>& expired) {
  auto problem = request.problem;
  problem.horizon_s = horizon_of(request);
  const PlanningOcean waters{ocean, request};
  planning::BoundSettings settings;
  if (!std::isnan(known_arrival_s)) settings.earlier_than_s = known_arrival_s;
  settings.at_once = [](std::size_t count, const std::function<void(std::size_t)>& body) {
    world::for_each_index(count, 0, body);
  };
  world::Turns turns;
  const auto one_at_a_time = [&] {
    bool is_over = false;
    turns.take([&] { is_over = expired(); });
    return is_over;
  };
  const auto asked = expired ? std::function<bool()>{one_at_a_time} : std::function<bool()>{};
  auto bound = planning::lower_bound(problem, waters.ocean(), chart, {kCertificateWork, asked}, settings);
  if (bound && bound->kind == planning::Bound::Kind::unreachable)
    bound->reason += assumed_of_time(ocean, problem.start.fix_s, problem.horizon_s);
  return bound;
}

}  // namespace glidehelm::daemon
