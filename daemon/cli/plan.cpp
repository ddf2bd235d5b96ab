#include "daemon/cli/plan.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/utc.hpp"
#include "core/planning/flight.hpp"
#include "daemon/candidate.hpp"
#include "daemon/cli/new_file.hpp"
#include "daemon/cli/plan_case.hpp"
#include "daemon/cli/plan_each.hpp"
#include "daemon/cli/plan_members.hpp"
#include "daemon/places.hpp"
#include "daemon/verify/judge_request.hpp"
#include "daemon/world/program_version.hpp"
#include "daemon/world/terminal.hpp"

namespace glidehelm::cli {

namespace {

using Json = nlohmann::ordered_json;

Json place(GeoPoint p) { return {{"lat_deg", p.lat.degrees()}, {"lon_deg", p.lon.degrees()}}; }
Json place(GeoPoint p, double t_s) {
  Json j = place(p);
  j["time"] = utc_text(instant_at(t_s), true);
  return j;
}
Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json objective_json(const planning::Objective& objective) {
  const auto* least = std::get_if<planning::MinDistanceAt>(&objective);
  if (!least) return {{"kind", "min_time"}};
  return {{"kind", "min_distance_at"}, {"time", utc_text(instant_at(least->epoch_s), true)}};
}

/// Null without a body.
Json force_balance_json(const Case& c) {
  if (c.water == mission::WaterFrom::none) return nullptr;
  const auto& words = c.ocean->forecast.facts().water.words;
  return {{"glide_angle_deg", in_degrees(c.mission.glide_angle)},
          {"water", mission::word(c.water)},
          {"forecast_water", words.empty() ? Json(nullptr) : Json(words)}};
}

Json inputs_json(const Case& c) {
  const auto& p = c.request.problem;
  const auto& goal = std::get<planning::PointGoal>(p.goal);
  return {{"horizontal_speed_m_per_s", p.glider.horizontal_speed.si()},
          {"believed_speed_m_per_s", p.glider.believed_speed.si()},
          {"current_correction", p.glider.current_correction},
          {"force_balance", force_balance_json(c)},
          {"stint_s", p.schedule.stint.count()},
          {"first_stint_s", p.schedule.first_stint.count()},
          {"surface_s", p.schedule.surface.count()},
          {"time_to_dive_s", p.schedule.time_to_dive.count()},
          {"goal",
           {{"kind", "point"},
            {"lat_deg", goal.at.lat.degrees()},
            {"lon_deg", goal.at.lon.degrees()},
            {"radius_m", goal.radius.si()}}},
          {"objective", objective_json(p.objective)},
          {"outside_time", c.mission.currents.outside_time == ocean::OutsideTime::hold    ? "hold"
                           : c.mission.currents.outside_time == ocean::OutsideTime::cycle ? "cycle"
                                                                                          : "forbid"},
          {"horizon_s", p.horizon_s - p.start.fix_s},
          {"seed", p.seed},
          {"headings", p.headings},
          {"cell_m", p.cell.si()}};
}

/// Null where there is no bound, or no plan that arrives to compare with.
void add_certificate(Json& j, const Expected<planning::Bound, planning::PlanFailure>& bound, double travel_s) {
  const bool known = bound && bound->kind == planning::Bound::Kind::arrival;
  j["lower_bound_s"] = known ? Json(bound->travel_s) : Json(nullptr);
  j["lower_bound_error_s"] = known ? Json(bound->error_s) : Json(nullptr);
  j["gap"] = known && bound->travel_s > 0 ? number_or_null(travel_s / bound->travel_s - 1) : Json(nullptr);
}

/// No plan arrives, and it is proven that none can.
bool proven_unreachable(const Expected<planning::Bound, planning::PlanFailure>& bound, bool arrives) {
  return !arrives && bound && bound->kind == planning::Bound::Kind::unreachable;
}

Json plan_json(const Case& c, const std::optional<mission::Candidate>& found,
               const Expected<planning::Bound, planning::PlanFailure>& bound, const std::string& problem,
               double wall_s) {
  const auto& p = c.request.problem;
  Json j{{"schema", "glidehelm/plan/v1"}};
  const planning::Plan nothing;
  const auto& plan = found ? found->plan : nothing;
  j["method"] = found ? plan.method : c.request.method;
  const bool arrives = found && plan.reaches_goal();
  const bool proven = proven_unreachable(bound, arrives);
  j["status"] = proven ? "proven_unreachable" : !found ? "no_plan" : arrives ? "reaches_goal" : "closest_approach";
  j["reason"] = proven ? bound->reason : found ? plan.reason : problem;
  j["inputs"] = inputs_json(c);
  j["start"] = place(p.start.fix, p.start.fix_s);
  j["travel_time_s"] = arrives ? Json(plan.arrival_s - p.start.fix_s) : Json(nullptr);
  j["arrival"] = arrives ? Json(utc_text(instant_at(plan.arrival_s), true)) : Json(nullptr);
  j["remaining_distance_m"] = found ? plan.remaining.si() : distance(p.start.fix, planning::disc_of(p).centre).si();
  add_certificate(j, bound, arrives ? plan.arrival_s - p.start.fix_s : std::nan(""));
  j["stints"] = Json::array();
  for (const auto& s : plan.stints)
    j["stints"].push_back({{"dive", place(s.dive, s.dive_s)},
                           {"surface", place(s.surface, s.surface_s)},
                           {"heading_deg", s.heading.degrees()},
                           {"dac", {{"east_m_per_s", s.dac.east.si()}, {"north_m_per_s", s.dac.north.si()}}},
                           {"arrives", s.arrives},
                           {"steering_error_m", number_or_null(s.steering_error.si())}});
  j["waypoints"] = Json::array();
  if (found)
    for (const auto& w : found->list.points) {
      Json point = place(w.at);
      point["role"] = w.role == model::WaypointRole::aim ? "aim" : "goal";
      j["waypoints"].push_back(std::move(point));
    }
  j["list"] = {{"radius_m", found ? Json(found->list.radius.si()) : Json(nullptr)},
               {"initial_wpt", 0},
               {"num_legs_to_run", c.request.at_end == model::AtEnd::loop ? -1 : -2}};
  j["statistics"] = {{"wall_s", wall_s},
                     {"expansions", plan.statistics.expansions},
                     {"cost_evaluations", plan.statistics.cost_evaluations},
                     {"current_evaluations", plan.statistics.current_evaluations}};
  j["provenance"] = {{"forecast", c.ocean->label()},
                     {"mission_sha256", Sha256::of(std::string_view{c.mission_text}).hex()},
                     {"version", world::program_version()}};
  return j;
}

/// One line of what the body's forces come to; nothing without a body.
std::string force_balance_text(const Case& c) {
  if (c.water == mission::WaterFrom::none) return "";
  const auto& words = c.ocean->forecast.facts().water.words;
  std::string whose{mission::words(c.water)};
  if (c.water != mission::WaterFrom::mission && !words.empty())
    whose += (c.water == mission::WaterFrom::forecast ? ": " : "; ") + words;
  return fmt::format("by its forces the glider makes {:.3f} m/s, {:.1f} degrees below the horizon, in {}\n",
                     c.mission.horizontal_speed.si(), in_degrees(c.mission.glide_angle), whose);
}

std::string hours(double seconds) {
  const auto minutes = static_cast<long>(std::llround(seconds / 60));
  return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

void print_certificate(const Expected<planning::Bound, planning::PlanFailure>& bound, double travel_s,
                       std::ostream& out) {
  if (bound && bound->kind == planning::Bound::Kind::arrival)
    out << fmt::format("no vehicle arrives earlier than {} after the fix: this plan is at most {:.2f} % above that\n",
                       hours(bound->travel_s), 100 * (travel_s / bound->travel_s - 1));
}

void print_table(const Case& c, const mission::Candidate& found, std::ostream& out) {
  const auto& plan = found.plan;
  const auto& p = c.request.problem;
  out << fmt::format("plan by {} for {} ({})\n", plan.method, c.mission.name, c.ocean->label());
  out << force_balance_text(c);
  if (plan.reaches_goal())
    out << fmt::format("reaches the goal {} after the fix, at {}\n", hours(plan.arrival_s - p.start.fix_s),
                       utc_text(instant_at(plan.arrival_s)));
  else
    out << fmt::format("does not reach the goal: {}; comes within {:.1f} km of it\n", plan.reason,
                       plan.remaining.si() / 1000);
  out << "stint  dive                   latitude  longitude  heading  current m/s   surfacing  steering\n";
  for (std::size_t k = 0; k < plan.stints.size(); ++k) {
    const auto& s = plan.stints[k];
    out << fmt::format("{:5}  {}  {:8.4f}  {:9.4f}  {:7.1f}  {:5.2f} at {:03.0f}  {:8.4f},{:.4f}  {:.0f} m{}\n", k + 1,
                       utc_text(instant_at(s.dive_s)), s.dive.lat.degrees(), s.dive.lon.degrees(), s.heading.degrees(),
                       s.dac.speed().si(), Course::of(s.dac.east.si(), s.dac.north.si()).degrees(),
                       s.surface.lat.degrees(), s.surface.lon.degrees(), s.steering_error.si(),
                       s.arrives ? "  arrives" : "");
  }
  out << found.file_name << " (radius " << found.list.radius.si() << " m):";
  for (const auto& w : found.list.points) out << fmt::format(" {:.4f},{:.4f}", w.at.lat.degrees(), w.at.lon.degrees());
  out << "\n";
}

verify::VerifyRequest verify_request(const Case& c, const mission::Candidate& found) {
  verify::VerifyRequest v;
  auto& d = v.dossier;
  const auto& p = c.request.problem;
  d.file_name = found.file_name;
  d.file_bytes = found.file_bytes;
  d.glider_expected = c.mission.glider;
  d.at.glider = c.mission.glider;
  d.at.fix = p.start.fix;
  d.at.fix_taken = instant_at(p.start.fix_s);
  d.at.heard = d.at.fix_taken;
  d.current_surfacing = d.answers_surfacing = c.request.surfacing;
  d.glider = p.glider;
  d.believed_current = p.believed_current;
  d.schedule = p.schedule;
  d.fix_s = p.start.fix_s;
  d.horizon_s = found.horizon_s;
  d.rules.coast_margin = p.coast_margin;
  d.rules.max_waypoints = c.mission.max_waypoints;
  d.rules.slot = c.mission.slot;
  d.rules.max_wpt_distance = c.mission.max_wpt_distance;
  d.promise = found.promise;
  d.judged_s = p.start.fix_s;
  d.deadline_s = p.start.fix_s + c.mission.window_max.count();
  daemon::put_ocean(*c.ocean, v);
  v.coast = c.chart->coast;
  v.bathymetry = c.chart->bathymetry;
  v.least_depth = c.chart->least_depth;
  v.keep_in = c.chart->keep_in;
  v.keep_out = c.chart->keep_out;
  return v;
}

/// Judges the list and writes it when it is accepted; the exit code.
int write_goto(const Case& c, const mission::Candidate& found, const std::string& path, world::World& world,
               std::ostream& err) {
  const auto verdict = verify::judge_request(verify_request(c, found), world.files);
  if (!verdict) {
    err << "glidehelm plan: no verdict, nothing written: " << verdict.error().message() << "\n";
    return 4;
  }
  if (!verdict->accepted) {
    err << "glidehelm plan: the verifier refuses the list, nothing written:\n" << verify::explain(*verdict);
    return 4;
  }
  if (const auto problem = write_new_file(path, found.file_bytes, world.files); !problem.empty()) {
    err << "glidehelm plan: --goto: " << problem << "\n";
    return 2;
  }
  return 0;
}

}  // namespace

int run_plan(const PlanOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  const auto c = prepare_case(options, world, err);
  if (!c) {
    err << "glidehelm plan: " << c.error().message << "\n";
    return c.error().code;
  }
  const auto members = members_to_fly(*c, options, world);
  const auto misuse =
      options.each && members && *members == 0
          ? std::optional{Trouble{
                2, "--each: there is no ensemble; give --members N, or currents.ensemble in the mission"}}
          : std::nullopt;
  if (!members || misuse) {
    const auto& trouble = misuse ? *misuse : members.error();
    err << "glidehelm plan: " << trouble.message << "\n";
    return trouble.code;
  }
  const auto begin = world.clock.tick();
  const auto waited = [&] { return Seconds{world.clock.tick() - begin}; };
  std::optional<mission::Candidate> found;
  const auto expired =
      options.budget ? std::function<bool()>{[&] { return waited() >= *options.budget; }} : std::function<bool()>{};
  std::string problem = daemon::answer(c->request, *c->ocean, c->chart->chart, expired,
                                       [&](mission::Candidate candidate) { found = std::move(candidate); });
  const auto planned = waited();
  const bool arrives = found && found->plan.reaches_goal();
  const double arrival_s = arrives ? found->plan.arrival_s : std::nan("");
  const auto bound = daemon::certificate(c->request, *c->ocean, c->chart->chart, arrival_s, expired);
  if (!found) {  // a start or goal that cannot be is named with its line
    std::string places;
    for (const auto& error : daemon::Places{world.files}.errors_of(c->mission, c->mission_text, options.mission))
      places += (places.empty() ? "" : "\n") + error.message();
    if (!places.empty()) problem = places;
  }
  std::vector<planning::MemberFlight> flights;
  if (found && *members > 0) {
    auto flown = fly_in_members(*c, found->plan, *members, world::is_terminal(2), world, err);
    if (!flown) {
      err << "glidehelm plan: " << flown.error().message << "\n";
      return flown.error().code;
    }
    flights = std::move(flown).value();
  }
  std::vector<EachPlan> each;
  if (options.each) {
    auto plans = plan_in_members(*c, found ? std::optional{found->plan} : std::nullopt, *members, world::is_terminal(2),
                                 world, err);
    if (!plans) {
      err << "glidehelm plan: " << plans.error().message << "\n";
      return plans.error().code;
    }
    each = std::move(plans).value();
  }
  if (options.json) {
    auto document = plan_json(*c, found, bound, problem, planned.count());
    if (!flights.empty()) document["ensemble"] = members_json(flights);
    if (!each.empty()) document["ensemble_plans"] = each_json(each);
    out << document.dump() << "\n";
  } else if (found) {
    print_table(*c, *found, out);
    if (arrives) print_certificate(bound, arrival_s - c->request.problem.start.fix_s, out);
    if (!flights.empty()) print_members(flights, out);
  }
  if (!options.json && !each.empty()) print_each(each, out);
  if (!options.json && proven_unreachable(bound, arrives)) out << "proven unreachable: " << bound->reason << "\n";
  if (!found) {
    err << "glidehelm plan: " << problem << "\n";
    return options.budget && waited() >= *options.budget ? 5 : 1;
  }
  if (!options.goto_file.empty())
    if (const int code = write_goto(*c, *found, options.goto_file, world, err); code != 0) return code;
  return found->plan.reaches_goal() ? 0 : 1;
}

}  // namespace glidehelm::cli
