#include "simulator/scenario.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "config/yaml_reader/schema.hpp"
#include "core/base/text.hpp"
#include "simulator/random.hpp"
#include "simulator/scenario_draft.hpp"

namespace glidehelm::simulator {
namespace {

using config::Reading;

std::string path_beside(const std::string& file, const std::string& path) {
  const auto slash = file.find_last_of('/');
  if (path.empty() || path.front() == '/' || slash == std::string::npos) return path;
  return file.substr(0, slash + 1) + path;
}

GeoPoint point(const PlaceDraft& p) {
  return GeoPoint::from_degrees(p.lat_deg.value_or(0), p.lon_deg.value_or(0)).value_or(GeoPoint{});
}

std::optional<Current> current(const CurrentDraft& c) {
  if (!c.east || !c.north) return std::nullopt;
  return Current{MetresPerSecond{*c.east}, MetresPerSecond{*c.north}};
}

std::optional<LineAddress> address(const std::string& text, bool connect) {
  const auto colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return std::nullopt;
  const auto port = number_from(text.substr(colon + 1));
  if (!port || *port < 1 || *port > 65535 || *port != static_cast<double>(static_cast<int>(*port))) return std::nullopt;
  return LineAddress{connect, text.substr(0, colon), static_cast<std::uint16_t>(*port)};
}

void check_glider(const GliderDraft& g, const std::string& path, Reading& reading) {
  const auto is_set = [&](const char* key) { return reading.places.count(path + "." + key) > 0; };
  if (!g.line.connect.empty() && !g.line.listen.empty())
    reading.complain(path + ".line", "both connect and listen", {}, "one of the two");
  const auto& text = g.line.connect.empty() ? g.line.listen : g.line.connect;
  if (!text.empty() && !address(text, true))
    reading.complain(path + ".line", "no address", config::shown(text), "HOST:PORT");
  if (g.variation_deg && g.rotation_deg)
    reading.complain(path + ".frame", "both magnetic_variation_deg and rotation_deg", {}, "one of the two");
  if (g.climb_to >= g.dive_depth)
    reading.complain(path + ".vehicle.climb_to_m", "not above the dive depth", {}, "less than dive_depth_m");
  check_flight(g, path, reading);
  // The transfer of a short list has to fit between the script and the end of the window.
  if (g.call.call_after + g.call.dockzr_after + 60 > g.times.surface - g.times.post_fix)
    reading.complain(path + ".call.dockzr_after_s", "the script would run after the glider has dived", {},
                     "after_fix_s + dockzr_after_s at least two minutes below surface_min");
  if (is_set("start.lat_deg") && is_set("goal.lat_deg") && distance(point(g.start), point(g.goal)) < g.goal.radius)
    reading.complain(path + ".start", "already inside the goal radius");
}

void check_truth(const TruthDraft& t, Reading& reading) {
  const auto given = [&](const char* key) { return reading.places.count(std::string{"truth."} + key) > 0; };
  const int count =
      (given("grid") ? 1 : 0) + (given("analytic") ? 1 : 0) + (given("coastal") ? 1 : 0) + (t.still ? 1 : 0);
  if (count != 1)
    reading.complain("truth", count == 0 ? "no ocean" : "more than one ocean", {},
                     "one of grid, analytic, coastal, still: true");
  const auto& c = t.coastal;
  if (!given("coastal") || !c.west_deg || !c.east_deg || !c.south_deg || !c.north_deg) return;
  if (*c.east_deg <= *c.west_deg || *c.east_deg - *c.west_deg > 20)
    reading.complain("truth.coastal.area.east_deg", "no width of an area", {}, "greater than west_deg by at most 20");
  if (*c.north_deg <= *c.south_deg || *c.north_deg - *c.south_deg > 20)
    reading.complain("truth.coastal.area.north_deg", "no height of an area", {},
                     "greater than south_deg by at most 20");
}

template <class Draft>
void check_area(const Draft& d, const std::string& path, Reading& reading) {
  if (!d.west_deg || !d.east_deg || !d.south_deg || !d.north_deg) return;
  if (*d.east_deg <= *d.west_deg)
    reading.complain(path + ".area.east_deg", "no width of an area", {}, "greater than west_deg");
  if (*d.north_deg <= *d.south_deg)
    reading.complain(path + ".area.north_deg", "no height of an area", {}, "greater than south_deg");
}

void check_forecasts(const ForecastDraft& f, Reading& reading) {
  if (reading.places.count("forecasts") == 0) return;
  check_area(f, "forecasts", reading);
  if (f.folder.empty()) reading.complain("forecasts", "no folder", {}, "folder: where the files appear");
  for (std::size_t i = 1; i < f.grid.depths_m.size(); ++i)
    if (f.grid.depths_m[i] <= f.grid.depths_m[i - 1]) {
      reading.complain("forecasts.depths_m", "depths that do not rise", {}, "each greater than the one before");
      break;
    }
  if (!f.west_deg || !f.east_deg || !f.south_deg || !f.north_deg || f.time_step_h <= 0) return;
  const double nodes = ((*f.east_deg - *f.west_deg) / f.step_deg + 1) *
                       ((*f.north_deg - *f.south_deg) / f.step_deg + 1) * (f.hours / f.time_step_h + 1) *
                       static_cast<double>(std::max<std::size_t>(1, f.grid.depths_m.size()));
  if (nodes > 2e7)
    reading.complain("forecasts", "more than 20 million values a component", {}, "a larger step_deg or time_step_h");
}

void check_fleet(const FleetDraft& f, Reading& reading) {
  if (reading.places.count("fleet") == 0) return;
  check_area(f, "fleet", reading);
  if (!f.connect.empty()) {
    const auto first = address(f.connect, true);
    if (!first || first->port + f.count - 1 > 65535)
      reading.complain("fleet.connect", "no address", config::shown(f.connect),
                       "HOST:PORT, with ports for all of them");
  }
  check_glider(f.each, "fleet.each", reading);
}

void check(const ScenarioDraft& d, Reading& reading) {
  check_truth(d.truth, reading);
  if (d.truth.error.shortest_km > d.truth.error.longest_km)
    reading.complain("truth.error.shortest_km", "longer than longest_km", {}, "at most longest_km");
  check_forecasts(d.forecasts, reading);
  check_fleet(d.fleet, reading);
  if (d.gliders.empty() && reading.places.count("fleet") == 0 && reading.places.count("gliders") == 0)
    reading.complain("gliders", "no glider", {}, "a list of gliders, or a fleet");
  std::set<std::string> names, folders;
  for (std::size_t i = 0; i < d.gliders.size(); ++i) {
    const auto path = "gliders[" + std::to_string(i) + "]";
    check_glider(d.gliders[i], path, reading);
    if (!names.insert(d.gliders[i].name).second)
      reading.complain(path + ".name", "two gliders with one name", d.gliders[i].name);
    if (!folders.insert(d.gliders[i].folder).second)
      reading.complain(path + ".folder", "two gliders with one folder", config::shown(d.gliders[i].folder));
  }
}

GliderSetup setup_of(const GliderDraft& d, double start_s, std::uint64_t seed) {
  GliderSetup s;
  s.name = d.name;
  s.mission_file = d.mission_file;
  s.mission_number = d.mission_number;
  s.slot = d.slot;
  s.start = point(d.start);
  s.start_s = start_s;
  s.hull.speed = d.speed;
  s.hull.glide_angle = d.glide_angle;
  s.hull.dive_depth = d.dive_depth;
  s.hull.climb_to = d.climb_to;
  s.hull.heading_bias = d.heading_bias;
  s.hull.leeway = current(d.leeway).value_or(Current{});
  s.belief = {d.believed_speed.value_or(d.speed), d.correction};
  s.prior_water = current(d.prior);
  s.frame = d.rotation_deg ? LocalFrame{degrees(*d.rotation_deg)}
                           : LocalFrame::from_variation(degrees(d.variation_deg.value_or(0)), s.start);
  s.stint_s = d.stint_s;
  s.stint_jitter = d.jitter;
  s.cycle_s = d.cycle_s;
  s.times = d.times;
  s.clock_skew_s = d.clock_skew_s;
  s.seed = seed;
  put_flight(d, s);
  if (d.initial_list.empty()) {
    s.list.waypoints = {point(d.goal)};
    s.list.radius = d.initial_radius;
    s.list.initial = 0;
  }
  return s;
}

ScenarioGlider glider_of(const GliderDraft& d, const std::string& file, double start_s, std::uint64_t seed) {
  ScenarioGlider g;
  g.plan.setup = setup_of(d, start_s, seed);
  g.plan.goal = point(d.goal);
  g.plan.goal_radius = d.goal.radius;
  g.plan.call = d.call;
  g.plan.lost_calls = d.lost_calls;
  g.plan.not_taken = d.not_taken;
  g.plan.no_connection_block = d.no_connection_block;
  g.plan.redial = d.redial;
  g.plan.line = d.line_faults;
  g.initial_list = path_beside(file, d.initial_list);
  g.folder = path_beside(file, d.folder);
  while (g.folder.size() > 1 && g.folder.back() == '/') g.folder.pop_back();
  if (!d.line.connect.empty()) g.line = *address(d.line.connect, true);
  if (!d.line.listen.empty()) g.line = *address(d.line.listen, false);
  return g;
}

/// The gliders that `fleet` stands for: starts in its area, goals a leg away in a direction that stays inside when there is one.
std::vector<GliderDraft> fleet_of(const FleetDraft& f, std::uint64_t seed) {
  std::vector<GliderDraft> all;
  Random random = Random{seed}.stream(78);
  const auto first = f.connect.empty() ? std::nullopt : address(f.connect, true);
  const auto inside = [&](GeoPoint p) {
    return p.lat.degrees() > *f.south_deg && p.lat.degrees() < *f.north_deg && p.lon.degrees() > *f.west_deg &&
           p.lon.degrees() < *f.east_deg;
  };
  for (int i = 1; i <= f.count; ++i) {
    GliderDraft g = f.each;
    char number[8];
    std::snprintf(number, sizeof number, f.count > 99 ? "%03d" : "%02d", i);
    g.name = f.name + number;
    g.folder = f.folder + "/" + g.name;
    g.goal.radius = f.goal_radius;
    // Not at the very edge: a glider that starts there is soon outside the ocean.
    g.start.lat_deg = *f.south_deg + random.uniform(0.1, 0.9) * (*f.north_deg - *f.south_deg);
    g.start.lon_deg = *f.west_deg + random.uniform(0.1, 0.9) * (*f.east_deg - *f.west_deg);
    auto goal = GeoPoint::from_degrees(0.5 * (*f.south_deg + *f.north_deg), 0.5 * (*f.west_deg + *f.east_deg));
    constexpr int kTries = 100;
    for (int k = 0; k < kTries; ++k) {
      const auto there = destination(point(g.start), Bearing{Radians{random.uniform(0, 2 * kPi)}}, f.leg);
      if (!inside(there)) continue;
      goal = there;
      break;
    }
    g.goal.lat_deg = goal.value_or(GeoPoint{}).lat.degrees();
    g.goal.lon_deg = goal.value_or(GeoPoint{}).lon.degrees();
    if (first) g.line.connect = first->host + ":" + std::to_string(first->port + i - 1);
    if (f.mixed_firmware) g.call.firmware = i % 10 == 0 ? Firmware::g1 : i % 3 == 0 ? Firmware::g2 : Firmware::g3;
    g.mission_number = (f.each.mission_number + i - 1) % 10000;
    all.push_back(std::move(g));
  }
  return all;
}

ForecastPlan forecasts_of(const ForecastDraft& d, std::uint64_t seed, const std::string& file) {
  ForecastPlan plan = d;
  plan.folder = path_beside(file, d.folder);
  plan.grid.west_deg = d.west_deg.value_or(0);
  plan.grid.east_deg = d.east_deg.value_or(0);
  plan.grid.south_deg = d.south_deg.value_or(0);
  plan.grid.north_deg = d.north_deg.value_or(0);
  plan.grid.step_deg = d.step_deg;
  plan.seed = seed;
  return plan;
}

TruthPlan truth_of(const ScenarioDraft& d, const Scenario& s, bool coastal, bool error, const std::string& file) {
  TruthPlan t;
  if (error) {
    t.error = d.truth.error;
    t.error->seed = d.truth.error.own_seed.value_or(s.seed);
  }
  t.grid = path_beside(file, d.truth.grid);
  t.still = d.truth.still;
  for (const auto& a : d.truth.analytic) {
    ocean::AnalyticSpec spec = a;
    spec.origin = point(a.origin_deg);
    t.analytic.push_back(std::move(spec));
  }
  if (!coastal) return t;
  const auto& c = d.truth.coastal;
  CoastalTruth made{c.spec, c.variant};
  made.spec.seed = c.seed.value_or(s.seed);
  made.spec.west_deg = *c.west_deg;
  made.spec.east_deg = *c.east_deg;
  made.spec.south_deg = *c.south_deg;
  made.spec.north_deg = *c.north_deg;
  made.spec.start_s = epoch_seconds(s.start);
  made.spec.from = c.from.lat_deg ? point(c.from) : s.gliders.front().plan.setup.start;
  made.spec.to = c.to.lat_deg ? point(c.to) : s.gliders.front().plan.goal;
  t.coastal = made;
  return t;
}

}  // namespace

Expected<Scenario, std::vector<config::ConfigError>> read_scenario(std::string_view text, const std::string& file,
                                                                   std::optional<std::uint64_t> seed) {
  auto document = config::read_yaml(text, file);
  Reading reading{file};
  for (auto& error : document.errors) reading.problems.add(std::move(error));
  ScenarioDraft draft;
  if (document.readable) {
    const config::At root{document.root, nullptr, {}, reading};
    if (config::expect_map(root)) {
      scenario_fields().read(root, draft);
      check(draft, reading);
    }
  }
  if (!reading.problems.empty()) return unexpected(reading.problems.sorted());

  Scenario s;
  s.seed = seed.value_or(draft.seed);
  s.start = *draft.start;
  s.coast = path_beside(file, draft.coast);
  s.clock = path_beside(file, draft.clock);
  s.charge_computing = draft.charge_computing;
  s.daemon_wait_s = draft.daemon_wait_s;
  s.end = draft.end;
  Random seeds = Random{s.seed}.stream(77);
  for (const auto& g : draft.gliders) s.gliders.push_back(glider_of(g, file, epoch_seconds(s.start), seeds.next()));
  if (draft.fleet.count > 0) {
    const auto fleet = fleet_of(draft.fleet, s.seed);
    for (std::size_t i = 0; i < fleet.size(); ++i)
      s.gliders.push_back(glider_of(
          fleet[i], file,
          epoch_seconds(s.start) +
              std::floor(3600 * draft.fleet.spread_h * static_cast<double>(i) / static_cast<double>(fleet.size())),
          seeds.next()));
  }
  for (auto& g : s.gliders) g.plan.setup.hull.seabed = seabed_of(draft.seabed, g.plan.setup.start);
  s.forecasts = forecasts_of(draft.forecasts, s.seed, file);
  s.truth =
      truth_of(draft, s, reading.places.count("truth.coastal") > 0, reading.places.count("truth.error") > 0, file);
  return s;
}

std::string scenario_key_table() { return config::key_table(scenario_fields().shape()); }

}  // namespace glidehelm::simulator
