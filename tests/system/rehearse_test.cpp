#include "daemon/cli/rehearse.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

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
  CHECK(again.code == 1);
  CHECK(again.err.find("page.html") != std::string::npos);
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
