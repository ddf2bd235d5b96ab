#include "core/planning/ladder.hpp"

#include <array>
#include <catch2/catch.hpp>

#include "core/planning/optimization.hpp"
#include "core/planning/refined_cts.hpp"
#include "core/planning/registry.hpp"
#include "core/planning/to_go.hpp"
#include "tests/bench/case_suite.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;

namespace {

Expected<planning::Plan, planning::PlanFailure> answer(const char* method, const test::Sea& sea,
                                                       const planning::Budget& budget = {}) {
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{sea.field, sea.field}};
  return planning::planner_named(method)->plan(sea.problem, members, chart::Chart{}, budget, {});
}

}  // namespace

TEST_CASE("best is never worse than any single method and wears the name of the stage that made it") {
  for (auto sea : test::analytic_seas()) {
    sea.problem.headings = 9;
    const auto best = answer("best", sea);
    INFO(sea.name);
    REQUIRE(best);
    bool labelled = best->method == "direct-refined";  // of no single method; the others have their own stints
    for (const char* method : {"direct", "cts-astar", "cts-astar-refined"}) {
      const auto single = answer(method, sea);
      REQUIRE(single);
      CHECK_FALSE(planning::better_than(*single, *best));
      labelled = labelled || (best->method == method && best->stints == single->stints);
    }
    CHECK((labelled || best->method == "iterative-optimization"));
    // That one is only asked in doubt. In the same valley it ends where refinement does, to what the flights of two lists differ by: the minutes
    // after the ring of each stint, of 30 h.
    const auto optimized = answer("iterative-optimization", sea);
    REQUIRE(optimized);
    CHECK(optimized->arrival_s >= best->arrival_s - 0.001 * (best->arrival_s - test::kT0));
  }
}

TEST_CASE("short of the goal best is behind no kernel of optimization that uses slopes") {
  // Among these islands kernels end in two valleys, more than 3 km apart at the horizon. Which of them ends in which hangs on last bits, and so on
  // the compiler; refinement alone ends some metres behind one of them at least.
  const auto sea = suite::dynamic_cases(MetresPerSecond{0.4}, 18).back();
  const std::array<ocean::Ocean, 1> members{sea.ocean()};
  const auto remaining = [&](const planning::Planner& planner) {
    const auto plan = planner.plan(sea.problem, members, sea.chart(), {}, {});
    REQUIRE(plan);
    CHECK_FALSE(plan->reaches_goal());
    return plan->remaining.si();
  };
  const double best = remaining(planning::Ladder{});
  for (const auto kernel : {planning::Kernel::quasi_newton, planning::Kernel::least_squares, planning::Kernel::sqp}) {
    const double left = remaining(planning::Optimization{planning::OptimizationSettings{.kernel = kernel}});
    INFO(planning::word(kernel) << " leaves " << left);
    CHECK(best <= left);
  }
}

TEST_CASE("searches that end in the same valley leave no doubt, and those that do not arrive leave some") {
  const test::Uniform current{0.05, 0.1};
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{current, current}};
  const chart::Chart open;
  auto p = test::problem_between(geo_point(28, -16), geo_point(28.3, -15.7));
  const auto in_doubt = [&] {
    const auto plan = planning::planner_named("cts-astar")->plan(p, members, open, {}, {});
    REQUIRE(plan);
    const planning::Budget endless;
    planning::Purse purse{endless};
    planning::SharedToGo to_go{p, members, open};
    return planning::refined({&*plan, 1}, p, members[0], open, purse, to_go).in_doubt;
  };
  CHECK_FALSE(in_doubt());
  p.horizon_s = test::kT0 + 0.7 * planning::still_water_time(p).count();
  CHECK(in_doubt());
}

TEST_CASE("the stages are told as they come, each better than the one before, the last one again at the end") {
  const auto sea = test::analytic_seas().at(3);
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{sea.field, sea.field}};
  std::vector<planning::Plan> told;
  const auto best = planning::Ladder{}.plan(sea.problem, members, chart::Chart{}, {},
                                            [&](const planning::Plan& p) { told.push_back(p); });
  REQUIRE(best);
  REQUIRE(told.size() >= 2);
  for (std::size_t i = 1; i + 1 < told.size(); ++i) CHECK(planning::better_than(told[i], told[i - 1]));
  CHECK(told.front().method == "direct");
  // Each says what had been spent until it was found, not what its own stage cost.
  for (std::size_t i = 1; i < told.size(); ++i)
    CHECK((told[i].statistics.expansions > 0 &&
           told[i].statistics.current_evaluations >= told[i - 1].statistics.current_evaluations));
  CHECK(told.back() == *best);
}

TEST_CASE("without work for a search the straight way is the answer") {
  planning::Budget nothing;
  nothing.work = 0;
  const auto best = answer("best", test::analytic_seas().at(0), nothing);
  REQUIRE(best);
  CHECK(best->method == "direct");
  CHECK(best->statistics.expansions == 0);
}

TEST_CASE("a clock that has run out leaves the straight way and says at which count the search was cut") {
  planning::Budget late;
  late.expired = [] { return true; };
  auto sea = test::analytic_seas().at(6);
  sea.problem.goal =
      planning::PointGoal{destination(sea.problem.start.fix, Bearing{degrees(60)}, Metres{52e3}), Metres{500}};
  const auto best = answer("best", sea, late);
  REQUIRE(best);
  CHECK(best->cut_at > 0);
  CHECK(best->statistics.expansions == best->cut_at);
}
