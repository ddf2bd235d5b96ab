#include "daemon/cli/plan_case.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "core/base/utc.hpp"
#include "daemon/world/real.hpp"
#include "tests/support/netcdf.hpp"

using namespace glidehelm;

namespace {

/// A still sea with fields at 0, 48 and 168 h after its reference time, 1 March 2026 00:00 UTC; and a mission in it.
std::string mission_in_old_sea(const test::ScratchFolder& folder) {
  test::make_netcdf(folder, "sea.nc", R"(netcdf sea { dimensions: time = 3 ; lat = 3 ; lon = 3 ; variables:
    double time(time) ; time:units = "hours since 2026-03-01 00:00:00" ;
    double forecast_reference_time ; forecast_reference_time:standard_name = "forecast_reference_time" ;
    forecast_reference_time:units = "hours since 2026-03-01 00:00:00" ;
    double lat(lat) ; lat:units = "degrees_north" ; double lon(lon) ; lon:units = "degrees_east" ;
    float uo(time, lat, lon) ; uo:units = "m/s" ; uo:standard_name = "eastward_sea_water_velocity" ;
    float vo(time, lat, lon) ; vo:units = "m/s" ; vo:standard_name = "northward_sea_water_velocity" ;
    data: time = 0, 48, 168 ; forecast_reference_time = 0 ; lat = 40, 41, 42 ; lon = 4, 5, 6 ;
    uo = .1,.1,.1,.1,.1,.1,.1,.1,.1, .1,.1,.1,.1,.1,.1,.1,.1,.1, .1,.1,.1,.1,.1,.1,.1,.1,.1 ;
    vo = .1,.1,.1,.1,.1,.1,.1,.1,.1, .1,.1,.1,.1,.1,.1,.1,.1,.1, .1,.1,.1,.1,.1,.1,.1,.1,.1 ; })");
  const auto path = folder / "m.yaml";
  std::ofstream{path} << "schema: glidehelm/mission/v1\nname: leg\nglider: sim01\ngoal: {lat_deg: 41.2, lon_deg: 5}\n"
                         "start: {lat_deg: 41, lon_deg: 5}\ncurrents: {files: ["
                      << folder / "sea.nc"
                      << "]}\napproval: {mode: manual}\n";
  return path;
}

struct Prepared {
  std::string trouble, warnings;
};
Prepared prepare(const std::string& mission, const std::string& at) {
  world::RealWorld real;
  auto w = real.world();
  std::ostringstream err;
  cli::PlanOptions options;
  options.mission = mission;
  options.at = utc_from_text(at);
  const auto found = cli::prepare_case(options, w, err);
  return {found ? "" : found.error().message, err.str()};
}

}  // namespace

TEST_CASE(
    "a plan at a time for which the forecast is too old is refused as the daemon would, and told when it is old") {
  const test::ScratchFolder folder;
  const auto mission = mission_in_old_sea(folder);
  const auto young = prepare(mission, "2026-03-02T11:00:00Z");  // 35 h
  CHECK(young.trouble.empty());
  CHECK(young.warnings.find("old at") == std::string::npos);
  const auto old = prepare(mission, "2026-03-02T13:00:00Z");  // 37 h
  CHECK(old.trouble.empty());
  CHECK(old.warnings.find("is 37.0 h old at 2026-03-02T13:00:00Z") != std::string::npos);
  CHECK(prepare(mission, "2026-03-03T23:00:00Z").trouble.empty());  // 71 h
  const auto expired = prepare(mission, "2026-03-04T01:00:00Z");
  CHECK(expired.trouble.find("is 73.0 h old at 2026-03-04T01:00:00Z; planned on are at most 72 h") !=
        std::string::npos);
}
