#include <catch2/catch.hpp>
#include <cmath>

#include "tests/daemon/ingest/run.hpp"

using namespace glidehelm;
using test::run_ingest;

namespace {

std::string one_sided(const std::string& name, const std::string& standard, const std::string& hours,
                      const std::string& values) {
  return "netcdf f { dimensions: time = 2 ; lat = 2 ; lon = 2 ; variables: double time(time) ; time:units = \"hours "
         "since "
         "2024-01-01\" ; float lat(lat) ; lat:units = \"degrees_north\" ; float lon(lon) ; lon:units = "
         "\"degrees_east\" ; "
         "float " +
         name + "(time, lat, lon) ; " + name + ":units = \"m/s\" ; " +
         (standard.empty() ? "" : name + ":standard_name = \"" + standard + "\" ; ") + "data: time = " + hours +
         " ; lat = 40, 41 ; lon = 5, 6 ; " + name + " = " + values + " ; }";
}

}  // namespace

TEST_CASE("u in one file and v in another become one field, whatever their order") {
  const test::ScratchFolder folder;
  const auto u1 = test::make_netcdf(folder, "u1.nc",
                                    one_sided("uo", "eastward_sea_water_velocity", "0, 6", ".1,.2,.3,.4,.5,.6,.7,.8"));
  const auto v1 = test::make_netcdf(folder, "v1.nc", one_sided("vo", "", "0, 6", "-.1,-.2,-.3,-.4,-.5,-.6,-.7,_"));
  const auto u2 =
      test::make_netcdf(folder, "u2.nc", one_sided("uo", "eastward_sea_water_velocity", "12, 18", "1,1,1,1,1,1,1,1"));
  const auto v2 = test::make_netcdf(folder, "v2.nc", one_sided("vo", "", "12, 18", "2,2,2,2,2,2,2,2"));
  for (const auto& order : {u1 + " " + v1 + " " + u2 + " " + v2, v1 + " " + v2 + " " + u2 + " " + u1}) {
    const auto result = run_ingest(folder, order);
    INFO(result.ran.err);
    REQUIRE(result.view);
    CHECK(result.view->axes.times_s.size() == 4);
    CHECK(result.at(0, 0, 0, 1, 0) == 0.2F);
    CHECK(result.at(0, 0, 0, 1, 1) == -0.2F);
    CHECK(std::isnan(result.at(1, 0, 1, 1, 0)));  // v is missing there
    CHECK(result.at(2, 0, 0, 0, 0) == 1.0F);
    CHECK(result.at(3, 0, 0, 0, 1) == 2.0F);
    CHECK(result.view->facts.east_variable == "uo");
    CHECK(result.view->facts.north_variable == "vo");
    CHECK(result.view->facts.sources.size() == 4);
  }
}

TEST_CASE("half a current without its other half is refused, and so are halves of different times") {
  const test::ScratchFolder folder;
  const auto u = test::make_netcdf(folder, "u.nc", one_sided("uo", "", "0, 6", "1,1,1,1,1,1,1,1"));
  CHECK(run_ingest(folder, u).ran.err ==
        "glidehelm-ingest: " + u +
            ": it has the eastward velocity only, and no file with the northward one of the same times and nodes was "
            "given\n");
  const auto v = test::make_netcdf(folder, "v.nc", one_sided("vo", "", "0, 7", "1,1,1,1,1,1,1,1"));
  CHECK(run_ingest(folder, v + " " + u).ran.err.find("v.nc: it has the northward velocity only") != std::string::npos);
  // Together they are judged like any field.
  const auto fast = test::make_netcdf(folder, "w.nc", one_sided("vo", "", "0, 6", "1,1,1,6,1,1,1,1"));
  CHECK(run_ingest(folder, u + " " + fast).ran.err.find("u.nc with w.nc: a current of 6.08 m/s at 41.0000, 6.0000") !=
        std::string::npos);
}
