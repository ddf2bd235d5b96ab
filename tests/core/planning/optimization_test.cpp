#include "core/planning/optimization.hpp"

#include <catch2/catch.hpp>

#include "core/planning/cts_astar.hpp"
#include "core/planning/direct_to_goal.hpp"
#include "tests/contract/planner_contract.hpp"

using namespace glidehelm;
using planning::FirstWay;
using planning::Kernel;

namespace {

test::FromFunction uniform(double east, double north) {
  return test::FromFunction{[east, north](double, double, double) {
                              return std::pair{east, north};
                            },
                            std::hypot(east, north)};
}

Expected<planning::Plan, planning::PlanFailure> ask(const planning::Planner& planner, const planning::Problem& p,
                                                    ocean::FieldRef field, const chart::Chart& chart = {}) {
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{field, field}};
  return planner.plan(p, members, chart, {}, {});
}

/// Least distance after `stints` stints.
planning::Problem least_distance(planning::Problem p, int stints) {
  p.objective = planning::MinDistanceAt{p.start.fix_s + p.schedule.surfacing_time(stints - 1).count() + 1};
  return p;
}

/// Two eddies beside the way, one either way round, of 0.2 m/s at most: one valley holds all good ways.
ocean::AnalyticField two_eddies(GeoPoint origin) {
  ocean::AnalyticSpec spec;
  spec.kind = "gaussians";
  spec.origin = origin;
  spec.length_scale = Metres{1000};
  spec.speed_scale = MetresPerSecond{1};
  spec.gaussians = {{2000, 12, 8, 100, 0, 100, 0, 0}, {-2500, 22, -9, 120, 0, 120, 0, 0}};
  return *ocean::AnalyticField::make(spec, instant_at(test::kT0));
}

}  // namespace

TEST_CASE(
    "in a uniform current the least distance at a time is the closed form, and the heading points at the goal as it "
    "drifts") {
  // At the equator, where 120 km of WGS84 are flat to (120/6378)² = 4e-4 of the way at most.
  const auto from = geo_point(0, 0);
  const double east = 0.08, north = -0.15, goal_east = 110e3, goal_north = 60e3;
  const auto metric = LocalMetric::at(0);
  const auto to = GeoPoint::from_kernel(goal_north / metric.meridian_radius, goal_east / metric.parallel_radius);
  const auto field = uniform(east, north);
  for (const int stints : {1, 3, 6}) {
    const auto p = least_distance(test::problem_between(from, to), stints);
    const auto plan = ask(planning::Optimization{}, p, field);
    REQUIRE(plan);
    CHECK_FALSE(plan->reaches_goal());
    REQUIRE(plan->stints.size() == static_cast<std::size_t>(stints));
    const double all = p.schedule.surfacing_time(stints - 1).count(), under = stints * test::kStint;
    const double off_east = goal_east - east * all, off_north = goal_north - north * all;
    const double expected = std::hypot(off_east, off_north) - test::kSpeed * under;
    // Flat to 4e-4 of 120 km; and each stint's law ends off the held heading by what it says itself.
    double steering = 0;
    for (const auto& stint : plan->stints) steering += stint.steering_error.si();
    CHECK(std::abs(plan->remaining.si() - expected) < 50 + steering);
    // A heading that is off by a costs a²/2 of the way, so it is no sharper than that: 0.05 costs a thousandth.
    for (const auto& stint : plan->stints)
      CHECK(std::abs(std::remainder(stint.heading.from_north().si() - std::atan2(off_east, off_north), 2 * kPi)) <
            0.05);
  }
}

TEST_CASE("upstream of a current that is too strong the distance left grows as the closed form says") {
  const auto from = geo_point(0, 0), to = destination(from, Bearing{degrees(90)}, Metres{60e3});
  const auto field = uniform(-0.5, 0);
  const auto p = least_distance(test::problem_between(from, to), 3);
  const auto plan = ask(planning::Optimization{}, p, field);
  REQUIRE(plan);
  CHECK_FALSE(plan->reaches_goal());
  const double expected = 60e3 + 0.5 * p.schedule.surfacing_time(2).count() - test::kSpeed * 3 * test::kStint;
  double steering = 0;
  for (const auto& stint : plan->stints) steering += stint.steering_error.si();
  CHECK(std::abs(plan->remaining.si() - expected) < 20 + steering);
  CHECK(plan->remaining.si() > 60e3);  // where it is then, not where it has been nearest
}

TEST_CASE("every kernel finds the optimum of two and three stints that a fine grid of headings has") {
  const auto from = geo_point(36, -10);
  const auto field = two_eddies(from);
  const ocean::Ocean ocean{field, field};
  const chart::Chart open;
  const auto to = destination(from, Bearing{degrees(95)}, Metres{55e3});
  for (const int stints : {2, 3}) {
    const auto p = planning::within_objective(least_distance(test::problem_between(from, to), stints));
    const double until = p.start.fix_s + p.schedule.surfacing_time(stints - 1).count();
    planning::FlightEndings endings{p, ocean, open, Metres{0}, Metres{0}};
    const double step = (stints == 2 ? 1 : 3) * kPi / 180;
    double least = 1e18;
    std::vector<double> h(static_cast<std::size_t>(stints));
    const auto grid = [&](const auto& deeper, std::size_t k) -> void {
      if (k == h.size()) {
        least = std::min(least, endings.end(h, until).off.norm());
        return;
      }
      for (double x = 30 * kPi / 180; x < 120 * kPi / 180; x += step) {
        h[k] = x;
        deeper(deeper, k + 1);
      }
    };
    grid(grid, 0);
    // The grid's nearest headings are half a step off: its least is above the optimum by at most ½·(stints)·U·t_s·(step/2)², times
    // four for what the eddies' shear magnifies.
    const double coarse = 4 * 0.5 * stints * test::kSpeed * test::kStint * step * step / 4;
    for (const auto kernel : planning::kKernels) {
      planning::OptimizationSettings settings;
      settings.kernel = kernel;
      planning::Budget budget;
      planning::Purse purse{budget};
      planning::WayOptimizer optimizer{p, ocean, open, Metres{0}, settings, purse};
      const auto way = optimizer.improve(optimizer.straight());
      INFO(planning::word(kernel) << ", " << stints << " stints");
      REQUIRE(way.headings.size() == static_cast<std::size_t>(stints));
      CHECK(way.remaining_m < least + 1);
      CHECK(way.remaining_m > least - coarse);
      CHECK(purse.spent().expansions > 0);
    }
  }
}

TEST_CASE("the straight first way is trapped behind land, the searched one leads round it") {
  const auto still = test::still_water();
  const auto from = geo_point(28, -16), to = destination(from, Bearing{degrees(40)}, Metres{90e3});
  const auto chart = test::block_between(from, to, 25e3);
  auto p = test::problem_between(from, to);
  p.coast_margin = Metres{2000};
  planning::OptimizationSettings settings;
  settings.first = FirstWay::straight;
  const auto naive = ask(planning::Optimization{settings}, p, still, chart);
  settings.first = FirstWay::searched;
  const auto searched = ask(planning::Optimization{settings}, p, still, chart);
  REQUIRE(searched);
  CHECK(searched->reaches_goal());
  if (naive) CHECK_FALSE(planning::better_than(*naive, *searched));
  // Round the block: no shorter than the taut line past its corner with the margin, which is the way of two straight legs.
  CHECK(searched->arrival_s > p.start.fix_s + planning::still_water_time(p).count());
}

TEST_CASE("a growing number of stints arrives no later than a search, and in still water on the straight way") {
  for (auto sea : test::analytic_seas()) {
    const auto grown = ask(planning::IterativeOptimization{}, sea.problem, sea.field);
    const auto fixed = ask(planning::Optimization{}, sea.problem, sea.field);
    const auto searched = ask(planning::CtsAStar{}, sea.problem, sea.field);
    INFO(sea.name);
    REQUIRE((grown && fixed && searched));
    if (!searched->reaches_goal()) continue;
    REQUIRE((grown->reaches_goal() && fixed->reaches_goal()));
    // Both begin at a coarse search of their own; the law's lateness, 0.5 % of a short way, may fall to either.
    const double travel = searched->arrival_s - sea.problem.start.fix_s;
    CHECK(grown->arrival_s < searched->arrival_s + 0.005 * travel);
    CHECK(fixed->arrival_s < searched->arrival_s + 0.005 * travel);
  }
}

TEST_CASE("a goal that can be reached before the time of the objective is reached as early as can be") {
  const auto still = test::still_water();
  const auto from = geo_point(10, 20), to = destination(from, Bearing{degrees(10)}, Metres{30e3});
  const auto p = test::problem_between(from, to);
  const auto timely = ask(planning::Optimization{}, least_distance(p, 8), still);
  REQUIRE(timely);
  REQUIRE(timely->reaches_goal());
  CHECK(timely->arrival_s - p.start.fix_s == Approx(planning::still_water_time(p).count()).epsilon(1e-3));
}

TEST_CASE("iterative optimization says that it cannot look for a least distance") {
  const auto still = test::still_water();
  const auto from = geo_point(10, 20);
  const auto p = least_distance(test::problem_between(from, destination(from, Bearing{}, Metres{90e3})), 2);
  const auto plan = ask(planning::IterativeOptimization{}, p, still);
  REQUIRE_FALSE(plan);
  CHECK(plan.error().what == planning::NoPlan::unsuited_method);
  CHECK(plan.error().message.find("use optimization") != std::string::npos);
}
