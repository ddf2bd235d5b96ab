#include "daemon/ingest/grid_file.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/daemon/ingest/model_file.hpp"
#include "tests/support/data.hpp"
#include "tests/support/netcdf.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;

namespace {

/// A file made by ncgen, open.
class Opened {
 public:
  Opened(const std::string& cdl) {
    const test::ScratchFolder folder;
    bytes_ = test::file_bytes(test::make_netcdf(folder, "g.nc", cdl));
    auto file = NetcdfFile::open(std::as_bytes(std::span{bytes_.data(), bytes_.size()}));
    REQUIRE(file);
    file_.emplace(std::move(*file));
  }
  [[nodiscard]] const NetcdfFile& file() const { return *file_; }
  [[nodiscard]] Found find(const std::string& name) const { return {&*file_, file_->find(name)}; }

 private:
  std::string bytes_;
  std::optional<NetcdfFile> file_;
};

/// Positions of a straight mesh of 4 by 5 at 1°, shifted by fractions of a cell, as data of CDL.
std::string positions(const std::string& lat, const std::string& lon, double along_eta, double along_xi,
                      std::size_t rows = 4, std::size_t columns = 5) {
  return test::cdl_data(lat, test::over(rows, columns, 0, 0, [&](double j, double) { return 10 + j + along_eta; })) +
         test::cdl_data(lon, test::over(rows, columns, 0, 0, [&](double, double i) { return 20 + i + along_xi; }));
}

const std::string kVelocity = "float u(y, x) ; float v(y, x) ; ";

}  // namespace

TEST_CASE("a C grid of ROMS is known by a column and a row less, from a grid file with other names of dimensions") {
  const Opened currents(
      "netcdf c { dimensions: erho = 4 ; xrho = 5 ; eu = 4 ; xu = 4 ; ev = 3 ; xv = 5 ; variables: float "
      "u(eu, xu) ; float v(ev, xv) ; }");
  const Opened grid(
      "netcdf g { dimensions: eta = 4 ; xi = 5 ; variables: double lat_rho(eta, xi) ; double lon_rho(eta, xi) ; "
      "data:\n" +
      positions("lat_rho", "lon_rho", 0, 0) + "}");
  const ModelFiles both{{&currents.file(), &grid.file()}};
  const auto found = model_grid(both, currents.find("u"), currents.find("v"), false);
  REQUIRE(found);
  CHECK(found->words ==
        "rectilinear Arakawa C grid of 4 by 5 points (lat_rho, lon_rho), u and v on the inner faces, averaged "
        "to the points");
  CHECK(found->staggering.u.before == -1);
  CHECK_FALSE(found->staggering.u.along_eta);
  CHECK(found->staggering.v.along_eta);
  const auto without = model_grid(ModelFiles{{&currents.file()}}, currents.find("u"), currents.find("v"), false);
  REQUIRE_FALSE(without);
  CHECK(without.error().what ==
        "u(eu, xu) (4 by 4) and v(ev, xv) (3 by 5) fit no positions of grid points (there are none); name the model's "
        "grid "
        "file among the files or with --grid-file");
}

TEST_CASE("a grid of another size is refused with both sizes") {
  const Opened currents(
      "netcdf c { dimensions: eu = 4 ; xu = 4 ; ev = 3 ; xv = 5 ; variables: float u(eu, xu) ; float v(ev, xv) ; }");
  const Opened grid(
      "netcdf g { dimensions: eta = 4 ; xi = 6 ; variables: double lat_rho(eta, xi) ; double lon_rho(eta, xi) ; "
      "data:\n" +
      positions("lat_rho", "lon_rho", 0, 0, 4, 6) + "}");
  const auto found =
      model_grid(ModelFiles{{&currents.file(), &grid.file()}}, currents.find("u"), currents.find("v"), false);
  REQUIRE_FALSE(found);
  CHECK(found.error().what.find("fit no positions of grid points (lat_rho, lon_rho 4 by 6)") != std::string::npos);
}

TEST_CASE("on which side of the centres u and v lie follows from their positions") {
  struct Case {
    double u_eta, u_xi, v_eta, v_xi;
    const char* words;  ///< nullptr: refused
    bool staggered;
    int before;
  };
  const Case cases[] = {{0, 0.5, 0.5, 0, "u and v on the faces behind their centres", true, -1},
                        {0, -0.5, -0.5, 0, "u and v on the faces before their centres", true, 0},
                        {0, 0, 0, 0, "", false, -1},
                        {0, 0.5, 0, 0, nullptr, false, 0},
                        {0.5, 0.5, 0.2, 0, nullptr, false, 0}};
  for (const auto& c : cases) {
    INFO(c.u_xi << " " << c.v_eta);
    const Opened file("netcdf n { dimensions: y = 4 ; x = 5 ; variables: " + kVelocity +
                      "double gphit(y, x) ; double glamt(y, x) ; double gphiu(y, x) ; double glamu(y, x) ; double "
                      "gphiv(y, x) ; double "
                      "glamv(y, x) ; data:\n" +
                      positions("gphit", "glamt", 0, 0) + positions("gphiu", "glamu", c.u_eta, c.u_xi) +
                      positions("gphiv", "glamv", c.v_eta, c.v_xi) + "}");
    const auto found = model_grid(ModelFiles{{&file.file()}}, file.find("u"), file.find("v"), false);
    CHECK(found.has_value() == (c.words != nullptr));
    if (!found) {
      CHECK(found.error().what.find("the staggering of u(y, x) (4 by 5) and v(y, x) (4 by 5) is not known: u lies") ==
            0);
      continue;
    }
    CHECK(found->staggering.staggered == c.staggered);
    CHECK(found->staggering.words == c.words);
    CHECK(found->staggering.u.before == c.before);
    CHECK(found->centre_words == (c.staggered ? "gphit, glamt" : "gphiu, glamu"));
  }
}

TEST_CASE("centres that no file gives are half a cell beside u") {
  const Opened file("netcdf n { dimensions: y = 4 ; x = 5 ; variables: " + kVelocity +
                    "double gphiu(y, x) ; double glamu(y, x) ; double gphiv(y, x) ; double glamv(y, x) ; data:\n" +
                    positions("gphiu", "glamu", 0, 0.5) + positions("gphiv", "glamv", 0.5, 0) + "}");
  const auto found = model_grid(ModelFiles{{&file.file()}}, file.find("u"), file.find("v"), false);
  REQUIRE(found);
  CHECK(found->centre_words == "half a cell beside gphiu, glamu");
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 5; ++i) {
      CHECK(found->centres.lat[found->centres.index(j, i)] == Approx(10.0 + static_cast<double>(j)));
      CHECK(found->centres.lon[found->centres.index(j, i)] == Approx(20.0 + static_cast<double>(i)));
    }
}

TEST_CASE(
    "components on the centres' shape without positions of their own are refused, unless they are east and north") {
  const Opened currents(
      "netcdf c { dimensions: gridY = 4 ; gridX = 5 ; variables: float u(gridY, gridX) ; float v(gridY, gridX) ; }");
  const Opened grid(
      "netcdf g { dimensions: y = 4 ; x = 5 ; variables: double nav_lat(y, x) ; double nav_lon(y, x) ; data:\n" +
      positions("nav_lat", "nav_lon", 0, 0) + "}");
  const ModelFiles both{{&currents.file(), &grid.file()}};
  const auto open = model_grid(both, currents.find("u"), currents.find("v"), false);
  REQUIRE_FALSE(open);
  CHECK(open.error().what.find(
            "they may lie on the centres or on the faces; needed are positions in their file, or glamu") !=
        std::string::npos);
  const auto east = model_grid(both, currents.find("u"), currents.find("v"), true);
  REQUIRE(east);
  CHECK_FALSE(east->staggering.staggered);
}

TEST_CASE("a velocity's own positions are those it names, else those over its dimensions") {
  const Opened file(
      "netcdf n { dimensions: y = 4 ; x = 5 ; variables: double nav_lat(y, x) ; double nav_lon(y, x) ; double lat_u(y, "
      "x) ; "
      "double lon_u(y, x) ; float u(y, x) ; u:coordinates = \"lon_u lat_u\" ; float v(y, x) ; float w(x, y) ; }");
  CHECK(own_positions(file.find("u"))->words() == "lat_u, lon_u");
  CHECK(own_positions(file.find("v"))->words() == "nav_lat, nav_lon");
  CHECK_FALSE(own_positions(file.find("w")));
}

TEST_CASE("what a file holds is seen in its header") {
  const auto contents = [](const std::string& variables) {
    const Opened file("netcdf f { dimensions: t = 2 ; y = 4 ; x = 5 ; variables: " + variables + " }");
    return contents_of(file.file(), "", "");
  };
  CHECK(contents("float u(t, y, x) ; float v(t, y, x) ;") == Contents::currents);
  CHECK(contents("float vozocrtx(t, y, x) ; float nav_lat(y, x) ; float nav_lon(y, x) ;") == Contents::u_only);
  CHECK(contents("float vomecrty(t, y, x) ;") == Contents::v_only);
  CHECK(contents("float q(t, y, x) ; q:standard_name = \"sea_water_y_velocity\" ;") == Contents::v_only);
  CHECK(contents("float lat_rho(y, x) ; float lon_rho(y, x) ; float mask_rho(y, x) ;") == Contents::grid);
  CHECK(contents("float glamt(y, x) ; float gphit(y, x) ; float glamu(y, x) ;") == Contents::grid);
  CHECK(contents("float lat(y) ; float lon(x) ; float h(y, x) ;") == Contents::grid);
  CHECK(contents("float lat(y) ; float lon(x) ; float h(y, x) ; float salt(t, y, x) ;") == Contents::other);
  CHECK(contents("float lat(y, x) ; float lon(y, x) ; float mask(y, x) ; float adt(t, y, x) ; adt:standard_name = "
                 "\"sea_surface_height_above_geoid\" ;") == Contents::other);
  CHECK(contents("float lat_rho(y, x) ; float lon_rho(y, x) ;") == Contents::other);  // positions of what?
}

TEST_CASE("several velocities are settled by being exact, then by known names, else refused") {
  const auto found = [](const std::string& variables) {
    const Opened file("netcdf f { dimensions: y = 4 ; x = 5 ; variables: " + variables + " }");
    const auto pair = model_velocity(ModelFiles{{&file.file()}}, "", "");
    if (!pair) return "refused: " + pair.error().what;
    return *pair ? (*pair)->u.variable->name + " by " + (*pair)->why : std::string{"none"};
  };
  const auto pair = [](const std::string& u, const std::string& v, const std::string& kind) {
    return "float " + u + "(y, x) ; " + u + ":standard_name = \"" + kind + "_x_velocity\" ; float " + v + "(y, x) ; " +
           v + ":standard_name = \"" + kind + "_y_velocity\" ; ";
  };
  CHECK(found(pair("a", "b", "sea_water_surface") + pair("c", "d", "sea_water")) ==
        "c by standard_name sea_water_x_velocity");
  CHECK(found(pair("ubar", "vbar", "barotropic_sea_water") + pair("u_sur", "v_sur", "sea_water_surface")) ==
        "u_sur by standard_name sea_water_surface_x_velocity");
  CHECK(found(pair("a", "b", "sea_water_surface") + pair("c", "d", "barotropic_sea_water")) ==
        "refused: several velocities (a, b; c, d); say which with --variables EAST,NORTH");
  CHECK(found("float vozocrtx(y, x) ; float vomecrty(y, x) ; ") == "vozocrtx by name vozocrtx");
  CHECK(found("float temp(y, x) ; ") == "none");
}

TEST_CASE("real data: the grid file of the Sandy case is known as one, its forecasts as currents") {
  GLIDEHELM_NEEDS_DATA(data);
  const auto contents = [&](const std::string& path) {
    const auto bytes = test::file_bytes(data + "/currents/" + path);
    const auto file = NetcdfFile::open(std::as_bytes(std::span{bytes.data(), bytes.size()}));
    REQUIRE(file);
    return contents_of(*file, "", "");
  };
  CHECK(contents("roms_us_east_sandy/Sandy_roms_grid.nc") == Contents::grid);
  CHECK(contents("roms_us_east_sandy/coawst_clm_20121028.nc") == Contents::currents);
  CHECK(contents("roms_wcofs_oregon/WCOFS_subset.nc") == Contents::currents);
  CHECK(contents("tides/tide_forc_Sandy.nc") == Contents::other);
  CHECK(contents("tides/tidepredictor_currents.nc") == Contents::other);
}
