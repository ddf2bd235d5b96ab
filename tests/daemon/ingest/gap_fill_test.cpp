#include "daemon/ingest/gap_fill.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/ocean/gridded.hpp"
#include "tests/daemon/ingest/run.hpp"
#include "tests/support/data.hpp"
#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;

namespace {

/// A surface grid of 0.1° at 40°N (11.1 km by 8.5 km) whose dry nodes are said by row and column.
template <class Dry>
ocean::Grid surface(std::size_t rows, std::size_t columns, const Dry& dry) {
  return test::make_grid(
      {{0.0}, {0.0}, test::steps(40, 0.1, rows), test::steps(-70, 0.1, columns), true, false},
      [&](double lat, double lon, double, double) {
        const auto j = std::lround((lat - 40) * 10), i = std::lround((lon + 70) * 10);
        return dry(j, i) ? std::pair{test::kDry, test::kDry} : std::pair{0.1 * static_cast<double>(i), 0.2};
      });
}

}  // namespace

TEST_CASE("a hole is filled with the weighted mean around it, and marked") {
  auto grid = surface(5, 5, [](long j, long i) { return j == 2 && i == 2; });
  CHECK(fill_gaps(grid, 12'000) == 1);
  // By symmetry of east and west the mean of 0.1·i is that of the middle column.
  CHECK(grid.values[2 * 12] == Approx(0.2));
  CHECK(grid.values[2 * 12 + 1] == Approx(0.2));
  CHECK(grid.filled == std::vector<ocean::NodeRun>{{12, 1}});
}

TEST_CASE("water beyond the edge of the values is not filled, whatever the distance") {
  auto grid = surface(5, 8, [](long, long i) { return i >= 5; });
  CHECK(fill_gaps(grid, 50'000) == 0);
  CHECK(grid.filled.empty());
}

TEST_CASE("a gap wider than the distance stays open, and filled nodes do not fill others") {
  // Columns 2 to 5 are missing: from the middle of them the values lie 2 and 3 columns away, 17 km and 26 km.
  const auto gap = [] { return surface(5, 8, [](long, long i) { return i >= 2 && i <= 5; }); };
  auto narrow = gap();
  CHECK(fill_gaps(narrow, 18'000) == 0);
  auto wide = gap();
  CHECK(fill_gaps(wide, 27'000) == 10);  // columns 3 and 4; columns 2 and 5 lack a value within 27 km on one side
  CHECK(std::isnan(wide.values[2 * 2]));
  CHECK_FALSE(std::isnan(wide.values[2 * 3]));
}

TEST_CASE("every time is filled by itself") {
  auto grid = test::make_grid({{0.0, 3600.0}, {0.0}, test::steps(40, 0.1, 3), test::steps(-70, 0.1, 3), true, false},
                              [](double lat, double lon, double, double t) {
                                const bool middle = lat > 40.05 && lat < 40.15 && lon > -69.95 && lon < -69.85;
                                return middle && t > 0 ? std::pair{test::kDry, test::kDry} : std::pair{t / 3600, 0.0};
                              });
  CHECK(fill_gaps(grid, 12'000) == 1);
  CHECK(grid.filled == std::vector<ocean::NodeRun>{{13, 1}});
  CHECK(grid.values[2 * 13] == 1.0F);
}

TEST_CASE("two cells are the longer side twice") {
  const auto grid = surface(5, 5, [](long, long) { return false; });
  // A tenth of a degree of latitude at 40.2° is 11.10 km by the meridian radius 6 362 km·π/1800.
  CHECK(two_cells(grid.axes) == Approx(2 * 11'104).epsilon(1e-3));
}

TEST_CASE("a radar file is filled by default, another only when asked, and the mark arrives at the sample") {
  const test::ScratchFolder folder;
  const auto cdl = [](const std::string& more) {
    return "netcdf r { dimensions: time = 1 ; lat = 3 ; lon = 3 ; variables: double time(time) ; time:units = \"hours "
           "since "
           "2024-01-01\" ; float lat(lat) ; lat:units = \"degrees_north\" ; float lon(lon) ; lon:units = "
           "\"degrees_east\" ; "
           "float u(time, lat, lon) ; u:units = \"m/s\" ; float v(time, lat, lon) ; v:units = \"m/s\" ; " +
           more +
           " data: time = 0 ; lat = 40, 40.1, 40.2 ; lon = 5, 5.1, 5.2 ; u = 1, 1, 1, 1, _, 1, 1, 1, 1 ; "
           "v = 0, 0, 0, 0, _, 0, 0, 0, 0 ; }";
  };
  const auto radar =
      test::run_ingest(folder, test::make_netcdf(folder, "r.nc", cdl(":title = \"Totals of the HF Radar network\" ;")));
  REQUIRE(radar.view);
  CHECK(radar.view->filled == std::vector<ocean::NodeRun>{{4, 1}});
  CHECK(radar.view->facts.warnings ==
        std::vector<std::string>{"r.nc: 1 gaps are filled from values on both sides within 22.2 km"});
  const ocean::GriddedField field{*radar.view, {}};
  const double t = radar.view->axes.times_s.front();
  CHECK(field.sample(geo_point(40.1, 5.1), Depth{}, t)->extrapolated);
  CHECK(field.sample(geo_point(40.05, 5.05), Depth{}, t)->extrapolated);
  CHECK_FALSE(field.sample(geo_point(40.0, 5.05), Depth{}, t)->extrapolated);

  const auto off = test::run_ingest(folder, (folder / "r.nc") + " --fill-gaps 0");
  CHECK(off.view->filled.empty());
  const auto plain = test::make_netcdf(folder, "p.nc", cdl(""));
  CHECK(test::run_ingest(folder, plain).view->filled.empty());
  CHECK(test::run_ingest(folder, plain + " --fill-gaps 12").view->filled.size() == 1);
  CHECK(test::run_command(std::string{GLIDEHELM_INGEST} + " -o " + (folder / "g") + " --fill-gaps -1 " + plain, folder)
            .code == 2);
}

TEST_CASE("real data: what failed the radar's quality control is left out, and gaps of two cells are filled") {
  GLIDEHELM_NEEDS_DATA(data);
  const test::ScratchFolder folder;
  const auto file = data + "/currents/hfradar_midatlantic/hfr_rtv_midatl_6km_oi_maracoos_2022_02_21_1200.nc";
  const auto filled = test::run_ingest(folder, file), open = test::run_ingest(folder, "--fill-gaps 0 " + file);
  REQUIRE(filled.view);
  REQUIRE(open.view);
  // Counted with netCDF4 for Python: 5336 values, of which qc_primary_flag calls 2123 failed.
  CHECK(open.view->facts.warnings.front() ==
        "hfr_rtv_midatl_6km_oi_maracoos_2022_02_21_1200.nc: 2123 of 5336 values failed the producer's quality control "
        "(qc_primary_flag) and are left out");
  const std::size_t nodes = open.view->axes.nodes();
  std::size_t wet = 0, added = 0, changed = 0;
  for (std::size_t n = 0; n < nodes; ++n) {
    const float before = open.view->values[2 * n], after = filled.view->values[2 * n];
    wet += std::isnan(before) ? 0 : 1;
    added += std::isnan(before) && !std::isnan(after) ? 1 : 0;
    changed += !std::isnan(before) && before != after ? 1 : 0;
  }
  CHECK(wet == 5336 - 2123);
  CHECK(changed == 0);
  std::size_t marked = 0;
  for (const auto& run : filled.view->filled) marked += run.length;
  CHECK(marked == added);
  CHECK(added > 0);
  WARN("filled " << added << " nodes beside " << wet << " measured ones");
}
