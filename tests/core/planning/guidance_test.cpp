#include "core/planning/guidance.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/lower_bound.hpp"
#include "core/planning/to_go.hpp"
#include "core/vehicle/goal_distance.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;
using planning::Guidance;
using planning::Heuristic;
using planning::Weighting;

namespace {

constexpr std::array kHeuristics{Heuristic::straight_line, Heuristic::envelope,
                                 Heuristic::cost_to_go};  // weaker ones first

/// A search whose labels have cells of their own: 100 m wide, where a stint is 8.6 km long. Then CTS-A* is A* on a tree, and what
/// theory says of that holds to the bit.
planning::Problem tree_problem(const test::Sea& sea) {
  auto p = sea.problem;
  p.headings = 8;
  p.cell = Metres{100};
  p.horizon_s = test::kT0 + 1.5 * planning::still_water_time(p).count();
  return p;
}

planning::CtsSearch found(planning::Problem p, const test::Sea& sea, const Guidance& guidance,
                          planning::HeadingSampling sampling = planning::HeadingSampling::uniform) {
  p.guidance = guidance;
  planning::CtsSettings settings;
  settings.sampling = sampling;
  return planning::search(p, {sea.field, sea.field}, chart::Chart{}, {}, settings);
}

double hours(const planning::CtsSearch& s) { return (s.arrival_s - test::kT0) / 3600; }

}  // namespace

TEST_CASE("from many places no heuristic says more than the front of all that can be reached") {
  // h bounds every vehicle on the schedule, also one that may turn at every instant: the front's. travel_s + error_s is the earliest of
  // its three runs, which is within error_s of the truth.
  std::mt19937_64 random{11};
  std::uniform_real_distribution<double> all_round{0, 2 * kPi}, way{4e3, 25e3};
  int places = 0;
  for (const auto& sea : test::analytic_seas())
    for (int i = 0; i < 3; ++i) {
      auto p = sea.problem;
      const auto goal = planning::disc_of(p);
      p.start.fix = destination(goal.centre, Bearing{Radians{all_round(random)}}, Metres{way(random)});
      if (!sea.field.coverage().contains(p.start.fix)) continue;
      p.horizon_s = test::kT0 + 2 * planning::still_water_time(p).count();
      const ocean::Ocean ocean{sea.field, sea.field};
      const auto certificate = planning::lower_bound(p, ocean, chart::Chart{}, {}, {Metres{400}, {}});
      REQUIRE(certificate);
      const auto& bound = *certificate;
      if (bound.kind != planning::Bound::Kind::arrival) continue;
      ++places;
      double before = 0;
      for (const auto heuristic : kHeuristics) {
        p.guidance.heuristic = heuristic;
        const planning::ToGo to_go{p, ocean, chart::Chart{}};
        const double lat = p.start.fix.lat.radians(), lon = p.start.fix.lon.radians();
        const double h = to_go.from_fix(lat, lon, vehicle::GoalDistance{goal}.least(lat, lon));
        INFO(sea.name << " " << static_cast<int>(heuristic) << ": " << h << " s, the front " << bound.travel_s);
        CHECK(h <= bound.travel_s + 2 * bound.error_s);
        CHECK(h >= before * (1 - 1e-12));  // and each is at least the weaker one
        before = h;
      }
    }
  WARN(places);
  CHECK(places >= 25);  // the others lie outside the sea, or the front does not come there by the horizon
}

TEST_CASE("the straight line is the distance at full speed, drifting or diving") {
  const test::Uniform below{0.1, 0}, surface{0.6, 0};
  auto p = test::problem_between(geo_point(0, 0), geo_point(0, 1));
  for (const auto& [wind, speed] : {std::pair{below, 0.4}, std::pair{surface, 0.6}}) {
    p.guidance.heuristic = Heuristic::straight_line;
    const planning::ToGo straight{p, {below, wind}, chart::Chart{}};
    p.guidance.heuristic = Heuristic::envelope;
    const planning::ToGo envelope{p, {below, wind}, chart::Chart{}};
    for (double d = 600; d < 200e3; d *= 1.3) {
      CHECK(straight.from_surfacing(0, 0, d) == Approx((d - 500) / speed));
      CHECK(straight.from_fix(0, 0, d) == Approx((d - 500) / speed));
      CHECK(envelope.from_surfacing(0, 0, d) >= straight.from_surfacing(0, 0, d) * (1 - 1e-12));
    }
    CHECK(straight.from_surfacing(0, 0, 499) == 0);
  }
}

TEST_CASE("unweighted every heuristic finds the same arrival, and a stronger one expands no more") {
  // On a tree A* with a consistent h expands exactly the labels with f below the arrival it finds: a greater h, fewer of them.
  std::array<std::uint64_t, kHeuristics.size()> sum{};
  for (const auto& sea : test::analytic_seas()) {
    const auto p = tree_problem(sea);
    const auto first = found(p, sea, {kHeuristics.front(), Weighting::none, 0});
    REQUIRE_FALSE(std::isnan(first.arrival_s));
    std::uint64_t before = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t i = 0; i < kHeuristics.size(); ++i) {
      const auto s = found(p, sea, {kHeuristics[i], Weighting::none, 0});
      INFO(sea.name << " " << i << ": " << hours(s) << " h after " << s.statistics.expansions << " expansions");
      CHECK(s.exhausted);
      CHECK(s.arrival_s == first.arrival_s);
      CHECK(s.statistics.expansions <= before);
      before = s.statistics.expansions;
      sum[i] += before;
    }
  }
  for (std::size_t i = 1; i < sum.size(); ++i) CHECK(sum[i] < sum[i - 1]);
}

TEST_CASE("a weight of epsilon costs at most that share of the time, and saves expansions") {
  for (const auto heuristic : kHeuristics) {
    std::uint64_t none = 0;
    for (const double epsilon : {0.0, 0.1, 1.0}) {
      std::uint64_t constant = 0, by_depth = 0;
      for (const auto& sea : test::analytic_seas()) {
        const auto p = tree_problem(sea);
        const auto best = found(p, sea, {heuristic, Weighting::none, epsilon});
        const auto all_the_way = found(p, sea, {heuristic, Weighting::constant, epsilon});
        const auto at_first = found(p, sea, {heuristic, Weighting::by_depth, epsilon});
        INFO(sea.name << " ε = " << epsilon << ": " << hours(best) << " h, " << hours(all_the_way) << " h, "
                      << hours(at_first) << " h");
        for (const auto& s : {all_the_way, at_first}) {
          CHECK(hours(s) >= hours(best));
          CHECK(hours(s) <= (1 + epsilon) * hours(best) * (1 + 1e-12));
        }
        if (epsilon == 0) none += best.statistics.expansions;
        constant += all_the_way.statistics.expansions;
        by_depth += at_first.statistics.expansions;
      }
      INFO("ε = " << epsilon << ": " << none << " expansions without, " << constant << " static, " << by_depth
                  << " dynamic");
      if (epsilon == 0) {
        CHECK(constant == none);
        CHECK(by_depth == none);
      } else {
        CHECK(constant < by_depth);  // the dynamic one weighs less and less
        CHECK(by_depth < none);
      }
    }
  }
}

TEST_CASE("the weight of the dynamic way falls to nothing at the anticipated depth") {
  const Guidance g{Heuristic::envelope, Weighting::by_depth, 0.4};
  CHECK(g.factor(0, 10) == Approx(1.4));
  CHECK(g.factor(5, 10) == Approx(1.2));
  CHECK(g.factor(10, 10) == 1.0);
  CHECK(g.factor(25, 10) == 1.0);
  CHECK(Guidance{Heuristic::envelope, Weighting::constant, 0.4}.factor(25, 10) == Approx(1.4));
  CHECK(Guidance{Heuristic::envelope, Weighting::none, 0.4}.factor(0, 10) == 1.0);
}

TEST_CASE("a weighted search does not take its weight for proof that the horizon is too near") {
  // One per cent more than the best arrival is left: the weighted f of every label is beyond the horizon, g + h is not.
  for (const auto& sea : test::analytic_seas()) {
    auto p = tree_problem(sea);
    const auto best = found(p, sea, {});
    p.horizon_s = test::kT0 + 1.01 * (best.arrival_s - test::kT0);
    for (const auto weighting : {Weighting::constant, Weighting::by_depth}) {
      const auto s = found(p, sea, {Heuristic::envelope, weighting, 10});
      INFO(sea.name << ": " << hours(s) << " h, best " << hours(best) << " h");
      CHECK(s.arrival_s <= p.horizon_s);
    }
    // And where it is too near all say so, with the same nearest place: nothing that may arrive was left out.
    p.horizon_s = test::kT0 + 0.99 * (best.arrival_s - test::kT0);
    for (const auto weighting : {Weighting::none, Weighting::constant}) {
      const auto s = found(p, sea, {Heuristic::envelope, weighting, 10});
      CHECK(std::isnan(s.arrival_s));
      CHECK(s.exhausted);
      CHECK(s.stopped.horizon);
    }
  }
}

TEST_CASE("drawn headings are led and weighted as uniform ones") {
  std::uint64_t plain = 0, weighted = 0;
  for (const auto& sea : test::analytic_seas()) {
    auto p = sea.problem;
    p.cell = Metres{1000};
    const auto adaptive = planning::HeadingSampling::adaptive;
    const auto best = found(p, sea, {Heuristic::envelope}, adaptive),
               quick = found(p, sea, {Heuristic::envelope, Weighting::constant, 0.5}, adaptive);
    CHECK_FALSE(std::isnan(quick.arrival_s));
    plain += best.statistics.expansions;
    weighted += quick.statistics.expansions;
  }
  CHECK(weighted < plain);
}
