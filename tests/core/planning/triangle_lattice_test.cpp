#include "core/planning/triangle_lattice.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "core/base/geo.hpp"
#include "core/base/local_metric.hpp"

using namespace glidehelm;
using planning::TriangleLattice;

namespace {

constexpr double kSide = 5000;

/// Around 50° north and the antimeridian: rows differ in width, longitudes run on.
TriangleLattice lattice() { return {50 * kPi / 180, 179.9 * kPi / 180, kSide, 33e3, 21e3, 48e3, 57e3}; }

double metres_between(TriangleLattice::Place a, TriangleLattice::Place b) {
  return distance(GeoPoint::from_kernel(a.lat, a.lon), GeoPoint::from_kernel(b.lat, b.lon)).si();
}

}  // namespace

TEST_CASE("the seed of a lattice is one of its nodes and the box holds what was asked for") {
  const auto all = lattice();
  const auto seed = all.at(all.seed());
  CHECK(seed.lat == Approx(50 * kPi / 180).epsilon(1e-14));
  CHECK(seed.lon == Approx(179.9 * kPi / 180).epsilon(1e-14));
  TriangleLattice::Within in;
  const auto metric = LocalMetric::at(50 * kPi / 180);
  for (const auto& [north, east] : {std::pair{-33e3, -45e3}, {21e3, 57e3}, {21e3, -45e3}, {-33e3, 57e3}}) {
    // The western edge is a zigzag: half a side is missing in every second row.
    CHECK(all.locate(seed.lat + north / metric.meridian_radius, seed.lon + east / metric.parallel_radius, in));
  }
  CHECK_FALSE(all.locate(seed.lat + 0.02, seed.lon, in));
  CHECK_FALSE(all.locate(std::nan(""), seed.lon, in));
  CHECK_FALSE(all.locate(seed.lat, std::nan(""), in));
}

TEST_CASE("every triangle of a lattice is equilateral and as long as it says") {
  const auto all = lattice();
  for (std::size_t i = 0; i < all.triangles(); ++i) {
    const auto t = all.triangle(i);
    // Parallels within 33 km of 50° differ by 0.7 % from the one at the seed; inside a triangle by 0.05 %.
    CHECK(metres_between(all.at(t.left), all.at(t.right)) == Approx(t.base).epsilon(1e-3));
    CHECK(t.base == Approx(kSide).epsilon(8e-3));
    CHECK(std::abs(t.height) == Approx(std::sqrt(0.75) * kSide).epsilon(1e-3));
    for (const auto corner : {t.left, t.right})
      CHECK(metres_between(all.at(t.apex), all.at(corner)) == Approx(kSide).epsilon(8e-3));
    CHECK((t.height > 0) == (all.at(t.apex).lat > all.at(t.left).lat));
    CHECK(t.narrowest <= 1);
    CHECK(t.widest >= 1);
    CHECK(t.widest - t.narrowest < 2e-3);
  }
}

TEST_CASE("a node knows the triangles that it is a corner of and no others") {
  const auto all = lattice();
  std::map<std::size_t, std::set<std::size_t>> corners;
  for (std::size_t i = 0; i < all.triangles(); ++i) {
    const auto t = all.triangle(i);
    for (const auto corner : {t.left, t.right, t.apex}) corners[corner].insert(i);
  }
  for (std::size_t n = 0; n < all.nodes(); ++n) {
    const auto around = all.around(n);
    std::set<std::size_t> told(around.triangle.begin(), around.triangle.begin() + around.count);
    CHECK(told.size() == static_cast<std::size_t>(around.count));
    CHECK(told == corners[n]);
    CHECK((around.count == 6) == !all.on_rim(n));
  }
}

TEST_CASE("a position is the mean of the corners of its triangle by its weights") {
  const auto all = lattice();
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> north{-0.005, 0.003}, east{-0.011, 0.013};
  const auto seed = all.at(all.seed());
  for (int i = 0; i < 2000; ++i) {
    const double lat = seed.lat + north(random), lon = seed.lon + east(random);
    TriangleLattice::Within in;
    REQUIRE(all.locate(lat, lon - (i % 2 == 0 ? 0 : 2 * kPi), in));
    for (const double weight : {in.left, in.right, in.apex}) {
      CHECK(weight >= -1e-9);  // rounding of longitudes near π by columns of 1e-3: 1e-12 of a column
      CHECK(weight <= 1 + 1e-9);
    }
    const auto t = all.triangle(in.index);
    const auto left = all.at(t.left), right = all.at(t.right), apex = all.at(t.apex);
    CHECK(in.left * left.lat + in.right * right.lat + in.apex * apex.lat == Approx(lat).margin(1e-12));
    CHECK(in.left * left.lon + in.right * right.lon + in.apex * apex.lon == Approx(lon).margin(1e-11));
  }
}
