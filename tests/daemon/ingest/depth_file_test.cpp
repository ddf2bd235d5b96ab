#include "daemon/ingest/depth_file.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "core/base/utm.hpp"
#include "daemon/ingest/ascii_grid.hpp"
#include "tests/daemon/ingest/run.hpp"
#include "tests/support/data.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
using Positive = DepthOptions::Positive;

std::string refusal(std::string_view text) {
  const auto grid = read_ascii_grid(text);
  return grid ? "" : grid.error().what;
}

Variable named(std::string name, std::vector<std::pair<std::string, std::string>> texts) {
  Variable v;
  v.name = std::move(name);
  v.type = Type::float32;
  for (auto& [key, text] : texts) v.attributes.push_back({key, Type::text, text, {}});
  return v;
}

/// "up: why", "down: why" or the refusal.
std::string said(const Variable& v) {
  const auto sign = sign_of(v);
  return sign ? (sign->up ? "up: " : "down: ") + sign->why : sign.error().what;
}

const std::string kSmall =
    "NCOLS 3\r\nnrows 2\r\nXLLCORNER 10\r\nyllcorner 50\r\ncellsize 0.5\r\nnodata_VALUE -9999\r\n";

}  // namespace

TEST_CASE("an ASCII grid is read with keys in any case and lines of any length") {
  const auto grid = read_ascii_grid(kSmall + "-1 -2\n-3 -4 -9999\n -6\n\n");
  REQUIRE(grid);
  CHECK(grid->columns == 3);
  CHECK(grid->rows == 2);
  CHECK(grid->corner);
  CHECK(grid->x == 10.25);
  CHECK(grid->y == 50.25);
  CHECK(grid->values[3] == -4);
  CHECK(std::isnan(grid->values[4]));
  const auto centred = read_ascii_grid("ncols 2 nrows 2 xllcenter 1 yllcenter 2 dx 3 dy 4 1 2 3 4");
  REQUIRE(centred);
  CHECK(centred->x == 1);
  CHECK(centred->dx == 3);
  CHECK(centred->dy == 4);
  CHECK_FALSE(centred->corner);
}

TEST_CASE("damage of an ASCII grid is named with its place") {
  CHECK(refusal(kSmall + "1 2 3 4 5") == "line 7, column 10: the file ends after 5 numbers, expected 6");
  CHECK(refusal(kSmall + "1 2 3\n4 5 6 7") == "line 8, column 7: more than the 6 numbers of the grid: '7'");
  CHECK(refusal(kSmall + "1 2 3\n4 5,5 6") == "line 8, column 3: '5,5' has a decimal comma; numbers have a point");
  CHECK(refusal(kSmall + "1 2 x3\n4 5 6") == "line 7, column 5: 'x3' is no number, expected is a depth or a height");
  CHECK(refusal("ncols 3\nncols 3\n") == "line 2, column 1: key 'ncols' stands here a second time");
  CHECK(refusal("ncols 3\nwidth 3\n").substr(0, 44) == "line 2, column 1: key 'width' is not known; ");
  CHECK(refusal("ncols 3 nrows 2 xllcorner 1 cellsize 1 1 2 3 4 5 6") ==
        "head of the grid: neither yllcenter nor yllcorner is given");
  CHECK(refusal("ncols 3 nrows 2 xllcorner 1 xllcenter 1 yllcorner 1 cellsize 1 1") ==
        "head of the grid: both xllcenter and xllcorner are given");
  CHECK(refusal("ncols 3 nrows 2 xllcorner 1 yllcorner 1 dx 1 1").find("cellsize, or dx and dy") != std::string::npos);
  CHECK(refusal("ncols 100000000 nrows 100000000 xllcorner 1 yllcorner 1 cellsize 1 1").find("more than its bytes") !=
        std::string::npos);
  for (std::size_t n = 0; n < kSmall.size(); ++n) CHECK_FALSE(read_ascii_grid(kSmall.substr(0, n)));
}

TEST_CASE("UTM coordinates give positions: textbook points and the symmetries of the projection") {
  CHECK(utm_zone_from("utm33n") == UtmZone{33, true});
  CHECK(utm_zone_from("UTM5S") == UtmZone{5, false});
  CHECK(utm_zone_from("EPSG:32755") == UtmZone{55, false});
  for (const auto* none : {"utm61n", "utm0n", "utm33", "epsg:3857", "epsg:326330", "utmn", "", "utm333n"})
    CHECK_FALSE(utm_zone_from(none));
  // On the central meridian the northing is the scale 0.9996 times the meridian arc; a quarter of it is 10001965.729 m.
  const auto pole = from_utm({31, true}, 500'000, 0.9996 * 10'001'965.729);
  REQUIRE(pole);
  CHECK(pole->lat.degrees() == Approx(90).margin(1e-8));
  const auto origin = from_utm({31, true}, 500'000, 0);
  CHECK(origin->lat.degrees() == Approx(0).margin(1e-12));
  CHECK(origin->lon.degrees() == Approx(3));
  const auto east = from_utm({31, true}, 700'000, 4'650'000), west = from_utm({31, true}, 300'000, 4'650'000);
  CHECK(east->lat.degrees() == Approx(west->lat.degrees()).epsilon(1e-12));
  CHECK(east->lon.degrees() - 3 == Approx(3 - west->lon.degrees()).epsilon(1e-12));
  const auto south = from_utm({31, false}, 700'000, 10'000'000 - 4'650'000);
  CHECK(south->lat.degrees() == Approx(-east->lat.degrees()).epsilon(1e-12));
  CHECK_FALSE(from_utm({31, true}, 1e9, 0));
  CHECK_FALSE(from_utm({31, true}, kNone, 0));
}

TEST_CASE("a prj file is read when it names UTM on a datum like WGS84 and refused otherwise") {
  const std::string tail = "UNIT[\"Meter\",1.0]]";
  const auto zone = zone_of_prj("PROJCS[\"WGS_1984_UTM_Zone_31N\",PROJECTION[\"Transverse_Mercator\"]," + tail);
  REQUIRE(zone);
  CHECK(*zone == UtmZone{31, true});
  CHECK(*zone_of_prj("PROJCS[\"NAD83 / UTM zone 5S\",PROJECTION[\"Transverse_Mercator\"]," + tail) ==
        UtmZone{5, false});
  for (const auto* bad :
       {"PROJCS[\"Lambert\",PROJECTION[\"Lambert_Conformal_Conic\"],UNIT[\"Meter\",1]]",
        "PROJCS[\"ED_1950_UTM_Zone_31N\",PROJECTION[\"Transverse_Mercator\"],UNIT[\"Meter\",1]]",
        "PROJCS[\"WGS_1984_TM\",PROJECTION[\"Transverse_Mercator\"],UNIT[\"Meter\",1]]",
        "PROJCS[\"WGS_1984_UTM_Zone_31N\",PROJECTION[\"Transverse_Mercator\"],UNIT[\"Foot\",0.3]]", ""})
    CHECK_FALSE(zone_of_prj(bad));
}

TEST_CASE("which way numbers count is read from what the file says and never guessed") {
  CHECK(said(named("z", {{"positive", "up"}})) == "up: its attribute positive = up");
  CHECK(said(named("Band1", {{"positive", "Down"}})) == "down: its attribute positive = down");
  CHECK(said(named("elevation", {})) == "up: its name elevation");
  CHECK(said(named("deptho", {})) == "down: its name deptho");
  CHECK(said(named("x", {{"standard_name", "sea_floor_depth_below_geoid"}})).substr(0, 5) == "down:");
  CHECK(said(named("Bathymetry", {{"long_name", "sea_floor_depth"}})).substr(0, 5) == "down:");
  for (const auto* open : {"z", "Band1", "bathymetry", "Bathymetry"})
    CHECK(said(named(open, {{"units", "m"}})).find("say --positive up") != std::string::npos);
  CHECK(said(named("depth", {{"positive", "up"}})).find("contradicts itself") != std::string::npos);
}

TEST_CASE("an ASCII bathymetry needs to be told which way it counts and where metres lie") {
  const auto units = Units::load();
  REQUIRE(units);
  DepthOptions options;
  const std::string text = kSmall + "-10 -20 -30\n-40 -9999 60\n";
  CHECK(read_depths(text, options, *units).error().what.find("--positive up") != std::string::npos);
  options.positive = Positive::up;
  const auto grid = read_depths(text, options, *units);
  REQUIRE(grid);
  CHECK(grid->south_deg == 50.25);
  CHECK(grid->depths_m[0] == 40);  // the south row comes first
  CHECK(std::isnan(grid->depths_m[1]));
  CHECK(grid->depths_m[2] == -60);
  CHECK(grid->depths_m[5] == 30);
  CHECK(grid->decided == "heights, positive up, by --positive");
  options.positive = Positive::down;
  const auto land = read_depths(kSmall + "-1 -2 -3 -4 -5 -6", options, *units);
  CHECK(land.error().what.find("every place would be land") != std::string::npos);
  const std::string metres = "ncols 2 nrows 2 xllcorner 500000 yllcorner 4650000 cellsize 10 1 2 3 4";
  CHECK(read_depths(metres, options, *units).error().what.find("--crs utm33n") != std::string::npos);
  options.crs = "EPSG:2154";
  CHECK(read_depths(metres, options, *units).error().what.find("allowed are degrees") != std::string::npos);
}

TEST_CASE("depths of a bent mesh come out nowhere deeper than the point in whose cell a place lies") {
  std::mt19937 draw{7};
  DepthMesh mesh{14, 11, {}, {}, {}};
  // Turned by 30 degrees; beside a cell's middle lie only places of that cell.
  for (std::size_t j = 0; j < mesh.rows; ++j)
    for (std::size_t i = 0; i < mesh.columns; ++i) {
      const double a = static_cast<double>(i), b = static_cast<double>(j);
      mesh.lats.push_back(45 + 0.01 * (0.5 * a + 0.866 * b));
      mesh.lons.push_back(8 + 0.01 * (0.866 * a - 0.5 * b));
      mesh.depths.push_back(draw() % 40 == 0 ? kNone : 1.0 + static_cast<double>(draw() % 100));
    }
  const auto grid = even_depths(mesh);
  REQUIRE(grid);
  const auto surface = chart::Bathymetry::make(*grid);
  REQUIRE(surface);
  for (int k = 0; k < 20000; ++k) {
    const double a = static_cast<double>(draw() % 10'000) / 1000, b = static_cast<double>(draw() % 13'000) / 1000;
    const double lat = 45 + 0.01 * (0.5 * a + 0.866 * b), lon = 8 + 0.01 * (0.866 * a - 0.5 * b);
    const auto nearest =
        static_cast<std::size_t>(std::lround(b)) * mesh.columns + static_cast<std::size_t>(std::lround(a));
    const double there = std::isnan(mesh.depths[nearest]) ? chart::Bathymetry::kUnknown : mesh.depths[nearest];
    CHECK((*surface)->depth(lat * kPi / 180, lon * kPi / 180) <= there + 1e-4);  // float
  }
  // Not everything became unknown: a flat bottom is kept where the mesh is whole.
  std::fill(mesh.depths.begin(), mesh.depths.end(), 77.0);
  const auto flat = chart::Bathymetry::make(*even_depths(mesh));
  CHECK((*flat)->depth((45 + 0.01 * (2.5 + 0.866 * 6)) * kPi / 180, (8 + 0.01 * (0.866 * 5 - 3)) * kPi / 180) ==
        Approx(77));
}

TEST_CASE("even axes are taken over and around the Earth there is no seam") {
  std::vector<double> lats{-10, 0, 10}, lons, depths;
  for (int k = 0; k < 36; ++k) lons.push_back(-180 + 10.0 * k);
  for (int n = 0; n < 3 * 36; ++n) depths.push_back(n % 36);
  const auto grid = even_depths(lats, lons, depths);
  REQUIRE(grid);
  CHECK(grid->columns == 37);
  CHECK(grid->depths_m[36] == 0);
  const auto surface = chart::Bathymetry::make(*grid);
  REQUIRE(surface);
  CHECK((*surface)->depth(0, 175 * kPi / 180) == Approx(17.5));
}
