#include "core/planning/direct_to_goal.hpp"

#include <catch2/catch.hpp>

#include "tests/support/planning.hpp"

using namespace glidehelm;

namespace {

planning::Plan direct(const planning::Problem& p, ocean::FieldRef field) {
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{field, field}};
  const auto plan = planning::DirectToGoal{}.plan(p, members, chart::Chart{}, {}, {});
  REQUIRE(plan);
  return *plan;
}

}  // namespace

TEST_CASE("at every dive the heading is the bearing to the goal") {
  for (const auto& sea : test::analytic_seas()) {
    const auto plan = direct(sea.problem, sea.field);
    INFO(sea.name);
    for (const auto& stint : plan.stints) {
      if (stint.arrives) continue;  // steered at the goal itself
      const auto bearing = geodesic(stint.dive, planning::disc_of(sea.problem).centre).departing;
      CHECK(stint.heading.from_north().si() == bearing.from_north().si());
    }
  }
}

TEST_CASE("along a uniform current the travel time is that of the closed form, drifts included") {
  for (const double lat : {0.0, 28.0, 60.0}) {
    const test::Uniform field{0.1, 0};
    auto p = test::problem_between(geo_point(lat, 0), geo_point(lat, 1.2), 1000);
    p.glider.current_correction = 1;
    p.believed_current = Current{MetresPerSecond{0.1}, MetresPerSecond{0}};
    const auto plan = direct(p, field);
    REQUIRE(plan.reaches_goal());
    // After k whole stints the way is k·t_s·(U + c) + (k·t_surface + time_to_dive)·c; the rest is flown at U + c. Along
    // a parallel the geodesic bends off by (70 km)²·tan 60°/(8·6.4e6) = 160 m at most: 3e-5 of the way, and the current
    // keeps its direction to cos 0.6°.
    const double way = (distance(p.start.fix, planning::disc_of(p).centre)).si() - 1000;
    const double per_stint = 28800 * 0.4 + 900 * 0.1;
    const double whole = std::floor((way - 90) / per_stint);
    const double t = 900 + whole * (28800 + 900) + (way - 90 - whole * per_stint) / 0.4;
    INFO(lat);
    CHECK(plan.arrival_s - test::kT0 == Approx(t).epsilon(1e-3));
  }
}

TEST_CASE("across a shear every stint ends where its closed form says") {
  ocean::AnalyticSpec spec;
  spec.kind = "shear";
  spec.origin = geo_point(0, 0);
  spec.length_scale = Metres{40e3};
  spec.speed_scale = MetresPerSecond{0.2};
  const auto field = *ocean::AnalyticField::make(spec, instant_at(test::kT0), test::box_around(spec.origin, 2));
  const auto p = test::problem_between(geo_point(0, 0), geo_point(0.35, 0.1), 1000);
  const auto plan = direct(p, field);
  REQUIRE(plan.stints.size() >= 3);
  const double rate = 0.2 / 40e3;
  for (const auto& s : plan.stints) {
    if (s.arrives) continue;
    const double t = s.surface_s - s.dive_s, y0 = field.plane(s.dive).v * 40e3;
    const double east = 0.3 * std::sin(s.heading.from_north().si()),
                 north = 0.3 * std::cos(s.heading.from_north().si());
    const double x = field.plane(s.dive).u * 40e3 + east * t + rate * (y0 * t + 0.5 * north * t * t),
                 y = y0 + north * t;
    // The plane is exact to (y/R)²/2 = 2e-5 of 9 km; the rest is what the stint's steering differs from its heading.
    CHECK(std::hypot(field.plane(s.surface).u * 40e3 - x, field.plane(s.surface).v * 40e3 - y) <
          s.steering_error.si() + 1.0);
    CHECK(s.steering_error.si() <= 2 * 0.01 * 0.5 * t);  // the last 1 % turned back at 0.5 m/s over ground at most
  }
}

TEST_CASE("in solid-body rotation every stint ends where its closed form says") {
  ocean::AnalyticSpec spec;
  spec.kind = "solid-body";
  spec.origin = geo_point(0, 0);
  spec.length_scale = Metres{40e3};
  spec.speed_scale = MetresPerSecond{0.2};
  const auto field = *ocean::AnalyticField::make(spec, instant_at(test::kT0), test::box_around(spec.origin, 2));
  const auto p = test::problem_between(geo_point(0, 0.1), geo_point(0.3, 0), 1000);
  const auto plan = direct(p, field);
  REQUIRE(plan.stints.size() >= 3);
  const double omega = 0.2 / 40e3;
  for (const auto& s : plan.stints) {
    if (s.arrives) continue;
    // ẋ = −ωy + e, ẏ = ωx + n turns around the still point (−n/ω, e/ω).
    const double east = 0.3 * std::sin(s.heading.from_north().si()),
                 north = 0.3 * std::cos(s.heading.from_north().si());
    const double px = -north / omega, py = east / omega, turn = omega * (s.surface_s - s.dive_s);
    const double x = field.plane(s.dive).u * 40e3 - px, y = field.plane(s.dive).v * 40e3 - py;
    const double to_x = px + x * std::cos(turn) - y * std::sin(turn),
                 to_y = py + x * std::sin(turn) + y * std::cos(turn);
    CHECK(std::hypot(field.plane(s.surface).u * 40e3 - to_x, field.plane(s.surface).v * 40e3 - to_y) <
          s.steering_error.si() + 1.0);
  }
}

TEST_CASE("a current that cannot be beaten is reported as a closest approach with the distance left") {
  const test::Uniform field{0, -0.5};
  const auto p = test::problem_between(geo_point(28, -16), geo_point(28.4, -16));
  const auto plan = direct(p, field);
  CHECK_FALSE(plan.reaches_goal());
  CHECK(plan.remaining == distance(p.start.fix, planning::disc_of(p).centre));
  CHECK(plan.reason.find("horizon") != std::string::npos);
}
