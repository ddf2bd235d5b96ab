#include "daemon/ingest/part.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "core/base/utc.hpp"
#include "core/ocean/gridded.hpp"
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
      {"roms_us_east_sandy/coawst_clm_20121028.nc", "curvilinear grid: lat_rho(erho, xrho)"},
      {"roms_us_east_sandy/Sandy_roms_grid.nc", "curvilinear grid: lat_rho(eta_rho, xi_rho)"},
      {"roms_wcofs_oregon/WCOFS_subset.nc", "curvilinear grid: lat_psi(eta_psi, xi_psi)"},
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
    CHECK(result.ran.code == 1);
    CHECK(result.ran.err.find("glidehelm-ingest: " + path + ": " + reason) == 0);
  }
}

namespace {

/// Reads a file with netCDF4 for Python and interpolates linearly with its own arithmetic at random points whose corners
/// all have values. Prints one point a line: latitude, longitude, epoch second, depth, east, north, largest difference of
/// the corners.
const char* kIndependent = R"(
import sys, random, datetime, netCDF4, numpy as np
path, east, north, seed = sys.argv[1:5]
d = netCDF4.Dataset(path)
u, v = d[east], d[north]
axis = {}
for name in u.dimensions:
    c = d[name]
    low = name.lower()
    kind = 't' if 'time' in low else 'y' if 'lat' in low else 'x' if 'lon' in low else 'z'
    values = np.array(c[:], dtype=float)
    if kind == 't':
        epoch = datetime.datetime(1970, 1, 1)
        values = np.array([(netCDF4.num2date(x, c.units, only_use_cftime_datetimes=False,
                            only_use_python_datetimes=True) - epoch).total_seconds() for x in c[:].tolist()])
    axis[kind] = values
order = ''.join({'t': 't', 'y': 'y', 'x': 'x', 'z': 'z'}[k] for k in axis)
U, V = np.ma.filled(u[:].astype(float), np.nan), np.ma.filled(v[:].astype(float), np.nan)
r = random.Random(int(seed))
done = 0
while done < 1000:
    place, cells = {}, []
    for k in order:
        a = axis[k]
        if len(a) == 1:
            place[k] = a[0]; cells.append((0, 0, 0.0)); continue
        i = r.randrange(len(a) - 1); f = r.random()
        place[k] = a[i] + f * (a[i + 1] - a[i]); cells.append((i, i + 1, f))
    su = sv = 0.0; us = []; vs = []
    for corner in range(1 << len(order)):
        index, weight = [], 1.0
        for n, (i, j, f) in enumerate(cells):
            bit = corner >> n & 1
            index.append(j if bit else i); weight *= f if bit else 1 - f
        us.append(U[tuple(index)]); vs.append(V[tuple(index)])
        su += weight * us[-1] if weight else 0; sv += weight * vs[-1] if weight else 0
    if not np.isfinite(us).all() or not np.isfinite(vs).all(): continue
    spread = max(max(us) - min(us), max(vs) - min(vs))
    print('%.12f %.12f %.6f %.9f %.12g %.12g %.6g' % (place['y'], (place['x'] + 180) % 360 - 180, place.get('t', 0),
          place.get('z', 0), su, sv, spread))
    done += 1
)";

}  // namespace

TEST_CASE("real data: a thousand random points of four files agree with an independent reading") {
  GLIDEHELM_NEEDS_DATA(data);
  const test::ScratchFolder folder;
  test::write_bytes(folder / "read.py", kIndependent);
  const std::tuple<const char*, const char*, const char*> files[] = {
      {"rtofs_washington/wa_RTOFS_global.nc", "water_u", "water_v"},
      {"duacs/derived_geostrophic_west_med_2005T2.nc", "ugos", "vgos"},
      {"cmems_glo12_ionian_3d/currents.nc", "uo", "vo"},
      {"tides/derived_hourly_tidal_current_forth.nc", "uo", "vo"}};
  for (const auto& [file, east, north] : files) {
    INFO(file);
    const auto path = data + "/currents/" + file;
    const auto result = run_ingest(folder, path);
    REQUIRE(result.view);
    const ocean::GriddedField field{*result.view, {}};
    const auto read = test::run_command(
        "/usr/bin/python3 " + (folder / "read.py") + " " + path + " " + east + " " + north + " 4", folder);
    INFO(read.err);
    REQUIRE(read.code == 0);
    std::istringstream lines{read.out};
    double lat, lon, time, depth, u, v, spread;
    int points = 0;
    while (lines >> lat >> lon >> time >> depth >> u >> v >> spread) {
      const auto sample = field.sample(geo_point(lat, lon), Depth{Metres{depth}}, time);
      REQUIRE(sample);
      // Values are floats (2^-24 of at most 2 m/s = 1.2e-7, a few operations: 1e-6), and an axis stored as floats counts
      // as straight to 2e-4 of a cell (grid_axis.hpp), in each of two directions.
      const double tolerance = 1e-6 + 4e-4 * spread;
      CHECK(std::abs(sample->current.east.si() - u) <= tolerance);
      CHECK(std::abs(sample->current.north.si() - v) <= tolerance);
      CHECK_FALSE(sample->extrapolated);
      ++points;
    }
    CHECK(points == 1000);
  }
}
