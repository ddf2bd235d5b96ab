#include "core/planning/member_plans.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/support/planning.hpp"

using namespace glidehelm;

namespace {

/// A plan through these points, the fix first: each further one is a surfacing, and the next dive is where it surfaced.
planning::Plan plan_through(const std::vector<GeoPoint>& points, double arrival_s) {
  planning::Plan plan;
  plan.status = std::isnan(arrival_s) ? planning::PlanStatus::closest_approach : planning::PlanStatus::reaches_goal;
  plan.arrival_s = arrival_s;
  for (std::size_t k = 1; k < points.size(); ++k) {
    vehicle::Stint stint;
    stint.dive = points[k - 1];
    stint.surface = points[k];
    stint.heading = Heading{geodesic(points[k - 1], points[k]).departing.from_north()};
    plan.stints.push_back(stint);
  }
  return plan;
}

const GeoPoint kFix = geo_point(0, 10);
const planning::Problem kProblem = test::problem_between(kFix, geo_point(0, 14));

}  // namespace

TEST_CASE("a plan beside the control's at a constant latitude is apart by the meridian's arc between them") {
  // Along the equator; the other way goes up to 1° north and comes back. The arc of 0° to 1° is 110574.39 m (WGS84), and the foot of
  // a place at 1° on the equator is due south: the distance is geodesic, good to a millimetre.
  const auto control = plan_through({kFix, geo_point(0, 12), geo_point(0, 14)}, test::kT0 + 1e6);
  const auto other = plan_through({kFix, geo_point(1, 11.5), geo_point(1, 12.5), geo_point(0, 14)}, test::kT0 + 1.2e6);
  const auto said = planning::member_plan(other, control, kProblem);
  REQUIRE(said.apart);
  CHECK(said.apart->si() == Approx(110574.39).margin(0.01));
  CHECK(said.travel->count() == Approx(1.2e6));
  // Due east is 90°; to 1° north and 1.5° east it is about 56°, to the left.
  CHECK(said.turn->si() == Approx(geodesic(kFix, geo_point(1, 11.5)).departing.from_north().si() - kPi / 2));
  CHECK(said.turn->si() < 0);
  CHECK(planning::member_plan(control, control, kProblem).apart == Metres{0});
  CHECK(planning::member_plan(control, control, kProblem).turn == Radians{0});
}

TEST_CASE("a way across the antimeridian is as near as the same way elsewhere") {
  const auto moved = [](double by) {
    const auto fix = geo_point(45, 178 + by);
    auto problem = test::problem_between(fix, geo_point(45, std::remainder(182 + by, 360)));
    const auto at = [&](double lat, double lon) { return geo_point(lat, std::remainder(lon + by, 360)); };
    return *planning::member_plan(plan_through({fix, at(45.3, 179.5), at(45, 182)}, test::kT0),
                                  plan_through({fix, at(44.8, 180.5), at(45, 182)}, test::kT0), problem)
                .apart;
  };
  // A millimetre: the same geodesic from other longitudes.
  CHECK(moved(0).si() == Approx(moved(-100).si()).margin(1e-3));
  CHECK(moved(0).si() > 30e3);
}

TEST_CASE("the distance between ways is that of a search along the control's way") {
  std::mt19937_64 random{77};
  std::uniform_real_distribution<double> east{0, 1.2}, north{-0.7, 0.7};
  for (int n = 0; n < 6; ++n) {
    const auto fix = geo_point(n % 2 == 0 ? 50 : -58, 20);
    const auto way = [&] {
      std::vector<GeoPoint> points{fix};
      for (int k = 0; k < 5; ++k)
        points.push_back(
            geo_point(points.back().lat.degrees() + north(random), points.back().lon.degrees() + east(random)));
      return points;
    };
    const auto a = way(), b = way();
    double expected = 0;
    for (const auto p : a) {
      double nearest = 1e9;
      for (std::size_t k = 1; k < b.size(); ++k)
        for (int step = 0; step <= 400; ++step) {
          const double share = step / 400.0;
          nearest = std::min(
              nearest,
              distance(p, geo_point(b[k - 1].lat.degrees() + share * (b[k].lat.degrees() - b[k - 1].lat.degrees()),
                                    b[k - 1].lon.degrees() + share * (b[k].lon.degrees() - b[k - 1].lon.degrees())))
                  .si());
        }
      expected = std::max(expected, nearest);
    }
    const auto said = planning::member_plan(plan_through(a, test::kT0), plan_through(b, test::kT0),
                                            test::problem_between(fix, geo_point(50, 26)));
    // The search steps by a 400th of at most 130 km: at 10 km and more from the way it is at most 163²/(2·10 km) = 1.3 m too far.
    CHECK(said.apart->si() >= expected - 2);
    CHECK(said.apart->si() < 1.01 * expected);
  }
}

TEST_CASE("the summary of plans has quantiles of what each of them has") {
  std::vector<planning::MemberPlan> plans(5);
  for (int k = 0; k < 5; ++k) {
    auto& plan = plans[static_cast<std::size_t>(k)];
    if (k < 3) plan.travel = Seconds{1000.0 + 100 * k};
    if (k < 4) plan.turn = Radians{0.1 * (k - 1)};
    if (k < 4) plan.apart = Metres{500.0 * k};
  }
  const auto all = planning::summary_of(plans);
  CHECK(all.plans == 5);
  CHECK(all.arrived == 3);
  // Of n values the share q lies (n − 1)·q places after the first.
  CHECK(all.median->count() == Approx(1100));
  CHECK(all.tenth->count() == Approx(1020));
  CHECK(all.ninetieth->count() == Approx(1180));
  CHECK(all.turned_left->si() == Approx(-0.07));
  CHECK(all.turned_right->si() == Approx(0.17));
  CHECK(all.apart_median->si() == Approx(750));
  CHECK(all.apart_most->si() == Approx(1500));
}

TEST_CASE("plans without a stint have no way and no heading") {
  const planning::Plan none;
  const auto control = plan_through({kFix, geo_point(0, 12)}, std::nan(""));
  CHECK_FALSE(planning::member_plan(none, control, kProblem).first);
  CHECK_FALSE(planning::member_plan(none, control, kProblem).apart);
  CHECK_FALSE(planning::member_plan(control, none, kProblem).turn);
  CHECK_FALSE(planning::member_plan(control, none, kProblem).travel);
  CHECK_FALSE(planning::summary_of(std::vector<planning::MemberPlan>(2)).median);
}
