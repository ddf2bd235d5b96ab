#include "core/ocean/grid_axis.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/base/units.hpp"
#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ocean;

namespace {
double rad(double deg) { return deg * kPi / 180; }

/// The search that GridAxis speeds up.
AxisPlace slow(const GridAxis& axis, double x) {
  std::size_t k = 0;
  while (k + 2 < axis.size() && x >= axis.node(k + 1)) ++k;
  return {k, (x - axis.node(k)) / (axis.node(k + 1) - axis.node(k))};
}
}  // namespace

TEST_CASE("an axis of equal steps is uniform and finds cells by division") {
  const GridAxis axis{test::steps(-10, 0.25, 81)};
  REQUIRE(axis.uniform());
  const auto place = axis.place(rad(-9.9));
  CHECK(place.cell == 0);
  CHECK(place.fraction == Approx(0.4).epsilon(1e-9));  // 0.1° of 0.25°; rounding of radians is 1e-16/0.004
  CHECK(axis.place(axis.last()).cell == 79);
  CHECK(axis.place(axis.last()).fraction == Approx(1.0).epsilon(1e-12));
  CHECK(axis.place(axis.first()).cell == 0);
  CHECK(axis.place(axis.first()).fraction == 0.0);
}

TEST_CASE("steps stored as floats still count as uniform, a node off by a hundredth of a cell does not") {
  auto degrees = test::steps(-126.763, 1.0 / 12, 34);
  for (auto& d : degrees) d = static_cast<double>(static_cast<float>(d));
  CHECK(GridAxis{degrees}.uniform());
  degrees[7] += 0.01 / 12;
  CHECK_FALSE(GridAxis{degrees}.uniform());
}

TEST_CASE("an uneven axis finds the same cell as a search from the start") {
  std::mt19937_64 random{11};
  std::uniform_real_distribution<double> step{0.001, 2.0};
  std::vector<double> degrees{-60};
  for (int k = 0; k < 57; ++k) degrees.push_back(degrees.back() + step(random));
  const GridAxis axis{degrees};
  REQUIRE_FALSE(axis.uniform());
  std::uniform_real_distribution<double> anywhere{axis.first(), axis.last()};
  for (int n = 0; n < 20000; ++n) {
    const double x = n < 58 ? axis.node(static_cast<std::size_t>(n)) : anywhere(random);
    const auto found = axis.place(x), expected = slow(axis, x);
    REQUIRE(found.cell == expected.cell);
    // Multiplying by the inverse width rounds twice where dividing rounds once.
    REQUIRE(found.fraction == Approx(expected.fraction).margin(1e-14));
  }
}

TEST_CASE("an axis contains its ends and nothing beyond them") {
  const GridAxis axis{std::vector<double>{1, 2, 4}};
  CHECK(axis.contains(axis.first()));
  CHECK(axis.contains(axis.last()));
  CHECK_FALSE(axis.contains(rad(0.999)));
  CHECK_FALSE(axis.contains(rad(4.001)));
  CHECK_FALSE(axis.contains(std::nan("")));
}
