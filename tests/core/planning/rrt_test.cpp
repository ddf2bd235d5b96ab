#include "core/planning/rrt.hpp"

#include <catch2/catch.hpp>

#include "core/planning/mean_motion.hpp"
#include "tests/contract/planner_contract.hpp"

using namespace glidehelm;

namespace {

Expected<planning::Plan, planning::PlanFailure> ask(const planning::Problem& p, ocean::FieldRef field,
                                                    const chart::Chart& chart = {}) {
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{field, field}};
  return planning::Rrt{}.plan(p, members, chart, {}, {});
}

planning::RrtWays trees(const planning::Problem& p, ocean::FieldRef field, const chart::Chart& chart = {}) {
  const ocean::Ocean ocean{field, field};
  return planning::grow_trees(p, ocean, chart, {}, Metres{0});
}

}  // namespace

TEST_CASE("the random tree keeps the promises of every planner that do not ask for the shortest way") {
  const planning::Rrt rrt;
  SECTION("land and areas are never crossed") { test::never_cross_land(rrt); }
  SECTION("what cannot be planned is said with its reason") { test::explain_failures(rrt); }
  SECTION("a start inside the goal has arrived") { test::arrive_where_they_are(rrt); }
}

TEST_CASE("in static currents the random tree arrives, and its plan flies as it says") {
  for (const auto& sea : test::analytic_seas()) {
    const auto plan = ask(sea.problem, sea.field);
    INFO(sea.name);
    if (!plan && plan.error().what == planning::NoPlan::unsuited_method) continue;  // currents of this sea change
    REQUIRE(plan);
    const ocean::Ocean ocean{sea.field, sea.field};
    test::check_plan(*plan, sea.problem, ocean, chart::Chart{});
    CHECK(plan->method == "rrt");
  }
}

TEST_CASE("a way of the trees is as long as its segments and no quicker than still water allows") {
  const auto from = geo_point(28, -16), to = destination(from, Bearing{degrees(40)}, Metres{150e3});
  const auto p = test::problem_between(from, to);
  const auto found = trees(p, test::still_water());
  REQUIRE(found.arrives);
  REQUIRE(found.ways.size() == 3);
  const planning::MeanMotion motion{p, ocean::Ocean{test::still_water(), test::still_water()}};
  double last = 0;
  for (const auto& way : found.ways) {
    // Still water: each segment takes its length over the mean speed, to the 1e-4 of the local metric.
    for (std::size_t i = 1; i < way.size(); ++i) {
      const double length = local_offset(way[i - 1].lat, way[i - 1].lon, way[i].lat, way[i].lon).length();
      CHECK(way[i].t_s - way[i - 1].t_s == Approx(length / motion.speed()).epsilon(2e-4).margin(1e-3));
      // A share of the way to a drawn place is measured with the metric of its middle: a degree of latitude away the parallel is
      // longer by tan(28°)·π/180, one percent.
      CHECK(length <= 0.3 * 8 * 3600 * 1.02);
    }
    CHECK(distance(GeoPoint::from_kernel(way.back().lat, way.back().lon), to).si() < 1);
    const double took = way.back().t_s - way.front().t_s;
    CHECK(took >= 150e3 / motion.speed() * (1 - 1e-4));
    // The quickest first. Ways are put in order by the sum of their segments' times; here two instants of 1.8e9 s, which a double
    // holds to 2.4e-7 s, are taken from each other.
    CHECK(took >= last - 1e-6);
    last = took;
  }
}

TEST_CASE("no segment comes nearer to land than its margin") {
  const auto from = geo_point(28, -16), to = destination(from, Bearing{degrees(40)}, Metres{120e3});
  const auto chart = test::block_between(from, to, 25e3);
  auto p = test::problem_between(from, to);
  p.coast_margin = Metres{2000};
  int ways = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    p.seed = seed;
    const auto found = trees(p, test::still_water(), chart);
    INFO("seed " << seed);
    for (const auto& way : found.ways) {
      ++ways;
      for (std::size_t i = 1; i < way.size(); ++i)
        CHECK(chart.segment_is_clear(way[i - 1].lat, way[i - 1].lon, way[i].lat, way[i].lon, 2000));
    }
  }
  CHECK(ways >= 10);
}

TEST_CASE("the same seed grows the same trees, another seed others") {
  const auto from = geo_point(40, 3), to = destination(from, Bearing{degrees(200)}, Metres{100e3});
  auto p = test::problem_between(from, to);
  const auto once = ask(p, test::still_water()), again = ask(p, test::still_water());
  p.seed = 2;
  const auto other = ask(p, test::still_water());
  REQUIRE((once && again && other));
  CHECK(*once == *again);
  CHECK_FALSE(once->stints == other->stints);
}

TEST_CASE("currents that change with time are refused with where and by how much") {
  const auto from = geo_point(40, 3);
  const auto p = test::problem_between(from, destination(from, Bearing{}, Metres{100e3}));
  const test::FromFunction tide{[](double, double, double t_s) {
                                  return std::pair{0.1 * std::sin((t_s - test::kT0) / 7000), 0.0};
                                },
                                0.1};
  const auto plan = ask(p, tide);
  REQUIRE_FALSE(plan);
  CHECK(plan.error().what == planning::NoPlan::unsuited_method);
  CHECK(plan.error().message.find("here they change by 0.") != std::string::npos);
}

TEST_CASE("a work limit stops the growth, and the same limit at the same place") {
  const auto from = geo_point(40, 3), to = destination(from, Bearing{degrees(200)}, Metres{200e3});
  const auto p = test::problem_between(from, to);
  const auto still = test::still_water();
  const ocean::Ocean ocean{still, still};
  planning::Budget budget;
  budget.work = 3;
  const auto few = planning::grow_trees(p, ocean, chart::Chart{}, budget, Metres{0});
  CHECK(few.statistics.expansions == 3);
  CHECK_FALSE(few.exhausted);
  CHECK_FALSE(few.arrives);  // six segments of a sixth at most do not join in three rounds
  planning::Budget clock;
  clock.expired = [] { return true; };
  const auto cut = planning::grow_trees(p, ocean, chart::Chart{}, clock, Metres{0});
  if (cut.cut_at == 0) return;  // all ways were found before the clock was asked
  budget.work = cut.cut_at;
  const auto counted = planning::grow_trees(p, ocean, chart::Chart{}, budget, Metres{0});
  CHECK(counted.statistics == cut.statistics);
}
