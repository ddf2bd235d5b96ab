#include "simulator/scenario.hpp"
#include "tests/simulator/scenario_errors.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

using namespace glidehelm;
using simulator::read_scenario;
using test::errors_of;

namespace {

const std::string kSmall =
    "schema: glidehelm/scenario/v1\n"
    "start: 2026-03-01T00:00:00Z\n"
    "truth: {still: true}\n"
    "gliders:\n"
    "  - name: sim01\n"
    "    start: {lat_deg: 40.0, lon_deg: 5.0}\n"
    "    goal: {lat_deg: 40.5, lon_deg: 5.5}\n"
    "    folder: sim01\n";

/// The small scenario with one line of it replaced.
std::string with(const std::string& line, const std::string& other) {
  std::string text = kSmall;
  const auto at = text.find(line);
  REQUIRE(at != std::string::npos);
  return text.replace(at, line.size(), other);
}

std::string slurp(const std::filesystem::path& path) {
  std::ifstream in{path};
  REQUIRE(in);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

}  // namespace

TEST_CASE("the smallest scenario has every default") {
  const auto s = read_scenario(kSmall, "/x/s.yaml");
  REQUIRE(s);
  CHECK(s->seed == 1);
  CHECK(s->truth.still);
  CHECK(s->end.at_goal);
  REQUIRE(s->gliders.size() == 1);
  const auto& g = s->gliders[0];
  CHECK(g.folder == "/x/sim01");
  CHECK(g.plan.setup.stint_s == 4 * 3600);
  CHECK(g.plan.setup.times.surface == 900);
  CHECK(g.plan.setup.belief.speed == MetresPerSecond{0.3});
  CHECK(g.plan.setup.belief.correction == 1);
  CHECK(g.plan.goal_radius == Metres{2000});
  CHECK(g.plan.setup.list.waypoints == std::vector{geo_point(40.5, 5.5)});
  CHECK(g.plan.setup.list.initial == 0);
  CHECK(g.plan.setup.start_s == epoch_seconds(s->start));
}

TEST_CASE("keys are read in their own units") {
  const auto s = read_scenario(kSmall +
                                   "    vehicle: {horizontal_speed_m_per_s: 0.28, believed_speed_m_per_s: 0.31, "
                                   "heading_bias_deg: 3, current_correction: 0}\n"
                                   "    schedule: {stint_h: 8, stint_jitter_percent: 5, surface_min: 20, cycle_s: 20}\n"
                                   "    frame: {rotation_deg: 9.5}\n"
                                   "    line: {connect: \"127.0.0.1:6500\"}\n"
                                   "    faults: {lost_calls: {probability: 0.1}, redial: {surfacings: [2, 5]}}\n"
                                   "    prior_water: {east_m_per_s: 0.1, north_m_per_s: -0.2}\n"
                                   "    call: {dockzr_after_s: 90, reread: after_transfer, resume: at_once}\n",
                               "s.yaml");
  REQUIRE(s);
  const auto& g = s->gliders[0];
  CHECK(g.plan.setup.hull.speed == MetresPerSecond{0.28});
  CHECK(g.plan.setup.belief.speed == MetresPerSecond{0.31});
  CHECK(g.plan.setup.hull.heading_bias.si() == Approx(degrees(3).si()));
  CHECK(g.plan.setup.stint_s == 8 * 3600);
  CHECK(g.plan.setup.stint_jitter == Approx(0.05));
  CHECK(g.plan.setup.times.surface == 1200);
  CHECK(g.plan.setup.frame.rotation.si() == Approx(degrees(9.5).si()));
  CHECK(g.line == simulator::LineAddress{true, "127.0.0.1", 6500});
  CHECK(g.plan.lost_calls.probability == 0.1);
  CHECK(g.plan.redial.surfacings == std::vector{2, 5});
  CHECK(g.plan.setup.prior_water->north == MetresPerSecond{-0.2});
  CHECK(g.plan.call.dockzr_after == 90);
  CHECK_FALSE(g.plan.call.reread_always);
  CHECK(g.plan.call.resume_at_once);
}

TEST_CASE("what the dialog tells of frame and current is set by its keys") {
  const auto s = read_scenario(kSmall +
                                   "    dialog: {firmware: g2, without: [m_gps_mag_var, m_vacuum], "
                                   "mag_var_error_deg: -6, water: awaited, waypoint_line: false}\n",
                               "s.yaml");
  REQUIRE(s);
  const auto& call = s->gliders[0].plan.call;
  CHECK(call.firmware == simulator::Firmware::g2);
  CHECK(call.tells == simulator::Telling{{"m_gps_mag_var", "m_vacuum"}, degrees(-6), true, false});
}

TEST_CASE("a sensor that no dialog prints and a correction that nobody describes are refused by name") {
  CHECK(errors_of(kSmall + "    dialog: {without: [m_gps_magvar]}\n").find("m_gps_mag_var") != std::string::npos);
  const auto two = errors_of(kSmall + "    vehicle: {current_correction: 2}\n");
  CHECK(two ==
        "/x/s.yaml:9:35: gliders[0].vehicle.current_correction: not simulated: no source tells its algorithm; found 2; "
        "allowed: 0 or 1\n");
  CHECK(errors_of(kSmall + "    vehicle: {current_correction: 3}\n").find("0 to 1") != std::string::npos);
}

TEST_CASE("a made-up sea takes ends and seed from the scenario unless it has its own") {
  const auto text = with(
      "{still: true}", "{coastal: {area: {west_deg: 4, east_deg: 6, south_deg: 39, north_deg: 41}, jet_m_per_s: 0.2}}");
  const auto s = read_scenario(text, "s.yaml", 42);
  REQUIRE(s);
  REQUIRE(s->truth.coastal);
  CHECK(s->seed == 42);
  CHECK(s->truth.coastal->spec.seed == 42);
  CHECK(s->truth.coastal->spec.jet == 0.2);
  CHECK(s->truth.coastal->spec.from == geo_point(40, 5));
  CHECK(s->truth.coastal->spec.to == geo_point(40.5, 5.5));
  CHECK(s->truth.coastal->variant == simulator::Variant::truth);
}

TEST_CASE("analytic truths take the parameters of their kind") {
  const auto text = with("{still: true}",
                         "{analytic: [{kind: solid-body, origin: {lat_deg: 40, lon_deg: 5}, length_scale_m: 1000, "
                         "speed_scale_m_per_s: 0.1, params: {omega: 2}}]}");
  const auto s = read_scenario(text, "s.yaml");
  REQUIRE(s);
  REQUIRE(s->truth.analytic.size() == 1);
  CHECK(s->truth.analytic[0].kind == "solid-body");
  CHECK(s->truth.analytic[0].origin == geo_point(40, 5));
  CHECK(s->truth.analytic[0].params == std::vector<std::pair<std::string, double>>{{"omega", 2.0}});
}

TEST_CASE("every mistake is told at once, with line, column and the nearest key") {
  const auto all = errors_of(
      "schema: glidehelm/scenario/v1\n"
      "start: 2026-03-01T00:00:00Z\n"
      "sede: 4\n"
      "truth: {still: true, grid: a.ghg}\n"
      "gliders:\n"
      "  - name: sim01\n"
      "    start: {lat_deg: 95.0, lon_deg: 5.0}\n"
      "    goal: {lat_deg: 40.5, lon_deg: 5.5, radius_m: 1}\n"
      "    folder: sim01\n");
  CHECK(all.find("/x/s.yaml:3:1: sede: unknown key") != std::string::npos);
  CHECK(all.find("did you mean seed") != std::string::npos);
  CHECK(all.find("more than one ocean") != std::string::npos);
  CHECK(all.find("lat_deg") != std::string::npos);
  CHECK(all.find("radius_m") != std::string::npos);
}

TEST_CASE("what cannot be played is refused with the reason") {
  CHECK(errors_of(with("truth: {still: true}", "truth: {still: false}")).find("no ocean") != std::string::npos);
  CHECK(errors_of(with("lat_deg: 40.5, lon_deg: 5.5", "lat_deg: 40.001, lon_deg: 5.0"))
            .find("already inside the goal radius") != std::string::npos);
  CHECK(errors_of(kSmall + "    line: {connect: \"here\"}\n").find("no address") != std::string::npos);
  CHECK(errors_of(kSmall + "    line: {connect: \"a:1\", listen: \"b:2\"}\n").find("both connect and listen") !=
        std::string::npos);
  CHECK(errors_of(kSmall + "    frame: {rotation_deg: 1, magnetic_variation_deg: 1}\n").find("frame") !=
        std::string::npos);
  CHECK(errors_of(kSmall + "    schedule: {surface_min: 5}\n    call: {dockzr_after_s: 200}\n")
            .find("the script would run after the glider has dived") != std::string::npos);
  CHECK(errors_of(kSmall + "  - name: sim01\n    start: {lat_deg: 40.0, lon_deg: 5.0}\n    goal: {lat_deg: 40.5, "
                           "lon_deg: 5.5}\n    folder: b\n")
            .find("two gliders with one name") != std::string::npos);
}

TEST_CASE("gliders of one scenario draw from different seeds") {
  const auto s = read_scenario(kSmall +
                                   "  - name: sim02\n    start: {lat_deg: 40.0, lon_deg: 5.0}\n    goal: {lat_deg: "
                                   "40.5, lon_deg: 5.5}\n    folder: b\n",
                               "s.yaml");
  REQUIRE(s);
  CHECK(s->gliders[0].plan.setup.seed != s->gliders[1].plan.setup.seed);
}

TEST_CASE("a fleet of a few lines is many gliders with places, ports, folders and seeds of their own") {
  const std::string text =
      "schema: glidehelm/scenario/v1\nstart: 2026-03-01T00:00:00Z\ntruth: {still: true}\n"
      "fleet:\n  count: 50\n  area: {west_deg: 4, east_deg: 6, south_deg: 39, north_deg: 41}\n  leg_km: 60\n"
      "  connect: \"127.0.0.1:7000\"\n  each:\n    schedule: {stint_h: 6}\n    faults: {garbled: {probability: 0.5}}\n";
  const auto s = read_scenario(text, "/x/s.yaml");
  REQUIRE(s);
  REQUIRE(s->gliders.size() == 50);
  std::set<std::string> names, folders;
  std::set<std::uint64_t> seeds;
  std::map<simulator::Firmware, int> firmware;
  for (std::size_t i = 0; i < 50; ++i) {
    const auto& g = s->gliders[i];
    names.insert(g.plan.setup.name);
    folders.insert(g.folder);
    seeds.insert(g.plan.setup.seed);
    ++firmware[g.plan.call.firmware];
    CHECK(g.line == simulator::LineAddress{true, "127.0.0.1", static_cast<std::uint16_t>(7000 + i)});
    CHECK(g.plan.setup.stint_s == 6 * 3600);
    CHECK(g.plan.line.garbled.probability == 0.5);
    CHECK(g.plan.setup.start_s >= epoch_seconds(s->start));
    CHECK(g.plan.setup.start_s < epoch_seconds(s->start) + 4 * 3600);
    for (const auto p : {g.plan.setup.start, g.plan.goal}) {
      CHECK(p.lat.degrees() > 39);
      CHECK(p.lat.degrees() < 41);
      CHECK(p.lon.degrees() > 4);
      CHECK(p.lon.degrees() < 6);
    }
    CHECK(distance(g.plan.setup.start, g.plan.goal).si() == Approx(60e3).epsilon(1e-6));
  }
  CHECK(names.size() == 50);
  CHECK(folders.size() == 50);
  CHECK(seeds.size() == 50);
  CHECK(firmware[simulator::Firmware::g1] == 5);
  CHECK(s->gliders[0].plan.setup.name == "g01");
  CHECK(s->gliders[49].folder == "/x/run/g50");
  const auto again = read_scenario(text, "/x/s.yaml"), other = read_scenario(text, "/x/s.yaml", 9);
  CHECK(again->gliders[7].plan.goal == s->gliders[7].plan.goal);
  CHECK(other->gliders[7].plan.goal != s->gliders[7].plan.goal);
}

TEST_CASE("an ocean's error, forecasts and faults are read in their units") {
  const auto s =
      read_scenario(with("truth: {still: true}",
                         "truth: {still: true, error: {shift_km: 5, noise_m_per_s: 0.05, tide_m_per_s: 0.1}}\n"
                         "forecasts: {folder: f, area: {west_deg: 4, east_deg: 6, south_deg: 39, north_deg: 41}, "
                         "every_h: 12, depths_m: "
                         "[0, 100]}") +
                        "    dialog: {firmware: g2, aborts: 4}\n"
                        "    faults: {cut: {surfacings: [3]}, slow: {probability: 0.1}, slow_bytes_per_s: 60, "
                        "garbled_per_kilobyte: 2}\n",
                    "/x/s.yaml", 6);
  REQUIRE(s);
  REQUIRE(s->truth.error);
  CHECK(s->truth.error->shift_km == 5);
  CHECK(s->truth.error->seed == 6);
  CHECK(s->forecasts.folder == "/x/f");
  CHECK(s->forecasts.every_h == 12);
  CHECK(s->forecasts.grid.depths_m == std::vector{0.0, 100.0});
  const auto& g = s->gliders[0].plan;
  CHECK(g.call.firmware == simulator::Firmware::g2);
  CHECK(g.call.aborts == 4);
  CHECK(g.line.cut.surfacings == std::vector{3});
  CHECK(g.line.slow.probability == 0.1);
  CHECK(g.line.setup == simulator::LineSetup{60, 2});
}

TEST_CASE("fleets, errors and forecasts that cannot be are refused with the reason") {
  const std::string none = "schema: glidehelm/scenario/v1\nstart: 2026-03-01T00:00:00Z\ntruth: {still: true}\n";
  CHECK(errors_of(none).find("no glider") != std::string::npos);
  const std::string area = "area: {west_deg: 4, east_deg: 6, south_deg: 39, north_deg: 41}";
  CHECK(errors_of(none + "fleet: {count: 3, area: {west_deg: 6, east_deg: 4, south_deg: 39, north_deg: 41}}\n")
            .find("no width of an area") != std::string::npos);
  CHECK(errors_of(none + "fleet: {count: 3, connect: \"a:65534\", " + area + "}\n").find("ports for all of them") !=
        std::string::npos);
  CHECK(errors_of(kSmall + "forecasts: {" + area + "}\n").find("no folder") != std::string::npos);
  CHECK(errors_of(kSmall + "forecasts: {folder: f, depths_m: [0, 50, 50], " + area + "}\n").find("do not rise") !=
        std::string::npos);
  CHECK(errors_of(kSmall + "forecasts: {folder: f, step_deg: 0.002, " + area + "}\n").find("20 million") !=
        std::string::npos);
  CHECK(errors_of(with("{still: true}", "{still: true, error: {longest_km: 5}}")).find("longer than longest_km") !=
        std::string::npos);
  CHECK(errors_of(kSmall + "    dialog: {firmware: g4}\n").find("g1") != std::string::npos);
}

TEST_CASE("every example scenario is read") {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator{std::filesystem::path{GLIDEHELM_SOURCE} / "simulator/scenarios"}) {
    if (entry.path().extension() != ".yaml") continue;
    INFO(entry.path().string());
    INFO(errors_of(slurp(entry.path())));
    CHECK(read_scenario(slurp(entry.path()), entry.path().string()));
    ++count;
  }
  CHECK(count >= 3);
}

TEST_CASE("the README lists every key") {
  const auto readme = slurp(std::filesystem::path{GLIDEHELM_SOURCE} / "simulator/README.md");
  CHECK((readme.find(simulator::scenario_key_table()) != std::string::npos));
}
