#include "core/ocean/time_axis.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace glidehelm::ocean;

TEST_CASE("an instant lies between its two neighbours, or exactly on one") {
  const TimeAxis axis{{100, 200, 400}, true, OutsideTime::forbid};
  const auto inside = axis.bracket(250);
  REQUIRE(inside);
  CHECK(inside->first == 1);
  CHECK(inside->next == 2);
  CHECK(inside->fraction == Approx(0.25));
  const auto on = axis.bracket(200);
  REQUIRE(on);
  CHECK(on->first == 1);
  CHECK(on->next == 1);
  const auto last = axis.bracket(400);
  REQUIRE(last);
  CHECK(last->first == 2);
  CHECK(last->next == 2);
}

TEST_CASE("outside the times: forbid has none, hold keeps the end, NaN has none") {
  const TimeAxis forbid{{100, 200}, true, OutsideTime::forbid}, hold{{100, 200}, true, OutsideTime::hold};
  CHECK_FALSE(forbid.bracket(99.9));
  CHECK_FALSE(forbid.bracket(200.1));
  CHECK(hold.bracket(50)->first == 0);
  CHECK(hold.bracket(50)->fraction == 0);
  CHECK(hold.bracket(1e9)->first == 1);
  CHECK_FALSE(hold.bracket(std::nan("")));
}

TEST_CASE("cycle goes on with the phase of the last 24.84 hours, and before the start with the first") {
  std::vector<double> hours;
  for (int h = 0; h <= 72; ++h) hours.push_back(3600.0 * h);
  const TimeAxis axis{hours, true, OutsideTime::cycle};
  const double last = 72 * 3600.0;
  for (const double beyond : {60.0, 5000.0, 80000.0}) {
    const auto later = axis.bracket(last + beyond), same = axis.bracket(last - kTidalCycle + beyond);
    CHECK(later->first == same->first);
    CHECK(later->fraction == Approx(same->fraction).margin(1e-9));
    const auto next_turn = axis.bracket(last + beyond + 3 * kTidalCycle);
    CHECK(next_turn->first == same->first);
    const auto earlier = axis.bracket(-kTidalCycle + beyond), in_first = axis.bracket(beyond);
    CHECK(earlier->first == in_first->first);
    CHECK(earlier->fraction == Approx(in_first->fraction).margin(1e-9));
  }
}

TEST_CASE("a record shorter than a tidal cycle holds instead of cycling") {
  const TimeAxis axis{{0, 3600}, true, OutsideTime::cycle};
  CHECK(axis.bracket(1e6)->first == 1);
  CHECK(axis.bracket(-1e6)->first == 0);
}

TEST_CASE("a field without times answers at every instant") {
  const TimeAxis axis{{0}, false, OutsideTime::forbid};
  CHECK(axis.bracket(1e12));
}

TEST_CASE("cubic in time is exact on parabolas, also with uneven steps") {
  const std::vector<double> t{0, 1, 2.5, 3, 5, 6};
  std::vector<double> v;
  for (const double x : t) v.push_back(3 - 2 * x + 0.7 * x * x);
  for (std::size_t k = 1; k + 2 < t.size(); ++k)
    for (const double f : {0.1, 0.5, 0.77}) {
      const double x = t[k] + f * (t[k + 1] - t[k]);
      // The three-point slope of a parabola is its derivative, and a Hermite cubic through right slopes is exact.
      CHECK(interpolate_in_time(Interpolation::cubic, t, v, k, f) == Approx(3 - 2 * x + 0.7 * x * x).epsilon(1e-13));
    }
}

TEST_CASE("Akima does not overshoot beside a step and is exact on lines") {
  const std::vector<double> t{0, 1, 2, 3, 4, 5}, step{0, 0, 0, 1, 1, 1}, line{1, 3, 5, 7, 9, 11};
  for (const double f : {0.2, 0.5, 0.9}) {
    // The secants on both sides of the flat part are equal, so its slopes are zero and it stays flat.
    CHECK(interpolate_in_time(Interpolation::akima, t, step, 1, f) == 0.0);
    CHECK(interpolate_in_time(Interpolation::akima, t, step, 3, f) == 1.0);
    CHECK(interpolate_in_time(Interpolation::akima, t, line, 2, f) == Approx(5 + 2 * f).epsilon(1e-14));
    CHECK(interpolate_in_time(Interpolation::akima, t, line, 0, f) == Approx(1 + 2 * f).epsilon(1e-14));
  }
}

TEST_CASE("Akima gives the published slope: weights are the differences of the opposite secants") {
  // Secants 1, 2, 4, 0 around the node t = 2: m = (|0 − 4|·2 + |2 − 1|·4)/(4 + 1) = 12/5 (Akima 1970, eq. 1).
  const std::vector<double> t{0, 1, 2, 3, 4}, v{0, 1, 3, 7, 7};
  const double e = 1e-6;
  const double slope = (interpolate_in_time(Interpolation::akima, t, v, 2, e) - v[2]) / e;
  CHECK(slope == Approx(2.4).epsilon(1e-4));  // the next term of the polynomial is of the order e
}

TEST_CASE("no interpolation leaves the bound that is promised") {
  const std::vector<double> t{0, 1, 2, 3, 4, 5}, wild{-1, 1, -1, 1, -1, 1}, hump{0, 1, 1, 1, -1, -1};
  for (const auto how : {Interpolation::nearest, Interpolation::linear, Interpolation::cubic, Interpolation::akima})
    for (const auto* v : {&wild, &hump})
      for (std::size_t k = 0; k + 1 < t.size(); ++k)
        for (double f = 0; f <= 1; f += 0.01)
          CHECK(std::abs(interpolate_in_time(how, t, *v, k, f)) <= overshoot_bound(how, 1.0) * (1 + 1e-15));
}

TEST_CASE("the step ratio is the largest between neighbours, in either direction") {
  CHECK(TimeAxis({0, 1, 2}, true, OutsideTime::hold).step_ratio() == 1);
  CHECK(TimeAxis({0, 1, 4, 5}, true, OutsideTime::hold).step_ratio() == 3);
}
