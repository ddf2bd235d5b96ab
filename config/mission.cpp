#include "config/mission.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "config/areas.hpp"
#include "config/currents.hpp"
#include "config/flight_model.hpp"
#include "config/yaml_reader/schema.hpp"
#include "core/mission/in_water.hpp"

namespace glidehelm::config {

namespace {

using mission::Approval;
using mission::Mission;

constexpr double kHour = 3600.0, kMinute = 60.0, kKilometre = 1000.0;
constexpr double kShortestStint_h = mission::kShortestStint.count() / kHour,
                 kLongestStint_h = mission::kLongestStint.count() / kHour;

/// A mission as its file says it, before what depends on several keys is worked out.
struct MissionDraft : Mission {
  std::optional<double> goal_lat, goal_lon, start_lat, start_lon;  ///< degrees
  std::optional<MetresPerSecond> speed_given;
  std::optional<Radians> glide_angle_given;
  std::optional<Seconds> stint_given, first_stint_given;
  std::vector<CurrentsItem> fields;
  AreasDraft inside, outside;
};

bool matches_next(std::string_view text) { return text.substr(0, 5) == "next " && kName.matches(text.substr(5)); }
bool matches_mi(std::string_view text) {
  return text.size() > 3 && text.size() <= 8 + 3 && text.substr(text.size() - 3) == ".mi" &&
         std::all_of(text.begin(), text.end() - 3,
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; });
}
const Pattern kNext{"^next [a-z0-9][a-z0-9_-]{0,31}$", "`next NAME`", matches_next};
// The firmware keeps its files under 8.3 names.
const Pattern kMi{"^[a-z0-9_-]{1,8}\\.mi$", "1 to 8 of a–z, 0–9, _ and -, then .mi", matches_mi};

Fields<MissionDraft> goal_fields() {
  Fields<MissionDraft> f;
  f.latitude({"lat_deg", "latitude of the goal, south negative", true}, &MissionDraft::goal_lat);
  f.longitude({"lon_deg", "longitude of the goal, west negative", true}, &MissionDraft::goal_lon);
  f.number({"radius_m", "the mission has arrived within this distance"}, &MissionDraft::goal_radius, 1,
           from_to(10, 200'000));
  return f;
}

Fields<MissionDraft> objective_fields() {
  Fields<MissionDraft> f;
  f.time({"min_distance_at",
          "be as near to the goal as can be at the last surfacing before this time; reached earlier is better still",
          false, "the earliest arrival"},
         &MissionDraft::nearest_at);
  return f;
}

Fields<MissionDraft> start_fields() {
  Fields<MissionDraft> f;
  f.latitude({"lat_deg", "latitude of the start", false, "the fix"}, &MissionDraft::start_lat);
  f.longitude({"lon_deg", "longitude of the start", false, "the fix"}, &MissionDraft::start_lon);
  f.time({"time", "time of the start", false, "the time of the fix"}, &MissionDraft::start_time);
  return f;
}

Fields<MissionDraft> vehicle_fields() {
  Fields<MissionDraft> f;
  f.maybe_number({"horizontal_speed_m_per_s",
                  "speed through water, horizontal part: U·cos(glide angle); not together with `force_balance`", false,
                  "0.3, or what `force_balance` gives"},
                 &MissionDraft::speed_given, 1, above(0, 2));
  f.maybe_number({"glide_angle_deg", "angle of the path below the horizon; not together with `force_balance`", false,
                  "26, or what `force_balance` gives"},
                 &MissionDraft::glide_angle_given, kDegree, from_to(5, 60));
  f.word({"motion",
          "what carries a plan: `point`, the mean current over the dive; `yo-yo`, the current at the depth at each "
          "instant "
          "(slower)"},
         &MissionDraft::motion,
         std::vector<std::pair<std::string, vehicle::MotionModel>>{{"point", vehicle::MotionModel::point},
                                                                   {"yo-yo", vehicle::MotionModel::yo_yo}});
  f.custom(
      {"force_balance", "the glider as a body: its speed and glide angle follow from hull, pump, pitch and water",
       false, "none"},
      flight_model_fields().shape(), "", [](const At& at, MissionDraft& d) { read_flight_model(at, d.flight_model); },
      [](const MissionDraft& d, const std::string& path, Effective& out) {
        print_flight_model(d.flight_model, path, out);
      });
  f.number({"dive_depth_m", "lower turning depth of the yo"}, &MissionDraft::dive_depth, 1, above(0, 1500));
  f.number({"climb_to_m", "upper turning depth of the yo; less than `dive_depth_m`"}, &MissionDraft::climb_to, 1,
           from_to(0, 1500));
  f.whole({"current_correction",
           "`u_use_current_correction` of the glider: 0 steers without currents, 1 with the last measured one"},
          &MissionDraft::current_correction, from_to(0, 1));
  f.maybe_number({"local_frame_rotation_deg", "rotation of the glider's local frame against east and north", false,
                  "learned; 0 until then"},
                 &MissionDraft::frame_rotation, kDegree, from_to(-180, 180));
  return f;
}

Fields<MissionDraft> schedule_fields() {
  Fields<MissionDraft> f;
  f.maybe_number({"stint_h", "time under water between two surfacings; not together with `half_cycles`", false,
                  "4, or what `half_cycles` gives"},
                 &MissionDraft::stint_given, kHour, from_to(kShortestStint_h, kLongestStint_h));
  f.number({"surface_min", "time at the surface between two stints"}, &MissionDraft::surface, kMinute, from_to(0, 240));
  f.maybe_number({"first_stint_h", "time under water of the first stint"}, &MissionDraft::first_stint_given, kHour,
                 from_to(kShortestStint_h, kLongestStint_h), "same");
  f.maybe_whole({"half_cycles", "dives and climbs of the yo in one stint, instead of `stint_h`", false, "none"},
                &MissionDraft::half_cycles, from_to(1, 1000));
  return f;
}

Fields<planning::LatticeChoice> lattice_fields() {
  using planning::GridKind;
  using planning::LatticeChoice;
  Fields<LatticeChoice> f;
  f.whole({"neighbours", "8, 16 or 24 neighbours of a node (on triangles 6, 12 or 18)"}, &LatticeChoice::neighbours,
          from_to(8, 24));
  f.whole({"radius", "rings of neighbours of neighbours, as far as they lie in new directions"}, &LatticeChoice::radius,
          from_to(1, 4));
  f.word({"grid", "`regular` in latitude and longitude; `irregular`: finer beside start and goal; `triangular`"},
         &LatticeChoice::grid,
         std::vector<std::pair<std::string, GridKind>>{
             {"regular", GridKind::regular}, {"irregular", GridKind::irregular}, {"triangular", GridKind::triangular}});
  return f;
}

Fields<planning::SectorGrid> sector_grid_fields() {
  using planning::SectorGrid;
  Fields<SectorGrid> f;
  f.whole({"sectors", "rows and columns that an edge may span: 1, 2 or 3 give 8, 16 or 32 directions"},
          &SectorGrid::sectors, from_to(1, 3));
  f.maybe_number({"grid_km", "distance of rows and columns; `auto`: as `cell_km`"}, &SectorGrid::spacing, kKilometre,
                 above(0, 1000), "auto");
  return f;
}

Fields<MissionDraft> planning_fields() {
  Fields<MissionDraft> f;
  const std::vector<std::pair<std::string, std::string>> methods{{"direct", "direct"},
                                                                 {"astar", "astar"},
                                                                 {"cts-astar", "cts-astar"},
                                                                 {"abs-cts-astar", "abs-cts-astar"},
                                                                 {"tve", "tve"},
                                                                 {"astar-tve", "astar-tve"},
                                                                 {"ztve", "ztve"},
                                                                 {"zastar-tve", "zastar-tve"},
                                                                 {"cts-astar-refined", "cts-astar-refined"},
                                                                 {"rrt", "rrt"},
                                                                 {"optimization", "optimization"},
                                                                 {"iterative-optimization", "iterative-optimization"},
                                                                 {"zermelo", "zermelo"},
                                                                 {"best", "best"}};
  f.word({"method", "how the way is found; `best` takes the best of all"}, &MissionDraft::method, methods);
  f.whole({"headings", "headings tried at each surfacing"}, &MissionDraft::headings, from_to(4, 72));
  f.maybe_number({"cell_km", "cell in which two surfacings count as one; `auto`: half a stint through still water"},
                 &MissionDraft::cell, kKilometre, above(0, 1000), "auto");
  f.number({"budget_s", "time after the fix at which the best plan so far goes out"}, &MissionDraft::budget, 1,
           above(0, 900));
  f.maybe_number(
      {"horizon_h", "longest travel time looked at; `auto`: three times that through still water, at least 12 stints"},
      &MissionDraft::horizon, kHour, above(0, 8784), "auto");
  f.word({"heuristic",
          "least time left that `cts-astar` and `abs-cts-astar` reckon with: `straight_line` at full speed, `envelope` "
          "on the dive schedule, `cost_to_go` on the dive schedule through the currents that there are; the stronger, "
          "the less work"},
         &MissionDraft::heuristic,
         std::vector<std::pair<std::string, planning::Heuristic>>{{"straight_line", planning::Heuristic::straight_line},
                                                                  {"envelope", planning::Heuristic::envelope},
                                                                  {"cost_to_go", planning::Heuristic::cost_to_go}});
  f.word({"weighting",
          "what the heuristic is multiplied by, for less work: `static` by 1 + `weight`, `dynamic` by less and less "
          "towards "
          "the goal"},
         &MissionDraft::weighting,
         std::vector<std::pair<std::string, planning::Weighting>>{{"none", planning::Weighting::none},
                                                                  {"static", planning::Weighting::constant},
                                                                  {"dynamic", planning::Weighting::by_depth}});
  f.number({"weight", "of `weighting`: the search's way may take up to this share longer than without"},
           &MissionDraft::weight, 1, from_to(0, 10));
  f.part({"astar", "the nodes that `astar` goes over; their spacing is `cell_km`"}, &MissionDraft::lattice,
         lattice_fields());
  f.part({"tve", "the grid that `tve`, `astar-tve`, `ztve` and `zastar-tve` go over"}, &MissionDraft::sector_grid,
         sector_grid_fields());
  f.whole({"seed", "of methods that draw random numbers"}, &MissionDraft::seed, from_to(0, 9007199254740992.0));
  return f;
}

void add_areas(Fields<MissionDraft>& f, const char* key, const char* meaning, AreasDraft MissionDraft::*member) {
  f.custom(
      {key, meaning}, areas_shape(), "[]", [member](const At& at, MissionDraft& d) { read_areas(at, d.*member); },
      [member, key](const MissionDraft& d, const std::string& path, Effective& out) {
        print_areas(d.*member, path, key, out);
      });
}

Fields<MissionDraft> safety_fields() {
  Fields<MissionDraft> f;
  f.text({"coast", "coast file, cut with `glidehelm coast`", false,
          "that of the daemon file, else the land of the forecast, with a warning"},
         &MissionDraft::coast_file);
  f.number(
      {"min_distance_to_coast_m", "distance that the track keeps from the coast and from the border of every area"},
      &MissionDraft::min_distance_to_coast, 1, from_to(0, 50'000));
  f.text({"bathymetry", "depth file, made with `glidehelm-ingest --bathymetry`", false,
          "none: the depth of the water is not judged"},
         &MissionDraft::bathymetry_file);
  f.maybe_number({"min_water_depth_m", "least depth of the water under the track; needs `bathymetry`", false,
                  "with `bathymetry`: climb_to_m + depth_margin_m"},
                 &MissionDraft::min_water_depth, 1, from_to(0, 11'000));
  f.number({"depth_margin_m", "the glider turns this far above the bottom; needs `bathymetry`"},
           &MissionDraft::depth_margin, 1, from_to(0, 1000));
  add_areas(f, "keep_in", "the glider stays inside one of these polygons; none: everywhere", &MissionDraft::inside);
  add_areas(f, "keep_out", "the glider stays outside all of these polygons", &MissionDraft::outside);
  f.maybe_number({"max_wpt_distance_m",
                  "`max_wpt_distance` of the glider's mission: a waypoint beyond aborts it; legs stay below 0.9 of it",
                  false, "none"},
                 &MissionDraft::max_wpt_distance, 1, above(0, 1e7));
  return f;
}

Fields<MissionDraft> list_fields() {
  using model::AtEnd;
  Fields<MissionDraft> f;
  f.whole({"slot", "NN of `goto_lNN.ma`"}, &MissionDraft::slot, from_to(0, 99));
  f.whole({"max_waypoints", "longest list that the glider takes"}, &MissionDraft::max_waypoints, from_to(1, 8));
  f.maybe_number({"radius_m", "distance at which a waypoint counts as reached; `auto`: 10 % of the median leg"},
                 &MissionDraft::list_radius, 1, from_to(10, 100'000), "auto");
  f.word({"at_end", "after the last waypoint: back to the first, or wait for the next file"}, &MissionDraft::at_end,
         std::vector<std::pair<std::string, AtEnd>>{{"loop", AtEnd::loop}, {"wait", AtEnd::wait}});
  return f;
}

Fields<MissionDraft> window_fields() {
  Fields<MissionDraft> f;
  f.number({"max_min", "longest time from the fix to the dive that is counted on, whatever the dialog says"},
           &MissionDraft::window_max, kMinute, above(0, 120));
  f.number({"dockzr_after_s", "time from the call to the moment at which the dockserver's script sends files"},
           &MissionDraft::dockzr_after, 1, from_to(0, 900));
  f.word({"emit_on",
          "the file goes out once the at-surface block has named the mission, or already on the connection block"},
         &MissionDraft::emit_on_connection,
         std::vector<std::pair<std::string, bool>>{{"at_surface", false}, {"connection", true}});
  return f;
}

const Fields<MissionDraft>& mission_fields() {
  static const Fields<MissionDraft> kFields = [] {
    Fields<MissionDraft> approval;
    approval.word(
        {"mode",
         "`manual`: propose, emit nothing; `auto-if-safe`: emit what the verifier accepts if nothing is unusual; "
         "`auto`: emit what the verifier accepts"},
        &MissionDraft::approval,
        std::vector<std::pair<std::string, Approval>>{
            {"manual", Approval::manual}, {"auto-if-safe", Approval::auto_if_safe}, {"auto", Approval::automatic}});
    Fields<MissionDraft> f;
    f.constant({"schema", "what this file is", true}, kMissionSchema);
    f.text({"name", "name of the mission, in logs and for `after_goal`", true}, &MissionDraft::name, kName);
    f.text({"glider", "glider that flies it, as in the daemon file", true}, &MissionDraft::glider, kName);
    f.text({"glider_mission", "mission that must run on the glider; another one is not steered", false, "any"},
           &MissionDraft::slocum_mission, kMi);
    f.section({"goal", "where to", true}, goal_fields());
    f.section({"objective", "what makes a plan the better one"}, objective_fields());
    f.section({"start", "where from, for `plan` and `rehearse`; in service the fix decides"}, start_fields());
    f.section({"vehicle", "the glider as it is expected to fly"}, vehicle_fields());
    f.section({"schedule", "when it dives and surfaces"}, schedule_fields());
    f.custom(
        {"currents", "what the water does; a list adds fields", true}, currents_shape(), "",
        [](const At& at, MissionDraft& d) { read_currents(at, d.fields); },
        [](const MissionDraft& d, const std::string& path, Effective& out) { print_currents(d.fields, path, out); });
    f.section({"planning", "how the way is found"}, planning_fields());
    f.section({"safety", "what the verifier holds every file against"}, safety_fields());
    f.section({"list", "the waypoint file"}, list_fields());
    f.section({"window", "the time at the surface"}, window_fields());
    f.section({"approval", "who lets a file out"}, approval);
    f.text({"after_goal", "`next NAME`: that mission takes over at the goal", false, "the glider stays at the goal"},
           &MissionDraft::after_goal, kNext);
    return f;
  }();
  return kFields;
}

void check_positions(const MissionDraft& d, Reading& reading) {
  if (d.goal_lat && d.goal_lon && *d.goal_lat == 0 && *d.goal_lon == 0)
    reading.complain("goal", "latitude 0, longitude 0 is no goal but a position that was never set");
  const bool lat = reading.places.count("start.lat_deg") > 0, lon = reading.places.count("start.lon_deg") > 0;
  if (lat && !lon) reading.complain("start.lon_deg", "missing; start.lat_deg is set");
  if (lon && !lat) reading.complain("start.lat_deg", "missing; start.lon_deg is set");
}

void check_vehicle(const MissionDraft& d, Reading& reading) {
  if (d.climb_to >= d.dive_depth)
    reading.complain("vehicle.climb_to_m", "not above the dive depth", yaml_number(d.climb_to.si()),
                     "less than dive_depth_m (" + yaml_number(d.dive_depth.si()) + " m)");
  if (!d.flight_model) return;
  for (const auto& [key, given] : {std::pair{"horizontal_speed_m_per_s", d.speed_given.has_value()},
                                   std::pair{"glide_angle_deg", d.glide_angle_given.has_value()}})
    if (given)
      reading.complain(std::string{"vehicle."} + key, "both " + std::string{key} + " and force_balance", {},
                       "one of the two");
}

/// Speed and glide angle: as they are given, or the means of the body over the yo.
void resolve_speed(MissionDraft& d, Reading& reading) {
  if (!d.flight_model) {
    d.speed_given = d.horizontal_speed = d.speed_given.value_or(Mission{}.horizontal_speed);
    d.glide_angle_given = d.glide_angle = d.glide_angle_given.value_or(Mission{}.glide_angle);
    return;
  }
  if (!reading.problems.empty()) return;  // of a body that is described wrongly nothing follows
  const auto means =
      yo_means(d.flight_model->hull, d.flight_model->trim, d.flight_model->column(), d.climb_to, d.dive_depth);
  if (!means) return reading.complain("vehicle.force_balance", means.error());
  d.horizontal_speed = means->horizontal;
  d.glide_angle = means->glide_angle;
}

void check_schedule(const MissionDraft& d, Reading& reading) {
  if (!d.half_cycles) return;
  if (d.stint_given) {
    reading.complain("schedule.half_cycles", "both half_cycles and stint_h", {}, "one of the two");
    return;
  }
  if (d.climb_to >= d.dive_depth) return;  // reported; the stint would be nonsense
  const double hours = stint_of_half_cycles(*d.half_cycles, d).count() / kHour;
  if (!from_to(kShortestStint_h, kLongestStint_h).contains(hours))
    reading.complain("schedule.half_cycles", "gives a stint of " + yaml_number(std::round(hours * 100) / 100) + " h",
                     {}, "a stint of " + from_to(kShortestStint_h, kLongestStint_h).text() + " h");
}

void check_planning(const MissionDraft& d, Reading& reading) {
  if (d.lattice.neighbours % 8 != 0)
    reading.complain("planning.astar.neighbours", "no neighbourhood", std::to_string(d.lattice.neighbours),
                     "8, 16 or 24");
}

void check_safety(const MissionDraft& d, Reading& reading) {
  if (!d.min_water_depth) return;
  if (d.bathymetry_file.empty())
    reading.complain("safety.min_water_depth_m",
                     "a least depth needs safety.bathymetry, the depth file to judge it on");
  else if (*d.min_water_depth < d.climb_to + d.depth_margin)
    reading.complain("safety.min_water_depth_m",
                     yaml_number(d.min_water_depth->si()) + " m of water leave no room to dive", {},
                     "at least climb_to_m + depth_margin_m = " + yaml_number((d.climb_to + d.depth_margin).si()));
}

/// Works out what depends on several keys. Only for a draft without error.
void resolve(MissionDraft& d, const std::string& file) {
  d.goal = GeoPoint::from_degrees(*d.goal_lat, *d.goal_lon).value();
  if (d.start_lat && d.start_lon) d.start = GeoPoint::from_degrees(*d.start_lat, *d.start_lon).value();
  if (d.half_cycles)
    d.stint = stint_of_half_cycles(*d.half_cycles, d);
  else
    d.stint_given = d.stint = d.stint_given.value_or(Mission{}.stint);
  d.first_stint = d.first_stint_given.value_or(d.stint);
  d.currents = resolve_currents(d.fields);
  d.coast_file = path_beside(file, d.coast_file);
  d.bathymetry_file = path_beside(file, d.bathymetry_file);
  d.keep_in = d.inside.areas;
  d.keep_out = d.outside.areas;
}

}  // namespace

Expected<MissionFile, std::vector<ConfigError>> read_mission_file(std::string_view text, const std::string& file,
                                                                  const LoadFile& load) {
  auto document = read_yaml(text, file);
  Reading reading{file};
  for (auto& error : document.errors) reading.problems.add(std::move(error));
  MissionDraft draft;
  if (document.readable) {
    const At root{document.root, nullptr, "", reading};
    reading.places[""] = document.root.place;
    if (expect_map(root)) {
      mission_fields().read(root, draft);
      check_positions(draft, reading);
      check_vehicle(draft, reading);
      resolve_speed(draft, reading);
      check_schedule(draft, reading);
      check_planning(draft, reading);
      check_safety(draft, reading);
      load_areas(draft.inside, load, "safety.keep_in", reading);
      load_areas(draft.outside, load, "safety.keep_out", reading);
    }
  }
  if (!reading.problems.empty()) return unexpected(reading.problems.sorted());
  resolve(draft, file);
  Effective effective{&reading};
  mission_fields().print(draft, "", effective);
  return MissionFile{static_cast<const Mission&>(draft), effective.text()};
}

Expected<Mission, std::vector<ConfigError>> read_mission(std::string_view text, const std::string& file,
                                                         const LoadFile& load) {
  auto result = read_mission_file(text, file, load);
  if (!result) return unexpected(std::vector<ConfigError>{result.error()});
  return std::move(result->mission);
}

Shape mission_shape() { return mission_fields().shape(); }

std::string mission_schema() { return json_schema(mission_shape(), kMissionSchema, "Glidehelm mission"); }

}  // namespace glidehelm::config
