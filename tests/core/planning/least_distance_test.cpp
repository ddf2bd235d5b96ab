#include <catch2/catch.hpp>

#include "core/planning/cts_astar.hpp"
#include "core/planning/registry.hpp"
#include "tests/contract/planner_contract.hpp"

using namespace glidehelm;

// MinDistanceAt: as near to the goal as can be at the last surfacing that is not later (Thesis 3.1.2).

namespace {

Expected<planning::Plan, planning::PlanFailure> ask(const std::string& method, const planning::Problem& p,
                                                    ocean::FieldRef field) {
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{field, field}};
  return planning::planner_named(method)->plan(p, members, chart::Chart{}, {}, {});
}

planning::Problem least_distance(GeoPoint from, GeoPoint to, int stints) {
  auto p = test::problem_between(from, to);
  p.objective = planning::MinDistanceAt{p.start.fix_s + p.schedule.surfacing_time(stints - 1).count() + 600};
  return p;
}

}  // namespace

TEST_CASE("in still water every method that can is as far on its way as stints allow") {
  const auto from = geo_point(40, 3), to = destination(from, Bearing{degrees(220)}, Metres{150e3});
  const auto p = least_distance(from, to, 5);
  for (const char* method : {"direct", "cts-astar", "cts-astar-refined", "optimization", "best"}) {
    const auto plan = ask(method, p, test::still_water());
    INFO(method);
    REQUIRE(plan);
    CHECK_FALSE(plan->reaches_goal());
    CHECK(plan->stints.size() == 5);
    // A thousandth of the way for headings of the search and the bend of the rhumb line; the law's own errors are along the track.
    double steering = 0;
    for (const auto& stint : plan->stints) steering += stint.steering_error.si();
    CHECK(std::abs(plan->remaining.si() - (150e3 - 5 * test::kSpeed * test::kStint)) < 150 + steering);
    CHECK(plan->remaining == distance(plan->stints.back().surface, to));
  }
}

TEST_CASE("carried off by a current that is too strong the least distance is the closed form") {
  // Nothing comes nearer than d + c·T − U·n·t_s: straight against it all the time. The searches' headings hold that direction.
  const auto from = geo_point(0, 0), to = destination(from, Bearing{degrees(90)}, Metres{60e3});
  const test::Uniform west{-0.5, 0};
  const auto p = least_distance(from, to, 4);
  const double expected = 60e3 + 0.5 * p.schedule.surfacing_time(3).count() - test::kSpeed * 4 * test::kStint;
  REQUIRE(expected > 60e3);
  for (const char* method : {"direct", "cts-astar", "cts-astar-refined", "optimization", "best"}) {
    const auto plan = ask(method, p, west);
    INFO(method);
    REQUIRE(plan);
    REQUIRE(plan->stints.size() == 4);
    double steering = 0;
    for (const auto& stint : plan->stints) steering += stint.steering_error.si();
    CHECK(std::abs(plan->remaining.si() - expected) < 20 + steering);
  }
}

TEST_CASE("on every analytic sea the search and the optimisation are no farther from the goal than the straight way") {
  for (auto sea : test::analytic_seas()) {
    sea.problem.goal =
        planning::PointGoal{destination(sea.problem.start.fix, Bearing{degrees(75)}, Metres{55e3}), Metres{500}};
    sea.problem.horizon_s = test::kT0 + 20 * 86400;
    sea.problem.objective = planning::MinDistanceAt{test::kT0 + sea.problem.schedule.surfacing_time(2).count() + 60};
    const auto direct = ask("direct", sea.problem, sea.field), best = ask("best", sea.problem, sea.field),
               optimal = ask("optimization", sea.problem, sea.field);
    INFO(sea.name);
    REQUIRE(direct);
    REQUIRE(best);
    REQUIRE(optimal);
    CHECK_FALSE(planning::better_than(*direct, *best));
    const ocean::Ocean ocean{sea.field, sea.field};
    test::check_continuity(*best, sea.problem, ocean, chart::Chart{});
    if (direct->reaches_goal()) continue;
    // Its optimum is that of held headings; flown by the law it may fall behind by what its stints say.
    double steering = 0;
    for (const auto& stint : optimal->stints) steering += stint.steering_error.si();
    CHECK(optimal->remaining.si() < direct->remaining.si() + steering + 1);
  }
}

TEST_CASE("methods that know the earliest arrival alone say so") {
  const auto from = geo_point(40, 3);
  const auto p = least_distance(from, destination(from, Bearing{}, Metres{150e3}), 3);
  for (const auto& method : planning::method_names()) {
    const auto plan = ask(method, p, test::still_water());
    INFO(method);
    if (plan) {
      CHECK(plan->stints.size() == 3);
      continue;
    }
    CHECK(plan.error().what == planning::NoPlan::unsuited_method);
    CHECK(plan.error().message.find(method) != std::string::npos);
  }
}

TEST_CASE("the objective is the least distance only while a stint can still surface by its time") {
  auto p = test::problem_between(geo_point(40, 3), geo_point(41, 3));
  const double first = p.start.fix_s + p.schedule.surfacing_time(0).count();
  CHECK(planning::objective_at(std::nullopt, p) == planning::Objective{planning::MinTime{}});
  CHECK(planning::objective_at(first - 1, p) == planning::Objective{planning::MinTime{}});
  CHECK(planning::objective_at(first, p) == planning::Objective{planning::MinDistanceAt{first}});
  p.horizon_s = first + 1e6;
  p.objective = planning::MinDistanceAt{first};
  CHECK(planning::within_objective(p).horizon_s == first);
  CHECK(planning::stints_within(planning::within_objective(p)) == 1);
  p.objective = planning::MinTime{};
  CHECK(planning::within_objective(p) == p);
}
