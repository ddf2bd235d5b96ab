#include "core/planning/planner.hpp"

#include <catch2/catch.hpp>

#include "core/planning/cts_astar.hpp"
#include "core/planning/direct_to_goal.hpp"
#include "core/planning/ladder.hpp"
#include "core/planning/optimization.hpp"
#include "core/planning/refined_cts.hpp"
#include "tests/contract/planner_contract.hpp"

using namespace glidehelm;
using planning::NoPlan;

TEMPLATE_TEST_CASE("every planner keeps the contract", "", planning::DirectToGoal, planning::CtsAStar,
                   planning::RefinedCts, planning::Ladder, planning::Optimization, planning::IterativeOptimization) {
  test::check_planner<TestType>();
}

TEST_CASE("statistics add up") {
  planning::Statistics a{1, 2, 3};
  a += {10, 20, 30};
  CHECK(a == planning::Statistics{11, 22, 33});
}

TEST_CASE("every reason for having no plan has a word of its own") {
  CHECK(planning::word(NoPlan::start_on_land) == "start_on_land");
  CHECK(planning::word(NoPlan::goal_on_land) == "goal_on_land");
  CHECK(planning::word(NoPlan::start_outside_field) == "start_outside_field");
  CHECK(planning::word(NoPlan::goal_outside_field) == "goal_outside_field");
  CHECK(planning::word(NoPlan::no_forecast) == "no_forecast");
  CHECK(planning::word(NoPlan::boxed_in) == "boxed_in");
  CHECK(planning::word(NoPlan::out_of_budget) == "out_of_budget");
  CHECK(planning::word(NoPlan::unsuited_method) == "unsuited_method");
}
