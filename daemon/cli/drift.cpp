#include "daemon/cli/drift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/utc.hpp"
#include "daemon/cli/plan_case.hpp"
#include "daemon/cli/plan_members.hpp"
#include "daemon/world/program_version.hpp"
#include "protocol/latlon.hpp"

namespace glidehelm::cli {

namespace {

using DriftJson = nlohmann::ordered_json;
using vehicle::DriftEnd;
using vehicle::DriftTrack;

/// Everything that is told.
struct Drifted {
  DriftTrack track;                 ///< in the forecast's first member
  std::vector<DriftTrack> members;  ///< empty without an ensemble
};

bool is_afloat(const DriftTrack& track) {
  return !track.points.empty() && (track.end == DriftEnd::time || track.end == DriftEnd::forecast);
}

std::string_view end_words(DriftEnd end) {
  switch (end) {
    case DriftEnd::time:
      return "still afloat";
    case DriftEnd::forecast:
      return "still afloat: the forecast reaches no farther";
    case DriftEnd::aground:
      return "aground";
    case DriftEnd::left_chart:
      return "it leaves the coast file";
    case DriftEnd::left_area:
      return "it leaves the area of the forecast";
    case DriftEnd::bottom:
      return "the water is no longer as deep as it drifts";
    case DriftEnd::no_data:
      return "it comes where the forecast has no current";
  }
  return "?";
}

/// The chart of the shore alone: areas and depths bind the mission's glider, not what drifts.
Expected<std::shared_ptr<const daemon::ChartSource>, std::string> shore_chart_of(const Case& c, world::Files& files) {
  auto mission = c.mission;
  if (mission.keep_in.empty() && mission.keep_out.empty() && mission.bathymetry_file.empty()) return c.chart;
  mission.keep_in.clear();
  mission.keep_out.clear();
  mission.bathymetry_file.clear();
  return daemon::load_chart(mission, files);
}

vehicle::DriftSettings settings_of(const DriftOptions& options, const Case& c, const ocean::ForecastFacts& facts) {
  vehicle::DriftSettings settings{c.request.problem.start.fix_s, options.duration, options.every};
  // One time only holds for all, and a tide comes again.
  if (facts.has_time && facts.first_s < facts.last_s && c.mission.currents.outside_time != ocean::OutsideTime::cycle)
    settings.forecast_last_s = facts.last_s;
  return settings;
}

Expected<Drifted, Trouble> drift_all(const DriftOptions& options, const Case& c, int members, world::World& world) {
  const auto shore = shore_chart_of(c, world.files);
  if (!shore) return unexpected(Trouble{1, shore.error()});
  const auto drift_in = [&](const ocean::Forecast& forecast) {
    return vehicle::drift(options.vehicle, forecast.full(), (*shore)->chart, c.request.problem.start.fix,
                          settings_of(options, c, forecast.facts()));
  };
  Drifted all{drift_in(c.ocean->forecast), {}};
  for (std::uint32_t member = 0; member < static_cast<std::uint32_t>(members); ++member) {
    const auto ocean = load_member(c, member, world);
    if (!ocean) return unexpected(ocean.error());
    all.members.push_back(drift_in((*ocean)->forecast));
  }
  return all;
}

/// Mean of the ends of all members that are afloat when the last of them is, and the root of their mean square distance from it.
struct DriftSpread {
  std::size_t afloat{};
  std::optional<GeoPoint> mean;
  Metres spread;
};
DriftSpread spread_of(const std::vector<DriftTrack>& members) {
  double last_s = -1e18;
  for (const auto& track : members)
    if (is_afloat(track)) last_s = std::max(last_s, track.points.back().t_s);
  std::vector<GeoPoint> ends;
  for (const auto& track : members)
    if (is_afloat(track) && last_s - track.points.back().t_s < 1) ends.push_back(track.points.back().at);
  if (ends.empty()) return {};
  const auto& first = ends.front();
  double dlat = 0, dlon = 0;
  for (const auto& end : ends) {
    dlat += end.lat.radians() - first.lat.radians();
    dlon += std::remainder(end.lon.radians() - first.lon.radians(), 2 * kPi);
  }
  const auto count = static_cast<double>(ends.size());
  const auto mean = GeoPoint::from_kernel(first.lat.radians() + dlat / count, first.lon.radians() + dlon / count);
  double square = 0;
  for (const auto& end : ends) square += std::pow(distance(mean, end).si(), 2);
  return {ends.size(), mean, Metres{std::sqrt(square / count)}};
}

DriftJson drift_place(GeoPoint p) { return {{"lat_deg", p.lat.degrees()}, {"lon_deg", p.lon.degrees()}}; }

DriftJson end_json(const DriftTrack& track) {
  DriftJson j{{"reason", vehicle::word(track.end)}};
  if (track.points.empty()) {
    for (const auto* key : {"after_s", "lat_deg", "lon_deg", "time", "distance_m", "bearing_deg"}) j[key] = nullptr;
    return j;
  }
  const auto &start = track.points.front(), &end = track.points.back();
  const auto way = geodesic(start.at, end.at);
  j["after_s"] = end.t_s - start.t_s;
  j.update(drift_place(end.at));
  j["time"] = utc_text(instant_at(end.t_s), true);
  j["distance_m"] = way.length.si();
  j["bearing_deg"] = way.departing.degrees();
  return j;
}

DriftJson vehicle_json(const vehicle::Passive& passive) {
  if (const auto* drifter = std::get_if<vehicle::Drifter>(&passive))
    return {{"kind", "drifter"}, {"depth_m", drifter->depth.si()}};
  const auto& f = std::get<vehicle::ProfilingFloat>(passive);
  return {{"kind", "float"},
          {"park_m", f.park.si()},
          {"profile_m", f.profile.si()},
          {"cycle_s", f.cycle.count()},
          {"surface_s", f.surface.count()},
          {"vertical_speed_m_per_s", f.vertical.si()}};
}

DriftJson spread_json(const std::vector<DriftTrack>& members) {
  const auto spread = spread_of(members);
  DriftJson j{{"members", members.size()}, {"afloat", spread.afloat}, {"mean", nullptr}, {"spread_m", nullptr}};
  if (spread.mean) {
    j["mean"] = drift_place(*spread.mean);
    j["spread_m"] = spread.spread.si();
  }
  j["ends"] = DriftJson::array();
  for (std::size_t k = 0; k < members.size(); ++k) {
    DriftJson end{{"member", k}};
    end.update(end_json(members[k]));
    j["ends"].push_back(std::move(end));
  }
  return j;
}

DriftJson drift_json(const DriftOptions& options, const Case& c, const Drifted& all) {
  const auto& start = c.request.problem.start;
  DriftJson j{{"schema", "glidehelm/drift/v1"}, {"vehicle", vehicle_json(options.vehicle)}};
  j["start"] = drift_place(start.fix);
  j["start"]["time"] = utc_text(instant_at(start.fix_s), true);
  j["end"] = end_json(all.track);
  j["track"] = DriftJson::array();
  for (const auto& p : all.track.points) {
    DriftJson row{{"time", utc_text(instant_at(p.t_s), true)}};
    row.update(drift_place(p.at));
    row.update(DriftJson{{"phase", vehicle::word(p.phase)},
                         {"depth_m", p.depth.si()},
                         {"due_m", p.due.si()},
                         {"east_m_per_s", p.current.east.si()},
                         {"north_m_per_s", p.current.north.si()},
                         {"distance_m", distance(start.fix, p.at).si()}});
    j["track"].push_back(std::move(row));
  }
  if (!all.members.empty()) j["ensemble"] = spread_json(all.members);
  j["provenance"] = {{"forecast", c.ocean->label()},
                     {"mission_sha256", Sha256::of(std::string_view{c.mission_text}).hex()},
                     {"version", world::program_version()}};
  return j;
}

/// "after 36 h 20 min at 41.1234,5.2345, 23.4 km at 045 from the start; still afloat".
std::string end_text(const DriftTrack& track) {
  if (track.points.empty()) return fmt::format("it does not get under way: {}", end_words(track.end));
  const auto &start = track.points.front(), &end = track.points.back();
  const auto way = geodesic(start.at, end.at);
  const auto minutes = std::lround((end.t_s - start.t_s) / 60);
  return fmt::format("after {} h {:02} min at {:.4f},{:.4f}, {:.1f} km at {:03.0f} from the start; {}", minutes / 60,
                     minutes % 60, end.at.lat.degrees(), end.at.lon.degrees(), way.length.si() / 1000,
                     way.departing.degrees(), end_words(track.end));
}

std::string vehicle_text(const vehicle::Passive& passive) {
  if (const auto* drifter = std::get_if<vehicle::Drifter>(&passive))
    return fmt::format("drifter at {:.0f} m", drifter->depth.si());
  const auto& f = std::get<vehicle::ProfilingFloat>(passive);
  return fmt::format("float parked at {:.0f} m, profiles from {:.0f} m every {:.1f} h", f.park.si(), f.profile.si(),
                     f.cycle.count() / 3600);
}

/// What a float did not reach, from its points.
void print_turned(const DriftTrack& track, std::ostream& out) {
  const auto short_of = [](const vehicle::DriftPoint& p) { return p.due.si() - p.depth.si(); };
  const auto most = std::max_element(track.points.begin(), track.points.end(),
                                     [&](const auto& a, const auto& b) { return short_of(a) < short_of(b); });
  if (most != track.points.end() && short_of(*most) > 0)
    out << fmt::format(
        "the water, or the forecast, ends above the depth that is due: at {} at {:.0f} m instead of {:.0f} m\n",
        utc_text(instant_at(most->t_s)), most->depth.si(), most->due.si());
}

void print_drift(const DriftOptions& options, const Case& c, const Drifted& all, std::ostream& out) {
  out << fmt::format("{}, from the start of {} ({})\n", vehicle_text(options.vehicle), c.mission.name,
                     c.ocean->label());
  if (!all.track.points.empty())
    out << "time                   latitude  longitude       DDMM.mmmm    DDDMM.mmmm  depth m  current m/s   "
           "start km  phase\n";
  for (const auto& p : all.track.points)
    out << fmt::format("{}  {:8.4f}  {:9.4f}  {:>14}  {:>12}  {:7.0f}  {:5.2f} at {:03.0f}  {:9.1f}  {}\n",
                       utc_text(instant_at(p.t_s)), p.at.lat.degrees(), p.at.lon.degrees(), protocol::ddmm(p.at.lat),
                       protocol::ddmm(p.at.lon), p.depth.si(), p.current.speed().si(),
                       Course::of(p.current.east.si(), p.current.north.si()).degrees(),
                       distance(c.request.problem.start.fix, p.at).si() / 1000, vehicle::word(p.phase));
  print_turned(all.track, out);
  out << end_text(all.track) << "\n";
  if (all.members.empty()) return;
  for (std::size_t k = 0; k < all.members.size(); ++k)
    out << fmt::format("member {:3}: {}\n", k, end_text(all.members[k]));
  const auto spread = spread_of(all.members);
  out << fmt::format("{} of {} members are afloat to the end", spread.afloat, all.members.size());
  if (spread.mean)
    out << fmt::format(", on the mean at {:.4f},{:.4f} and {:.1f} km from it (root mean square)",
                       spread.mean->lat.degrees(), spread.mean->lon.degrees(), spread.spread.si() / 1000);
  out << "\n";
}

/// What no forecast without depths can tell.
bool asks_for_depth(const vehicle::Passive& passive) {
  const auto* drifter = std::get_if<vehicle::Drifter>(&passive);
  return !drifter || drifter->depth.si() > 0;
}

int refuse_drift(std::ostream& err, const Trouble& trouble) {
  err << "glidehelm drift: " << trouble.message << "\n";
  return trouble.code;
}

}  // namespace

int run_drift(const DriftOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  if (const auto* f = std::get_if<vehicle::ProfilingFloat>(&options.vehicle))
    if (const auto why = vehicle::why_no_float(*f); !why.empty()) return refuse_drift(err, {2, "--float: " + why});
  PlanOptions plan;
  plan.mission = options.mission;
  plan.from = options.from;
  plan.at = options.at;
  plan.members = options.members;
  const auto c = prepare_case(plan, world, err);
  if (!c) return refuse_drift(err, c.error());
  const auto members = members_to_fly(*c, plan, world);
  if (!members) return refuse_drift(err, members.error());
  if (c->ocean->forecast.facts().levels <= 1 && asks_for_depth(options.vehicle))
    err << "note: the currents have one level only, which is taken for all depths\n";
  const auto all = drift_all(options, *c, *members, world);
  if (!all) return refuse_drift(err, all.error());
  if (options.json)
    out << drift_json(options, *c, *all).dump() << "\n";
  else
    print_drift(options, *c, *all, out);
  return is_afloat(all->track) ? 0 : 1;
}

}  // namespace glidehelm::cli
