#include "daemon/ingest/curvilinear.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/units.hpp"
#include "tests/daemon/ingest/model_file.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;
using test::turned_mesh;

namespace {

/// A number in [0, 1) from a linear congruential generator.
double chance(std::uint64_t& state) {
  state = state * 6364136223846793005ULL + 1442695040888963407ULL;
  return static_cast<double>(state >> 11) / 9007199254740992.0;
}

std::vector<double> everywhere(const Mesh& mesh, double value) { return std::vector<double>(mesh.lat.size(), value); }

}  // namespace

TEST_CASE("the direction of a mesh's rows is the angle by which it was turned, also across the antimeridian") {
  for (const double lon : {-40.0, 179.9, -179.95, 359.9})
    for (const double turn : {0.0, 15.0, -80.0, 130.0, 179.5}) {
      INFO(lon << " " << turn);
      // A small mesh at the equator: there a degree of longitude is as long as one of latitude to cos 0.2° = 1 − 6e-6.
      const Mesh mesh = turned_mesh(9, 11, 0.0, lon, turn, 0.02);
      for (const double theta : axis_directions(mesh)) CHECK(std::abs(fold_radians(theta - turn * kDegree)) < 1e-5);
      for (const double theta : axis_directions(mesh, true))
        CHECK(std::abs(fold_radians(theta - (turn + 90) * kDegree)) < 1e-5);
      CHECK(check_right_handed(mesh));
    }
}

TEST_CASE("a mesh whose rows run the other way round, or whose axes are oblique, gives no meaning to components") {
  Mesh mesh = turned_mesh(6, 6, 30, 10, 20, 0.1);
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 6; ++i) {
      std::swap(mesh.lat[mesh.index(j, i)], mesh.lat[mesh.index(5 - j, i)]);
      std::swap(mesh.lon[mesh.index(j, i)], mesh.lon[mesh.index(5 - j, i)]);
    }
  REQUIRE_FALSE(check_right_handed(mesh));
  CHECK(check_right_handed(mesh).error().what.find("left-handed") != std::string::npos);
  Mesh oblique = turned_mesh(6, 6, 0, 10, 0, 0.1);
  for (std::size_t j = 0; j < 6; ++j)
    for (std::size_t i = 0; i < 6; ++i) oblique.lon[oblique.index(j, i)] += 0.1 * static_cast<double>(j);
  REQUIRE_FALSE(check_right_handed(oblique));
  CHECK(check_right_handed(oblique).error().what ==
        "the axes of the grid meet at 45.0°, so that components along them have no one meaning; allowed is 90°");
}

TEST_CASE("an angle is used in the unit and the sense in which it fits the positions") {
  const Mesh mesh = turned_mesh(8, 8, 0.0, 20, 25, 0.02);
  struct Case {
    double stored;
    const char *unit, *warning;
  };
  const Case cases[] = {
      {25 * kDegree, "radians", ""},
      {25, "degrees", ""},
      {25, "radians", "in degrees, counter-clockwise from east to the rows"},
      {25 * kDegree, "degree", "in radians, counter-clockwise from east to the rows"},
      {-25 * kDegree, "radian", "clockwise from east to the rows"},
      {115 * kDegree, "radians", "counter-clockwise from east to the columns"},
      {25 * kDegree + 2 * kPi, "radians", ""},
  };
  for (const auto& c : cases) {
    INFO(c.stored << " " << c.unit);
    std::vector<std::string> warnings;
    const auto rotation = rotation_from(mesh, "angle", c.unit, everywhere(mesh, c.stored), warnings);
    REQUIRE(rotation);
    for (const double theta : rotation->theta) CHECK(std::abs(theta - 25 * kDegree) < 1e-12);
    CHECK(rotation->words == "turned by angle (25.0° from east; it agrees with the positions to 0.0°)");
    if (*c.warning == '\0')
      CHECK(warnings.empty());
    else
      CHECK(warnings == std::vector<std::string>{std::string{"angle agrees with the positions only when it is read "} +
                                                 c.warning + "; read so"});
  }
}

TEST_CASE("an angle that fits the positions in no sense is refused with the difference") {
  const Mesh mesh = turned_mesh(8, 8, 0.0, 20, 25, 0.02);
  std::vector<std::string> warnings;
  const auto rotation = rotation_from(mesh, "angle", "radians", everywhere(mesh, 0.0), warnings);
  REQUIRE_FALSE(rotation);
  CHECK(rotation.error().what.find("angle does not fit the positions: it is 25.0° off") == 0);
  const auto nothing = rotation_from(mesh, "angle", "radians", everywhere(mesh, NAN), warnings);
  REQUIRE_FALSE(nothing);
  CHECK(nothing.error().what == "angle has no value where the grid has positions");
}

TEST_CASE("the place in a cell is the inverse of its bilinear map") {
  std::uint64_t state = 7;
  int found = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    // A square of side 1 whose corners are moved by up to 0.2: always convex, its map one to one.
    CellCorners cell{{0, 1, 0, 1}, {0, 0, 1, 1}};
    for (int k = 0; k < 4; ++k) {
      cell.x[k] += 0.4 * chance(state) - 0.2;
      cell.y[k] += 0.4 * chance(state) - 0.2;
    }
    const double xi = chance(state), eta = chance(state);
    const double w[4] = {(1 - xi) * (1 - eta), xi * (1 - eta), (1 - xi) * eta, xi * eta};
    double x = 0, y = 0;
    for (int k = 0; k < 4; ++k) x += w[k] * cell.x[k], y += w[k] * cell.y[k];
    const auto place = place_in_cell(cell, x, y, 1e-9);
    REQUIRE(place);
    // Newton ends with steps below 1e-12, and converges quadratically.
    CHECK(std::abs(place->xi - xi) < 1e-11);
    CHECK(std::abs(place->eta - eta) < 1e-11);
    ++found;
    CHECK_FALSE(place_in_cell(cell, x + 2, y, 1e-9));
  }
  CHECK(found == 2000);
  CHECK_FALSE(place_in_cell({{0, 0, 0, 0}, {0, 0, 0, 0}}, 0, 0, 1e-9));
  CHECK_FALSE(place_in_cell({{0, 1, 0, 1}, {0, 0, 1, 1}}, NAN, 0.5, 1e-9));
}

TEST_CASE("a rectilinear grid that is written in two dimensions is recognised, a turned one is not") {
  Mesh mesh{3, 4, {}, {}};
  for (const double lat : {50.0, 49.0, 47.5})
    for (const double lon : {179.0, -180.0, -179.0, -177.5}) mesh.lat.push_back(lat), mesh.lon.push_back(lon);
  const auto axes = separable_axes(mesh);
  REQUIRE(axes);
  CHECK(axes->lats == std::vector<double>{50, 49, 47.5});
  CHECK(axes->lons == std::vector<double>{179, 180, 181, 182.5});
  mesh.lat[5] += 0.01;
  CHECK_FALSE(separable_axes(mesh));
  CHECK_FALSE(separable_axes(turned_mesh(5, 5, 0, 0, 3, 0.1)));
}

TEST_CASE("positions that cannot be are left out") {
  Mesh mesh{2, 3, {0, 0, 91, 45, NAN, 46}, {0, 0, 10, 1e20, 3, 11}};
  CHECK(drop_impossible_positions(mesh) == 5);
  CHECK(mesh.lat[5] == 46);
  CHECK(std::isnan(mesh.lon[0]));
  Mesh gulf{2, 2, {0, 0, 0.1, 0.1}, {0, 0.1, 0, 0.1}};  // one point in the Gulf of Guinea is a place
  CHECK(drop_impossible_positions(gulf) == 0);
}

TEST_CASE("the median spacing is that of the mesh, in metres") {
  // 0.1° along a row of the equator: 6378137 m · 0.1° = 11131.9 m; along the meridian M(0) = 6335439 m: 11057.4 m.
  const auto spacing = median_spacing(turned_mesh(5, 5, 0, 0, 0, 0.1));
  CHECK(spacing.xi_m == Approx(11131.9).epsilon(1e-4));
  CHECK(spacing.eta_m == Approx(11057.4).epsilon(1e-4));
}
