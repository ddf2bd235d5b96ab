#include "core/planning/member_flight.hpp"

#include <catch2/catch.hpp>

#include "core/planning/direct_to_goal.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;

namespace {

/// A plan along the equator for still water.
struct Along {
  planning::Problem problem = test::problem_between(geo_point(0, 0), geo_point(0, 0.6), 1000);
  planning::Plan plan;
  chart::Chart chart;

  Along() {
    const test::Uniform still{0, 0};
    const std::array<ocean::Ocean, 1> members{ocean::Ocean{still, still}};
    auto found = planning::DirectToGoal{}.plan(problem, members, chart, {}, {});
    REQUIRE(found);
    plan = *found;
    REQUIRE(plan.reaches_goal());
  }
  [[nodiscard]] planning::MemberFlight in(double east, double north) const {
    const test::Uniform field{east, north};
    return planning::fly_in_member(plan, problem, ocean::Ocean{field, field}, chart);
  }
};

}  // namespace

TEST_CASE("in the member that it was planned in a plan arrives when it said") {
  const Along along;
  const auto flight = along.in(0, 0);
  REQUIRE(flight.travel);
  CHECK(flight.travel->count() == Approx(along.plan.arrival_s - test::kT0).epsilon(1e-9));
  CHECK_FALSE(flight.coast);
  CHECK_FALSE(flight.lost);
}

TEST_CASE("in members with uniform currents along the way the travel times are those of the closed form") {
  Along along;
  along.problem.glider.current_correction = 1;  // then ring and drift are steered with the current that was met
  const double way = distance(along.problem.start.fix, geo_point(0, 0.6)).si() - 1000;
  std::vector<planning::MemberFlight> flights;
  std::vector<double> times;
  for (const double c : {-0.1, -0.05, 0.05, 0.1, 0.15}) {
    flights.push_back(along.in(c, 0));
    INFO(c);
    REQUIRE(flights.back().travel);
    // Along the equator every aim lies straight ahead. A stint makes t_s·(U + c), each surface interval drifts with c, and
    // the way is flown out at U + c, or drifted out at c within an interval: that begins with the drift before the dive.
    const auto& s = along.problem.schedule;
    double t = s.time_to_dive.count(), x = c * t;
    while (x + s.stint.count() * (0.3 + c) < way) {
      x += s.stint.count() * (0.3 + c) + s.surface.count() * c;
      t += s.stint.count() + s.surface.count();
    }
    t += (way - x) / (0.3 + c);
    // The integrator is exact in a uniform current; metric and distance differ by 1e-6 of the way, the crossing of the
    // goal's circle is found to a second.
    CHECK(flights.back().travel->count() == Approx(t).epsilon(1e-5).margin(2));
    times.push_back(t);
  }
  const auto all = planning::summary_of(flights);
  CHECK(all.share() == 1);
  // Five times from the slowest to the fastest: the median is the third, 10 % lie 0.4 of the way from the last to the
  // one before, 90 % likewise from the other end.
  CHECK(all.median->count() == Approx(times[2]).epsilon(1e-5).margin(2));
  CHECK(all.tenth->count() == Approx(times[4] + 0.4 * (times[3] - times[4])).epsilon(1e-5).margin(2));
  CHECK(all.ninetieth->count() == Approx(times[0] + 0.4 * (times[1] - times[0])).epsilon(1e-5).margin(2));
}

TEST_CASE("a member whose current is stronger than the glider counts as one without arrival") {
  const Along along;
  std::vector<planning::MemberFlight> flights;
  for (const double c : {0.0, 0.05, 0.1, -0.35}) flights.push_back(along.in(c, 0));
  CHECK_FALSE(flights.back().travel);
  // Driven away from the fix, it never was nearer than there.
  CHECK(flights.back().remaining.si() == Approx(distance(geo_point(0, 0), geo_point(0, 0.6)).si()));
  const auto all = planning::summary_of(flights);
  CHECK(all.flights == 4);
  CHECK(all.arrived == 3);
  CHECK(all.share() == 0.75);
  CHECK(*all.median == *flights[1].travel);
}

TEST_CASE("without a flight that arrives there are no travel times, and the nearest coast is that of all flights") {
  std::vector<planning::MemberFlight> flights(2);
  flights[0].coast = Metres{4000};
  flights[1].coast = Metres{2500};
  const auto all = planning::summary_of(flights);
  CHECK(all.share() == 0);
  CHECK_FALSE(all.median);
  CHECK(*all.coast == Metres{2500});
  CHECK_FALSE(planning::summary_of(std::vector<planning::MemberFlight>(1)).coast);
}
