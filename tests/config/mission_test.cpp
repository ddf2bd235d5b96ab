#include "config/mission.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/utc.hpp"
#include "tests/support/config.hpp"

using namespace glidehelm;
using config::read_mission;
using config::read_mission_file;
using mission::Mission;
using test::errors_of;
using test::no_files;
using test::six_lines;
using Lines = std::vector<std::string>;

namespace {

/// The methods of this version, as a complaint lists them.
const std::string kMethods =
    "direct, astar, cts-astar, abs-cts-astar, tve, astar-tve, ztve, zastar-tve, cts-astar-refined, rrt, optimization, "
    "iterative-optimization, zermelo, best";

Lines mission_errors(const std::string& yaml) { return errors_of(read_mission(yaml, "m.yaml", no_files())); }
/// Errors of the six lines with `more` from line 7 on.
Lines errors_with(const std::string& more) { return mission_errors(six_lines(more)); }
Mission read(const std::string& yaml) {
  const auto m = read_mission(yaml, "m.yaml", no_files());
  if (!m)
    for (const auto& error : m.error()) UNSCOPED_INFO(error.message());
  REQUIRE(m);
  return *m;
}

/// Everything of product.md 5 in one file: the smallest mission and the rest with its defaults, keys without a default
/// left empty.
const char* const kWholeLayout = R"(schema: glidehelm/mission/v1
name: leg-2
glider: sim01
goal: {lat_deg: 29.1667, lon_deg: -15.5, radius_m: 2000}
currents: {files: [/var/lib/glidehelm/currents/*.nc], outside_time: hold, interpolation: linear, variables: {east: , north: }, time_epoch: }
approval: {mode: auto}
start: {lat_deg: , lon_deg: , time: }
vehicle: {horizontal_speed_m_per_s: 0.30, glide_angle_deg: 26, dive_depth_m: 200, climb_to_m: 20, current_correction: 1, local_frame_rotation_deg: }
schedule: {stint_h: 4.0, surface_min: 15, first_stint_h: same}
planning: {method: best, headings: 18, cell_km: auto, budget_s: 20, horizon_h: auto, heuristic: cost_to_go, weighting: none, weight: 0.1, seed: 1}
safety: {coast: , min_distance_to_coast_m: 2000, bathymetry: , min_water_depth_m: , depth_margin_m: 20, keep_in: [], keep_out: []}
list: {slot: 10, max_waypoints: 8, radius_m: auto, at_end: loop}
window: {max_min: 15, dockzr_after_s: 120, emit_on: at_surface}
)";

}  // namespace

TEST_CASE("the smallest legal mission is six lines, and the rest of the layout states its defaults") {
  const auto six = read(six_lines());
  Mission wanted;
  wanted.name = "leg-2";
  wanted.glider = "sim01";
  wanted.goal = geo_point(29.1667, -15.5);
  wanted.currents.files = {"/var/lib/glidehelm/currents/*.nc"};
  wanted.approval = mission::Approval::automatic;
  CHECK(six == wanted);
  CHECK(read(kWholeLayout) == wanted);
}

TEST_CASE("without approval a mission proposes and emits nothing") {
  CHECK(read("schema: glidehelm/mission/v1\nname: a1\nglider: b1\ngoal: {lat_deg: 1, lon_deg: 2}\ncurrents: {files: "
             "[c.nc]}\n")
            .approval == mission::Approval::manual);
}

TEST_CASE("every key reaches its place in the mission, in SI units") {
  const auto m = read(R"(schema: glidehelm/mission/v1
name: leg-3
glider: sea1
glider_mission: esp_eddy.mi
goal: {lat_deg: -29.5, lon_deg: 179.5, radius_m: 500}
start: {lat_deg: -30, lon_deg: -179.5, time: 2026-11-25T06:00Z}
vehicle: {horizontal_speed_m_per_s: 0.25, glide_angle_deg: 20, dive_depth_m: 900, climb_to_m: 5, current_correction: 0, local_frame_rotation_deg: -3.5}
schedule: {stint_h: 8, surface_min: 20, first_stint_h: 2}
currents: {files: [a.nc, b/*.nc], outside_time: cycle, interpolation: akima, variables: {east: uo, north: vo}, time_epoch: 2000-01-01}
planning: {method: cts-astar, headings: 36, cell_km: 2.5, budget_s: 5, horizon_h: 240, seed: 7, heuristic: straight_line, weighting: dynamic, weight: 0.25, astar: {neighbours: 24, radius: 2, grid: triangular}, tve: {sectors: 2, grid_km: 4}}
safety: {coast: c.coast, min_distance_to_coast_m: 0, bathymetry: c.depth, min_water_depth_m: 120, depth_margin_m: 30, max_wpt_distance_m: 50000,
         keep_in: [[{lat_deg: -31, lon_deg: 178}, {lat_deg: -31, lon_deg: -178}, {lat_deg: -28, lon_deg: 180}]], keep_out: []}
list: {slot: 0, max_waypoints: 1, radius_m: 150, at_end: wait}
window: {max_min: 10, dockzr_after_s: 60, emit_on: connection}
approval: {mode: auto-if-safe}
after_goal: next leg-4
)");
  CHECK(m.slocum_mission == "esp_eddy.mi");
  CHECK(m.goal == geo_point(-29.5, 179.5));
  CHECK(m.goal_radius == Metres{500});
  CHECK(m.start == geo_point(-30, -179.5));
  CHECK(m.start_time == utc_from_text("2026-11-25T06:00:00Z"));
  CHECK(m.horizontal_speed == MetresPerSecond{0.25});
  CHECK(m.glide_angle == degrees(20));
  CHECK(m.dive_depth == Metres{900});
  CHECK(m.climb_to == Metres{5});
  CHECK(m.current_correction == 0);
  CHECK(m.frame_rotation == degrees(-3.5));
  CHECK(m.stint == Seconds{8 * 3600});
  CHECK(m.surface == Seconds{1200});
  CHECK(m.first_stint == Seconds{7200});
  CHECK(m.currents.files == std::vector<std::string>{"a.nc", "b/*.nc"});
  CHECK(m.currents.outside_time == mission::OutsideTime::cycle);
  CHECK(m.currents.interpolation == mission::Interpolation::akima);
  CHECK(m.currents.east_variable == "uo");
  CHECK(m.currents.north_variable == "vo");
  CHECK(m.currents.time_epoch == utc_from_text("2000-01-01"));
  CHECK(m.method == "cts-astar");
  CHECK(m.headings == 36);
  CHECK(m.cell == Metres{2500});
  CHECK(m.budget == Seconds{5});
  CHECK(m.horizon == Seconds{240 * 3600});
  CHECK(m.seed == 7);
  CHECK(m.sector_grid == planning::SectorGrid{2, Metres{4000}});
  CHECK(m.heuristic == planning::Heuristic::straight_line);
  CHECK(m.weighting == planning::Weighting::by_depth);
  CHECK(m.weight == 0.25);
  CHECK(m.lattice == planning::LatticeChoice{24, 2, planning::GridKind::triangular});
  CHECK(m.coast_file == "c.coast");
  CHECK(m.min_distance_to_coast == Metres{0});
  CHECK(m.depth_margin == Metres{30});
  CHECK(m.bathymetry_file.find("c.depth") != std::string::npos);
  CHECK(m.least_depth() == Metres{120});
  CHECK(m.max_wpt_distance == Metres{50000});
  REQUIRE(m.keep_in.size() == 1);
  CHECK(m.keep_in[0].vertices[2] == geo_point(-28, 180));
  CHECK(m.keep_out.empty());
  CHECK(m.slot == 0);
  CHECK(m.max_waypoints == 1);
  CHECK(m.list_radius == Metres{150});
  CHECK(m.at_end == model::AtEnd::wait);
  CHECK(m.window_max == Seconds{600});
  CHECK(m.dockzr_after == Seconds{60});
  CHECK(m.emit_on_connection);
  CHECK(m.approval == mission::Approval::auto_if_safe);
  CHECK(m.after_goal == "next leg-4");
}

TEST_CASE("relative paths are meant from the folder of the mission file") {
  const auto m = read_mission(
      "schema: glidehelm/mission/v1\nname: a1\nglider: b1\ngoal: {lat_deg: 1, lon_deg: 2}\ncurrents: {files: [c/*.nc, "
      "/d/e.nc]}\n"
      "safety: {coast: f.coast}\n",
      "/etc/glidehelm/missions.d/m.yaml", no_files());
  REQUIRE(m);
  CHECK(m->currents.files == std::vector<std::string>{"/etc/glidehelm/missions.d/c/*.nc", "/d/e.nc"});
  CHECK(m->coast_file == "/etc/glidehelm/missions.d/f.coast");
}

TEST_CASE("first_stint_h: same follows the stint") {
  CHECK(read(six_lines("schedule: {stint_h: 6, first_stint_h: same}\n")).first_stint == Seconds{6 * 3600});
  CHECK(read(six_lines("schedule: {stint_h: 6}\n")).first_stint == Seconds{6 * 3600});
}

TEST_CASE("half cycles give the stint of a yo from the surface and back") {
  // Two half cycles down to D and back are 2D of vertical way whatever the upper turn is; a third and fourth add the way
  // between the turns twice: 2D + 2(D − C). An odd number ends at D, from where the glider climbs to the surface.
  const double vertical = 0.30 * std::tan(26 * kPi / 180);  // m/s
  for (const auto& [cycles, way] : {std::pair{1, 400.0}, {2, 400.0}, {3, 760.0}, {4, 760.0}, {10, 1840.0}}) {
    CAPTURE(cycles);
    const auto m = read(six_lines("schedule: {half_cycles: " + std::to_string(cycles) + "}\n"));
    CHECK(m.half_cycles == cycles);
    CHECK(m.stint.count() == Approx(way / vertical).epsilon(1e-12));  // rounding of a few operations
    CHECK(m.first_stint == m.stint);
  }
}

TEST_CASE("every mistake of a mission is named with its line and column") {
  struct Row {
    const char* more;  ///< from line 7 on
    Lines errors;
  };
  const auto row = GENERATE(values<Row>({
      {"planning: {headigns: 18}\n", {"7:12 planning.headigns: unknown key; did you mean headings?"}},
      {"planing: {headings: 18}\n", {"7:1 planing: unknown key; did you mean planning?"}},
      {"vehicle:\n  dive_depth: 200\n", {"8:3 vehicle.dive_depth: unknown key; did you mean dive_depth_m?"}},
      {"name: leg-3\n", {"7:1 name: duplicate key; it stands first in line 2"}},
      {"vehicle: {horizontal_speed_m_per_s: 0}\n",
       {"7:37 vehicle.horizontal_speed_m_per_s: out of range; found 0; allowed: above 0, up to 2 m/s"}},
      {"vehicle: {horizontal_speed_m_per_s: 2.5}\n",
       {"7:37 vehicle.horizontal_speed_m_per_s: out of range; found 2.5; allowed: above 0, up to 2 m/s"}},
      {"vehicle: {current_correction: 2}\n",
       {"7:31 vehicle.current_correction: out of range; found 2; allowed: 0 to 1"}},
      {"vehicle: {climb_to_m: 200}\n",
       {"7:23 vehicle.climb_to_m: not above the dive depth; found 200; allowed: less than dive_depth_m (200 m)"}},
      {"vehicle: {dive_depth_m: 15}\n",
       {"7:10 vehicle.climb_to_m: not above the dive depth; found 20; allowed: less than dive_depth_m (15 m)"}},
      {"schedule: {stint_h: 0}\n", {"7:21 schedule.stint_h: out of range; found 0; allowed: 0.1 to 72 h"}},
      {"schedule: {stint_h: 73}\n", {"7:21 schedule.stint_h: out of range; found 73; allowed: 0.1 to 72 h"}},
      {"schedule: {first_stint_h: saem}\n",
       {"7:27 schedule.first_stint_h: not one of the words; found saem; allowed: same, a number; did you mean same?"}},
      {"schedule: {stint_h: 4, half_cycles: 6}\n",
       {"7:37 schedule.half_cycles: both half_cycles and stint_h; allowed: one of the two"}},
      {"schedule: {half_cycles: 900}\n",
       {"7:25 schedule.half_cycles: gives a stint of 307.62 h; allowed: a stint of 0.1 to 72 h"}},
      {"planning: {method: rtr}\n",
       {"7:20 planning.method: not one of the words; found rtr; allowed: " + kMethods + "; did you mean rrt?"}},
      {"planning: {method: cts_astar}\n",
       {"7:20 planning.method: not one of the words; found cts_astar; allowed: " + kMethods +
        "; did you mean cts-astar?"}},
      {"planning: {headings: 73}\n", {"7:22 planning.headings: out of range; found 73; allowed: 4 to 72"}},
      {"planning: {cell_km: atuo}\n",
       {"7:21 planning.cell_km: not one of the words; found atuo; allowed: auto, a number; did you mean auto?"}},
      {"planning: {heuristic: straight-line}\n",
       {"7:23 planning.heuristic: not one of the words; found straight-line; allowed: straight_line, envelope, "
        "cost_to_go; did you "
        "mean straight_line?"}},
      {"planning: {weighting: statik}\n",
       {"7:23 planning.weighting: not one of the words; found statik; allowed: none, static, dynamic; did you mean "
        "static?"}},
      {"planning: {weight: -0.1}\n", {"7:20 planning.weight: out of range; found -0.1; allowed: 0 to 10"}},
      {"planning: {astar: {neighbours: 12}}\n",
       {"7:32 planning.astar.neighbours: no neighbourhood; found 12; allowed: 8, 16 or 24"}},
      {"planning: {astar: {grid: hexagonal}}\n",
       {"7:26 planning.astar.grid: not one of the words; found hexagonal; allowed: regular, irregular, triangular"}},
      {"planning: {tve: {sectors: 4}}\n", {"7:27 planning.tve.sectors: out of range; found 4; allowed: 1 to 3"}},
      {"planning: {tve: {grid_km: 0}}\n",
       {"7:27 planning.tve.grid_km: out of range; found 0; allowed: above 0, up to 1000 km"}},
      {"safety: {min_water_depth_m: 30}\n",
       {"7:29 safety.min_water_depth_m: a least depth needs safety.bathymetry, the depth file to judge it on"}},
      {"safety: {bathymetry: a.depth, min_water_depth_m: 39}\n",
       {"7:50 safety.min_water_depth_m: 39 m of water leave no room to dive; allowed: at least climb_to_m + "
        "depth_margin_m = 40"}},
      {"list: {slot: 100}\n", {"7:14 list.slot: out of range; found 100; allowed: 0 to 99"}},
      {"list: {slot: -1}\n", {"7:14 list.slot: out of range; found -1; allowed: 0 to 99"}},
      {"list: {slot: 1.5}\n", {"7:14 list.slot: not a whole number; found 1.5; allowed: 0 to 99"}},
      {"glider_mission: ninechars.mi\n",
       {"7:17 glider_mission: not of the form that is needed; found ninechars.mi; allowed: 1 to 8 of a–z, 0–9, _ and "
        "-, "
        "then .mi"}},
      {"list: {slot: 08}\n",
       {"7:14 list.slot: a number with a leading zero, which YAML may read as octal; found 08; allowed: 0 to 99, "
        "without the zero"}},
      {"list: {max_waypoints: 9}\n", {"7:23 list.max_waypoints: out of range; found 9; allowed: 1 to 8"}},
      {"list: {max_waypoints: 0}\n", {"7:23 list.max_waypoints: out of range; found 0; allowed: 1 to 8"}},
      {"list: {radius_m: 9}\n", {"7:18 list.radius_m: out of range; found 9; allowed: 10 to 100000 m"}},
      {"list: {at_end: stay}\n", {"7:16 list.at_end: not one of the words; found stay; allowed: loop, wait"}},
      {"window: {emit_on: surface}\n",
       {"7:19 window.emit_on: not one of the words; found surface; allowed: at_surface, connection; did you mean "
        "at_surface?"}},
      {"after_goal: leg-3\n", {"7:13 after_goal: not of the form that is needed; found leg-3; allowed: `next NAME`"}},
      {"glider_mission: ../esp.mi\n",
       {"7:17 glider_mission: not of the form that is needed; found ../esp.mi; allowed: 1 to 8 of a–z, 0–9, _ and -, "
        "then .mi"}},
      {"start: {lat_deg: 28}\n", {"7:8 start.lon_deg: missing; start.lat_deg is set"}},
      {"start: {lon_deg: 28}\n", {"7:8 start.lat_deg: missing; start.lon_deg is set"}},
      {"start: {lat_deg: 120, lon_deg: 28}\n",
       {"7:18 start.lat_deg: latitude out of range; latitude and longitude swapped?; found 120; allowed: -90 to 90 °"}},
      {"vehicle:\n\tdive_depth_m: 100\n", {"8:1 tab; found \\x09; allowed: blanks"}},
  }));
  CAPTURE(row.more);
  CHECK(errors_with(row.more) == row.errors);
}

TEST_CASE("mistakes in the six lines are named too") {
  const std::string tail = "currents: {files: [c.nc]}\n";
  const auto with = [&](const std::string& head) { return mission_errors(head + tail); };
  CHECK(with("schema: glidehelm/mission/v1\nname: a1\nglider: b1\ngoal: {lat_deg: 0, lon_deg: 0.0}\n") ==
        Lines{"4:7 goal: latitude 0, longitude 0 is no goal but a position that was never set"});
  CHECK(with("schema: glidehelm/mission/v1\nname: a1\nglider: b1\ngoal: {lat_deg: -125.9, lon_deg: 47.2}\n") ==
        Lines{"4:17 goal.lat_deg: latitude out of range; latitude and longitude swapped?; found -125.9; allowed: -90 "
              "to 90 °"});
  CHECK(with("schema: glidehelm/mission/v1\nname: a1\nglider: b1\ngoal: {lat_deg: 1, lon_deg: 2, radius_m: 9.9}\n") ==
        Lines{"4:42 goal.radius_m: out of range; found 9.9; allowed: 10 to 200000 m"});
  CHECK(with("schema: glidehelm/mission/v2\nname: A1\nglider: b/1\ngoal: {lat_deg: 1}\n") ==
        Lines{"1:9 schema: not one of the words; found glidehelm/mission/v2; allowed: glidehelm/mission/v1; did you "
              "mean glidehelm/mission/v1?",
              "2:7 name: not of the form that is needed; found A1; allowed: 1 to 32 of a–z, 0–9, _ and -, the first a "
              "letter or digit",
              "3:9 glider: not of the form that is needed; found b/1; allowed: 1 to 32 of a–z, 0–9, _ and -, the first "
              "a letter or digit",
              "4:7 goal.lon_deg: missing; the key is required"});
  CHECK(mission_errors("name: a1\n") ==
        Lines{"1:1 schema: missing; the key is required", "1:1 glider: missing; the key is required",
              "1:1 goal: missing; the key is required", "1:1 currents: missing; the key is required"});
  CHECK(mission_errors("") ==
        Lines{"1:1 not a map of keys; found nothing; allowed: KEY: VALUE lines, or {KEY: VALUE, …}"});
  CHECK(mission_errors("- a\n") ==
        Lines{"1:1 not a map of keys; found a list; allowed: KEY: VALUE lines, or {KEY: VALUE, …}"});
}

TEST_CASE("all mistakes of a file are told at once") {
  CHECK(errors_with("vehicle: {dive_depth_m: 10, glide_angel_deg: 3}\nlist: {slot: 010}\nsafety: {keep_in: "
                    "no.geojson}\nname: x1\n") ==
        Lines{"7:10 vehicle.climb_to_m: not above the dive depth; found 20; allowed: less than dive_depth_m (10 m)",
              "7:29 vehicle.glide_angel_deg: unknown key; did you mean glide_angle_deg?",
              "8:14 list.slot: a number with a leading zero, which YAML may read as octal; found 010; allowed: 0 to "
              "99, without the zero",
              "9:19 safety.keep_in: cannot read no.geojson: No such file or directory",
              "10:1 name: duplicate key; it stands first in line 2"});
}

TEST_CASE("a half-saved file is refused or means what its whole lines say") {
  // Cut anywhere, a file gives errors, or a mission that differs from the whole one only by what was cut off.
  const std::string whole = kWholeLayout;
  const auto full = read(whole);
  int refused = 0;
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const auto m = read_mission(whole.substr(0, n), "m.yaml", no_files());
    if (!m) {
      ++refused;
      for (const auto& error : m.error()) CHECK(error.line >= 1);
      continue;
    }
    CHECK(m->name == full.name);
    CHECK(m->goal == full.goal);
    CHECK(m->currents == full.currents);
  }
  CHECK(refused > static_cast<int>(whole.size()) / 2);
}

TEST_CASE("the values in force are printed with their origin and read back to the same mission") {
  const auto file =
      read_mission_file(six_lines("schedule: {half_cycles: 5}\nvehicle:\n  glide_angle_deg: 23.4\n  climb_to_m: 7.7\n"
                                  "safety:\n  keep_out: [[{lat_deg: 28.1, lon_deg: -15.2}, {lat_deg: 28.2, lon_deg: "
                                  "-15.1}, {lat_deg: 28.3, lon_deg: 344.7}]]\n"),
                        "m.yaml", no_files());
  REQUIRE(file);
  const auto& text = file->effective;
  CAPTURE(text);
  for (const char* line : {"schema: glidehelm/mission/v1                   # m.yaml:1",
                           "  lat_deg: 29.1667                             # m.yaml:4",
                           "  glide_angle_deg: 23.4                        # m.yaml:9",
                           "  dive_depth_m: 200                            # default",
                           "  first_stint_h: same                          # default",
                           "  half_cycles: 5                               # m.yaml:7",
                           "  local_frame_rotation_deg:                    # default: learned; 0 until then",
                           "  files: [\"/var/lib/glidehelm/currents/*.nc\"]  # m.yaml:5"})
    CHECK(("\n" + text).find("\n" + std::string{line} + "\n") != std::string::npos);
  CHECK(read(text) == file->mission);
  CHECK(read(read_mission_file(kWholeLayout, "m.yaml", no_files())->effective) == read(kWholeLayout));
}

TEST_CASE("a hostile file gives errors, not a crash") {
  CHECK_FALSE(mission_errors(std::string(200'000, '[')).empty());
  CHECK_FALSE(errors_with("list: {slot: " + std::string(100'000, '9') + "}\n").empty());
  CHECK_FALSE(errors_with(std::string(500'000, 'k') + ": 1\n").empty());
  std::string many;
  for (int i = 0; i < 20'000; ++i) many += "k" + std::to_string(i) + ": 1\n";
  CHECK(errors_with(many).size() == config::kMostErrors + 1);
  const auto long_line = errors_with("glider_mission: " + std::string(100'000, 'x') + "\n");
  REQUIRE(long_line.size() == 1);
  CHECK(long_line[0].size() < 300);
}
