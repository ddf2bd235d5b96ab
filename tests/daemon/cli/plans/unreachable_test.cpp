#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "daemon/cli/plan.hpp"
#include "tests/daemon/cli/planned.hpp"

using namespace glidehelm;

namespace {

/// How far a way is, and in stints of what length.
struct Way {
  std::string goal_lon_deg, stint_h;
};
const Way kLong{"3.18", "4"};       ///< 20 km, 18.5 h in still water
const Way kToLagoon{"3.045", "1"};  ///< 5 km

/// A mission along the equator to the east at 0.3 m/s, with `more` lines of its own.
struct EastwardDesk {
  test::ScratchFolder folder;
  cli::PlanOptions options;
  explicit EastwardDesk(const std::string& more, const Way& way = kLong) {
    test::write_bytes(folder / "m.yaml",
                      "schema: glidehelm/mission/v1\nname: east\nglider: sim01\n"
                      "goal: {lat_deg: 0.0, lon_deg: " +
                          way.goal_lon_deg +
                          ", radius_m: 200}\n"
                          "start: {lat_deg: 0.0, lon_deg: 3.0, time: 2026-03-01T00:00:00Z}\n"
                          "approval: {mode: manual}\nschedule: {stint_h: " +
                          way.stint_h + "}\n" + more);
    options.mission = folder / "m.yaml";
  }
  explicit EastwardDesk(double east, const std::string& more = "", const Way& way = kLong)
      : EastwardDesk{
            "currents:\n  - analytic: {kind: constant, origin: {lat_deg: 0, lon_deg: 3}, length_scale_m: 1000, "
            "speed_scale_m_per_s: 1, params: {u: " +
                std::to_string(east) + ", v: 0}}\n" + more,
            way} {}
  [[nodiscard]] nlohmann::json plan(int code) const { return test::planned(options, {code}); }
};

void check_proven(const nlohmann::json& plan) {
  INFO(plan.dump());
  CHECK(plan["status"] == "proven_unreachable");
  CHECK(plan["travel_time_s"].is_null());
  CHECK(plan["arrival"].is_null());
  CHECK(plan["lower_bound_s"].is_null());
  CHECK(plan["gap"].is_null());
  CHECK(plan["remaining_distance_m"].get<double>() > 200);
  CHECK(plan["reason"].get<std::string>().find("reaches the goal within the horizon of ") != std::string::npos);
}

/// A goal 5 km to the east in the middle of a ring of four forbidden areas, half a kilometre thick, 2 km from the goal. A scale of its own: the front
/// of the bound has markers every 100 m at least, so that a small lagoon is quickly filled round.
const char* const kLagoon =
    "safety:\n  min_distance_to_coast_m: 0\n  keep_out:\n"
    "    - [{lat_deg: 0.018, lon_deg: 3.022}, {lat_deg: 0.023, lon_deg: 3.022}, {lat_deg: 0.023, lon_deg: 3.068}, "
    "{lat_deg: 0.018, lon_deg: 3.068}]\n"
    "    - [{lat_deg: -0.023, lon_deg: 3.022}, {lat_deg: -0.018, lon_deg: 3.022}, {lat_deg: -0.018, lon_deg: 3.068}, "
    "{lat_deg: -0.023, lon_deg: 3.068}]\n"
    "    - [{lat_deg: -0.023, lon_deg: 3.022}, {lat_deg: 0.023, lon_deg: 3.022}, {lat_deg: 0.023, lon_deg: 3.027}, "
    "{lat_deg: -0.023, lon_deg: 3.027}]\n"
    "    - [{lat_deg: -0.023, lon_deg: 3.063}, {lat_deg: 0.023, lon_deg: 3.063}, {lat_deg: 0.023, lon_deg: 3.068}, "
    "{lat_deg: -0.023, lon_deg: 3.068}]\n";

}  // namespace

TEST_CASE("plan says proven unreachable of a goal upstream of a current faster than the glider") {
  check_proven(EastwardDesk{-0.35}.plan(1));
  // Against a current slower than the glider it is reached: 20 km at 0.1 m/s, 56 h and the drifts of a dozen surface intervals.
  const auto slower = EastwardDesk{-0.2, "planning: {horizon_h: 120}\n"}.plan(0);
  CHECK(slower["status"] == "reaches_goal");
  CHECK(slower["lower_bound_s"].get<double>() <= slower["travel_time_s"].get<double>());
}

TEST_CASE("plan says proven unreachable of a goal in a closed lagoon") {
  // In 20 h, 16 of them under water, 17 km are flown: to the far side it is less than 5 + π·3.5 km.
  check_proven(EastwardDesk{0.0, std::string{kLagoon} + "planning: {horizon_h: 20}\n", kToLagoon}.plan(1));
  // Without the eastern wall there is a way round: less than 8 + 5 + 5 km, 17 h under water and as many surface intervals.
  std::string open = kLagoon;
  open.erase(open.rfind("    - "));
  CHECK(EastwardDesk{0.0, open + "planning: {horizon_h: 24}\n", kToLagoon}.plan(0)["status"] == "reaches_goal");
}

TEST_CASE("plan says proven unreachable where the horizon is too short") {
  // 20.04 km less the radius at 0.3 m/s are 18.4 h under water and five surface intervals.
  const auto plan = EastwardDesk{0.0, "planning: {horizon_h: 17}\n"}.plan(1);
  check_proven(plan);
  CHECK(plan["reason"].get<std::string>().find("horizon of 17.0 h") != std::string::npos);
  CHECK(EastwardDesk{0.0, "planning: {horizon_h: 21}\n"}.plan(0)["status"] == "reaches_goal");
}

TEST_CASE("a proof beyond the forecast's times names what it assumes of them") {
  // Two fields a day apart, westward at 0.35 m/s; the automatic horizon is more than two days.
  for (const auto& [policy, words] : {std::pair{"hold", "held before and after (outside_time: hold)"},
                                      std::pair{"cycle", "repeated as a tide before and after (outside_time: cycle)"},
                                      std::pair{"forbid", "and none before and after (outside_time: forbid)"}}) {
    INFO(policy);
    const test::ScratchFolder sea;
    const auto file = test::make_netcdf(sea, "w.nc", R"(netcdf w {
dimensions: time = 2 ; lat = 2 ; lon = 2 ;
variables: double time(time) ; time:units = "hours since 2026-03-01" ; double lat(lat) ; lat:units = "degrees_north" ;
  double lon(lon) ; lon:units = "degrees_east" ;
  float u(time, lat, lon) ; u:units = "m/s" ; u:standard_name = "eastward_sea_water_velocity" ;
  float v(time, lat, lon) ; v:units = "m/s" ; v:standard_name = "northward_sea_water_velocity" ;
data: time = 0, 26 ; lat = -2, 2 ; lon = 0, 8 ; u = -.35, -.35, -.35, -.35, -.35, -.35, -.35, -.35 ; v = 0, 0, 0, 0, 0, 0, 0, 0 ; })");
    const EastwardDesk desk{"currents: {files: [" + file + "], outside_time: " + policy + "}\n"};
    const auto plan = desk.plan(1);
    check_proven(plan);
    const std::string reason = plan["reason"];
    INFO(reason);
    CHECK(reason.find("with the currents of 2026-03-01T00:00:00Z to 2026-03-02T02:00:00Z ") != std::string::npos);
    CHECK(reason.find(words) != std::string::npos);
    // Within the forecast's times nothing is assumed.
    const EastwardDesk shorter{"currents: {files: [" + file + "], outside_time: " + policy +
                               "}\nplanning: {horizon_h: 20}\n"};
    CHECK(shorter.plan(1)["reason"].get<std::string>().find("outside_time") == std::string::npos);
  }
}
