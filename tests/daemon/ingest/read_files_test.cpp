#include "daemon/ingest/read_files.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/daemon/ingest/model_file.hpp"
#include "tests/daemon/ingest/run.hpp"

// Sets of files, read by the built program.

using namespace glidehelm;
using test::run_ingest;

namespace {

const std::size_t kRows = 7, kColumns = 8;

/// The mesh of NEMO: u half a cell behind its centre along the rows, v along the columns, all of one shape.
test::Turned nemo_mesh() {
  test::Turned mesh;
  mesh.rows = kRows;
  mesh.columns = kColumns;
  return mesh;
}

/// One of NEMO's two files, with positions of its own, at an hour of the day.
std::string half_cdl(bool u, int hour, double east, double north) {
  const auto mesh = nemo_mesh();
  const double dj = u ? 0 : 0.5, di = u ? 0.5 : 0;
  const std::string name = u ? "vozocrtx" : "vomecrty";
  const auto lat = test::over(kRows, kColumns, dj, di, [&](double j, double i) { return mesh.lat(j, i); });
  const auto lon = test::over(kRows, kColumns, dj, di, [&](double j, double i) { return mesh.lon(j, i); });
  const auto along = test::over(kRows, kColumns, dj, di, [&](double j, double i) {
    const double c = std::cos(mesh.theta(j, i)), s = std::sin(mesh.theta(j, i));
    return u ? east * c + north * s : -east * s + north * c;
  });
  const std::string depth = u ? "depthu" : "depthv";
  return "netcdf n {\ndimensions: time_counter = 1 ; " + depth +
         " = 1 ; y = 7 ; x = 8 ;\nvariables:\n double "
         "time_counter(time_counter) ; time_counter:units = \"hours since 2024-01-01\" ; float " +
         depth + "(" + depth + ") ; " + depth + ":units = \"m\" ; " + depth +
         ":positive = \"down\" ; double nav_lat(y, x) ; double nav_lon(y, x) ; float " + name + "(time_counter, " +
         depth + ", y, x) ; " + name + ":units = \"m/s\" ;\ndata:\n time_counter = " + std::to_string(hour) + " ; " +
         depth + " = 5 ;\n" + test::cdl_data("nav_lat", lat) + test::cdl_data("nav_lon", lon) +
         test::cdl_data(name, along) + "}\n";
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A ROMS file without positions, and the grid that it lies on.
std::string currents_cdl() {
  auto file = nemo_mesh().file([](double, double) { return 0.3; }, [](double, double) { return -0.4; });
  file.lat = file.lon = file.angle = nullptr;
  return file.cdl();
}
std::string grid_cdl() {
  const auto mesh = nemo_mesh();
  const auto plane = [&](const test::ByIndex& f) { return test::over(kRows, kColumns, 0, 0, f); };
  return "netcdf g {\ndimensions: eta = 7 ; xi = 8 ;\nvariables: double lat_rho(eta, xi) ; double lon_rho(eta, xi) ; "
         "double "
         "angle(eta, xi) ; angle:units = \"radians\" ; double mask_rho(eta, xi) ;\ndata:\n" +
         test::cdl_data("lat_rho", plane([&](double j, double i) { return mesh.lat(j, i); })) +
         test::cdl_data("lon_rho", plane([&](double j, double i) { return mesh.lon(j, i); })) +
         test::cdl_data("angle", plane([&](double j, double i) { return mesh.theta(j, i); })) +
         test::cdl_data("mask_rho", plane([](double, double) { return 1.0; })) + "}\n";
}

double worst_of(const test::Ingested& result, std::size_t time, double east, double north) {
  const auto& axes = result.view->axes;
  double worst = 0;
  std::size_t nodes = 0;
  for (std::size_t j = 0; j < axes.lats_deg.size(); ++j)
    for (std::size_t i = 0; i < axes.lons_deg.size(); ++i) {
      const double e = result.at(time, 0, j, i, 0), n = result.at(time, 0, j, i, 1);
      if (std::isnan(e)) continue;
      ++nodes;
      worst = std::max(worst, std::hypot(e - east, n - north));
    }
  CHECK(nodes > 20);
  return worst;
}

/// As kBrim of model_part_test.cpp: half a cell of change of the angle where a centre has one face only.
constexpr double kBrim = 1.5e-4;

}  // namespace

TEST_CASE("NEMO's u and v in two files are paired by their times, and turned by their positions") {
  const test::ScratchFolder folder;
  const auto u0 = test::make_netcdf(folder, "a_grid_U.nc", half_cdl(true, 0, 0.3, -0.4));
  const auto u6 = test::make_netcdf(folder, "b_grid_U.nc", half_cdl(true, 6, 0.1, 0.2));
  const auto v6 = test::make_netcdf(folder, "a_grid_V.nc", half_cdl(false, 6, 0.1, 0.2));
  const auto v0 = test::make_netcdf(folder, "b_grid_V.nc", half_cdl(false, 0, 0.3, -0.4));
  const auto result = run_ingest(folder, u0 + " " + u6 + " " + v6 + " " + v0);
  INFO(result.ran.err);
  REQUIRE(result.view);
  CHECK(result.view->axes.times_s.size() == 2);
  CHECK(result.view->axes.depths_m == std::vector<double>{5});
  CHECK(worst_of(result, 0, 0.3, -0.4) < kBrim);
  CHECK(worst_of(result, 1, 0.1, 0.2) < kBrim);
  const auto& facts = result.view->facts;
  CHECK(says(facts.layout,
             "curvilinear Arakawa C grid of 7 by 8 points (half a cell beside nav_lat, nav_lon), u and v on "
             "the faces behind their centres"));
  CHECK(facts.sources.size() == 4);

  const auto lone = run_ingest(folder, u0 + " " + v6);
  CHECK(lone.ran.code == 1);
  CHECK(says(lone.ran.err,
             "a_grid_U.nc: it has one component of the velocity only, and no file with the other one at the "
             "same times was given"));
  const auto single = run_ingest(folder, u0);
  CHECK(single.ran.code == 5);  // by itself: the other file may come
  CHECK(says(single.ran.err, "along an axis of a model's own grid; give the file of the other component beside it"));
}

TEST_CASE("a grid file serves wherever it stands in the list, or by its option, and is named among the sources once") {
  const test::ScratchFolder folder;
  const auto a = test::make_netcdf(folder, "a.nc", currents_cdl());
  auto later = currents_cdl();
  later.replace(later.find("ocean_time = 0 ;"), 16, "ocean_time = 9 ;");
  const auto b = test::make_netcdf(folder, "b.nc", later);
  const auto grid = test::make_netcdf(folder, "grid.nc", grid_cdl());
  std::string first;
  for (const auto& arguments :
       {a + " " + b + " " + grid, grid + " " + a + " " + b, a + " " + b + " --grid-file " + grid}) {
    const auto result = run_ingest(folder, arguments);
    INFO(arguments << result.ran.err);
    REQUIRE(result.view);
    CHECK(result.view->axes.times_s.size() == 2);
    CHECK(worst_of(result, 1, 0.3, -0.4) < kBrim);
    CHECK(says(result.view->facts.layout, "turned by angle"));
    // As the arguments stand, so that a set is known by its contents; the numbers are the same.
    std::string names;
    for (const auto& source : result.view->facts.sources) names += " " + source.name;
    CHECK(arguments.find(names.substr(1, names.find(' ', 1) - 1)) == 0);
    CHECK(result.view->facts.sources.size() == 3);
    const auto numbers = result.bytes.substr(result.bytes.size() - 8 * result.view->axes.nodes());
    if (first.empty()) first = numbers;
    CHECK((numbers == first));
  }
  const auto without = run_ingest(folder, a);
  CHECK(without.ran.code == 5);
  CHECK(says(without.ran.err, "name the model's grid file among the files or with --grid-file"));
}

TEST_CASE("sets without currents, and grid files that are none, are refused by name") {
  const test::ScratchFolder folder;
  const auto a = test::make_netcdf(folder, "a.nc", currents_cdl());
  const auto grid = test::make_netcdf(folder, "grid.nc", grid_cdl()),
             other = test::make_netcdf(folder, "other.nc", grid_cdl());
  const auto grids = run_ingest(folder, grid + " " + other);
  CHECK(grids.ran.code == 1);
  CHECK(says(grids.ran.err, "grid.nc: it describes a grid, and no file has currents"));
  const auto wrong = run_ingest(folder, a + " --grid-file " + a);
  CHECK(wrong.ran.code == 1);
  CHECK(says(wrong.ran.err, "a.nc: it is given as a grid file, but it does not describe a grid"));
  const auto broken = run_ingest(folder, a + " --grid-file " + (folder / "nothing.nc"));
  CHECK(broken.ran.code != 0);
  CHECK(says(broken.ran.err, "nothing.nc"));
  CHECK(run_ingest(folder, a + " --rotation left").ran.code == 2);
  CHECK(run_ingest(folder, a + " --s-levels vtransform=9").ran.code == 2);
}
