#include "daemon/ingest/regrid.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/daemon/ingest/model_file.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;
using test::turned_mesh;

namespace {

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// A mesh whose cells all differ: turned, stretched and bent.
Mesh bent_mesh(std::size_t rows, std::size_t columns, double lat, double lon) {
  Mesh mesh{rows, columns, {}, {}};
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const double x = 0.08 * static_cast<double>(i) * (1 + 0.02 * static_cast<double>(i)),
                   y = 0.1 * static_cast<double>(j);
      mesh.lat.push_back(lat + 0.5 * x + 0.9 * y + 0.02 * std::sin(3 * x));
      double at = lon + 0.9 * x - 0.5 * y + 0.02 * std::sin(2 * y);
      if (at >= 180) at -= 360;
      mesh.lon.push_back(at);
    }
  return mesh;
}

}  // namespace

TEST_CASE("a centre takes the mean of its faces, of the one that has a value where the other has none") {
  // One row of four centres; inner faces 1, NaN, 5.
  const Faces inner{false, -1, 1, 3};
  const std::vector<double> faces{1, NAN, 5};
  const auto centres = to_centres(inner, 1, 4, faces, {});
  const double expected[] = {1, 1, 5, 5};
  for (std::size_t i = 0; i < 4; ++i) CHECK(same(centres[i], expected[i]));
  // All faces: five for four centres.
  const auto all = to_centres({false, 0, 1, 5}, 1, 4, std::vector<double>{1, 3, 5, NAN, NAN}, {});
  const double means[] = {2, 4, 5, NAN};
  for (std::size_t i = 0; i < 4; ++i) CHECK(same(all[i], means[i]));
  // As many faces as centres: behind the centre, the first has one only; before it, the last.
  CHECK(to_centres({false, -1, 1, 3}, 1, 3, std::vector<double>{2, 4, 8}, {}) == std::vector<double>{2, 3, 6});
  CHECK(to_centres({false, 0, 1, 3}, 1, 3, std::vector<double>{2, 4, 8}, {}) == std::vector<double>{3, 6, 8});
  // Along the columns: v of a grid of three rows and two columns.
  CHECK(to_centres({true, -1, 2, 2}, 3, 2, std::vector<double>{1, 10, 3, 30}, {}) ==
        std::vector<double>{1, 10, 2, 20, 3, 30});
}

TEST_CASE("closed faces do not count, whatever number stands there, and nothing flows between two of them") {
  const Faces inner{false, -1, 1, 4};
  const std::vector<double> faces{0.5, 77, 88, 0.25};  // numbers on land, as extrapolating producers write them
  const std::vector<std::uint8_t> open{1, 0, 0, 1};
  const auto centres = to_centres(inner, 1, 5, faces, open);
  CHECK(centres == std::vector<double>{0.5, 0.5, 0, 0.25, 0.25});
  // A closed face beside one that is missing: nothing is known.
  const auto unknown =
      to_centres({false, -1, 1, 2}, 1, 3, std::vector<double>{1, NAN}, std::vector<std::uint8_t>{0, 1});
  CHECK(same(unknown[0], 0));
  CHECK(std::isnan(unknown[1]));
  CHECK(std::isnan(unknown[2]));
}

TEST_CASE("a face is open between two wet centres") {
  const std::vector<std::uint8_t> wet{1, 1, 0, 1, 1, 1};  // two rows of three
  CHECK(open_faces({false, -1, 2, 2}, 2, 3, wet) == std::vector<std::uint8_t>{1, 0, 1, 1});
  CHECK(open_faces({true, -1, 1, 3}, 2, 3, wet) == std::vector<std::uint8_t>{1, 1, 0});
}

TEST_CASE("what is linear in latitude and longitude comes through exactly, on every mesh and across the antimeridian") {
  // Positions are bilinear within a cell, and so is a linear function of them: the interpolant is the function itself.
  for (const double lon : {-30.0, 178.9, -180.0}) {
    INFO(lon);
    const Mesh mesh = bent_mesh(20, 30, 35, lon);
    const auto axes = target_axes(mesh, 1, std::nullopt);
    REQUIRE(axes);
    CHECK_FALSE(axes->native);
    const auto& lats = axes->lats.values;
    const auto& lons = axes->lons.values;
    CHECK(lons.front() >= -180);
    CHECK(lons.front() < 180);
    const auto remap = Remap::of(mesh, lats, lons);
    CHECK(remap.inside() > remap.nodes() / 4);
    CHECK(remap.inside() < remap.nodes());
    std::vector<double> east, north;
    for (std::size_t k = 0; k < mesh.lat.size(); ++k) {
      const double off = fold_degrees(mesh.lon[k] - lon);
      east.push_back(0.1 * off + 0.02 * (mesh.lat[k] - 35));
      north.push_back(-0.05 * off + 0.3 * (mesh.lat[k] - 35));
    }
    std::vector<float> out(2 * remap.nodes());
    remap.apply(east, north, out.data());
    std::size_t wet = 0;
    for (std::size_t n = 0; n < remap.nodes(); ++n) {
      if (std::isnan(out[2 * n])) continue;
      ++wet;
      const double off = fold_degrees(lons[n % lons.size()] - lon), up = lats[n / lons.size()] - 35;
      // Values below 1 in floats: 6e-8; nodes up to 1e-3 of a cell (1e-4°) outside are clamped: 3e-5.
      CHECK(out[2 * n] == Approx(0.1 * off + 0.02 * up).margin(3e-5));
      CHECK(out[2 * n + 1] == Approx(-0.05 * off + 0.3 * up).margin(3e-5));
    }
    CHECK(wet == remap.inside());
  }
}

TEST_CASE("a node has a value when wet corners hold half of its weight, renormalised") {
  const Mesh square{2, 2, {0, 0, 1, 1}, {0, 1, 0, 1}};
  const std::vector<double> lats{0.25, 0.75}, lons{0.25, 0.75};
  const auto remap = Remap::of(square, lats, lons);
  REQUIRE(remap.inside() == 4);
  std::vector<float> out(8);
  // The corner (0, 0) is land: it weighs 9/16 at the first node, 3/16 at the second and third, 1/16 at the last.
  const std::vector<double> east{NAN, 1, 2, 4}, north{9, 9, 9, 9};
  remap.apply(east, north, out.data());
  CHECK(std::isnan(out[0]));
  CHECK(std::isnan(out[1]));
  CHECK(out[2] == Approx((9 * 1 + 1 * 2 + 3 * 4) / 13.0));
  CHECK(out[4] == Approx((1 * 1 + 9 * 2 + 3 * 4) / 13.0));
  CHECK(out[6] == Approx((3 * 1 + 3 * 2 + 9 * 4) / 15.0));
  CHECK(out[7] == Approx(9));
}

TEST_CASE("a mesh that is a rectilinear grid keeps its nodes and its numbers") {
  Mesh mesh{3, 3, {}, {}};
  std::vector<double> east, north;
  for (const double lat : {50.0, 49.5, 48.0})
    for (const double lon : {359.0, 0.5, 1.0}) {
      mesh.lat.push_back(lat);
      mesh.lon.push_back(lon);
      east.push_back(lat + fold_degrees(lon));
      north.push_back(lat == 49.5 && lon == 0.5 ? NAN : 1.0);
    }
  const auto axes = target_axes(mesh, 1, std::nullopt);
  REQUIRE(axes);
  CHECK(axes->native);
  CHECK(axes->lats.values == std::vector<double>{48, 49.5, 50});
  CHECK(axes->lons.values == std::vector<double>{-1, 0.5, 1});
  const auto remap = Remap::of(mesh, axes->lats.values, axes->lons.values);
  std::vector<float> out(18);
  remap.apply(east, north, out.data());
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      const float value = out[2 * (3 * j + i)];
      if (j == 1 && i == 1)
        CHECK(std::isnan(value));
      else
        CHECK(value == static_cast<float>(axes->lats.values[j] + axes->lons.values[i]));
    }
}

TEST_CASE("the spacing is the finer median of the mesh, in metres, and does not depend on the area") {
  const Mesh mesh = turned_mesh(40, 60, 0, 100, 30, 0.1);
  const auto whole = target_axes(mesh, 1, std::nullopt), part = target_axes(mesh, 1, Area{99, 101, -0.5, 0.5});
  REQUIRE(whole);
  REQUIRE(part);
  // Cells are squares of 0.1° turned by 30°: 11131.9 m and 11057.4 m along the axes of the ellipsoid, so each side is
  // between them; a degree of longitude at the equator is 111319 m, of latitude 110574 m.
  const double dlat = whole->lats.values[1] - whole->lats.values[0],
               dlon = whole->lons.values[1] - whole->lons.values[0];
  CHECK(dlat * 110574 == Approx(dlon * 111319).epsilon(1e-4));
  // A small mesh is brought onto half of its spacing, one of many levels onto the spacing itself.
  CHECK(2 * dlat * 110574 > 11057);
  CHECK(2 * dlat * 110574 < 11132);
  const auto deep = target_axes(mesh, 1000, std::nullopt);
  REQUIRE(deep);
  CHECK(deep->lats.values[1] - deep->lats.values[0] == Approx(2 * dlat).epsilon(1e-4));
  CHECK(part->lats.values.front() >= -0.5 - dlat);
  CHECK(part->lats.values.back() <= 0.5 + dlat);
  // The nodes of the part are nodes of the whole.
  for (const double lat : part->lats.values) CHECK(std::abs(lat / dlat - std::round(lat / dlat)) < 1e-6);
  REQUIRE_FALSE(target_axes(mesh, 1, Area{0, 1, 0, 1}));
}

TEST_CASE("a mesh around the globe becomes a grid around the globe, with no gap at its seam") {
  Mesh mesh{5, 36, {}, {}};
  for (std::size_t j = 0; j < 5; ++j)
    for (std::size_t i = 0; i < 36; ++i) {
      // Wavy rows, so that it is no rectilinear grid; the first column at 73°.
      mesh.lat.push_back(10.0 * static_cast<double>(j) - 20 + 2 * std::sin(static_cast<double>(i) * 0.35));
      mesh.lon.push_back(fold_degrees(73 + 10.0 * static_cast<double>(i)));
    }
  const auto axes = target_axes(mesh, 1, std::nullopt);
  REQUIRE(axes);
  const auto& lons = axes->lons.values;
  CHECK(lons.front() == -180);
  const double step = lons[1] - lons[0];
  CHECK(lons.back() + step == Approx(180));
  const auto remap = Remap::of(mesh, axes->lats.values, lons);
  std::vector<double> ones(mesh.lat.size(), 1.0);
  std::vector<float> out(2 * remap.nodes());
  remap.apply(ones, ones, out.data());
  // The mesh ends between its last column, 63°, and its first: the model's own seam. Everywhere else the equator is wet.
  std::size_t row = 0;
  while (std::abs(axes->lats.values[row]) > 1e-9 && row + 1 < axes->lats.values.size()) ++row;
  for (std::size_t i = 0; i < lons.size(); ++i) {
    INFO(lons[i]);
    const bool seam = lons[i] > 63 && lons[i] < 73;
    if (std::abs(lons[i] - 63) < 0.02 || std::abs(lons[i] - 73) < 0.02) continue;  // 1e-3 of a cell counts as inside
    CHECK(std::isnan(out[2 * (row * lons.size() + i)]) == seam);
  }
}
