#include "daemon/ingest/water.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "tests/daemon/ingest/model_file.hpp"
#include "tests/daemon/ingest/run.hpp"
#include "tests/support/data.hpp"

// Temperature and salinity beside the currents, read by the built program from files that ncgen makes here.

using namespace glidehelm;
using test::run_ingest;

namespace {

/// A file of two times, four depths and 3 by 3 nodes with still-born currents (0.1 m/s) and whatever water a test declares.
struct SeaFile {
  std::string temperature{
      "double thetao(time, depth, lat, lon) ; thetao:units = \"degC\" ; "
      "thetao:standard_name = \"sea_water_temperature\" ;"},
      salinity{"double so(time, depth, lat, lon) ; so:units = \"1\" ; so:standard_name = \"sea_water_salinity\" ;"};
  std::string t_name{"thetao"}, s_name{"so"};
  /// Stored numbers at (time, depth in m, row, column).
  std::function<double(int, double, int, int)> t{[](int, double z, int, int) { return 20 - 0.05 * z; }},
      s{[](int, double z, int, int) { return 36 - 0.004 * z; }};
  std::vector<double> depths{0, 10, 50, 200};

  [[nodiscard]] std::string cdl() const {
    std::vector<double> ts, ss;
    for (int time = 0; time < 2; ++time)
      for (const double z : depths)
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 3; ++i) {
            ts.push_back(t(time, z, j, i));
            ss.push_back(s(time, z, j, i));
          }
    const std::vector<double> current(ts.size(), 0.1);
    return "netcdf sea { dimensions: time = 2 ; depth = " + std::to_string(depths.size()) +
           " ; lat = 3 ; lon = 3 ; variables:\n"
           "double time(time) ; time:units = \"hours since 2026-03-01\" ;\n"
           "double depth(depth) ; depth:units = \"m\" ; depth:positive = \"down\" ;\n"
           "double lat(lat) ; lat:units = \"degrees_north\" ; double lon(lon) ; lon:units = \"degrees_east\" ;\n"
           "float uo(time, depth, lat, lon) ; uo:units = \"m/s\" ; uo:_FillValue = -9.f ;\n"
           "float vo(time, depth, lat, lon) ; vo:units = \"m/s\" ; vo:_FillValue = -9.f ;\n" +
           temperature + "\n" + salinity + "\ndata: time = 0, 24 ; lat = 40, 41, 42 ; lon = 4, 5, 6 ;\n" +
           test::cdl_data("depth", depths) + test::cdl_data("uo", current) + test::cdl_data("vo", current) +
           (temperature.empty() ? "" : test::cdl_data(t_name, ts)) +
           (salinity.empty() ? "" : test::cdl_data(s_name, ss)) + "}\n";
  }
};

ocean::GridWater water_in(const SeaFile& file, const std::string& more = "") {
  const test::ScratchFolder folder;
  const auto read = run_ingest(folder, test::make_netcdf(folder, "sea.nc", file.cdl()) + " " + more);
  INFO(read.ran.err);
  REQUIRE(read.view);  // whatever the water is, the currents are read
  CHECK(ocean::statistics_of(*read.view).wet_fraction == 1);
  return read.view->facts.water;
}

/// The column is read through floats: half a unit in the last of 24 bits of numbers below 64 is 2e-6.
constexpr double kFloat = 2e-6;

void check_linear(const ocean::GridWater& water, double tolerance) {
  INFO(water.words);
  REQUIRE(water.layers.size() == 4);
  for (const auto& layer : water.layers) {
    const double z = layer.depth.si();
    CHECK(layer.temperature_c == Approx(20 - 0.05 * z).margin(tolerance));
    CHECK(layer.salinity == Approx(36 - 0.004 * z).margin(tolerance));
  }
}

}  // namespace

TEST_CASE("a linear profile of temperature and salinity comes out as the same column, whatever its units and packing") {
  SeaFile plain;
  const auto water = water_in(plain);
  check_linear(water, kFloat);
  CHECK(water.words ==
        "thetao and so (standard_name sea_water_temperature), the mean of 18 columns of water, 2 of 2 times");

  SeaFile kelvin = plain;
  kelvin.temperature =
      "double thetao(time, depth, lat, lon) ; thetao:units = \"K\" ; "
      "thetao:standard_name = \"sea_water_temperature\" ;";
  kelvin.t = [](int, double z, int, int) { return 293.15 - 0.05 * z; };
  check_linear(water_in(kelvin), kFloat);

  SeaFile kilograms = plain;
  kilograms.salinity = "double so(time, depth, lat, lon) ; so:units = \"kg kg-1\" ;";
  kilograms.s = [](int, double z, int, int) { return (36 - 0.004 * z) / 1000; };
  check_linear(water_in(kilograms), kFloat);

  for (const char* unit : {"1e-3", "psu", "PSU", "g/kg", "ppt", "0.001"}) {
    INFO(unit);
    SeaFile other = plain;
    other.salinity = std::string{"double so(time, depth, lat, lon) ; so:units = \""} + unit + "\" ;";
    check_linear(water_in(other), kFloat);
  }
  for (const char* unit : {"C", "Celsius", "degrees_C", "deg C", "degree_Celsius"}) {
    INFO(unit);
    SeaFile other = plain;
    other.t_name = "water_temp";  // by name, in situ
    other.temperature = std::string{"double water_temp(time, depth, lat, lon) ; water_temp:units = \""} + unit + "\" ;";
    const auto named = water_in(other);
    check_linear(named, kFloat);
    CHECK(named.words.find("water_temp and so (name water_temp)") == 0);
  }

  SeaFile packed = plain;
  packed.temperature =
      "short thetao(time, depth, lat, lon) ; thetao:units = \"degC\" ; thetao:add_offset = 15. ; "
      "thetao:scale_factor = 0.001 ; thetao:standard_name = \"sea_water_temperature\" ;";
  packed.t = [](int, double z, int, int) { return std::round((5 - 0.05 * z) * 1000); };
  check_linear(water_in(packed), kFloat);
}

TEST_CASE("of several temperatures the one with depths is taken") {
  SeaFile file;  // the surface's stands first, and its standard_name is known before the other's
  file.temperature =
      "double sst(time, lat, lon) ; sst:units = \"degC\" ; sst:standard_name = \"sea_water_temperature\" ;\n"
      "double thetao(time, depth, lat, lon) ; thetao:units = \"degC\" ; "
      "thetao:standard_name = \"sea_water_potential_temperature\" ;";
  const auto water = water_in(file);
  CHECK(water.words.find("thetao and so (standard_name sea_water_potential_temperature)") == 0);
  CHECK(water.layers.size() == 4);
}

TEST_CASE("times and nodes are averaged, and an area counts alone") {
  SeaFile file;
  file.t = [](int time, double z, int j, int i) { return 16 - 0.02 * z + time + j + 0.25 * i; };
  const auto all = water_in(file);  // the means of time, j and i are 0.5, 1 and 1
  REQUIRE(all.layers.size() == 4);
  for (const auto& layer : all.layers)
    CHECK(layer.temperature_c == Approx(16 - 0.02 * layer.depth.si() + 0.5 + 1 + 0.25).margin(kFloat));
  const auto part = water_in(file, "--area 4.5/5.5/40/40.5");  // with one node to spare: rows 0 and 1, all columns
  REQUIRE(part.layers.size() == 4);
  for (const auto& layer : part.layers)
    CHECK(layer.temperature_c == Approx(16 - 0.02 * layer.depth.si() + 0.5 + 0.5 + 0.25).margin(kFloat));
}

TEST_CASE("potential temperature and absolute salinity become what the equation of state takes") {
  SeaFile file;
  file.depths = {0, 10, 500, 2000};
  file.t = [](int, double, int, int) { return 8; };
  file.s = [](int, double, int, int) { return 35.16504; };
  file.temperature =
      "double thetao(time, depth, lat, lon) ; thetao:units = \"degC\" ; "
      "thetao:standard_name = \"sea_water_potential_temperature\" ;";
  file.salinity =
      "double so(time, depth, lat, lon) ; so:units = \"g kg-1\" ; "
      "so:standard_name = \"sea_water_absolute_salinity\" ;";
  const auto water = water_in(file);
  INFO(water.words);
  REQUIRE(water.layers.size() == 4);
  CHECK(water.layers[0].temperature_c == Approx(8).margin(kFloat));
  for (const auto& layer : water.layers) {
    CHECK(layer.salinity == Approx(35).margin(kFloat));
    CHECK(layer.temperature_c ==
          Approx(ocean::in_situ_temperature(35, 8, ocean::pressure_at(layer.depth))).margin(2 * kFloat));
  }
  // The water of 2000 m is warmed by its pressure by about 0.2 °C.
  CHECK(water.layers[3].temperature_c > 8.15);
  CHECK(water.layers[3].temperature_c < 8.3);
}

TEST_CASE("land does not count: fill values, zeros, and nodes without a current") {
  SeaFile file;
  file.temperature =
      "double thetao(time, depth, lat, lon) ; thetao:units = \"degC\" ; thetao:_FillValue = -999. ; "
      "thetao:standard_name = \"sea_water_temperature\" ;";
  file.t = [](int, double z, int j, int i) { return j == 0 ? -999 : i == 2 ? 0 : 20 - 0.05 * z; };
  file.s = [](int, double z, int j, int i) { return j > 0 && i == 2 ? 0 : 36 - 0.004 * z; };
  const auto water = water_in(file);
  check_linear(water, kFloat);
  CHECK(water.words.find("the mean of 8 columns") != std::string::npos);  // two rows of two, at two times
}

TEST_CASE("what is no water for a dive is said, and the currents are read without it") {
  const auto words = [](const SeaFile& file) {
    const auto water = water_in(file);
    CHECK(water.layers.empty());
    return water.words;
  };
  SeaFile none;
  none.temperature = none.salinity = "";
  CHECK(words(none).empty());
  SeaFile half;
  half.salinity = "";
  CHECK(words(half).empty());

  SeaFile kelvin;
  kelvin.t = [](int, double z, int, int) { return 293.15 - 0.05 * z; };
  CHECK(words(kelvin) ==
        "thetao and so are not used: they hold 293.15 °C with salinity 36, allowed is -3 to 45 °C and 0 to 45");
  SeaFile salty;
  salty.s = [](int, double, int, int) { return 50; };
  CHECK(words(salty) ==
        "thetao and so are not used: they hold 20 °C with salinity 50, allowed is -3 to 45 °C and 0 to 45");
  SeaFile unit;
  unit.temperature = "double thetao(time, depth, lat, lon) ; thetao:units = \"m\" ;";
  CHECK(words(unit).find("thetao and so are not used: thetao: ") == 0);
  SeaFile surface;
  surface.temperature = "double thetao(time, lat, lon) ; thetao:units = \"degC\" ;";
  surface.salinity = "double so(time, lat, lon) ; so:units = \"1\" ;";
  surface.depths = {5};
  CHECK(words(surface) == "thetao and so are not used: they are of one depth only");
  SeaFile empty;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  empty.t = [nan](int, double, int, int) { return nan; };
  CHECK(words(empty) == "thetao and so are not used: they have no value in the water");
  SeaFile turned;
  turned.salinity = "double so(time, depth, lat, lon2) ; so:units = \"1\" ;";
  turned.temperature = "double lon2(lon2) ; lon2:units = \"degrees_east\" ;\n" + turned.temperature;
  auto cdl = turned.cdl();
  cdl.insert(cdl.find("lat = 3 ;"), "lon2 = 3 ; ");
  cdl.insert(cdl.rfind("}"), "lon2 = 7, 8, 9 ;\n");
  const test::ScratchFolder folder;
  const auto read = run_ingest(folder, test::make_netcdf(folder, "sea.nc", cdl));
  REQUIRE(read.view);
  CHECK(read.view->facts.water.words == "thetao and so are not used: they lie on different nodes");
}

TEST_CASE("at most eight times are read, spread over all of them") {
  CHECK(ingest::times_to_read(1) == std::vector<std::size_t>{0});
  CHECK(ingest::times_to_read(3) == std::vector<std::size_t>{0, 1, 2});
  CHECK(ingest::times_to_read(8).size() == 8);
  CHECK(ingest::times_to_read(71) == std::vector<std::size_t>{0, 10, 20, 30, 40, 50, 60, 70});
}

TEST_CASE("files that are joined have the mean of their columns, each for its times") {
  const test::ScratchFolder folder;
  SeaFile first, second;
  second.t = [](int, double z, int, int) { return 24 - 0.05 * z; };
  auto later = second.cdl();
  later.replace(later.find("time = 0, 24 ;"), 14, "time = 48, 72 ;");
  const auto read = run_ingest(
      folder, test::make_netcdf(folder, "a.nc", first.cdl()) + " " + test::make_netcdf(folder, "b.nc", later));
  INFO(read.ran.err);
  REQUIRE(read.view);
  const auto& water = read.view->facts.water;
  REQUIRE(water.layers.size() == 4);
  for (const auto& layer : water.layers)
    CHECK(layer.temperature_c == Approx(22 - 0.05 * layer.depth.si()).margin(kFloat));
  CHECK(water.words.find("; the mean of 2 such files") != std::string::npos);
  SeaFile without;
  without.temperature = without.salinity = "";
  auto last = without.cdl();
  last.replace(last.find("time = 0, 24 ;"), 14, "time = 96, 120 ;");
  const auto mixed = run_ingest(
      folder, test::make_netcdf(folder, "c.nc", last) + " " + test::make_netcdf(folder, "a.nc", first.cdl()));
  REQUIRE(mixed.view);
  check_linear(mixed.view->facts.water, kFloat);
}

TEST_CASE("water on s-levels comes out as the same column at fixed depths") {
  // Linear in the depth below the surface, over a floor of 40 to 100 m: linear interpolation between the levels gives it back, but above the
  // first level, which is 5 m deep at most, and below the last, where a column holds its value.
  test::Turned mesh;
  auto file = mesh.file([](double, double) { return 0.2; }, [](double, double) { return 0.1; });
  file.levels = 5;
  const auto depth = [](double j, double) { return 40 + 12 * j; };
  file.depth = depth;
  const std::vector<double> s{-0.9, -0.7, -0.5, -0.3, -0.1};  // sigma: depth = −s·h
  file.variables =
      "  double s_rho(s_rho) ; s_rho:standard_name = \"ocean_sigma_coordinate\" ; s_rho:positive = \"up\" ; "
      "s_rho:formula_terms = \"sigma: s_rho eta: zeta depth: h\" ;\n"
      "  double temp(ocean_time, s_rho, eta_rho, xi_rho) ; temp:units = \"C\" ; "
      "temp:standard_name = \"sea_water_temperature\" ;\n"
      "  double salt(ocean_time, s_rho, eta_rho, xi_rho) ; salt:units = \"psu\" ;\n";
  std::vector<double> t, salt;
  for (const double level : s)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 7; ++i) {
        t.push_back(20 + 0.1 * level * depth(j, i));
        salt.push_back(35 - 0.01 * level * depth(j, i));
      }
  file.data = test::cdl_data("s_rho", s) + test::cdl_data("temp", t) + test::cdl_data("salt", salt);
  const test::ScratchFolder folder;
  const auto read = run_ingest(folder, test::make_netcdf(folder, "m.nc", file.cdl(), "netCDF-4"));
  INFO(read.ran.err);
  REQUIRE(read.view);
  const auto& water = read.view->facts.water;
  CHECK(water.words ==
        "temp and salt (standard_name sea_water_temperature), the mean of 42 columns of water, 1 of 1 time");
  int compared = 0;
  for (const auto& layer : water.layers) {
    const double z = layer.depth.si();
    if (z < 10 || z > 36) continue;  // from the deepest first level, 10 m, to the shallowest last one, 36 m
    ++compared;
    // Ten printed digits of the file, and the sums of 42 numbers.
    CHECK(layer.temperature_c == Approx(20 - 0.1 * z).margin(1e-7));
    CHECK(layer.salinity == Approx(35 + 0.01 * z).margin(1e-7));
  }
  CHECK(compared >= 5);
  for (std::size_t k = 1; k < water.layers.size(); ++k)
    CHECK(water.layers[k].temperature_c <= water.layers[k - 1].temperature_c);
}

TEST_CASE("real data: the water of the Sandy case and of GLORYS becomes colder and denser with depth") {
  GLIDEHELM_NEEDS_DATA(data);
  const test::ScratchFolder folder;
  const auto sandy =
      run_ingest(folder, data + "/currents/roms_us_east_sandy/coawst_clm_*.nc " + data +
                             "/currents/roms_us_east_sandy/Sandy_roms_grid.nc --time-epoch 1858-11-17T00:00:00Z "
                             "--s-levels vtransform=2,vstretching=4,theta_s=5,theta_b=0.4,hc=50");
  REQUIRE(sandy.view);
  const auto glorys = run_ingest(folder, data + "/currents/glorys_packed/GLORYS_NA_2012.nc");
  REQUIRE(glorys.view);
  for (const auto& [name, view] : {std::pair{"Sandy", &*sandy.view}, std::pair{"GLORYS", &*glorys.view}}) {
    const auto& water = view->facts.water;
    INFO(name << ": " << water.words);
    REQUIRE(water.layers.size() > 3);
    const auto density = [](const ocean::WaterLayer& l) {
      return ocean::sea_water_density(l.salinity, l.temperature_c, 0);
    };
    std::printf("%s: %s\n", name, water.words.c_str());
    for (std::size_t k = 0; k < water.layers.size(); ++k) {
      const auto& l = water.layers[k];
      std::printf("  %7.1f m %7.3f C %7.3f, %8.3f kg/m3 at the surface\n", l.depth.si(), l.temperature_c, l.salinity,
                  density(l));
      // The upper 2000 m, where gliders are; below them, against the deepest columns' own pressure, potential density at the surface is no
      // measure of what is stable.
      if (k == 0 || l.depth.si() > 2000) continue;
      CHECK(density(l) >= density(water.layers[k - 1]) - 0.01);
      // A mixed layer: a tenth of a degree either way; below it, falling.
      CHECK(l.temperature_c <= water.layers[k - 1].temperature_c + 0.1);
    }
    CHECK(water.layers.front().temperature_c > water.layers.back().temperature_c + 3);
  }
}
