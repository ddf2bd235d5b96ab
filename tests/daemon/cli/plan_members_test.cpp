#include "daemon/cli/plan_members.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/cli/plan.hpp"
#include "daemon/world/real.hpp"
#include "tests/support/four_oceans.hpp"
#include "tests/support/netcdf.hpp"

using namespace glidehelm;

namespace {

/// One of those oceans as a file of its own, with the reference time `cycle` if one is given.
std::string one_member(double east, const std::string& cycle = {}) {
  const auto u = std::to_string(east);
  return R"(netcdf m {
dimensions: time = 1 ; lat = 2 ; lon = 2 ;
variables: double time(time) ; time:units = "hours since 2026-03-01" ;
  double lat(lat) ; lat:units = "degrees_north" ; double lon(lon) ; lon:units = "degrees_east" ;)" +
         (cycle.empty()
              ? std::string{}
              : " double forecast_reference_time ; forecast_reference_time:standard_name = "
                "\"forecast_reference_time\" ; forecast_reference_time:units = \"hours since 2026-03-01\" ;") +
         R"(
  float u(time, lat, lon) ; u:units = "m/s" ; u:standard_name = "eastward_sea_water_velocity" ;
  float v(time, lat, lon) ; v:units = "m/s" ; v:standard_name = "northward_sea_water_velocity" ;
data: time = 0 ; lat = -2, 2 ; lon = 0, 8 ; v = 0, 0, 0, 0 ; u = )" +
         u + ", " + u + ", " + u + ", " + u + " ; " +
         (cycle.empty() ? "" : "forecast_reference_time = " + cycle + " ; ") + "}";
}

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
    test::make_netcdf(folder, "e.nc", test::four_oceans());
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

TEST_CASE("a mission with an ensemble flies the plan of its control in all members unasked") {
  Desk desk;
  desk.write_mission("files: [" + (desk.folder / "e.nc") + "], ensemble: {members: 3}");
  const auto said = desk.plan();
  INFO(said.err);
  CHECK(said.code == 0);
  CHECK(said.json["ensemble"]["members"] == 3);
  CHECK(said.json["ensemble"]["arrived"] == 3);
  desk.options.members = 2;
  CHECK(desk.plan().json["ensemble"]["members"] == 2);
  desk.options.members = 0;
  desk.options.member = 1;
  CHECK_FALSE(desk.plan().json.contains("ensemble"));
  desk.options.member = 3;
  const auto beyond = desk.plan();
  CHECK(beyond.code == 2);
  CHECK(beyond.err.find("currents.ensemble has 3 members") != std::string::npos);
}

TEST_CASE("members in files of their own are what the same members along a dimension are") {
  Desk desk;
  const std::array<double, 4> currents{0.02, 0.06, -0.06, -0.6};
  for (std::size_t k = 0; k < 4; ++k)
    test::make_netcdf(desk.folder, "m0" + std::to_string(k + 1) + ".nc", one_member(currents[k]));
  desk.write_mission("files: ['" + (desk.folder / "m{member:2}.nc") + "'], ensemble: {members: 4, first: 1}");
  const auto own = desk.plan();
  INFO(own.err);
  CHECK(own.code == 0);
  CHECK(own.json["travel_time_s"].get<double>() == about(travel_s(0.02)));
  Desk together;
  together.options.members = 4;
  CHECK(own.json["ensemble"] == together.plan().json["ensemble"]);
  desk.options.member = 1;
  CHECK(desk.plan().json["travel_time_s"].get<double>() == about(travel_s(0.06)));
}

TEST_CASE("members without a file are named by their numbers with the line of the ensemble") {
  Desk desk;
  for (const auto* name : {"m1.nc", "m3.nc"}) test::make_netcdf(desk.folder, name, one_member(0.02));
  desk.write_mission("files: ['" + (desk.folder / "m{member}.nc") + "'],\n  ensemble: {members: 4, first: 1}");
  const auto said = desk.plan();
  CHECK(said.code == 1);
  CHECK(said.out.empty());
  CHECK(
      said.err.find("m.yaml:7:13: currents.ensemble: members without a file, by their numbers: 2, 4; nothing matches " +
                    (desk.folder / "m2.nc")) != std::string::npos);
}

TEST_CASE("members of another cycle than the control are refused with the line of the ensemble") {
  Desk desk;
  test::make_netcdf(desk.folder, "m0.nc", one_member(0.02, "-24"));
  test::make_netcdf(desk.folder, "m1.nc", one_member(0.02, "-24"));
  test::make_netcdf(desk.folder, "m2.nc", one_member(0.02, "-12"));
  desk.write_mission("files: ['" + (desk.folder / "m{member}.nc") + "'],\n  ensemble: {members: 2}");
  auto said = desk.plan();
  INFO(said.err);
  CHECK(said.code == 0);
  desk.write_mission("files: ['" + (desk.folder / "m{member}.nc") + "'],\n  ensemble: {members: 3}");
  said = desk.plan();
  CHECK(said.code == 1);
  CHECK(said.err.find("m.yaml:7:13: currents.ensemble: members of different cycles: member 2 has the reference time "
                      "2026-02-28T12:00:00Z, the one that is planned in 2026-02-28T00:00:00Z") != std::string::npos);
}
