#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <sstream>
#include <string>

#include "daemon/world/real.hpp"
#include "tests/support/netcdf.hpp"

/// Running the verbs `field …` in process, with the real adapters and the real child.
namespace glidehelm::test {

inline constexpr double kDryNode = std::numeric_limits<double>::quiet_NaN();

/// The built child is found through PATH, as an installed one would be.
inline world::World field_world() {
  static world::RealWorld real;
  static const bool once = [] {
    const std::string program = GLIDEHELM_INGEST;
    const char* path = std::getenv("PATH");
    return setenv("PATH", (program.substr(0, program.rfind('/')) + ":" + (path != nullptr ? path : "")).c_str(), 1) ==
           0;
  }();
  REQUIRE(once);
  return real.world();
}

template <class Options, class Run>
Ran run_verb(Run run, const Options& options) {
  auto world = field_world();
  std::ostringstream out, err;
  const int code = run(options, world, out, err);
  return {code, out.str(), err.str()};
}

/// A sea on uneven axes as a NetCDF file: u and v by formulas of (time index, depth index, row, column), NaN = dry.
struct SeaFile {
  std::string times{"0, 1, 3"}, depths{"0.5, 10, 50"}, lats{"30, 30.5, 31.25, 32"}, lons{"-20, -19.5, -19, -18"};
  std::function<double(int, int, int, int)> u, v;
};
inline std::string make_sea(const ScratchFolder& folder, const std::string& name, const SeaFile& sea) {
  const auto count = [](const std::string& list) { return 1 + std::count(list.begin(), list.end(), ','); };
  const auto numbers = [&](const auto& f) {
    std::string text;
    for (int t = 0; t < count(sea.times); ++t)
      for (int z = 0; z < count(sea.depths); ++z)
        for (int j = 0; j < count(sea.lats); ++j)
          for (int i = 0; i < count(sea.lons); ++i) {
            const double value = f(t, z, j, i);
            char buffer[40];
            std::snprintf(buffer, sizeof buffer, "%.9g", value);
            text += (text.empty() ? "" : ", ") + (value == value ? std::string{buffer} : std::string{"_"});
          }
    return text;
  };
  return make_netcdf(folder, name,
                     "netcdf sea {\ndimensions: time = " + std::to_string(count(sea.times)) +
                         " ; depth = " + std::to_string(count(sea.depths)) +
                         " ; lat = " + std::to_string(count(sea.lats)) + " ; lon = " + std::to_string(count(sea.lons)) +
                         R"( ;
variables:
  double time(time) ; time:units = "hours since 2024-05-01" ; float depth(depth) ; depth:units = "m" ; depth:positive = "down" ;
  float lat(lat) ; lat:units = "degrees_north" ; float lon(lon) ; lon:units = "degrees_east" ;
  float uo(time, depth, lat, lon) ; uo:units = "m s-1" ; uo:standard_name = "eastward_sea_water_velocity" ; uo:_FillValue = -99.f ;
  float vo(time, depth, lat, lon) ; vo:units = "m s-1" ; vo:standard_name = "northward_sea_water_velocity" ; vo:_FillValue = -99.f ;
data:
  time = )" + sea.times +
                         " ; depth = " + sea.depths + " ; lat = " + sea.lats + " ; lon = " + sea.lons +
                         " ;\n  uo = " + numbers(sea.u) + " ;\n  vo = " + numbers(sea.v) + " ;\n}");
}

}  // namespace glidehelm::test
