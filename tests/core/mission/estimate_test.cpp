#include "core/mission/estimate.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace glidehelm::mission;

TEST_CASE("without an observation the first guess holds with its own spread") {
  const Estimate e{14400, 1440, 60};
  CHECK(e.value() == 14400);
  CHECK(e.spread() == 1440);
}

TEST_CASE("one surfacing moves nothing, two half way, three all the way") {
  Estimate e{100, 10, 1};
  e.see(130);
  CHECK(e.value() == 100);  // of 100, 100, 130
  e.see(130);
  CHECK(e.value() == 115);  // of 100, 100, 130, 130
  e.see(130);
  CHECK(e.value() == 130);
  CHECK(e.spread() == 1);  // all agree: the floor
}

TEST_CASE("one bad surfacing among good ones moves the value no farther than to its good neighbour") {
  for (const double bad : {-1e6, 0.0, 1e6}) {
    Estimate e{100, 10, 1};
    for (const double good : {109.0, 110.0, 111.0, 110.0}) e.see(good);
    e.see(bad);
    CHECK(e.value() >= 109);
    CHECK(e.value() <= 111);
    CHECK(e.spread() < 3);  // the median distance does not see it either
    Estimate early{100, 10, 1};
    early.see(110);
    early.see(bad);
    CHECK(early.value() >= 100);
    CHECK(early.value() <= 110);
  }
}

TEST_CASE("an observation that is no number is left out") {
  Estimate e{100, 10, 1};
  e.see(std::numeric_limits<double>::quiet_NaN());
  CHECK(e == Estimate{100, 10, 1});
}

TEST_CASE("old observations are forgotten") {
  Estimate e{100, 10, 1};
  for (int i = 0; i < 20; ++i) e.see(200);
  for (int i = 0; i < 4; ++i) e.see(150);
  CHECK(e.value() == 150);  // four of the newest seven
}
