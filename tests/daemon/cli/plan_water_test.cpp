#include <catch2/catch.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "config/mission.hpp"
#include "daemon/cli/field_info.hpp"
#include "daemon/cli/plan.hpp"
#include "daemon/cli/polar.hpp"
#include "tests/daemon/cli/planned.hpp"
#include "tests/support/data.hpp"

// A body in the water of its forecast, from the published file to the answer.

using namespace glidehelm;

namespace {

/// A sea of 0.1 m/s to the east at 0, 100 and 400 m; with temperature and salinity where one is given: 24, 20 and 12 °C,
/// and that salinity, half more and half less.
std::string sea(const test::ScratchFolder& folder, const std::string& name, std::optional<double> salinity) {
  const auto field = [](const std::string& name_of_it, std::initializer_list<double> by_depth) {
    std::string numbers;
    for (const double value : by_depth)
      for (int n = 0; n < 9; ++n) numbers += (numbers.empty() ? "" : ", ") + std::to_string(value);
    return "  " + name_of_it + " = " + numbers + " ;\n";
  };
  std::string cdl =
      "netcdf sea {\ndimensions: depth = 3 ; lat = 3 ; lon = 3 ;\nvariables:\n"
      "  float depth(depth) ; depth:units = \"m\" ; depth:positive = \"down\" ;\n"
      "  float lat(lat) ; lat:units = \"degrees_north\" ; float lon(lon) ; lon:units = \"degrees_east\" ;\n"
      "  float uo(depth, lat, lon) ; uo:units = \"m s-1\" ; float vo(depth, lat, lon) ; vo:units = \"m s-1\" ;\n";
  if (salinity)
    cdl +=
        "  double thetao(depth, lat, lon) ; thetao:units = \"degC\" ; thetao:standard_name = \"sea_water_temperature\" "
        ";\n"
        "  double so(depth, lat, lon) ; so:units = \"1e-3\" ; so:standard_name = \"sea_water_practical_salinity\" ;\n";
  cdl += "data:\n  depth = 0, 100, 400 ; lat = 40, 41, 42 ; lon = 4, 5, 6 ;\n" + field("uo", {0.1, 0.1, 0.1}) +
         field("vo", {0, 0, 0});
  if (salinity) cdl += field("thetao", {24, 20, 12}) + field("so", {*salinity, *salinity + 0.5, *salinity - 0.5});
  return test::make_netcdf(folder, name, cdl + "}\n");
}

std::string mission_in(const std::string& file, const std::string& vehicle) {
  return "schema: glidehelm/mission/v1\nname: leg\nglider: sim01\ngoal: {lat_deg: 41.2, lon_deg: 5}\n"
         "start: {lat_deg: 41, lon_deg: 5, time: 2026-03-01T00:00:00Z}\ncurrents: {files: [" +
         file + "]}\nplanning: {method: direct}\napproval: {mode: manual}\nvehicle: {" + vehicle + "}\n";
}

nlohmann::json plan(const test::ScratchFolder& folder, const std::string& mission) {
  return test::planned(folder, mission, {0, 1});
}

}  // namespace

TEST_CASE(
    "a plan of a body in the forecast's water is that in the same water of the mission, and another one without") {
  const test::ScratchFolder folder;
  const auto wet = sea(folder, "wet.nc", 36), dry = sea(folder, "dry.nc", {});
  const auto there = plan(folder, mission_in(wet, "force_balance: {}"));
  CHECK(there["inputs"]["force_balance"]["water"] == "forecast");
  CHECK(there["inputs"]["force_balance"]["forecast_water"].get<std::string>().find("thetao and so") == 0);
  // The column passes through floats, in which these numbers are exact: so all that follows is equal to the bit.
  const auto own = plan(folder, mission_in(wet,
                                           "force_balance: {water: [{depth_m: 0, temperature_c: 24, salinity: 36}, "
                                           "{depth_m: 100, temperature_c: 20, salinity: 36.5}, "
                                           "{depth_m: 400, temperature_c: 12, salinity: 35.5}]}"));
  CHECK(own["inputs"]["force_balance"]["water"] == "mission");
  CHECK(there["inputs"]["horizontal_speed_m_per_s"] == own["inputs"]["horizontal_speed_m_per_s"]);
  CHECK(there["inputs"]["force_balance"]["glide_angle_deg"] == own["inputs"]["force_balance"]["glide_angle_deg"]);
  CHECK(there["stints"] == own["stints"]);
  CHECK(there["travel_time_s"] == own["travel_time_s"]);

  const auto without = plan(folder, mission_in(dry, "force_balance: {}"));
  CHECK(without["inputs"]["force_balance"]["water"] == "climatology");
  CHECK(without["inputs"]["force_balance"]["forecast_water"].is_null());
  CHECK(without["inputs"]["horizontal_speed_m_per_s"] != there["inputs"]["horizontal_speed_m_per_s"]);
  CHECK(without["travel_time_s"] != there["travel_time_s"]);
  CHECK(plan(folder, mission_in(wet, "horizontal_speed_m_per_s: 0.3"))["inputs"]["force_balance"].is_null());
}

TEST_CASE("half cycles in the forecast's water take as long as they do there") {
  const test::ScratchFolder folder;
  const auto wet = sea(folder, "wet.nc", 36);
  const auto cycles = [](std::string mission) { return mission + "schedule: {half_cycles: 6}\n"; };
  const auto there = plan(folder, cycles(mission_in(wet, "force_balance: {}")));
  const auto& in = there["inputs"];
  const double vertical = in["horizontal_speed_m_per_s"].get<double>() *
                          std::tan(in["force_balance"]["glide_angle_deg"].get<double>() * kPi / 180);
  // Six legs between 20 and 200 m, from the surface and back to it: 200 + 5·180 + 20 m.
  CHECK(in["stint_s"].get<double>() == Approx(1120 / vertical).epsilon(1e-12));
  CHECK(in["first_stint_s"] == in["stint_s"]);
}

TEST_CASE("the table, the polar and field info say whose water it is") {
  const test::ScratchFolder folder;
  const auto wet = sea(folder, "wet.nc", 36);
  test::write_bytes(folder / "m.yaml", mission_in(wet, "force_balance: {}"));
  cli::PlanOptions options;
  options.mission = folder / "m.yaml";
  const auto table = test::run_verb(cli::run_plan, options);
  CHECK(table.out.find("by its forces the glider makes 0.") != std::string::npos);
  CHECK(table.out.find("in the forecast's water: thetao and so") != std::string::npos);

  cli::PolarOptions polar;
  polar.mission = folder / "m.yaml";
  polar.json = true;
  const auto climate = nlohmann::json::parse(test::run_verb(cli::run_polar, polar).out);
  CHECK(climate["water"] == "climatology");
  polar.forecast = true;
  const auto there = nlohmann::json::parse(test::run_verb(cli::run_polar, polar).out);
  CHECK(there["water"] == "forecast");
  options.json = true;
  const auto planned = nlohmann::json::parse(test::run_verb(cli::run_plan, options).out);
  CHECK(there["yo"]["horizontal_speed_m_per_s"] == planned["inputs"]["horizontal_speed_m_per_s"]);
  CHECK(there["yo"]["horizontal_speed_m_per_s"] != climate["yo"]["horizontal_speed_m_per_s"]);
  polar.mission.clear();
  CHECK(test::run_verb(cli::run_polar, polar).code == 2);
  test::write_bytes(folder / "m.yaml", mission_in(folder / "gone.nc", "force_balance: {}"));
  polar.mission = folder / "m.yaml";
  CHECK(test::run_verb(cli::run_polar, polar).code == 1);

  cli::FieldInfoOptions info;
  info.files = {wet};
  const auto told = test::run_verb(cli::run_field_info, info);
  CHECK(told.out.find("density    at 0.0 m 24.00 C and salinity 36.00, at 400.0 m 12.00 C and 35.50; thetao and so") !=
        std::string::npos);
  info.json = true;
  const auto j = nlohmann::json::parse(test::run_verb(cli::run_field_info, info).out);
  REQUIRE(j["water"]["layers"].size() == 3);
  CHECK(j["water"]["layers"][0]["density_kg_per_m3"].get<double>() ==
        Approx(ocean::sea_water_density(36, 24, 0)).epsilon(1e-12));
}

TEST_CASE("water that a body does not fly in is warned about, and the climatological profile is taken") {
  const test::ScratchFolder folder;
  // 71.9 kg in 70 l fly in the climatological profile (1026 kg/m³ at the surface). Water of salinity 25 is 10 kg/m³ lighter: 0.7 kg, and the pump
  // carries 0.24 kg.
  const auto light = sea(folder, "light.nc", 25);
  test::write_bytes(folder / "m.yaml", mission_in(light, "force_balance: {mass_kg: 71.9}"));
  cli::PlanOptions options;
  options.mission = folder / "m.yaml";
  options.json = true;
  const auto said = test::run_verb(cli::run_plan, options);
  INFO(said.err);
  CHECK(said.err.find("does not fly in the forecast's water: the glider does not climb") != std::string::npos);
  CHECK(nlohmann::json::parse(said.out)["inputs"]["force_balance"]["water"] == "climatology");
}

TEST_CASE("real data: in the water of the Sandy case a body makes another speed than in the climatological profile") {
  GLIDEHELM_NEEDS_DATA(data);
  const std::string folder_of_data = data + "/currents/roms_us_east_sandy/";
  const auto mission = [&](const std::string& vehicle) {
    return "schema: glidehelm/mission/v1\nname: stream\nglider: sim01\n"
           "goal: {lat_deg: 33.0, lon_deg: -73.0, radius_m: 2000}\n"
           "start: {lat_deg: 33.0, lon_deg: -72.0, time: 2012-10-28T00:00:00Z}\n"
           "currents:\n  files: [" +
           folder_of_data + "coawst_clm_*.nc, " + folder_of_data +
           "Sandy_roms_grid.nc]\n  time_epoch: 1858-11-17T00:00:00Z\n"
           "  s_levels: {vtransform: 2, vstretching: 4, theta_s: 5, theta_b: 0.4, hc_m: 50}\n"
           "schedule: {stint_h: 6}\nplanning: {method: direct}\napproval: {mode: manual}\nvehicle: {" +
           vehicle + "}\n";
  };
  const test::ScratchFolder folder;
  for (const std::string& body : {std::string{"force_balance: {"}, std::string{"dive_depth_m: 1000, force_balance: {"},
                                  std::string{"force_balance: {mass_kg: 71.8"}}) {
    const auto there = plan(folder, mission(body + "}"));
    const auto text = mission(body + "}");
    const auto unreadable = [](const std::string& path) -> glidehelm::Expected<std::string, config::Unreadable> {
      return unexpected(config::Unreadable{path});
    };
    const auto climate = config::read_mission(text, "m.yaml", unreadable);
    REQUIRE(climate);
    const double in_forecast = there["inputs"]["horizontal_speed_m_per_s"], in_climate = climate->horizontal_speed.si();
    std::printf("%s}: %.5f m/s in the forecast's water, %.5f in the climatological profile (%+.2f %%), %s\n",
                body.c_str(), in_forecast, in_climate, 100 * (in_forecast / in_climate - 1),
                there["inputs"]["force_balance"]["water"].get<std::string>().c_str());
    CHECK(there["inputs"]["force_balance"]["water"] == "forecast");
    CHECK(in_forecast != in_climate);
    // The stratification of the Sargasso Sea is stronger than the profile's, by less than the pump's share: some percent.
    CHECK(std::abs(in_forecast / in_climate - 1) < 0.25);
  }
}
