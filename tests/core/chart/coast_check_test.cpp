#include "core/chart/coast_check.hpp"

#include <catch2/catch.hpp>

#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

TEST_CASE("an area is refused for what is wrong with it") {
  CHECK_FALSE(area_of(-180, 0, -85, 85).problem());
  CHECK_FALSE(area_of(179.9999999, 359, 0, 1).problem());
  CHECK(area_of(-180.1, 0, 0, 1).problem());
  CHECK(area_of(180, 181, 0, 1).problem());
  CHECK(area_of(0, 180.1, 0, 1).problem());
  CHECK(area_of(0, 0, 0, 1).problem());
  CHECK(area_of(0, 1, 1, 1).problem());
  CHECK(area_of(0, 1, -85.1, 1).problem());
}

TEST_CASE("the edges along each of the four borders may be cut edges, no other may") {
  const auto area = area_of(10, 12, 40, 42);
  auto all = ring_of(area, box_of(10, 12, 40, 42));
  all.cut = {true, true, true, true};
  CHECK_FALSE(RingCheck{area}.next(all));
  auto inner = ring_of(area, box_of(10, 11, 40, 42));
  inner.cut = {true, true, true, true};
  const auto fault = RingCheck{area}.next(inner);
  REQUIRE(fault);
  CHECK(fault->point == 1);
  CHECK(fault->problem == "a cut edge does not run along the border of the area");
}

TEST_CASE("a ring without a mark for every point is refused") {
  const auto area = area_of(10, 12, 40, 42);
  auto ring = ring_of(area, box_of(10, 11, 40, 42));
  ring.cut.pop_back();
  CHECK(RingCheck{area}.next(ring));
}

TEST_CASE("rings whose edges would fill the memory are refused before they do") {
  // A zigzag of edges 180° long, 10 000 pieces each: the limit of 2e7 points is met after some 2000 edges.
  const auto area = area_of(-180, 0, -10, 10);
  CoastRing zigzag;
  for (int k = 0; k < 3000; ++k) {
    zigzag.points.push_back({k % 2 == 0 ? 0 : 1'800'000'000, -90'000'000 + k});
    zigzag.cut.push_back(false);
  }
  const auto fault = RingCheck{area}.next(zigzag);
  REQUIRE(fault);
  CHECK(fault->point > 1500);
  CHECK(fault->point < 2500);
  CHECK_FALSE(Coast::make(area, "zigzag", {zigzag}));
}

TEST_CASE("a source is one line of printable ASCII") {
  CHECK_FALSE(problem_of_source("GSHHG 2.3.7"));
  CHECK(problem_of_source(""));
  CHECK(problem_of_source("two\nlines"));
  CHECK(problem_of_source("\xc3\xa9"));
  CHECK(problem_of_source(std::string(401, 'x')));
}
