#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/cli/field_info.hpp"
#include "daemon/cli/field_sample.hpp"
#include "daemon/world/real.hpp"
#include "tests/support/data.hpp"
#include "tests/support/netcdf.hpp"

// Numbers: what `glidehelm field sample` says against an independent reading of the same files (NetCDF through Python).

using namespace glidehelm;
using namespace glidehelm::cli;
using nlohmann::json;

namespace {

struct Sampled {
  const char *pattern, *east, *north;
};

/// Every rectilinear sample; of the thirty daily files two by themselves, and all joined.
const Sampled kSampled[] = {
    {"rtofs_washington/wa_RTOFS_global.nc", "water_u", "water_v"},
    {"hycom_washington/gridded_current.nc", "water_u", "water_v"},
    {"cmems_glo12_ionian_3d/currents.nc", "uo", "vo"},
    {"glorys_packed/GLORYS_NA_2012.nc", "uo", "vo"},
    {"globcurrent_agulhas/20020101*.nc", "eastward_eulerian_current_velocity", "northward_eulerian_current_velocity"},
    {"globcurrent_agulhas/20020120*.nc", "eastward_eulerian_current_velocity", "northward_eulerian_current_velocity"},
    {"globcurrent_agulhas/*.nc", "eastward_eulerian_current_velocity", "northward_eulerian_current_velocity"},
    {"duacs/nrt_global_allsat_phy_l4_20190223_20190226.nc", "ugos", "vgos"},
    {"duacs/derived_geostrophic_west_med_2005T2.nc", "ugos", "vgos"},
    {"hfradar_midatlantic/hfr_rtv_midatl_6km_oi_maracoos_2022_02_21_1200.nc", "u", "v"},
    {"tides/derived_hourly_tidal_current_forth.nc", "uo", "vo"}};

/// `glidehelm field sample` at the points of a CSV.
json samples(const std::string& pattern, const std::string& points) {
  static world::RealWorld real;
  const std::string program = GLIDEHELM_INGEST;
  const char* path = std::getenv("PATH");
  REQUIRE(setenv("PATH", (program.substr(0, program.rfind('/')) + ":" + (path != nullptr ? path : "")).c_str(), 1) ==
          0);
  auto world = real.world();
  FieldSampleOptions options;
  options.files = {pattern};
  options.points = points;
  options.json = true;
  std::ostringstream out, err;
  const int code = run_field_sample(options, world, out, err);
  INFO(err.str());
  REQUIRE(code == 0);
  return json::parse(out.str())["samples"];
}

}  // namespace

TEST_CASE("real data: a thousand random points of eleven readings agree with an independent reading") {
  GLIDEHELM_NEEDS_DATA(data);
  const test::ScratchFolder folder;
  for (const auto& file : kSampled) {
    INFO(file.pattern);
    const auto pattern = data + "/currents/" + file.pattern, points = folder / "points.csv";
    const auto read = test::run_command("/usr/bin/python3 " GLIDEHELM_SOURCE "/tests/support/independent_reading.py " +
                                            points + " 4 " + file.east + " " + file.north + " " + pattern,
                                        folder);
    INFO(read.err);
    REQUIRE(read.code == 0);
    const auto answers = samples(pattern, points);
    REQUIRE(answers.size() == 1000);
    std::istringstream lines{read.out};
    double worst = 0, east, north, spread;
    for (const auto& answer : answers) {
      REQUIRE(lines >> east >> north >> spread);
      // Values are floats: 2^-24 of at most 5 m/s is 3e-7, and so is a product of a value and a weight that are both
      // rounded; three such steps in space and time stay below 2e-6. An axis that is stored as floats counts as straight
      // up to 2e-4 of a cell (grid_axis.hpp), in each of two directions: that share of the corners' difference.
      const double tolerance = 2e-6 + 4e-4 * spread;
      const double off = std::max(std::abs(answer["east_m_per_s"].get<double>() - east),
                                  std::abs(answer["north_m_per_s"].get<double>() - north));
      CHECK(off <= tolerance);
      CHECK(answer["extrapolated"] == false);
      worst = std::max(worst, off);
    }
    WARN(file.pattern << ": 1000 points, largest difference " << worst << " m/s");
  }
}
