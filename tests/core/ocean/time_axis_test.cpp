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
