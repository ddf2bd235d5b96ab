#include "core/planning/flight.hpp"

#include <catch2/catch.hpp>

#include "tests/support/planning.hpp"

using namespace glidehelm;

TEST_CASE("an arrival beats none, an earlier one a later one, a nearer approach a farther one, a tie is not better") {
  planning::Plan arrives, later, near, far;
  arrives.status = later.status = planning::PlanStatus::reaches_goal;
  arrives.arrival_s = 100;
  later.arrival_s = 101;
  near.remaining = Metres{10};
  far.remaining = Metres{20};
  CHECK(planning::better_than(arrives, later));
  CHECK_FALSE(planning::better_than(later, arrives));
  CHECK_FALSE(planning::better_than(arrives, arrives));
  CHECK(planning::better_than(later, near));
  CHECK_FALSE(planning::better_than(near, later));
  CHECK(planning::better_than(near, far));
  CHECK_FALSE(planning::better_than(near, near));
}

TEST_CASE("the still-water time is the way less the radius over the speed, on the dive schedule") {
  const auto from = geo_point(28, -16);
  auto p = test::problem_between(from, destination(from, Bearing{degrees(30)}, Metres{20e3}), 2000);
  // 60000 s under water: two whole stints of 28800 s and one begun, so two surface intervals and the time to dive.
  CHECK(planning::still_water_time(p).count() == Approx(60000 + 3 * 900).margin(0.01));
  p.goal = planning::PointGoal{from, Metres{2000}};
  CHECK(planning::still_water_time(p).count() == Approx(900));
}

TEST_CASE("the automatic horizon is three times the still-water time, and never less than twelve stints") {
  const auto from = geo_point(28, -16);
  auto p = test::problem_between(from, destination(from, Bearing{degrees(30)}, Metres{200e3}), 2000);
  CHECK(planning::automatic_horizon(p) == 3.0 * planning::still_water_time(p));
  p.goal = planning::PointGoal{destination(from, Bearing{degrees(30)}, Metres{4e3}), Metres{2000}};
  // Twelve stints of 28800 s, the time to dive and eleven surface intervals of 900 s.
  CHECK(planning::automatic_horizon(p).count() == Approx(12 * 28800 + 12 * 900));
}

TEST_CASE("an end in the water of field and chart has no complaint, also inside the margin to an area") {
  const auto still = test::still_water();
  const auto home = geo_point(28, -16);
  auto p = test::problem_between(home, destination(home, Bearing{degrees(90)}, Metres{20e3}));
  chart::ChartSources sources;
  chart::Area area;
  area.name = "area";
  for (const double bearing : {200.0, 160.0, 120.0, 240.0})
    area.vertices.push_back(
        destination(home, Bearing{degrees(bearing)}, Metres{bearing > 150 && bearing < 210 ? 500 : 5e3}));
  sources.keep_out = {area};
  p.coast_margin = Metres{2000};
  CHECK_FALSE(planning::check_ends(p, {still, still}, chart::Chart{}));
}

TEST_CASE("a forecast that does not cover the start's time is said to be none") {
  struct Ended {
    [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint, Depth, double) const {
      return unexpected(ocean::NoCurrent::outside_time);
    }
    [[nodiscard]] ocean::Coverage coverage() const { return {}; }
    [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{0}; }
  };
  const Ended field;
  const auto p = test::problem_between(geo_point(28, -16), geo_point(28.2, -16));
  const auto wrong = planning::check_ends(p, {field, field}, chart::Chart{});
  REQUIRE(wrong);
  CHECK(wrong->what == planning::NoPlan::no_forecast);
  CHECK(wrong->message.find("28.0000,-16.0000") != std::string::npos);
}

TEST_CASE("a plan that does not arrive says how near it comes and why it ends") {
  const auto home = geo_point(28, -16), goal = geo_point(28.5, -16), near = geo_point(28.3, -16);
  const auto p = test::problem_between(home, goal);
  vehicle::FlownList flown;
  flown.closest = near;
  flown.lost = vehicle::Lost::left_area;
  const auto plan = planning::plan_from("direct", flown, p, {1, 2, 3});
  CHECK(plan.method == "direct");
  CHECK_FALSE(plan.reaches_goal());
  CHECK(std::isnan(plan.arrival_s));
  CHECK(plan.remaining == distance(near, goal));
  CHECK(plan.reason.find("left the area") != std::string::npos);
  CHECK(plan.statistics == planning::Statistics{1, 2, 3});
}
