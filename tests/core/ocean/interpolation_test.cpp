#include "core/ocean/interpolation.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ocean;

TEST_CASE("cubic is exact on parabolas, also with uneven steps") {
  const std::vector<double> t{0, 1, 2.5, 3, 5, 6};
  std::vector<double> v;
  for (const double x : t) v.push_back(3 - 2 * x + 0.7 * x * x);
  for (std::size_t k = 1; k + 2 < t.size(); ++k)
    for (const double f : {0.1, 0.5, 0.77}) {
      const double x = t[k] + f * (t[k + 1] - t[k]);
      // The three-point slope of a parabola is its derivative, and a Hermite cubic through right slopes is exact.
      CHECK(interpolate(Interpolation::cubic, t, v, k, f) == Approx(3 - 2 * x + 0.7 * x * x).epsilon(1e-13));
    }
}

TEST_CASE("Akima does not overshoot beside a step and is exact on lines") {
  const std::vector<double> t{0, 1, 2, 3, 4, 5}, step{0, 0, 0, 1, 1, 1}, line{1, 3, 5, 7, 9, 11};
  for (const double f : {0.2, 0.5, 0.9}) {
    // The secants on both sides of the flat part are equal, so its slopes are zero and it stays flat.
    CHECK(interpolate(Interpolation::akima, t, step, 1, f) == 0.0);
    CHECK(interpolate(Interpolation::akima, t, step, 3, f) == 1.0);
    CHECK(interpolate(Interpolation::akima, t, line, 2, f) == Approx(5 + 2 * f).epsilon(1e-14));
    CHECK(interpolate(Interpolation::akima, t, line, 0, f) == Approx(1 + 2 * f).epsilon(1e-14));
  }
}

TEST_CASE("Akima gives the published slope: weights are the differences of the opposite secants") {
  // Secants 1, 2, 4, 0 around the node t = 2: m = (|0 − 4|·2 + |2 − 1|·4)/(4 + 1) = 12/5 (Akima 1970, eq. 1).
  const std::vector<double> t{0, 1, 2, 3, 4}, v{0, 1, 3, 7, 7};
  const double e = 1e-6;
  const double slope = (interpolate(Interpolation::akima, t, v, 2, e) - v[2]) / e;
  CHECK(slope == Approx(2.4).epsilon(1e-4));  // the next term of the polynomial is of the order e
}

TEST_CASE("no interpolation leaves the bound that is promised") {
  const std::vector<double> t{0, 1, 2, 3, 4, 5}, wild{-1, 1, -1, 1, -1, 1}, hump{0, 1, 1, 1, -1, -1};
  for (const auto how : {Interpolation::nearest, Interpolation::linear, Interpolation::cubic, Interpolation::akima})
    for (const auto* v : {&wild, &hump})
      for (std::size_t k = 0; k + 1 < t.size(); ++k)
        for (double f = 0; f <= 1; f += 0.01)
          CHECK(std::abs(interpolate(how, t, *v, k, f)) <= overshoot_bound(how, 1.0) * (1 + 1e-15));
}

TEST_CASE("the step ratio is the largest between neighbours, in either direction") {
  CHECK(step_ratio(std::vector<double>{0, 1, 2}) == 1);
  CHECK(step_ratio(std::vector<double>{0, 1, 4, 5}) == 3);
}

namespace {

/// Akima's own form of the piece between x1 and x2 (1970, eq. 5): a power series, not Hermite's basis.
double akima_by_series(const std::vector<double>& x, const std::vector<double>& y, std::size_t k, double at) {
  const auto secant = [&](std::size_t i) { return (y[i + 1] - y[i]) / (x[i + 1] - x[i]); };
  const auto slope = [&](std::size_t i) {
    const double m1 = secant(i - 2), m2 = secant(i - 1), m3 = secant(i), m4 = secant(i + 1);
    if (m1 == m2 && m3 == m4) return (m2 + m3) / 2;
    return (std::abs(m4 - m3) * m2 + std::abs(m2 - m1) * m3) / (std::abs(m4 - m3) + std::abs(m2 - m1));
  };
  const double h = x[k + 1] - x[k], m = secant(k), t1 = slope(k), t2 = slope(k + 1), d = at - x[k];
  return y[k] + d * (t1 + d * ((3 * m - 2 * t1 - t2) / h + d * (t1 + t2 - 2 * m) / (h * h)));
}

}  // namespace

TEST_CASE("Akima's own example: his series and ours agree, and the flat part stays flat where a cubic swings") {
  const std::vector<double> x{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, y{10, 10, 10, 10, 10, 10, 10.5, 15, 50, 60, 85};
  for (std::size_t k = 2; k + 3 < x.size(); ++k)
    for (const double f : {0.05, 0.3, 0.5, 0.9})
      // Two forms of one polynomial below 100: a dozen roundings of 1e-16.
      CHECK(interpolate(Interpolation::akima, x, y, k, f) == Approx(akima_by_series(x, y, k, x[k] + f)).epsilon(1e-13));
  CHECK(interpolate(Interpolation::akima, x, y, 4, 0.5) == 10);
  CHECK(interpolate(Interpolation::cubic, x, y, 4, 0.5) < 10);  // slope 0.25 at x = 5: −1/8 of it half-way
}

TEST_CASE("cubic and Akima are the same read backwards and turned upside down") {
  const std::vector<double> x{0, 1, 2.5, 3, 5, 6, 6.5, 9}, y{0.3, -1, 2, 2, 5, 1, 0, 0.5};
  std::vector<double> back_x, back_y;
  for (std::size_t k = x.size(); k-- > 0;) {
    back_x.push_back(-x[k]);
    back_y.push_back(-y[k]);
  }
  for (const auto how : {Interpolation::linear, Interpolation::cubic, Interpolation::akima})
    for (std::size_t k = 0; k + 1 < x.size(); ++k)
      for (const double f : {0.125, 0.5, 0.75})
        CHECK(interpolate(how, back_x, back_y, x.size() - 2 - k, 1 - f) ==
              Approx(-interpolate(how, x, y, k, f)).epsilon(1e-12).margin(1e-12));
}

namespace {

/// One column, repeated: levels at uneven depths, east and north as functions of depth.
template <class F>
GriddedField column(const std::vector<double>& depths, Interpolation how, const F& current) {
  const GridAxes axes{{0.0}, depths, {0, 1}, {0, 1}, false, true};
  return {test::make_grid(axes, [&](double, double, double z, double) { return current(z); }),
          {OutsideTime::hold, how, 1.5, false}};
}

double east_at(const GriddedField& field, double depth) {
  const auto sample = field.sample(geo_point(0.5, 0.5), Depth{Metres{depth}}, 0);
  REQUIRE(sample);
  return sample->current.east.si();
}

/// Levels are floats below 2 m/s (1.2e-7); six of them with weights that sum to at most 3 in modulus: 4e-7.
constexpr double kFloats = 1e-6;

}  // namespace

TEST_CASE("in depth: nearest is a step, linear a line, cubic exact on a parabola, Akima the independent curve") {
  const std::vector<double> depths{0, 10, 25, 50, 80, 120, 200};
  const auto parabola = [](double z) { return std::pair{1 - z * z / 40'000, 0.0}; };
  std::vector<double> values;
  for (const double z : depths) values.push_back(parabola(z).first);
  CHECK(east_at(column(depths, Interpolation::nearest, parabola), 37) == Approx(values[2]).margin(kFloats));
  CHECK(east_at(column(depths, Interpolation::nearest, parabola), 38) == Approx(values[3]).margin(kFloats));
  CHECK(east_at(column(depths, Interpolation::linear, parabola), 37.5) ==
        Approx(0.5 * (values[2] + values[3])).margin(kFloats));
  const auto cubic = column(depths, Interpolation::cubic, parabola),
             akima = column(depths, Interpolation::akima, parabola);
  for (const double z : {12.0, 30.0, 50.0, 77.0, 119.0}) {
    INFO(z << " m");
    CHECK(east_at(cubic, z) == Approx(parabola(z).first).margin(kFloats));
  }
  for (const double z : {30.0, 44.0, 60.0}) {
    const std::size_t k = z < 50 ? 2 : 3;
    CHECK(east_at(akima, z) == Approx(akima_by_series(depths, values, k, z)).margin(kFloats));
  }
}

TEST_CASE("in depth Akima keeps the layers on both sides of a sharp shear, and no curve leaves its bound") {
  const auto two_layers = [](double z) { return std::pair{z < 45 ? 1.0 : -0.5, 0.0}; };
  const auto depths = test::steps(0, 10, 10);
  const auto akima = column(depths, Interpolation::akima, two_layers),
             cubic = column(depths, Interpolation::cubic, two_layers);
  for (const double z : {5.0, 25.0, 38.0}) CHECK(east_at(akima, z) == 1.0);
  for (const double z : {52.0, 65.0, 88.0}) CHECK(east_at(akima, z) == -0.5);
  CHECK(east_at(cubic, 35) > 1.01);
  for (const auto* field : {&akima, &cubic})
    for (double z = 0; z <= 90; z += 0.5) CHECK(std::abs(east_at(*field, z)) <= field->fastest().si());
}

TEST_CASE("a smooth column ends at its last wet level, and is no deeper than that") {
  const auto shallow = [](double z) { return z > 35 ? std::pair{test::kDry, test::kDry} : std::pair{z / 100, 0.0}; };
  for (const auto how : {Interpolation::cubic, Interpolation::akima}) {
    const auto field = column(test::steps(0, 10, 8), how, shallow);
    CHECK(east_at(field, 25) == Approx(0.25).margin(kFloats));  // a line stays one up to its end
    CHECK(east_at(field, 30) == Approx(0.30).margin(kFloats));
    const auto below = field.sample(geo_point(0.5, 0.5), Depth{Metres{31}}, 0);
    REQUIRE_FALSE(below);
    CHECK(below.error() == NoCurrent::below_bottom);
  }
}
