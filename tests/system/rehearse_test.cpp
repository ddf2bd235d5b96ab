#include "daemon/cli/rehearse.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/chart/coast.hpp"
#include "daemon/world/real.hpp"
#include "tests/simulator/temp_folder.hpp"

using namespace glidehelm;
using nlohmann::json;

namespace {

/// 9 km through a weak current: three or four stints.
const char* const kMission =
    "schema: glidehelm/mission/v1\nname: leg\nglider: sim01\n"
    "goal: {lat_deg: 40.70, lon_deg: 4.30, radius_m: 2000}\n"
    "start: {lat_deg: 40.60, lon_deg: 4.30, time: 2026-03-01T00:00:00Z}\n"
    "currents:\n  - analytic: {kind: constant, origin: {lat_deg: 40.6, lon_deg: 4.3}, length_scale_m: 1, "
    "speed_scale_m_per_s: 1, params: {u: 0.05, v: -0.02}}\n"
    "approval: {mode: manual}\n";

struct Said {
  int code{};
  std::string out, err;
};

Said rehearse(cli::RehearseOptions options) {
  world::RealWorld real;
  auto w = real.world();
  std::ostringstream out, err;
  const int code = cli::run_rehearse(options, w, out, err);
  return {code, out.str(), err.str()};
}

}  // namespace

TEST_CASE("a rehearsal flies the mission's method and direct for every seed and departure, and says the same twice") {
  test::TempFolder folder;
  std::ofstream{folder.path / "leg.yaml"} << kMission;
  cli::RehearseOptions options;
  options.plan.mission = folder.path / "leg.yaml";
  options.seeds = 2;
  options.delays_h = {0, 6};
  options.json = true;
  options.noise_m_per_s = options.shift_km = options.late_h = 0;
  const auto said = rehearse(options);
  INFO(said.err);
  CHECK(said.code == 0);
  const auto document = json::parse(said.out);
  CHECK(document["schema"] == "glidehelm/rehearsal/v1");
  REQUIRE(document["runs"].size() == 8);
  REQUIRE(document["summary"].size() == 4);
  for (const auto& run : document["runs"]) {
    CHECK(run["arrived"] == true);
    // 11 106 m less the radius, 54 m of drift back in three surface intervals, northward at √(U² − 0.05²) − 0.02 with U from
    // 0.291 to 0.309 m/s: 8.9 to 9.6 h, and the three intervals. A bias of 2° and ragged stints stay within a quarter of an hour.
    CHECK(run["travel_time_s"].get<double>() / 3600 > 9.4);
    CHECK(run["travel_time_s"].get<double>() / 3600 < 10.6);
    CHECK(run["files_emitted"] == run["surfacings"]);
    CHECK(run["windows_missed"] == 0);
    CHECK(run["rules"].empty());
    CHECK(run["closest_coast_m"].is_null());  // no coastline
    // The simulator's 1.5 W all the way, and a call of 6 W for less than a surface interval each time; the pump works once
    // a cycle: (0.1 + 2.01 MPa)·0.4 L/0.5 = 1.7 kJ at 200 m, every (2·200 − 20) m/(0.3·tan 26°) ≈ 40 min: 0.7 W.
    const double hours = run["travel_time_s"].get<double>() / 3600;
    CHECK(run["energy_wh"].get<double>() > (1.5 + 0.6) * hours);
    CHECK(run["energy_wh"].get<double>() < (1.5 + 0.9) * (hours + 4.5) + 6 * 0.25 * run["surfacings"].get<double>());
  }
  CHECK(rehearse(options).out == said.out);
}

TEST_CASE("the page of a rehearsal stands alone, and an existing file is not overwritten") {
  test::TempFolder folder;
  std::ofstream{folder.path / "leg.yaml"} << kMission;
  cli::RehearseOptions options;
  options.plan.mission = folder.path / "leg.yaml";
  options.plan.method = "direct";
  options.seeds = 1;
  options.html = folder.path / "page.html";
  const auto said = rehearse(options);
  INFO(said.err);
  CHECK(said.code == 0);
  CHECK(said.out.find("direct") != std::string::npos);
  std::ifstream file{folder.path / "page.html"};
  const std::string page{std::istreambuf_iterator<char>{file}, {}};
  CHECK(page.rfind("<!doctype html>", 0) == 0);
  CHECK(page.find("<polyline class=\"ours\"") != std::string::npos);
  for (const char* outside : {"http:", "https:", "src=", "@import", "<script"})
    CHECK(page.find(outside) == std::string::npos);
  const auto again = rehearse(options);
  CHECK(again.code == 2);
  CHECK(again.out.empty());  // said before anything is flown
  CHECK(again.err.find("page.html is there already and is not overwritten: name another file") != std::string::npos);
  std::ifstream after{folder.path / "page.html"};
  CHECK(page == std::string{std::istreambuf_iterator<char>{after}, {}});
}

TEST_CASE("a rehearsal with nothing to fly says why") {
  test::TempFolder folder;
  std::ofstream{folder.path / "leg.yaml"}
      << std::string{kMission}.replace(std::string{kMission}.find("start:"), 6, "strat:");
  cli::RehearseOptions options;
  options.plan.mission = folder.path / "leg.yaml";
  const auto said = rehearse(options);
  CHECK(said.code == 2);
  CHECK(said.out.empty());
  CHECK(said.err.find("strat: unknown key; did you mean start?") != std::string::npos);
}

TEST_CASE("a flight past an island knows how near it came") {
  // An island whose west shore is the meridian 4.40, and a way north along 4.30: at 40.65 N that is 8458 m away. The first dive knows
  // no current and is set 720 m east by 0.05 m/s in 4 h, a bias of 2° turns a dive of 4.3 km by 150 m, and two surface intervals
  // drift 45 m each; the next dives know the current and make for the goal: at most 960 m nearer, and a rest of 300 m.
  test::TempFolder folder;
  const chart::CoastRing island{
      {{6'000'000, 406'200'000}, {6'400'000, 406'200'000}, {6'400'000, 406'800'000}, {6'000'000, 406'800'000}},
      {false, false, false, false}};
  std::ofstream{folder.path / "sea.coast"}
      << (*chart::Coast::make({38'000'000, 49'000'000, 400'000'000, 412'000'000}, "a test", {island}))->text();
  std::ofstream{folder.path / "leg.yaml"} << kMission << "safety: {coast: sea.coast}\n";
  cli::RehearseOptions options;
  options.plan.mission = folder.path / "leg.yaml";
  options.plan.method = "direct";
  options.seeds = 2;
  options.json = true;
  options.noise_m_per_s = options.shift_km = options.late_h = 0;
  const auto said = rehearse(options);
  INFO(said.err);
  CHECK(said.code == 0);
  const auto document = json::parse(said.out);
  REQUIRE(document["runs"].size() == 2);  // `direct` is not flown twice
  for (const auto& run : document["runs"]) {
    CHECK(run["closest_coast_m"].get<double>() > 8458 - 960 - 300);
    CHECK(run["closest_coast_m"].get<double>() < 8458 - 720 + 150 + 300);
  }
}

TEST_CASE("progress is a line at every tenth for a file, a bar for a terminal, and nothing when nobody asks") {
  using Progress = cli::RehearseOptions::Progress;
  test::TempFolder folder;
  std::ofstream{folder.path / "leg.yaml"} << kMission;
  cli::RehearseOptions options;
  options.plan.mission = folder.path / "leg.yaml";
  options.plan.method = "direct";
  options.seeds = 2;
  const auto quiet = rehearse(options);
  options.progress = Progress::lines;
  const auto lines = rehearse(options);
  options.progress = Progress::bar;
  const auto bar = rehearse(options);
  CHECK(quiet.err.find("flights") == std::string::npos);
  CHECK(lines.err == quiet.err + "1 of 2 flights (50 %)\n2 of 2 flights (100 %)\n");
  CHECK(bar.err.find("\r[###############               ] 1 of 2 flights") != std::string::npos);
  CHECK(bar.err.back() == '\r');  // the bar is wiped away
  CHECK(lines.out == quiet.out);
  CHECK(bar.out == quiet.out);
}

TEST_CASE("what cannot be flown or written is said before anything is flown") {
  test::TempFolder folder;
  std::ofstream{folder.path / "leg.yaml"} << kMission;
  const auto said_of = [&](const std::function<void(cli::RehearseOptions&)>& change) {
    cli::RehearseOptions options;
    options.plan.mission = folder.path / "leg.yaml";
    options.seeds = 10'000;  // would take minutes
    change(options);
    const auto said = rehearse(options);
    CHECK(said.out.empty());
    CHECK(said.code == 2);
    return said.err;
  };
  const auto has = [](const std::string& text, const char* words) { return text.find(words) != std::string::npos; };
  CHECK(has(said_of([](auto& o) { o.delays_h = {0, 6, 6}; }), "--delays: 6 h is given twice"));
  CHECK(has(said_of([](auto& o) { o.plan.method = "bset"; }), "--method bset: unknown"));
  CHECK(has(said_of([](auto& o) { o.plan.from = {95, 4}; }), "--from: latitude 95 is out of range"));
  CHECK(has(said_of([](auto& o) { o.truth = {"/nowhere/truth.nc"}; }), "--truth: "));
  CHECK(has(said_of([](auto& o) { o.html = "/nowhere/page.html"; }), "--html: "));
  CHECK(has(said_of([](auto& o) { o.plan.mission = "/nowhere/leg.yaml"; }), "/nowhere/leg.yaml"));
}
