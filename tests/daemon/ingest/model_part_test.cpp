#include "daemon/ingest/model_part.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "core/ocean/gridded.hpp"
#include "tests/daemon/ingest/model_file.hpp"
#include "tests/daemon/ingest/run.hpp"
#include "tests/support/data.hpp"

// Models on their own grids, read by the built program from files that ncgen makes here.

using namespace glidehelm;
using test::run_ingest;
using test::Turned;

namespace {

test::Ingested read(const test::RomsFile& file, const std::string& more = "") {
  const test::ScratchFolder folder;
  return run_ingest(folder, test::make_netcdf(folder, "m.nc", file.cdl(), "netCDF-4") + " " + more);
}

std::string refusal(const test::RomsFile& file, const std::string& more = "") {
  const auto result = read(file, more);
  // 1: refused; 5: by itself, while a file beside it might help.
  CHECK((result.ran.code == 1 || result.ran.code == 5));
  const auto colon = result.ran.err.find("m.nc: ");
  return colon == std::string::npos ? result.ran.err : result.ran.err.substr(colon + 6);
}

test::ByIndex constant(double value) {
  return [value](double, double) { return value; };
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The mean absolute error of a grid's nodes against a flow in latitude and longitude.
struct Errors {
  double worst{}, sum{};
  std::size_t nodes{};
  [[nodiscard]] double mean() const { return sum / static_cast<double>(nodes); }
};
template <class Flow>
Errors errors_of(const ocean::GridView& view, Flow flow) {
  Errors errors;
  const auto& axes = view.axes;
  for (std::size_t j = 0; j < axes.lats_deg.size(); ++j)
    for (std::size_t i = 0; i < axes.lons_deg.size(); ++i) {
      const float* node = view.values + 2 * (j * axes.lons_deg.size() + i);
      if (std::isnan(node[0])) continue;
      const auto [east, north] = flow(axes.lats_deg[j], axes.lons_deg[i]);
      const double off = std::hypot(static_cast<double>(node[0]) - east, static_cast<double>(node[1]) - north);
      errors.worst = std::max(errors.worst, off);
      errors.sum += off;
      ++errors.nodes;
    }
  return errors;
}

/// What averaging leaves of a uniform flow on the mesh of `Turned`. Its angle changes with latitude by
/// sin θ cos θ tan φ Δφ = 0.32·Δφ; a centre at the edge has one face only, half a cell (0.05°) beside it: 0.5 m/s times
/// 0.32·8.7e-4 = 1.4e-4. Inside, the second order of it is left, below 1e-6; the computed angle is as exact.
constexpr double kEdge = 1.5e-4;

}  // namespace

TEST_CASE(
    "a uniform flow on a turned C grid comes out as the same flow everywhere, whatever the angle's unit and sense") {
  Turned mesh;
  struct Case {
    double scale;
    const char* unit;
    bool given;
  };
  for (const auto& c :
       {Case{1, "radians", true}, Case{1 / kDegree, "degrees", true}, Case{-1, "radians", true}, Case{0, "", false}}) {
    auto file = mesh.file(constant(0.3), constant(-0.4));
    file.angle_unit = c.unit;
    if (c.given)
      file.angle = [mesh, c](double j, double i) { return c.scale * mesh.theta(j, i); };
    else
      file.angle = nullptr;
    const auto result = read(file);
    INFO(c.unit << " " << c.scale << result.ran.err);
    REQUIRE(result.view);
    const auto errors = errors_of(*result.view, [](double, double) { return std::pair{0.3, -0.4}; });
    CHECK(errors.nodes > 20);
    CHECK(errors.worst < kEdge);
    const auto& layout = result.view->facts.layout;
    CHECK(contains(layout, "curvilinear Arakawa C grid of 6 by 7 points (lat_rho, lon_rho)"));
    CHECK(contains(layout, c.given ? "turned by angle (" : "turned by the direction of the grid's rows"));
    CHECK(contains(result.ran.err, "clockwise from east to the rows; read so") == (c.scale < 0));
  }
}

TEST_CASE("an analytic flow on a turned, stretched, staggered mesh comes through to second order") {
  // Halving the step of mesh and target divides the error of averaging and of both interpolations by four; one part in four
  // is left for what lies at the edges, where u and v have one face only and errors are of first order.
  const auto flow = [](double lat, double lon) {
    const double x = (lon + 30) * 2.0, y = (lat - 40) * 2.5;
    return std::pair{0.5 * std::cos(x) * std::sin(y), -0.4 * std::sin(x + 0.3) * std::cos(y)};
  };
  double before = 0;
  for (const int fine : {1, 2}) {
    Turned mesh;
    mesh.rows = 20 * fine + 1;
    mesh.columns = 24 * fine + 1;
    mesh.step_deg = 0.1 / fine;
    // Stretched: the index is pulled by a quarter of a sine, so that cells grow from 0.75 to 1.25 of the mean.
    const auto pull = [](double index, double length) {
      return index + 0.25 * length / (2 * kPi) * std::sin(2 * kPi * index / length);
    };
    const double rows = mesh.rows - 1, columns = mesh.columns - 1;
    auto file = mesh.file(nullptr, nullptr);
    const auto lat = [=](double j, double i) { return mesh.lat(pull(j, rows), pull(i, columns)); };
    const auto lon = [=](double j, double i) { return mesh.lon(pull(j, rows), pull(i, columns)); };
    const auto theta = [=](double j, double i) { return mesh.theta(pull(j, rows), pull(i, columns)); };
    file.lat = lat;
    file.lon = lon;
    file.angle = theta;
    file.u = [=](std::size_t, double j, double i) {
      const auto [e, n] = flow(lat(j, i), lon(j, i));
      return e * std::cos(theta(j, i)) + n * std::sin(theta(j, i));
    };
    file.v = [=](std::size_t, double j, double i) {
      const auto [e, n] = flow(lat(j, i), lon(j, i));
      return -e * std::sin(theta(j, i)) + n * std::cos(theta(j, i));
    };
    const auto result = read(file);
    INFO(result.ran.err);
    REQUIRE(result.view);
    // The inner half of the mesh: its edges have one face.
    const auto errors = errors_of(*result.view, flow);
    CHECK(errors.nodes > 250);
    if (fine == 1) {
      before = errors.mean();
      // (0.1°)²·(2.5² + 2²)·0.5/8 per interpolation or average, three of them: 0.02 m/s is a safe bound.
      CHECK(errors.mean() < 0.02);
      CHECK(errors.mean() > 1e-5);
    } else {
      CHECK(errors.mean() < before / 3);
    }
  }
}

TEST_CASE("numbers on land never reach the water") {
  Turned mesh;
  mesh.rows = 9;
  mesh.columns = 9;
  auto file = mesh.file(constant(0.2), constant(0.1));
  const auto east = file.u, north = file.v;
  const auto dry = [](double i) { return i >= 6; };
  file.mask = [=](double, double i) { return dry(i) ? 0.0 : 1.0; };
  // Land faces hold 3 m/s: a face is land when one of its two centres is.
  file.u = [=](std::size_t k, double j, double i) { return dry(i + 0.5) ? 3.0 : east(k, j, i); };
  file.v = [=](std::size_t k, double j, double i) { return dry(i) ? 3.0 : north(k, j, i); };
  const auto result = read(file);
  REQUIRE(result.view);
  const auto errors = errors_of(*result.view, [](double, double) { return std::pair{0.2, 0.1}; });
  CHECK(errors.nodes > 30);
  CHECK(errors.worst < kEdge);
  CHECK(contains(result.view->facts.layout, "land by mask_rho"));
  // Of 8 by 8 cells 5 by 8 are wet, and half of the sixth column by weight.
  const auto whole = read(mesh.file(constant(0.2), constant(0.1)));
  REQUIRE(whole.view);
  const auto all = errors_of(*whole.view, [](double, double) { return std::pair{0.2, 0.1}; });
  CHECK(static_cast<double>(errors.nodes) / static_cast<double>(all.nodes) == Approx(5.5 / 8).margin(0.1));
}

TEST_CASE("points that are exactly zero at every level are land when there is no other mark of it") {
  Turned mesh;
  mesh.rows = 9;
  mesh.columns = 9;
  auto file = mesh.file(constant(0.2), constant(0.1));
  const auto east = file.u, north = file.v;
  file.u = [=](std::size_t k, double j, double i) { return i > 5.4 ? 0.0 : east(k, j, i); };
  file.v = [=](std::size_t k, double j, double i) { return i > 5.4 ? 0.0 : north(k, j, i); };
  const auto result = read(file);
  REQUIRE(result.view);
  // Centres 6, 7 and 8 of each of the nine rows.
  CHECK(contains(result.ran.err, "the 27 points that are exactly zero at every time and level are taken as land"));
  CHECK(contains(read(mesh.file(constant(0.2), constant(0.1))).ran.err, "every point of the grid counts as water"));
}

TEST_CASE("a mesh across the antimeridian becomes one grid across it") {
  for (const double lon0 : {179.95, -179.95}) {
    Turned mesh;
    mesh.lon0 = lon0;
    auto file = mesh.file(constant(0.3), constant(-0.4));
    file.lon = [mesh](double j, double i) {
      const double lon = mesh.lon(j, i);
      return lon >= 180 ? lon - 360 : lon < -180 ? lon + 360 : lon;
    };
    const auto result = read(file);
    INFO(result.ran.err);
    REQUIRE(result.view);
    const auto& lons = result.view->axes.lons_deg;
    CHECK(lons.front() > 179);
    CHECK(lons.front() < 180);
    CHECK(lons.back() > 180);
    CHECK(errors_of(*result.view, [](double, double) { return std::pair{0.3, -0.4}; }).worst < kEdge);
    CHECK(errors_of(*result.view, [](double, double) { return std::pair{0.3, -0.4}; }).nodes > 20);
    const auto part = read(file, "--area 179.9/-179.9/39.9/40.1");
    INFO(part.ran.err);
    REQUIRE(part.view);
    CHECK(part.view->axes.lons_deg.size() < lons.size());
    CHECK(errors_of(*part.view, [](double, double) { return std::pair{0.3, -0.4}; }).nodes > 3);
  }
}

namespace {

/// s-levels of five layers over a sloping floor, with a flow that falls linearly from the surface: 0.5 − d/1000 east.
test::RomsFile shear_file(int vtransform, double zeta) {
  Turned mesh;
  auto file = mesh.file(constant(0), constant(0.1));
  file.levels = 5;
  file.depth = [](double j, double) { return 100 + 20 * j; };
  if (zeta != 0) file.zeta = [zeta](double, double) { return zeta; };
  const std::vector<double> s{-0.9, -0.7, -0.5, -0.3, -0.1}, c{-0.8, -0.5, -0.3, -0.15, -0.02};
  const double hc = 10;
  // Depths below the surface by the ROMS formulas, written out here a second time; linear in h, so that faces between two
  // centres lie at the mean of their depths only for Vtransform 1.
  const auto depth = [=](std::size_t k, double j) {
    const double h = 100 + 20 * j;
    const double zo = vtransform == 1 ? hc * s[k] + (h - hc) * c[k] : (hc * s[k] + h * c[k]) / (hc + h);
    return vtransform == 1 ? -(zo + zeta * zo / h) : -(zeta + h) * zo;
  };
  file.u = [=](std::size_t k, double j, double i) {
    return (0.5 - depth(k, j) / 1000) * std::cos(mesh.theta(j, i)) + 0.1 * std::sin(mesh.theta(j, i));
  };
  file.v = [=](std::size_t k, double j, double i) {
    return -(0.5 - depth(k, j) / 1000) * std::sin(mesh.theta(j, i)) + 0.1 * std::cos(mesh.theta(j, i));
  };
  file.variables =
      "  double s_rho(s_rho) ; s_rho:positive = \"up\" ; double Cs_r(s_rho) ; double hc ; int Vtransform ;\n";
  file.data = test::cdl_data("s_rho", s) + test::cdl_data("Cs_r", c) +
              "  hc = 10 ; Vtransform = " + std::to_string(vtransform) + " ;\n";
  return file;
}

}  // namespace

TEST_CASE(
    "a linear shear on s-levels is the same shear at fixed depths, with Vtransform 1 and 2 and a raised surface") {
  for (const int vtransform : {1, 2})
    for (const double zeta : {0.0, 1.5}) {
      INFO(vtransform << " " << zeta);
      const auto result = read(shear_file(vtransform, zeta));
      INFO(result.ran.err);
      REQUIRE(result.view);
      const auto& axes = result.view->axes;
      CHECK(axes.has_depth);
      CHECK(axes.depths_m.back() == 200);  // the water is 200 m deep at the last row
      const Turned mesh;
      std::size_t nodes = 0;
      for (std::size_t z = 0; z < axes.depths_m.size(); ++z)
        for (std::size_t j = 0; j < axes.lats_deg.size(); ++j)
          for (std::size_t i = 0; i < axes.lons_deg.size(); ++i) {
            const double east = result.at(0, z, j, i, 0);
            const double d = axes.depths_m[z];
            // Between the levels that every column has: the top one is 4.8 m deep at most, the deepest 81 m at least.
            if (std::isnan(east) || d < 6 || d > 80) continue;
            // Within the mesh's inner cells: at the edge u and v have one face only.
            const auto [row, column] = mesh.place(axes.lats_deg[j], axes.lons_deg[i]);
            if (row < 1 || row > 4 || column < 1 || column > 5) continue;
            ++nodes;
            // v is averaged between faces over water 20 m apart: their levels lie at the mean depth for Vtransform 1, and
            // for Vtransform 2 bend by hc·(s − C)·20²/(8·h²), below 0.02 m, so 2e-5 m/s; floats and angle add 1e-6.
            CHECK(std::abs(east - (0.5 - d / 1000)) < 3e-5);
            CHECK(std::abs(result.at(0, z, j, i, 1) - 0.1) < 3e-5);
          }
      CHECK(nodes > 100);
      CHECK(
          contains(result.view->facts.layout, "5 terrain-following levels (Vtransform " + std::to_string(vtransform)));
      CHECK(contains(result.view->facts.layout, zeta == 0 ? "below zeta = 0" : "below the moving surface zeta"));
    }
}

TEST_CASE("nothing is known below the floor of a sloping sea") {
  const auto result = read(shear_file(2, 0));
  REQUIRE(result.view);
  const auto& axes = result.view->axes;
  std::size_t checked = 0;
  Turned mesh;
  for (std::size_t z = 0; z < axes.depths_m.size(); ++z)
    for (std::size_t j = 0; j < axes.lats_deg.size(); ++j)
      for (std::size_t i = 0; i < axes.lons_deg.size(); ++i) {
        if (std::isnan(result.at(0, 0, j, i, 0))) continue;  // outside the mesh
        const double row = mesh.place(axes.lats_deg[j], axes.lons_deg[i]).first;
        const double deeper = 100 + 20 * std::ceil(row), shallower = 100 + 20 * std::floor(row);
        const double d = axes.depths_m[z];
        if (d > deeper) CHECK(std::isnan(result.at(0, z, j, i, 0)));
        if (d < shallower) CHECK_FALSE(std::isnan(result.at(0, z, j, i, 0)));
        ++checked;
      }
  CHECK(checked > 300);
}

TEST_CASE("s-levels without their stretching are refused, and read with the one that is given") {
  auto file = shear_file(2, 0);
  file.variables.clear();
  file.data.clear();
  CHECK(contains(refusal(file),
                 "5 terrain-following levels whose depths are not known: the files have no Vtransform, no "
                 "Cs_r, no hc; say --s-levels"));
  const auto read_so = read(file, "--s-levels vtransform=2,vstretching=4,theta_s=5,theta_b=0.4,hc=10");
  INFO(read_so.ran.err);
  REQUIRE(read_so.view);
  CHECK(contains(read_so.view->facts.layout, "Vstretching 4, theta_s 5, theta_b 0.4 as given, hc 10 m"));
  const auto unused = read(shear_file(2, 0), "--s-levels vtransform=1,vstretching=1,theta_s=5,theta_b=0.4,hc=5");
  REQUIRE(unused.view);
  CHECK(contains(unused.ran.err, "the s-levels given are not used"));
  // The same numbers as without the option.
  const auto plain = read(shear_file(2, 0));
  REQUIRE(plain.view);
  CHECK(std::equal(plain.view->values, plain.view->values + 2 * plain.view->axes.nodes(), unused.view->values,
                   [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
  auto no_depth = shear_file(2, 0);
  no_depth.depth = nullptr;
  CHECK(contains(refusal(no_depth), "terrain-following levels need the depth of the water (h)"));
}

TEST_CASE("sigma levels with formula_terms on a rectilinear grid keep its nodes, and a linear shear") {
  const test::ScratchFolder folder;
  // Water 50 m deep everywhere, the surface at 0: σ = −0.1 … −0.9 are depths of 5, 25 and 45 m; u = 1 − d/100.
  const auto file = test::make_netcdf(folder, "s.nc", R"(netcdf s {
dimensions: time = 1 ; sigma = 3 ; lat = 2 ; lon = 3 ;
variables:
  double time(time) ; time:units = "hours since 2024-01-01" ;
  double sigma(sigma) ; sigma:standard_name = "ocean_sigma_coordinate" ; sigma:formula_terms = "sigma: sigma eta: el depth: depth" ;
  double lat(lat) ; lat:units = "degrees_north" ; double lon(lon) ; lon:units = "degrees_east" ;
  double depth(lat, lon) ; double el(time, lat, lon) ;
  float u(time, sigma, lat, lon) ; u:units = "m/s" ; float v(time, sigma, lat, lon) ; v:units = "m/s" ;
data:
  time = 0 ; sigma = -0.1, -0.5, -0.9 ; lat = 40, 41 ; lon = 5, 6, 7 ;
  depth = 50, 50, 50, 50, 50, 50 ; el = 0, 0, 0, 0, 0, 0 ;
  u = 0.95, 0.95, 0.95, 0.95, 0.95, 0.95, 0.75, 0.75, 0.75, 0.75, 0.75, 0.75, 0.55, 0.55, 0.55, 0.55, 0.55, 0.55 ;
  v = 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1 ;
})");
  const auto result = run_ingest(folder, file);
  INFO(result.ran.err);
  REQUIRE(result.view);
  const auto& axes = result.view->axes;
  CHECK(axes.lats_deg == std::vector<double>{40, 41});
  CHECK(axes.lons_deg == std::vector<double>{5, 6, 7});
  CHECK(axes.depths_m.back() == 50);
  for (std::size_t z = 0; z < axes.depths_m.size(); ++z) {
    const double d = std::min(std::max(axes.depths_m[z], 5.0), 45.0);  // a level stands for its layer
    CHECK(result.at(0, z, 1, 2, 0) == Approx(1 - d / 100).margin(1e-6));
  }
  const auto& layout = result.view->facts.layout;
  CHECK(contains(layout, "rectilinear grid of 2 by 3 points (lat, lon)"));
  CHECK(contains(layout, "3 terrain-following levels (sigma, depth)"));
  CHECK(contains(layout, "kept on its own latitudes and longitudes"));
}

TEST_CASE("velocities whose direction is open are refused on a turned grid, and read as the pilot says") {
  const test::ScratchFolder folder;
  Turned mesh;
  const auto cdl = [&](const std::string& attributes) {
    const auto lat = test::over(6, 7, 0, 0, [&](double j, double i) { return mesh.lat(j, i); });
    const auto lon = test::over(6, 7, 0, 0, [&](double j, double i) { return mesh.lon(j, i); });
    return "netcdf c {\ndimensions: y = 6 ; x = 7 ;\nvariables: double nav_lat(y, x) ; double nav_lon(y, x) ; "
           "float u(y, x) ; u:units = \"m/s\" ; float v(y, x) ; v:units = \"m/s\" ; " +
           attributes + "\ndata:\n" + test::cdl_data("nav_lat", lat) + test::cdl_data("nav_lon", lon) +
           test::cdl_data("u", std::vector<double>(42, 0.3)) + test::cdl_data("v", std::vector<double>(42, 0.1)) +
           "}\n";
  };
  const auto file = test::make_netcdf(folder, "m.nc", cdl(""));
  const auto open = run_ingest(folder, file);
  CHECK(open.ran.code == 1);
  CHECK(contains(open.ran.err, "u and v may be east and north or along the grid's axes, which are turned by up to 25"));
  const auto none = run_ingest(folder, file + " --rotation none");
  REQUIRE(none.view);
  CHECK(errors_of(*none.view, [](double, double) { return std::pair{0.3, 0.1}; }).worst < 1e-6);
  const auto grid = run_ingest(folder, file + " --rotation grid");
  REQUIRE(grid.view);
  // Turned by 25° within the 0.3° by which the angle varies over the mesh: 0.316 m/s · 0.005.
  const double c = mesh.c(), s = mesh.s();
  const auto turned = errors_of(*grid.view, [&](double, double) {
    return std::pair{0.3 * c - 0.1 * s, 0.3 * s + 0.1 * c};
  });
  CHECK(turned.nodes > 20);
  CHECK(turned.worst < 2e-3);
  const auto eastward =
      run_ingest(folder, test::make_netcdf(folder, "m.nc",
                                           cdl("u:standard_name = \"eastward_sea_water_velocity\" ; "
                                               "v:standard_name = \"northward_sea_water_velocity\" ;")));
  REQUIRE(eastward.view);
  CHECK(contains(eastward.view->facts.layout, "components are east and north"));
  const auto along = run_ingest(
      folder, test::make_netcdf(
                  folder, "m.nc",
                  cdl("u:standard_name = \"sea_water_x_velocity\" ; v:standard_name = \"sea_water_y_velocity\" ;")));
  REQUIRE(along.view);
  CHECK(along.bytes.substr(along.bytes.size() - 8 * along.view->axes.nodes()) ==
        grid.bytes.substr(grid.bytes.size() - 8 * grid.view->axes.nodes()));
}

TEST_CASE("an angle of another grid, a left-handed grid and a lone u are refused with the reason") {
  Turned mesh;
  auto file = mesh.file(constant(0.3), constant(0));
  file.angle = constant(0);
  CHECK(contains(refusal(file), "angle does not fit the positions: it is 25"));
  auto flipped = mesh.file(constant(0.3), constant(0));
  flipped.lat = [mesh](double j, double i) { return mesh.lat(5 - j, i); };
  flipped.lon = [mesh](double j, double i) { return mesh.lon(5 - j, i); };
  CHECK(contains(refusal(flipped), "left-handed"));
  auto half = mesh.file(constant(0.3), constant(0));
  half.mask = constant(0.5);
  CHECK(contains(refusal(half), "mask mask_rho holds 0.5, allowed is 0 (land) and 1 (water)"));
}

TEST_CASE("more nodes than there is room for are refused with the way out") {
  // One cell of 0.001° among cells of 10° does not make a monster: the median counts. A mesh of 0.001° over 40° does.
  const test::ScratchFolder folder;
  Turned mesh;
  mesh.rows = 3;
  mesh.columns = 3;
  auto file = mesh.file(constant(0.3), constant(0.2));
  file.lat = [](double j, double i) { return 10 + 0.0005 * j + (i > 1.5 ? 40.0 : 0.0) + 0.0001 * i; };
  file.lon = [](double j, double i) { return 10 + 0.0005 * i + (j > 1.5 ? 60.0 : 0.0) - 0.0001 * j; };
  file.angle = nullptr;
  file.u = [](std::size_t, double, double) { return 0.3; };
  file.v = file.u;
  const auto text = refusal(file, "--rotation none");
  CHECK(contains(text, "brought onto latitudes and longitudes it has "));
  CHECK(contains(text, "allowed is 5e+08; cut it with --area W/E/S/N"));
}

namespace {

/// Reads a ROMS file with netCDF4 for Python and does everything again in its own way: averages faces with the masks, turns
/// by the file's angle, finds the cell of a node by the signs of cross products, inverts the bilinear map by a quadratic
/// equation, interpolates s-levels by numpy. Asks at random nodes of the grid that the program made (axes in axes.txt).
/// Prints: time index, depth index, row, column, east, north, speed of the unturned components, the mean direction of the
/// cell's rows from its positions, direction of the unturned current.
const char* kIndependent = R"(
import sys, random, netCDF4, numpy as np
files, grid, uname, vname, folder, depths = sys.argv[1].split(','), sys.argv[2], sys.argv[3], sys.argv[4], sys.argv[5], sys.argv[6]
g = netCDF4.Dataset(grid)
axes = [np.array([float(x) for x in line.split()]) for line in open(folder + '/axes.txt')]
zs, lats, lons = axes
lat, lon = np.array(g['lat_rho'][:]), np.array(g['lon_rho'][:])
wet, mu, mv = [np.array(g[n][:]) == 1 for n in ('mask_rho', 'mask_u', 'mask_v')]
angle = np.array(g['angle'][:])
def centres(f, open, axis):
    f = np.where(open, f, np.nan)
    pad = [(0, 0)] * f.ndim; pad[axis] = (1, 1)
    p = np.pad(f, pad, constant_values=np.nan)
    n = p.shape[axis]
    two = np.stack([np.take(p, range(0, n - 1), axis), np.take(p, range(1, n), axis)])
    closed = ~np.isfinite(two).any(0)
    with np.errstate(all='ignore'):
        import warnings; warnings.simplefilter('ignore')
        return np.where(closed, 0.0, np.nanmean(two, 0))
U, V = [], []
for path in files:
    d = netCDF4.Dataset(path)
    u, v = np.ma.filled(d[uname][:].astype(float), np.nan), np.ma.filled(d[vname][:].astype(float), np.nan)
    a, b = centres(u, mu, u.ndim - 1), centres(v, mv, v.ndim - 2)
    a[..., ~wet] = np.nan; b[..., ~wet] = np.nan
    if depths != '-':
        vt, ths, thb, hc = [float(x) for x in depths.split(',')]
        h, N = np.array(g['h'][:]), u.shape[1]
        s = (np.arange(N) + 0.5) / N - 1
        surf = (1 - np.cosh(ths * s)) / (np.cosh(ths) - 1)
        C = (np.exp(thb * surf) - 1) / (1 - np.exp(-thb))
        zeta = np.array(d['zeta'][:])
        A = np.full((u.shape[0], len(zs)) + h.shape, np.nan); B = A.copy()
        for t in range(u.shape[0]):
            for j, i in zip(*np.nonzero(wet)):
                S = (hc * s + h[j, i] * C) / (hc + h[j, i])
                total = h[j, i] + zeta[t, j, i]
                deep = -(total * S)[::-1]
                A[t, :, j, i] = np.where(zs <= total, np.interp(zs, deep, a[t, ::-1, j, i]), np.nan)
                B[t, :, j, i] = np.where(zs <= total, np.interp(zs, deep, b[t, ::-1, j, i]), np.nan)
        a, b = A, B
    else:
        a, b = a[:, None], b[:, None]
    U.append(a); V.append(b)
U, V = np.concatenate(U), np.concatenate(V)
E, N = U * np.cos(angle) - V * np.sin(angle), U * np.sin(angle) + V * np.cos(angle)
r = random.Random(5)
done = tries = 0
while done < 1000 and tries < 200000:
    tries += 1
    t, k, R, C = r.randrange(U.shape[0]), r.randrange(len(zs)), r.randrange(len(lats)), r.randrange(len(lons))
    y, x = lats[R], lons[C]
    def side(j0, i0, j1, i1):
        ax, ay = lon[j0, i0], lat[j0, i0]; bx, by = lon[j1, i1], lat[j1, i1]
        return (bx - ax) * (y - ay) - (by - ay) * (x - ax)
    s0, s1 = slice(None, -1), slice(1, None)
    tiny = -1e-7
    inside = (side(s0, s0, s0, s1) >= tiny) & (side(s0, s1, s1, s1) >= tiny) & (side(s1, s1, s1, s0) >= tiny) & (side(s1, s0, s0, s0) >= tiny)
    hits = np.argwhere(inside)
    if len(hits) == 0: continue
    j, i = hits[0]
    X = [lon[j, i], lon[j, i + 1], lon[j + 1, i], lon[j + 1, i + 1]]; Y = [lat[j, i], lat[j, i + 1], lat[j + 1, i], lat[j + 1, i + 1]]
    # Eliminate xi: a quadratic in eta.
    a0, b0, c0, d0 = X[0] - x, X[1] - X[0], X[2] - X[0], X[0] - X[1] - X[2] + X[3]
    a1, b1, c1, d1 = Y[0] - y, Y[1] - Y[0], Y[2] - Y[0], Y[0] - Y[1] - Y[2] + Y[3]
    roots = np.roots([c0 * d1 - c1 * d0, a0 * d1 + c0 * b1 - a1 * d0 - c1 * b0, a0 * b1 - a1 * b0])
    best = None
    for eta in roots:
        if abs(eta.imag) > 1e-9: continue
        eta = eta.real
        p, q = b0 + d0 * eta, b1 + d1 * eta
        xi = -(a0 + c0 * eta) / p if abs(p) > abs(q) else -(a1 + c1 * eta) / q
        off = max(-xi, xi - 1, -eta, eta - 1)
        if best is None or off < best[0]: best = (off, xi, eta)
    if best is None or best[0] > 1e-4: continue
    xi, eta = min(max(best[1], 0), 1), min(max(best[2], 0), 1)
    w = np.array([(1 - xi) * (1 - eta), xi * (1 - eta), (1 - xi) * eta, xi * eta])
    at = [(j, i), (j, i + 1), (j + 1, i), (j + 1, i + 1)]
    ok = np.array([np.isfinite(E[t, k][c]) for c in at])
    if (w * ok).sum() < 0.5: continue
    mean = lambda F: sum(w[n] * F[t, k][at[n]] for n in range(4) if ok[n] and w[n] > 0) / (w * ok).sum()
    east, north, u, v = mean(E), mean(N), mean(U), mean(V)
    squeeze = np.cos(np.radians(y))
    rows = np.arctan2((Y[1] - Y[0]) + (Y[3] - Y[2]), ((X[1] - X[0]) + (X[3] - X[2])) * squeeze)
    print(t, k, R, C, '%.12g %.12g %.12g %.12g %.12g' % (east, north, np.hypot(u, v), rows, np.arctan2(v, u)))
    done += 1
)";

struct RealModel {
  const char *files, *more, *grid, *u, *v, *levels;
};

}  // namespace

TEST_CASE(
    "real data: a thousand random nodes of the ROMS samples agree with an independent reading, in speed and "
    "direction") {
  GLIDEHELM_NEEDS_DATA(data);
  const std::string sandy = data + "/currents/roms_us_east_sandy/",
                    wcofs = data + "/currents/roms_wcofs_oregon/WCOFS_subset.nc";
  const std::string days = sandy + "coawst_clm_20121028.nc," + sandy + "coawst_clm_20121029.nc," + sandy +
                           "coawst_clm_20121030.nc," + sandy + "coawst_clm_20121031.nc," + sandy +
                           "coawst_clm_20121101.nc";
  const std::string epoch = " --time-epoch 1858-11-17T00:00:00Z ", grid = sandy + "Sandy_roms_grid.nc";
  struct Case {
    std::string arguments, files, grid, names, levels, layout;
  };
  const Case cases[] = {{wcofs, wcofs, wcofs, "u_sur v_sur", "-", "curvilinear Arakawa C grid of 68 by 37 points"},
                        {sandy + "*.nc" + epoch + "--variables ubar,vbar", days, grid, "ubar vbar", "-",
                         "rectilinear Arakawa C grid of 65 by 87 points"},
                        {sandy + "coawst*.nc" + epoch + "--grid-file " + grid +
                             " --s-levels vtransform=2,vstretching=4,theta_s=5,theta_b=0.4,hc=50",
                         days, grid, "u v", "2,5,0.4,50", "16 terrain-following levels (Vtransform 2, Vstretching 4"}};
  for (const auto& c : cases) {
    INFO(c.layout);
    const test::ScratchFolder folder;
    const auto result = run_ingest(folder, c.arguments);
    INFO(result.ran.err);
    REQUIRE(result.view);
    CHECK(contains(result.view->facts.layout, c.layout));
    const auto& axes = result.view->axes;
    std::ostringstream listed;
    listed.precision(17);
    for (const auto* axis : {&axes.depths_m, &axes.lats_deg, &axes.lons_deg}) {
      for (const double value : *axis) listed << value << ' ';
      listed << '\n';
    }
    test::write_bytes(folder / "axes.txt", listed.str());
    test::write_bytes(folder / "read.py", kIndependent);
    const auto read = test::run_command("/usr/bin/python3 " + (folder / "read.py") + " " + c.files + " " + c.grid +
                                            " " + c.names + " " + folder.path() + " " + c.levels,
                                        folder);
    INFO(read.err);
    REQUIRE(read.code == 0);
    std::istringstream lines{read.out};
    std::size_t t, z, j, i;
    double east, north, speed, rows, direction;
    int points = 0, directed = 0;
    while (lines >> t >> z >> j >> i >> east >> north >> speed >> rows >> direction) {
      ++points;
      INFO(t << " " << z << " " << j << " " << i);
      const double e = result.at(t, z, j, i, 0), n = result.at(t, z, j, i, 1);
      // Floats of at most 2.3 m/s: 1.2e-7 each way; positions of cells in double: 1e-9; on the separable mesh the file's
      // float longitudes differ from the grid file's by 4e-6° of 0.2°, so by 2e-5 of a difference of up to 1 m/s.
      CHECK(std::abs(e - east) < 3e-5);
      CHECK(std::abs(n - north) < 3e-5);
      // Speed: turning is linear and the angle varies within a cell by less than 0.003, so the mean of turned corners has
      // the length of the mean of unturned ones to (0.003)²/8 of the corners' speeds, far below 1e-4.
      CHECK(std::abs(std::hypot(e, n) - speed) < 1e-4);
      if (speed < 0.05) continue;
      ++directed;
      // Direction: east and north differ from the unturned components by the direction of the rows, taken from the
      // positions alone. The angle varies by up to 0.003 within a cell and positions are on an arc: 0.2° is safe, where a
      // wrong sign would be off by 30°.
      const double off = std::remainder(std::atan2(n, e) - direction - rows, 2 * kPi);
      CHECK(std::abs(off) < 0.2 * kDegree);
    }
    CHECK(points == 1000);
    CHECK(directed > 500);
  }
}

TEST_CASE("real data: what of the ROMS samples cannot be read is refused for its reason") {
  GLIDEHELM_NEEDS_DATA(data);
  const test::ScratchFolder folder;
  const std::string sandy = data + "/currents/roms_us_east_sandy/";
  const auto alone = run_ingest(folder, sandy + "Sandy_roms_grid.nc");
  CHECK(alone.ran.code == 5);
  CHECK(contains(alone.ran.err, "it describes a model's grid (lat_rho, lon_rho) and has no current"));
  const auto levels = run_ingest(folder, sandy + "coawst_clm_20121028.nc --time-epoch 1858-11-17T00:00:00Z");
  CHECK(levels.ran.code == 5);
  CHECK(contains(levels.ran.err, "16 terrain-following levels whose depths are not known"));
  CHECK(contains(levels.ran.err, "or read the depth mean with --variables ubar,vbar"));
  const auto tide =
      run_ingest(folder, sandy + "coawst_clm_20121028.nc --grid-file " + data + "/currents/tides/tide_forc_Sandy.nc");
  CHECK(tide.ran.code == 1);
  CHECK(contains(tide.ran.err, "it is given as a grid file, but it does not describe a grid"));
}

TEST_CASE(
    "real data: the turned mesh of the Salish Sea holds every node that lies in it, and gives linear functions back") {
  GLIDEHELM_NEEDS_DATA(data);
  const test::ScratchFolder folder;
  const auto bytes = test::file_bytes(data + "/bathymetry/salishsea_bathymetry_202108.nc");
  const auto file = ingest::NetcdfFile::open(std::as_bytes(std::span{bytes.data(), bytes.size()}));
  REQUIRE(file);
  const ingest::Positions positions{{&*file, file->find("nav_lat")}, {&*file, file->find("nav_lon")}};
  REQUIRE(positions.lat);
  REQUIRE(positions.lon);
  const auto mesh = ingest::mesh_of(positions);
  REQUIRE(mesh);
  CHECK(ingest::check_right_handed(*mesh));
  const auto axes = ingest::target_axes(*mesh, 1, std::nullopt);
  REQUIRE(axes);
  const auto remap = ingest::Remap::of(*mesh, axes->lats.values, axes->lons.values);
  std::vector<float> out(2 * remap.nodes());
  remap.apply(mesh->lat, mesh->lon, out.data());
  std::size_t wet = 0;
  for (std::size_t n = 0; n < remap.nodes(); ++n) {
    if (std::isnan(out[2 * n])) continue;
    ++wet;
    // Degrees up to 126 as floats: 4e-6; nodes clamped by 1e-3 of a cell of 0.005°: 5e-6.
    REQUIRE(std::abs(static_cast<double>(out[2 * n]) - axes->lats.values[n / axes->lons.values.size()]) < 2e-5);
    REQUIRE(std::abs(static_cast<double>(out[2 * n + 1]) - axes->lons.values[n % axes->lons.values.size()]) < 2e-5);
  }
  CHECK(wet == remap.inside());
  CHECK(wet > 100000);
}
