#include "core/planning/flown_refinement.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <vector>

#include "core/planning/cts_astar.hpp"
#include "core/planning/direct_to_goal.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/link_chain.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;

namespace {

planning::Plan searched(const planning::Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart) {
  const std::array<ocean::Ocean, 1> members{ocean};
  const auto plan = planning::CtsAStar{}.plan(problem, members, chart, {}, {});
  REQUIRE(plan);
  return *plan;
}

}  // namespace

TEST_CASE("straight through still water no flight is earlier") {
  const auto still = test::still_water();
  const ocean::Ocean ocean{still, still};
  const auto p = test::problem_between(geo_point(0, 0), geo_point(0, 0.5));
  const chart::Chart open;
  const std::array<ocean::Ocean, 1> members{ocean};
  const auto direct = planning::DirectToGoal{}.plan(p, members, open, {}, {});
  REQUIRE(direct);
  const auto refined = planning::refine_flown(*direct, p, ocean, open, {});
  // The straight line is the shortest: what a flight could win is the rounding of its steps, centimetres of 30 km.
  if (refined.flown) CHECK(*refined.flown->arrival_s == Approx(direct->arrival_s).margin(1.0));
  // Nothing is promised, so one round is measured and no step is flown beside the flight of the plan itself.
  CHECK(refined.statistics.expansions == 1);
  CHECK(refined.statistics.cost_evaluations == (planning::kLinkLanes + 1) * direct->stints.size());
}

TEST_CASE(
    "a refined flight is flown by the law, is earlier than the plan, and no heading of it can be turned to advantage") {
  int earlier = 0;
  for (const int correction : {0, 1})
    for (auto sea : test::analytic_seas()) {
      sea.problem.glider.current_correction = correction;
      const ocean::Ocean ocean{sea.field, sea.field};
      const chart::Chart open;
      const auto plan = searched(sea.problem, ocean, open);
      if (!plan.reaches_goal()) continue;
      const auto refined = planning::refine_flown(plan, sea.problem, ocean, open, {});
      INFO(sea.name << ", correction " << correction);
      if (!refined.flown) continue;
      REQUIRE(refined.flown->arrival_s);
      CHECK(*refined.flown->arrival_s < plan.arrival_s);
      ++earlier;
      std::vector<Heading> wanted;
      for (const auto& stint : refined.flown->stints) wanted.push_back(stint.heading);
      const auto waters = planning::waters_of(sea.problem, ocean, open);
      const auto flight = planning::flight_of(sea.problem);
      const double time = *refined.flown->arrival_s - test::kT0;
      const auto again = vehicle::fly_headings(wanted, flight, waters);
      REQUIRE(again.arrival_s);
      CHECK(*again.arrival_s - test::kT0 == Approx(time).margin(1e-3));
      // At an optimum a turn by ε gains nothing to first order. Rounds end below 3e-6 of some 30 h, 0.3 s, won or promised, or where none of eighteen steps is
      // earlier: the least share of a damped one is a hundredth of a turn, so of a turn of 1° that would gain g a step that gains 0.02·g is
      // looked for. 0.3 s of that are 15 s.
      for (std::size_t k = 0; k < wanted.size(); ++k)
        for (const double turn : {-1.0, 1.0}) {
          auto other = wanted;
          other[k] = other[k] + Radians{turn * kDegree};
          const auto flown = vehicle::fly_headings(other, flight, waters);
          if (flown.arrival_s) CHECK(*flown.arrival_s - test::kT0 > time - 15);
        }
    }
  CHECK(earlier >= 10);  // of 22: a search with eighteen headings leaves something in most seas
}

TEST_CASE("a refined flight keeps clear of land") {
  const auto still = test::still_water();
  const ocean::Ocean ocean{still, still};
  const auto p = test::problem_between(geo_point(0, 0), geo_point(0, 0.5));
  chart::Area island{"island", {}};
  for (int i = 0; i < 36; ++i)
    island.vertices.push_back(destination(geo_point(0.01, 0.25), Bearing{degrees(10.0 * i)}, Metres{4000}));
  const chart::Chart chart{{nullptr, {}, {island}}};
  const auto plan = searched(p, ocean, chart);
  REQUIRE(plan.reaches_goal());
  const auto refined = planning::refine_flown(plan, p, ocean, chart, {});
  REQUIRE(refined.flown);
  CHECK(*refined.flown->arrival_s < plan.arrival_s);
  // Flown with more margin than asked for, by nearly the half per cent of a stint's way that is kept for other integrators, it still arrives.
  std::vector<Heading> wanted;
  for (const auto& stint : refined.flown->stints) wanted.push_back(stint.heading);
  auto waters = planning::waters_of(p, ocean, chart);
  waters.margin = p.coast_margin + 0.0049 * (p.glider.horizontal_speed * p.schedule.stint);
  const auto flown = vehicle::fly_headings(wanted, planning::flight_of(p), waters);
  REQUIRE(flown.arrival_s);
  CHECK(*flown.arrival_s - *refined.flown->arrival_s == Approx(0).margin(1e-3));
  // A glider that must keep twice the margin more than this way does is left with its plan.
  auto strict = p;
  strict.coast_margin = p.coast_margin + Metres{2000};
  CHECK_FALSE(planning::refine_flown(plan, strict, ocean, chart, {}).flown);
}

TEST_CASE("refinement of a flight stops at its work, says where a clock cut it, and leaves what does not arrive") {
  auto sea = test::analytic_seas().back();
  const ocean::Ocean ocean{sea.field, sea.field};
  const chart::Chart open;
  const auto plan = searched(sea.problem, ocean, open);
  REQUIRE(plan.reaches_goal());
  planning::Budget one;
  one.work = 1;
  CHECK(planning::refine_flown(plan, sea.problem, ocean, open, one).statistics.expansions == 1);
  planning::Budget over;
  over.expired = [] { return true; };
  const auto cut = planning::refine_flown(plan, sea.problem, ocean, open, over);
  CHECK(cut.cut);
  CHECK_FALSE(cut.flown);
  auto lost = plan;
  lost.status = planning::PlanStatus::closest_approach;
  CHECK_FALSE(planning::refine_flown(lost, sea.problem, ocean, open, {}).flown);
}
