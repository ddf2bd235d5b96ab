#include "core/planning/refinement.hpp"

#include <catch2/catch.hpp>

#include "core/planning/cts_astar.hpp"
#include "core/planning/path_keeping.hpp"
#include "core/planning/purse.hpp"
#include "core/planning/refined_cts.hpp"
#include "tests/core/planning/exhaustive.hpp"
#include "tests/support/planning.hpp"
#include "tests/support/random_sea.hpp"

using namespace glidehelm;
using planning::Problem;
using planning::Refined;

namespace {

Heading turned(Heading h, double degrees_right) { return h + Radians{degrees_right * kDegree}; }

/// Seconds from the fix to the entry into the goal, held headings flown by the exact integrator; infinite without one.
double exact_travel_time(std::span<const Heading> headings, const Problem& problem, const ocean::Ocean& ocean,
                         const chart::Chart& chart) {
  const auto waters = planning::waters_of(problem, ocean, chart);
  const auto goal = planning::disc_of(problem);
  auto at = vehicle::state_at(problem.start.fix, problem.start.fix_s, waters);
  for (std::size_t k = 0; k < headings.size(); ++k) {
    const int n = static_cast<int>(k);
    const auto drift = vehicle::move(waters, ocean.surface, at, problem.schedule.drift_before(n).count(), {}, &goal);
    if (drift.arrival_s) return *drift.arrival_s - problem.start.fix_s;
    const auto dive = vehicle::move(waters, ocean.dive, drift.end, problem.schedule.stint_length(n).count(),
                                    vehicle::WaterVelocity::of(headings[k], problem.glider.horizontal_speed), &goal);
    if (dive.arrival_s) return *dive.arrival_s - problem.start.fix_s;
    if (drift.lost || dive.lost) break;
    at = dive.end;
  }
  return std::numeric_limits<double>::infinity();
}

/// Eddies and a mean current, and a way of about twelve stints through them.
struct RandomWay {
  std::vector<ocean::AnalyticField> fields;
  std::unique_ptr<ocean::FieldSum> sum;
  Problem problem;
  [[nodiscard]] ocean::Ocean ocean() const { return {*sum, *sum}; }
};
RandomWay random_way(std::uint64_t seed) {
  const auto from = geo_point(28.0, -16.0);
  RandomWay way;
  for (const auto& spec : test::random_sea({seed}, from, 0.25, 0.03, -0.02))
    way.fields.push_back(*ocean::AnalyticField::make(spec, instant_at(test::kT0), test::box_around(from, 2.0)));
  std::vector<ocean::FieldRef> parts(way.fields.begin(), way.fields.end());
  way.sum = std::make_unique<ocean::FieldSum>(std::move(parts));
  way.problem = test::problem_between(from, destination(from, Bearing{degrees(40)}, Metres{110e3}), 1000);
  way.problem.headings = 18;
  return way;
}

planning::CtsSearch searched(const RandomWay& way) {
  return planning::search(way.problem, way.ocean(), chart::Chart{}, {}, {});
}

}  // namespace

TEST_CASE("in still water a crooked way becomes the straight one") {
  const auto still = test::still_water();
  const ocean::Ocean ocean{still, still};
  const auto from = geo_point(28.0, -16.0);
  auto problem = test::problem_between(from, destination(from, Bearing{degrees(70)}, Metres{60e3}));
  std::vector<Heading> crooked;
  for (int k = 0; k < 12; ++k) crooked.push_back(turned(Heading{degrees(70)}, k % 2 == 0 ? 40 : -40));
  const auto refined = planning::refine(crooked, problem, ocean, chart::Chart{}, Metres{0}, {});
  // The straight way takes still_water_time; a turn of ε on a stint of length l costs l·ε²/2. Polishing ends when a round is worth
  // less than half a metre, 1.7 s at 0.3 m/s; the metric's 1e-4 of the way is 20 s.
  CHECK(refined.arrival_s - test::kT0 == Approx(planning::still_water_time(problem).count()).margin(25));
  CHECK(refined.headings.size() < crooked.size());
}

TEST_CASE("in a uniform current the refined way is Zermelo's straight one") {
  const test::Uniform current{0.08, -0.12};
  const ocean::Ocean ocean{current, current};
  const auto from =
      geo_point(0.0, 10.0);  // at the equator a uniform current is uniform in the plane to 1e-4 over 60 km
  auto problem = test::problem_between(from, destination(from, Bearing{degrees(30)}, Metres{60e3}));
  std::vector<Heading> crooked;
  for (int k = 0; k < 14; ++k) crooked.push_back(turned(Heading{degrees(30)}, k % 2 == 0 ? 35 : -35));
  const auto refined = planning::refine(crooked, problem, ocean, chart::Chart{}, Metres{0}, {});
  REQUIRE_FALSE(std::isnan(refined.arrival_s));
  // Earliest T with |D − c·T| − r = U·(time under water within T): by bisection on the schedule.
  const auto& schedule = problem.schedule;
  const auto underwater = [&](double t) {
    double sum = 0;
    for (int k = 0; schedule.dive_time(k).count() < t; ++k)
      sum += std::min(t - schedule.dive_time(k).count(), schedule.stint_length(k).count());
    return sum;
  };
  const double east = 60e3 * std::sin(30 * kDegree), north = 60e3 * std::cos(30 * kDegree);
  double low = 0, high = 20 * 86400;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * (low + high);
    const double left = std::hypot(east - current.east * t, north - current.north * t) - 500 - 0.3 * underwater(t);
    (left > 0 ? low : high) = t;
  }
  // The plane stands for the ellipsoid to 1e-4 of 60 km: 6 m, 20 s at 0.3 m/s, and the last half metre of polishing.
  CHECK(refined.arrival_s - test::kT0 == Approx(high).margin(25));
}

TEST_CASE("no heading of a refined way can be turned to advantage") {
  for (const std::uint64_t seed : {11U, 12U, 13U}) {
    const auto way = random_way(seed);
    const auto found = searched(way);
    REQUIRE_FALSE(std::isnan(found.arrival_s));
    auto refined = planning::refine(found.headings, way.problem, way.ocean(), chart::Chart{}, Metres{0}, {});
    INFO("seed " << seed << ", " << refined.rounds << " rounds");
    const double time = exact_travel_time(refined.headings, way.problem, way.ocean(), chart::Chart{});
    CHECK(time <= exact_travel_time(found.headings, way.problem, way.ocean(), chart::Chart{}));
    // At an optimum a turn by ε gains nothing to first order. Half a metre is left of the last round and the lanes' step is good to
    // 2e-4 of a stint (2 m, 6 s) in where it puts the optimum: of a turn of 1° a gain of at most 10 s remains.
    for (std::size_t k = 0; k < refined.headings.size(); ++k)
      for (const double turn : {-1.0, 1.0}) {
        auto other = refined.headings;
        other[k] = turned(other[k], turn);
        CHECK(exact_travel_time(other, way.problem, way.ocean(), chart::Chart{}) > time - 10);
      }
  }
}

TEST_CASE("whatever search it begins with, the refined way is the same") {
  const auto way = random_way(14);
  std::vector<double> arrivals;
  for (const int headings : {12, 18, 36}) {
    auto problem = way.problem;
    problem.headings = headings;
    const auto found = planning::search(problem, way.ocean(), chart::Chart{}, {}, {});
    const auto refined = planning::refine(found.headings, problem, way.ocean(), chart::Chart{}, Metres{0}, {});
    arrivals.push_back(refined.arrival_s - test::kT0);
  }
  // Each ends within half a metre, 1.7 s, of the bottom of its valley; the sea has one that all searches find.
  CHECK(arrivals[0] == Approx(arrivals[1]).margin(5));
  CHECK(arrivals[2] == Approx(arrivals[1]).margin(5));
}

TEST_CASE("refined plans are no later than every sequence on twenty-four headings, and than the searched ones") {
  for (auto sea : test::analytic_seas()) {
    sea.problem.headings = 18;
    const ocean::Ocean ocean{sea.field, sea.field};
    const auto found = planning::search(sea.problem, ocean, chart::Chart{}, {}, {});
    REQUIRE_FALSE(std::isnan(found.arrival_s));
    const auto refined = planning::refine(found.headings, sea.problem, ocean, chart::Chart{}, Metres{0}, {});
    const double time = refined.arrival_s - test::kT0;
    const double exhaustive = test::Exhaustive{sea.problem, sea.field, 24, 6, time * 1.001}.travel_time();
    INFO(sea.name << ": searched " << found.arrival_s - test::kT0 << " refined " << time << " exhaustive "
                  << exhaustive);
    // The exhaustive search may lie in another valley by a little and integrates with 20 min midpoint steps (1e-4).
    CHECK(time <= exhaustive * 1.0005);
    CHECK(time <= found.arrival_s - test::kT0 + 5);
  }
}

TEST_CASE("round an island the way is as short as a string, and keeps the margin") {
  const auto still = test::still_water();
  const ocean::Ocean ocean{still, still};
  const auto from = geo_point(0.0, 10.0), to = destination(from, Bearing{degrees(90)}, Metres{160e3});
  constexpr double kRadius = 15e3, kMargin = 2000;
  const auto centre = destination(from, Bearing{degrees(90)}, Metres{80e3});
  chart::Area island{"island", {}};
  for (int i = 0; i < 90; ++i)
    island.vertices.push_back(destination(centre, Bearing{degrees(4.0 * i)}, Metres{kRadius}));
  const chart::Chart chart{{nullptr, {}, {island}}};
  auto problem = test::problem_between(from, to, 1000);
  problem.coast_margin = Metres{kMargin};
  const auto found = planning::search(problem, ocean, chart, {}, {Metres{100}, {}, 1e18});
  REQUIRE_FALSE(std::isnan(found.arrival_s));
  const auto refined = planning::refine(found.headings, problem, ocean, chart, Metres{kMargin}, {});
  REQUIRE(refined.kept_margin);
  // Two tangents and the arc between them round the circle of island and margin.
  const double r = kRadius + kMargin, half = 80e3, angle = std::acos(r / half);
  const double string = 2 * std::sqrt(half * half - r * r) + r * (kPi - 2 * angle) - 1000;
  const double least = problem.schedule.travel_time(Seconds{string / 0.3}).count();
  const double time = exact_travel_time(refined.headings, problem, ocean, chart);
  CHECK(time >= least - 30);
  // Stints are chords, 8.6 km long, of a circle of 17 km: their middle keeps clear, so their ends lie up to l²/8r = 0.55 km outside, and
  // the arc of 0.43 rad is longer by that much of its radius: 0.3 km of 161. The toll holds another 0.1 km off. Asked: 0.5 %.
  CHECK(time <= 1.005 * least);
  CHECK(time <= found.arrival_s - test::kT0);
}

TEST_CASE("a goal that is not reached is come nearer to") {
  auto way = random_way(15);
  way.problem.horizon_s = test::kT0 + way.problem.schedule.surfacing_time(5).count() + 1;
  const auto found = searched(way);
  REQUIRE(std::isnan(found.arrival_s));
  const auto refined = planning::refine(found.headings, way.problem, way.ocean(), chart::Chart{}, Metres{0}, {});
  CHECK(std::isnan(refined.arrival_s));
  CHECK(refined.headings.size() == found.headings.size());
  CHECK(refined.remaining_m < found.nearest_m * 1.01);
  const auto more = planning::refine(refined.headings, way.problem, way.ocean(), chart::Chart{}, Metres{0}, {});
  CHECK(more.remaining_m <= refined.remaining_m + 0.5);
  CHECK(more.remaining_m == Approx(refined.remaining_m).margin(20));
}

TEST_CASE("refinement stops at its work, says where a clock cut it, and gives the same headings again") {
  const auto way = random_way(11);
  const auto found = searched(way);
  const auto run = [&](const planning::Budget& budget) {
    return planning::refine(found.headings, way.problem, way.ocean(), chart::Chart{}, Metres{0}, budget);
  };
  planning::Budget none, one, late;
  none.work = 0;
  one.work = 1;
  int asked = 0;
  late.expired = [&asked] { return ++asked > 2; };
  CHECK(run(none).rounds == 0);
  CHECK(run(one).statistics.expansions == 1);
  const auto cut = run(late);
  REQUIRE(cut.cut);
  planning::Budget again;
  again.work = cut.statistics.expansions;
  CHECK(run(again).headings == cut.headings);
  CHECK(run({}).headings == run({}).headings);
}

TEST_CASE("a way that leaves the margin is told apart and left alone") {
  const auto still = test::still_water();
  const ocean::Ocean ocean{still, still};
  const auto from = geo_point(0.0, 10.0), to = destination(from, Bearing{degrees(90)}, Metres{60e3});
  chart::Area island{"island", {}};
  const auto centre = destination(from, Bearing{degrees(90)}, Metres{30e3});
  for (int i = 0; i < 12; ++i) island.vertices.push_back(destination(centre, Bearing{degrees(30.0 * i)}, Metres{5e3}));
  const chart::Chart chart{{nullptr, {}, {island}}};
  auto problem = test::problem_between(from, to, 1000);
  const std::vector<Heading> through(8, Heading{degrees(90)});
  const auto refined = planning::refine(through, problem, ocean, chart, Metres{1000}, {});
  CHECK_FALSE(refined.kept_margin);
  CHECK(refined.rounds == 0);
}

TEST_CASE("the headings of a plan lead lanes to where the plan surfaces") {
  const auto way = random_way(12);
  const auto ocean = way.ocean();
  const std::array<ocean::Ocean, 1> members{ocean};
  const auto plan = planning::CtsAStar{}.plan(way.problem, members, chart::Chart{}, {}, {});
  REQUIRE(plan);
  const auto headings = planning::headings_of(*plan, way.problem, ocean, chart::Chart{});
  const auto waters_chart = chart::Chart{};
  const auto waters = planning::waters_of(way.problem, ocean, waters_chart);
  auto at = vehicle::state_at(way.problem.start.fix, way.problem.start.fix_s, waters);
  for (std::size_t k = 0; k + 1 < headings.size(); ++k) {
    const int n = static_cast<int>(k);
    at = vehicle::move(waters, ocean.surface, at, way.problem.schedule.drift_before(n).count(), {}, nullptr).end;
    at = vehicle::move(waters, ocean.dive, at, way.problem.schedule.stint_length(n).count(),
                       vehicle::WaterVelocity::of(headings[k], way.problem.glider.horizontal_speed), nullptr)
             .end;
    // Headings are chosen across the track. Along it the law flies elsewhere for the last 5 % of the first stint (430 m: nothing is
    // measured yet, decision 016) and for 1 % of the others, and that adds up.
    CHECK(distance(at.at(), plan->stints[k].surface).si() < 430 + 90.0 * static_cast<double>(k));
  }
}
