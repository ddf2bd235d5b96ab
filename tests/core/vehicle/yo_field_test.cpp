#include "core/vehicle/yo_field.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/chart/chart.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/registry.hpp"
#include "core/vehicle/motion.hpp"
#include "core/vehicle/yo.hpp"
#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::vehicle;

namespace {

/// An eastward current that falls with depth, to nothing at 200 m: 0.2·(1 − z/200).
struct Sheared {
  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint, Depth z, double) const {
    return ocean::Sample{{MetresPerSecond{0.2 * (1 - z.below_surface.si() / 200)}, MetresPerSecond{0}}, false};
  }
  [[nodiscard]] ocean::Coverage coverage() const { return {}; }
  [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{0.2}; }
};

constexpr double kFix = 1.7e9;

}  // namespace

TEST_CASE("the depth follows from the clock, stint after stint") {
  const model::Glider glider;
  model::DiveSchedule schedule;
  schedule.first_stint = Seconds{3 * 3600.0};
  const Sheared sheared;
  const YoField yo{sheared, glider, schedule, kFix};
  CHECK(yo.depth(kFix) == 0);
  CHECK(yo.depth(kFix + 899) == 0);  // it drifts for a quarter of an hour
  for (int k = 0; k < 4; ++k) {
    const double dive = kFix + schedule.dive_time(k).count(), length = schedule.stint_length(k).count();
    for (double s = 0; s <= length; s += 97)
      CHECK(yo.depth(dive + s) ==
            Approx(yo_depth(glider, s, length)).margin(1e-4));  // instants of 1.7e9 s are kept to 2.4e-7 s
    CHECK(yo.depth(dive + length + 450) == Approx(0).margin(1e-4));
  }
}

TEST_CASE("a stint in sheared water is carried by the mean over its yo-yo") {
  const model::Glider glider;
  model::DiveSchedule schedule;
  const Sheared sheared;
  const YoField yo{sheared, glider, schedule, kFix};
  // The mean of a current that is linear in depth is the current at the mean depth, which a fine sum over the yo gives.
  const double dive = kFix + schedule.dive_time(0).count(), length = schedule.stint_length(0).count();
  double depth = 0;
  constexpr int kParts = 200'000;
  for (int k = 0; k < kParts; ++k) depth += yo_depth(glider, (k + 0.5) * length / kParts, length) / kParts;
  const auto still = test::still_water();
  const chart::Chart open;
  const Waters waters{{still, still}, open, Metres{0}};
  const auto start = geo_point(0, 0);
  const auto motion = move(waters, yo, state_at(start, dive, waters), length, {}, nullptr);
  REQUIRE_FALSE(motion.lost);
  // The integrator is held to 0.02 m a step (motion.hpp); the shear has some twelve corners in this stint.
  CHECK(distance(start, motion.end.at()).si() == Approx(0.2 * (1 - depth / 200) * length).margin(0.5));
}

TEST_CASE("a current that is the same at all depths is left as it is") {
  const test::Uniform even{0.1, -0.2};
  const YoField yo{even, {}, {}, kFix};
  for (const double t : {0.0, 1000.0, 9000.0, 123456.0})
    CHECK(*yo.sample(geo_point(1, 2), Depth{}, kFix + t) == *even.sample(geo_point(1, 2), Depth{}, 0));
}

TEST_CASE("a planner in the yo-yo arrives when its list flown in all depths does") {
  // A jet at the surface across the way. In the field of the yo-yo the planner meets the very currents that the list is flown in, but that
  // the glider's own vertical speed and law decide when it is where: within a thousandth of the way.
  const Sheared sheared;
  planning::Problem p;
  p.start = {geo_point(40, 5), kFix};
  p.goal = planning::PointGoal{geo_point(40.4, 5.1), Metres{1000}};
  p.glider.horizontal_speed = p.glider.believed_speed = MetresPerSecond{0.3};
  p.coast_margin = Metres{0};
  p.horizon_s = kFix + planning::automatic_horizon(p).count();
  const YoField yo{sheared, p.glider, p.schedule, kFix};
  const ocean::Ocean ocean{yo, sheared};
  const std::array<ocean::Ocean, 1> members{ocean};
  const chart::Chart open;
  for (const auto* method : {"direct", "cts-astar"}) {
    INFO(method);
    const auto plan = planning::planner_named(method)->plan(p, members, open, {}, {});
    REQUIRE(plan);
    REQUIRE(plan->reaches_goal());
    auto waters = planning::waters_of(p, ocean, open);
    waters.full = sheared;
    const auto flight = planning::flight_of(p);
    const auto flown = fly_list(list_for(plan->stints, flight, waters, {50, {}, model::AtEnd::loop}), flight, waters);
    REQUIRE(flown.arrival_s);
    CHECK(*flown.arrival_s - kFix == Approx(plan->arrival_s - kFix).epsilon(1e-3));
  }
}
