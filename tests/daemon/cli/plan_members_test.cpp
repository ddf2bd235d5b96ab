#include "daemon/cli/plan_members.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/cli/plan.hpp"
#include "daemon/world/real.hpp"
#include "tests/support/netcdf.hpp"

using namespace glidehelm;

namespace {

/// Four oceans, each the same everywhere and always: an eastward current of 0.02, 0.06, −0.06 and −0.6 m/s.
const std::string kEnsemble = R"(netcdf e {
dimensions: member = 4 ; lat = 2 ; lon = 2 ;
variables: double lat(lat) ; lat:units = "degrees_north" ; double lon(lon) ; lon:units = "degrees_east" ;
  float u(member, lat, lon) ; u:units = "m/s" ; u:standard_name = "eastward_sea_water_velocity" ;
  float v(member, lat, lon) ; v:units = "m/s" ; v:standard_name = "northward_sea_water_velocity" ;
data: lat = -2, 2 ; lon = 0, 8 ;
  u = 0.02, 0.02, 0.02, 0.02, 0.06, 0.06, 0.06, 0.06, -0.06, -0.06, -0.06, -0.06, -0.6, -0.6, -0.6, -0.6 ;
  v = 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 ;
})";

/// 44 km eastward along the equator.
std::string mission(const std::string& currents) {
  return "schema: glidehelm/mission/v1\nname: east\nglider: sim01\n"
         "goal: {lat_deg: 0.0, lon_deg: 3.4, radius_m: 1000}\n"
         "start: {lat_deg: 0.0, lon_deg: 3.0, time: 2026-03-01T00:00:00Z}\n"
         "currents: {" +
         currents + "}\napproval: {mode: manual}\nschedule: {stint_h: 6}\nplanning: {method: direct}\n";
}

struct Planned {
  int code{};
  nlohmann::json json;
  std::string out, err;
};
struct Desk {
  test::ScratchFolder folder;
  cli::PlanOptions options;
  Desk() {
    test::make_netcdf(folder, "e.nc", kEnsemble);
    write_mission("files: [" + (folder / "e.nc") + "]");
    options.mission = folder / "m.yaml";
    options.json = true;
  }
  void write_mission(const std::string& currents) { test::write_bytes(folder / "m.yaml", mission(currents)); }
  [[nodiscard]] Planned plan() const {
    world::RealWorld real;
    auto w = real.world();
    std::ostringstream out, err;
    Planned said{cli::run_plan(options, w, out, err), {}, out.str(), err.str()};
    if (options.json) said.json = nlohmann::json::parse(said.out, nullptr, false);
    return said;
  }
};

/// Seconds to the goal's radius with an eastward current: 15 min of drift, then stints of 6 h and drifts of 15 min.
double travel_s(double current) {
  const double way = distance(geo_point(0, 3), geo_point(0, 3.4)).si() - 1000;
  double t = 900, x = current * t;
  while (x + 21600 * (0.3 + current) < way) {
    x += 21600 * (0.3 + current) + 900 * current;
    t += 21600 + 900;
  }
  return t + (way - x) / (0.3 + current);
}
// Currents are floats (6e-9 of 0.06), the way is measured on the ellipsoid and stepped in the local metric (1e-6 of it), the
// crossing of the goal's radius is found to a second.
Approx about(double seconds) { return Approx(seconds).epsilon(1e-5).margin(2); }

}  // namespace

TEST_CASE("each member is planned in by itself") {
  Desk desk;
  for (const auto& [member, current] : {std::pair{0U, 0.02}, std::pair{1U, 0.06}, std::pair{2U, -0.06}}) {
    desk.options.member = member;
    const auto said = desk.plan();
    INFO(said.err);
    CHECK(said.code == 0);
    CHECK(said.json["travel_time_s"].get<double>() == about(travel_s(current)));
    CHECK_FALSE(said.json.contains("ensemble"));
  }
  desk.options.member = 3;
  CHECK(desk.plan().code == 1);  // no glider of 0.3 m/s goes against 0.6
  desk.options.member = 4;
  const auto said = desk.plan();
  CHECK(said.code == 1);
  CHECK(said.err.find("it has no member 4: 4 members along member (by name), allowed is 0 to 3") != std::string::npos);
}

TEST_CASE("a plan is flown in every member and arrives in as many as its speed allows") {
  Desk desk;
  desk.options.members = 4;
  const auto said = desk.plan();
  INFO(said.err);
  CHECK(said.code == 0);
  CHECK(said.json["travel_time_s"].get<double>() == about(travel_s(0.02)));  // that of member 0
  const auto& all = said.json["ensemble"];
  CHECK(all["members"] == 4);
  CHECK(all["arrived"] == 3);
  CHECK(all["arrival_share"] == 0.75);
  CHECK(all["travel_time_s"]["median"].get<double>() == about(travel_s(0.02)));
  // Of three values 10 % lie 0.2 of the way from the first to the second.
  CHECK(all["travel_time_s"]["p10"].get<double>() == about(travel_s(0.06) + 0.2 * (travel_s(0.02) - travel_s(0.06))));
  CHECK(all["closest_coast_m"].is_null());
  REQUIRE(all["flights"].size() == 4);
  CHECK(all["flights"][2]["travel_time_s"].get<double>() == about(travel_s(-0.06)));
  CHECK(all["flights"][3]["travel_time_s"].is_null());
  CHECK(desk.plan().json["ensemble"] == all);
}

TEST_CASE("the sentences name the share, the times and the members that do not arrive") {
  Desk desk;
  desk.options.members = 4;
  desk.options.json = false;
  const auto out = desk.plan().out;
  CHECK(out.find("flown in 4 members: it arrives in 3 of them (75 %), after ") != std::string::npos);
  CHECK(out.find("member   3: comes within 44.5 km") != std::string::npos);
}

TEST_CASE("members that are not there and formulas are refused by name") {
  Desk desk;
  desk.options.members = 5;
  const auto said = desk.plan();
  CHECK(said.code == 1);
  CHECK(said.out.empty());
  CHECK(said.err.find("member 4: ") != std::string::npos);
  desk.write_mission(
      "analytic: {kind: constant, origin: {lat_deg: 0, lon_deg: 3}, length_scale_m: 10000, speed_scale_m_per_s: 0.1, "
      "params: {u: 1, v: 0}}");
  CHECK(desk.plan().code == 2);
}
