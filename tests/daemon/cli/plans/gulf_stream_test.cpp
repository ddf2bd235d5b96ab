#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/cli/plan.hpp"
#include "tests/daemon/cli/planned.hpp"
#include "tests/support/data.hpp"

using namespace glidehelm;

namespace {

/// 239 km up the core of the Gulf Stream off Cape Hatteras at 0.3 m/s, from 35.25 N to 33.5 N: the water runs at 1.3 m/s where it begins and at
/// 1.2 m/s where it ends. The samples name neither their epoch nor their levels: docs/forecasts.md.
std::string upstream(const std::string& data, const std::string& more) {
  const std::string folder = data + "/currents/roms_us_east_sandy/";
  return "schema: glidehelm/mission/v1\nname: upstream\nglider: sim01\n"
         "goal: {lat_deg: 33.5, lon_deg: -75.75, radius_m: 2000}\n"
         "start: {lat_deg: 35.25, lon_deg: -74.25, time: 2012-10-28T00:00:00Z}\n"
         "currents:\n  files: [" +
         folder + "coawst_clm_*.nc, " + folder +
         "Sandy_roms_grid.nc]\n  time_epoch: 1858-11-17T00:00:00Z\n"
         "  s_levels: {vtransform: 2, vstretching: 4, theta_s: 5, theta_b: 0.4, hc_m: 50}\n"
         "vehicle: {horizontal_speed_m_per_s: 0.3}\nschedule: {stint_h: 6}\napproval: {mode: manual}\n" +
         more;
}

nlohmann::json plan(const std::string& mission, int code) {
  return test::planned(test::ScratchFolder{}, mission, {code});
}

/// 194 km up the Stream off Florida, the goal in the middle of it: the searches miss it or come in the wrong way.
std::string off_florida(const std::string& data, const std::string& method) {
  auto mission = upstream(data, "planning: {method: " + method + "}\n");
  const auto swap = [&](const std::string& from, const std::string& to) {
    mission.replace(mission.find(from), from.size(), to);
  };
  swap("lat_deg: 33.5, lon_deg: -75.75", "lat_deg: 28.75, lon_deg: -79.75");
  swap("lat_deg: 35.25, lon_deg: -74.25", "lat_deg: 30.5, lon_deg: -79.75");
  return mission;
}

double speed_of(const nlohmann::json& stint) {
  return std::hypot(stint["dac"]["east_m_per_s"].get<double>(), stint["dac"]["north_m_per_s"].get<double>());
}

/// The core from 33.3 N to 35.75 N, some 100 km wide: all water faster than the glider.
const char* const kCoreOnly =
    "safety: {keep_in: [[{lat_deg: 33.3, lon_deg: -76.35}, {lat_deg: 34.5, lon_deg: -75.7}, {lat_deg: 35.25, lon_deg: "
    "-74.9}, "
    "{lat_deg: 35.75, lon_deg: -74.1}, {lat_deg: 35.75, lon_deg: -72.95}, {lat_deg: 35.25, lon_deg: -73.5}, "
    "{lat_deg: 34.5, lon_deg: -74.5}, {lat_deg: 33.3, lon_deg: -75.4}]]}\n";

}  // namespace

TEST_CASE(
    "real data: up the Gulf Stream a glider arrives by leaving it, and that it cannot within its core or sooner is "
    "proven") {
  GLIDEHELM_NEEDS_DATA(data);
  // With the automatic horizon, 28 days: out of the Stream to the south-east, back through the slow water beside it, and in again above the goal.
  const auto round = plan(upstream(data, ""), 0);
  CHECK(round["status"] == "reaches_goal");
  const double travel = round["travel_time_s"], bound = round["lower_bound_s"], bar = round["lower_bound_error_s"];
  CHECK(travel >= bound);
  // 0.8 % over what the front says is what stints of one heading may cost (product page, "Must show"); the bar is a spacing of the front
  // and more, because without a coastline the model's mask is land.
  CHECK(travel <= 1.008 * (bound + bar));
  const auto& stints = round["stints"];
  REQUIRE(stints.size() > 10);
  CHECK(speed_of(stints.front()) > 3 * 0.3);
  CHECK(speed_of(stints.back()) > 0.3);
  const auto slowest = std::min_element(stints.begin(), stints.end(),
                                        [](const auto& a, const auto& b) { return speed_of(a) < speed_of(b); });
  CHECK(speed_of(*slowest) < 0.1);
  std::printf(
      "up the Gulf Stream: %.1f h, bound %.1f h with a bar of %.1f h; slowest water on the way %.2f m/s at %.2f, "
      "%.2f\n",
      travel / 3600, bound / 3600, bar / 3600, speed_of(*slowest), (*slowest)["dive"]["lat_deg"].get<double>(),
      (*slowest)["dive"]["lon_deg"].get<double>());

  // Kept to the core, within 320 h, and within the forecast's own four days: proven, each for what it is.
  const auto in_core = plan(upstream(data, kCoreOnly), 1);
  CHECK(in_core["status"] == "proven_unreachable");
  const auto soon = plan(upstream(data, "planning: {horizon_h: 320}\n"), 1);
  CHECK(soon["status"] == "proven_unreachable");
  CHECK(soon["reason"].get<std::string>().find("to 2012-11-01T00:00:00Z held before and after") != std::string::npos);
  const auto known = plan(upstream(data, "planning: {horizon_h: 90}\n"), 1);
  CHECK(known["status"] == "proven_unreachable");
  CHECK(known["reason"].get<std::string>().find("outside_time") == std::string::npos);
}

TEST_CASE("real data: where the searches end in different valleys of the Gulf Stream best looks farther") {
  GLIDEHELM_NEEDS_DATA(data);
  const auto best = plan(off_florida(data, "best"), 0), searched = plan(off_florida(data, "cts-astar-refined"), 0);
  const double travel = best["travel_time_s"], bound = best["lower_bound_s"], alone = searched["travel_time_s"];
  std::printf("off Florida: %.1f h, with the searches alone %.1f h, bound %.1f h\n", travel / 3600, alone / 3600,
              bound / 3600);
  CHECK(travel >= bound);
  CHECK(travel < 1.03 * bound);
  CHECK(travel < alone);
}
