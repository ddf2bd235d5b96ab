#include "daemon/ingest/part.hpp"

#include <catch2/catch.hpp>

#include "core/base/utc.hpp"
#include "tests/daemon/ingest/run.hpp"
#include "tests/support/data.hpp"

// Reading one file: rules on small files stand in glidehelm_ingest_test.cpp; here are the real samples.

using namespace glidehelm;
using test::run_ingest;

namespace {

struct Expect {
  const char *files, *first, *last;
  std::size_t times, depths, lats, lons;
  const char* why;
};

/// Every rectilinear sample, with what its header in data/currents/headers and its description say.
const Expect kReadable[] = {
    {"rtofs_washington/wa_RTOFS_global.nc", "2024-10-28T03:00:00Z", "2024-11-05T00:00:00Z", 64, 1, 38, 34,
     "name water_u"},
    {"hycom_washington/gridded_current.nc", "2023-03-02T12:00:00Z", "2023-03-04T12:00:00Z", 17, 1, 52, 26,
     "standard_name eastward_sea_water_velocity"},
    {"duacs/derived_geostrophic_west_med_2005T2.nc", "2005-04-01T00:00:00Z", "2005-06-30T00:00:00Z", 91, 1, 78, 98,
     "standard_name surface_geostrophic_eastward_sea_water_velocity"},
    {"duacs/nrt_global_allsat_phy_l4_20190223_20190226.nc", "2019-02-23T00:00:00Z", "2019-02-23T00:00:00Z", 1, 1, 720,
     1440, "standard_name surface_geostrophic_eastward_sea_water_velocity"},
    {"glorys_packed/GLORYS_NA_2012.nc", "2012-01-01T12:00:00Z", "2012-12-31T12:00:00Z", 2, 5, 12, 18,
     "standard_name eastward_sea_water_velocity"},
    {"globcurrent_agulhas/*.nc", "2002-01-01T00:00:00Z", "2002-01-30T00:00:00Z", 30, 1, 41, 81,
     "name eastward_eulerian_current_velocity"},
    {"cmems_glo12_ionian_3d/currents.nc", "2024-11-20T12:00:00Z", "2024-11-20T12:00:00Z", 1, 50, 50, 82,
     "standard_name eastward_sea_water_velocity"},
    {"tides/derived_hourly_tidal_current_forth.nc", "2025-03-20T00:00:00Z", "2025-03-24T00:00:00Z", 97, 1, 30, 60,
     "standard_name eastward_sea_water_velocity"},
    {"hfradar_midatlantic/hfr_rtv_midatl_6km_oi_maracoos_2022_02_21_1200.nc", "2022-02-21T12:00:00Z",
     "2022-02-21T12:00:00Z", 1, 1, 187, 196, "standard_name surface_eastward_sea_water_velocity"}};

}  // namespace

TEST_CASE("real data: every rectilinear sample is read, with the extent that its header names") {
  GLIDEHELM_NEEDS_DATA(data);
  const test::ScratchFolder folder;
  for (const auto& expected : kReadable) {
    INFO(expected.files);
    const auto result = run_ingest(folder, data + "/currents/" + expected.files);
    INFO(result.ran.err);
    REQUIRE(result.view);
    const auto& axes = result.view->axes;
    CHECK(utc_text(instant_at(axes.times_s.front())) == expected.first);
    CHECK(utc_text(instant_at(axes.times_s.back())) == expected.last);
    CHECK(axes.times_s.size() == expected.times);
    CHECK(axes.depths_m.size() == expected.depths);
    CHECK(axes.lats_deg.size() == expected.lats);
    CHECK(axes.lons_deg.size() == expected.lons);
    CHECK(result.view->facts.recognised_by == expected.why);
    CHECK(ocean::statistics_of(*result.view).wet_fraction > 0.05);
  }
}

TEST_CASE("real data: every other sample is refused for its reason") {
  GLIDEHELM_NEEDS_DATA(data);
  const test::ScratchFolder folder;
  const std::pair<const char*, const char*> refused[] = {
      {"roms_us_east_sandy/coawst_clm_20121028.nc", "axis v3d_time has the unit \"days\" without an epoch"},
      {"roms_us_east_sandy/Sandy_roms_grid.nc", "it describes a model's grid (lat_rho, lon_rho) and has no current"},
      {"tides/tide_forc_Sandy.nc",
       "tidal constituents: tide_Cmax(tide_period, erho, xrho) describes the tide by its constituents, not the "
       "current"},
      {"tides/tidepredictor_currents.nc",
       "tidal constituents: major_axis(cons, lon, lat) describes the tide by its constituents, not the current"},
      {"unstructured/test_creofs_selfe.nc", "unstructured grid: lat(node) and lon(node)"},
      {"tides/ACT1951_1_Annual_2021.csv", "not a NetCDF file"},
      {"json/water-gbr.json", "not a NetCDF file"}};
  for (const auto& [file, reason] : refused) {
    const auto path = data + "/currents/" + file;
    const auto result = run_ingest(folder, path);
    INFO(result.ran.err);
    CHECK(result.ran.code == (std::string{file}.find("_grid.nc") != std::string::npos ? 5 : 1));  // 5: by itself
    CHECK(result.ran.err.find("glidehelm-ingest: " + path + ": " + reason) == 0);
  }
}
