#include "daemon/cli/plan_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/utc.hpp"
#include "core/ocean/freshness.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/registry.hpp"
#include "daemon/candidate.hpp"

namespace glidehelm::cli {

namespace {

/// The daemon's rule of age (product.md 7) as an offline plan meets it: counted to the start, so that an old case can be planned with its own
/// time, but not beyond now, so that next week's departure can be planned on today's forecast.
std::optional<Trouble> too_old(const daemon::OceanSource& ocean, Instant at, Instant now, std::ostream& err) {
  const auto issued = ocean.forecast.facts().issued_s;
  if (!issued) return std::nullopt;
  const double age_s = epoch_seconds(std::min(at, now)) - *issued;
  if (age_s > ocean::kExpiredAfter)
    return Trouble{
        1,
        fmt::format("the forecast {} is {:.1f} h old at {}; planned on are at most {:.0f} h (--at sets another time)",
                    ocean.label(), age_s / 3600, utc_text(std::min(at, now)), ocean::kExpiredAfter / 3600)};
  if (age_s > ocean::kOldAfter)
    err << fmt::format("warning: the forecast {} is {:.1f} h old at {}\n", ocean.label(), age_s / 3600,
                       utc_text(std::min(at, now)));
  return std::nullopt;
}

}  // namespace

Expected<Case, Trouble> prepare_case(const PlanOptions& options, world::World& world, std::ostream& err) {
  Case c;
  c.mission_file = options.mission;
  auto mission = mission_from(options.mission, world.files, c.mission_text);
  if (!mission) return unexpected(mission.error());
  c.mission = std::move(mission).value();
  if (!options.method.empty()) c.mission.method = options.method;
  if (!planning::planner_named(c.mission.method)) {
    std::string known;
    for (const auto& name : planning::method_names()) known += (known.empty() ? "" : ", ") + name;
    return unexpected(
        Trouble{2, "--method " + c.mission.method + ": unknown or not available in this version; available: " + known});
  }
  if (options.from) {
    const auto from = GeoPoint::from_degrees(options.from->first, options.from->second);
    if (!from)
      return unexpected(Trouble{2, "--from: " + from.error().message() +
                                       (std::abs(options.from->first) > 90 ? " (latitude comes first)" : "")});
    c.mission.start = *from;
  }
  if (!c.mission.start)
    return unexpected(Trouble{2, "no start: give --from LAT,LON or start: {lat_deg: , lon_deg: } in the mission"});
  auto chart = daemon::load_chart(c.mission, world.files);
  if (!chart) return unexpected(Trouble{1, chart.error()});
  c.chart = std::move(chart).value();
  if (!c.chart->chart.has_coast())
    err << "warning: no coastline (safety.coast): land is what the forecast's mask says\n";
  auto at = options.at ? options.at : c.mission.start_time;
  const auto& currents = c.mission.currents;
  if ((options.member || options.members > 0) && currents.files.empty() && currents.sources.empty())
    return unexpected(Trouble{2, "currents are formulas alone: they have no members"});
  if (const auto& ensemble = currents.ensemble;
      ensemble && std::max(static_cast<int>(options.member.value_or(0)) + 1, options.members) > ensemble->members)
    return unexpected(
        Trouble{2, fmt::format("currents.ensemble has {} members: allowed is --member 0 to {}, --members 1 to {}",
                               ensemble->members, ensemble->members - 1, ensemble->members)});
  c.order = {c.mission, world.files.scratch(), c.chart->chart.has_coast(), at.value_or(world.clock.utc()),
             c.mission.start};
  c.order.member = options.member;
  auto ocean = daemon::load_ocean(c.order, world);
  if (!ocean) return unexpected(Trouble{1, ocean.error()});
  c.ocean = std::move(ocean).value();
  const auto& facts = c.ocean->forecast.facts();
  for (const auto& warning : facts.warnings) err << "warning: " << warning << "\n";
  auto vehicle = mission::in_water(c.mission, facts.water.layers);
  if (!vehicle.refused.empty())
    err << "warning: the body of vehicle.force_balance does not fly in the forecast's water: " << vehicle.refused
        << "; the climatological profile is taken\n";
  c.mission = std::move(vehicle.mission);
  c.water = vehicle.from;
  if (!at) {
    at = world.clock.utc();
    if (facts.has_time && (epoch_seconds(*at) > facts.last_s || epoch_seconds(*at) < facts.first_s)) {
      at = instant_at(facts.first_s);
      err << "note: no --at given and the forecast does not reach to now: planning from its first time "
          << utc_text(*at) << "\n";
    }
  }
  const bool outside = facts.has_time && (epoch_seconds(*at) < facts.first_s || epoch_seconds(*at) > facts.last_s);
  // A snapshot holds for any time, and a tide comes again; a series held fast is no forecast of another month.
  if (outside && facts.first_s < facts.last_s && c.mission.currents.outside_time != ocean::OutsideTime::cycle)
    return unexpected(Trouble{
        1, fmt::format("the start time {} lies outside the forecast, which reaches from {} to {}", utc_text(*at),
                       utc_text(instant_at(facts.first_s)), utc_text(instant_at(facts.last_s)))});
  if (outside)
    err << "warning: the start time " << utc_text(*at) << " lies outside the forecast, which reaches from "
        << utc_text(instant_at(facts.first_s)) << " to " << utc_text(instant_at(facts.last_s)) << "\n";
  if (auto old = too_old(*c.ocean, *at, world.clock.utc(), err)) return unexpected(*old);
  auto& r = c.request;
  const auto& m = c.mission;
  r.id = 1;
  r.surfacing = m.glider + "/" + utc_text(*at);
  r.problem.start = {*m.start, epoch_seconds(*at)};
  r.problem.goal = planning::PointGoal{m.goal, m.goal_radius};
  r.problem.glider = {m.glider,     m.horizontal_speed, m.horizontal_speed,  m.glide_angle,
                      m.dive_depth, m.climb_to,         m.current_correction};
  r.problem.schedule = {m.stint, m.first_stint, m.surface, m.surface};
  if (options.water)
    r.problem.believed_current = Current{MetresPerSecond{options.water->first}, MetresPerSecond{options.water->second}};
  r.problem.coast_margin = m.min_distance_to_coast;
  r.problem.headings = m.headings;
  r.problem.cell = m.cell.value_or(0.5 * (m.horizontal_speed * m.stint));
  r.problem.seed = options.seed.value_or(m.seed);
  r.problem.guidance = {m.heuristic, m.weighting, m.weight};
  r.problem.lattice = m.lattice;
  r.problem.sector_grid = m.sector_grid;
  r.method = m.method;
  r.motion = m.motion;
  r.slot = m.slot;
  r.max_waypoints = m.max_waypoints;
  r.list_radius = m.list_radius;
  r.at_end = m.at_end;
  r.stamp = *at;
  r.horizon_wanted = m.horizon.value_or(Seconds{0});
  r.problem.objective =
      planning::objective_at(m.nearest_at ? std::optional{epoch_seconds(*m.nearest_at)} : std::nullopt, r.problem);
  r.problem.horizon_s = daemon::horizon_of(r);
  return c;
}

}  // namespace glidehelm::cli
