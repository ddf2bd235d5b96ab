#include "core/planning/abs_cts_astar.hpp"

#include <catch2/catch.hpp>

#include "core/planning/cts_astar.hpp"
#include "tests/contract/planner_contract.hpp"

using namespace glidehelm;

TEST_CASE("abs-cts-astar keeps the planner contract") { test::check_planner<planning::AbsCtsAStar>(); }

TEST_CASE("the same seed gives the same plan of abs-cts-astar and another seed another") {
  // The eddies' sea, where no heading is as good as the straight one. Cell and M are small enough for draws to matter.
  auto sea = test::analytic_seas().back();
  sea.problem.headings = 8;
  const ocean::Ocean ocean{sea.field, sea.field};
  const std::array<ocean::Ocean, 1> members{ocean};
  const auto plan = [&](std::uint64_t seed) {
    sea.problem.seed = seed;
    const auto answer = planning::AbsCtsAStar{}.plan(sea.problem, members, chart::Chart{}, {}, {});
    REQUIRE(answer);
    CHECK(answer->method == "abs-cts-astar");
    CHECK(answer->reaches_goal());
    return *answer;
  };
  const auto one = plan(1);
  CHECK(one.stints == plan(1).stints);
  CHECK(one.stints != plan(2).stints);
}

TEST_CASE("abs-cts-astar finds the way with few headings where uniform ones are too coarse to hit the goal") {
  // Eight uniform headings are 45° apart; across a current the one that makes the goal's direction good is not among them. ABS has it.
  // One stint covers the way: a plan in a uniform current cannot beat holding the course throughout.
  const test::Uniform cross{0.0, 0.12};
  auto p = test::problem_between(geo_point(20, -30), geo_point(20, -29), 500);
  p.headings = 8;
  const auto found = [&](planning::HeadingSampling sampling) {
    planning::CtsSettings settings;
    settings.sampling = sampling;
    return planning::search(p, {cross, cross}, chart::Chart{}, {}, settings).arrival_s - test::kT0;
  };
  // The best is one heading throughout, with T under water and W adrift: (U·T)² = way² + (c·(T + W))². Holding the course to the goal from each
  // dive makes up for the drifts (108 m each) late: in all they are 1.3 km, which the last of 13 stints must not be longer than
  // by a twentieth: 0.4 % of the whole. The disc's near edge is 500 m before the centre.
  const double way = distance(p.start.fix, geo_point(20, -29)).si() - 500;
  double under = way / 0.3;
  for (int i = 0; i < 50; ++i) {
    const double north = 0.12 * p.schedule.travel_time(Seconds{under}).count();
    under = std::hypot(way, north) / 0.3;
  }
  const double best = p.schedule.travel_time(Seconds{under}).count();
  CHECK(found(planning::HeadingSampling::adaptive) >= best - 1);
  CHECK(found(planning::HeadingSampling::adaptive) <= 1.004 * best);
  CHECK(found(planning::HeadingSampling::uniform) > found(planning::HeadingSampling::adaptive));
}
