#include "core/planning/zermelo.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/planning/extremal.hpp"
#include "core/planning/lower_bound.hpp"
#include "tests/contract/planner_contract.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;

namespace {

constexpr double kGoalRadius = 100;

planning::Problem submerged(GeoPoint from, GeoPoint to) {
  auto p = test::problem_between(from, to, kGoalRadius);
  p.schedule.surface = p.schedule.time_to_dive = Seconds{0};
  return p;
}
test::FromFunction plane_field(std::function<std::pair<double, double>(double x, double y)> f, double bound) {
  const auto m = LocalMetric::at(0);
  return {[f = std::move(f), m](double lat, double lon, double) {
            return f(lon * m.parallel_radius, lat * m.meridian_radius);
          },
          bound, test::box_around(geo_point(0, 0), 1.0)};
}
planning::WayPoint start_of(const planning::Problem& p) {
  return {p.start.fix.lat.radians(), p.start.fix.lon.radians(), test::kT0};
}
planning::Extremal shot(const planning::Problem& p, ocean::FieldRef field) {
  return planning::shoot({p, {field, field}}, start_of(p), planning::disc_of(p), p.horizon_s,
                         [](std::uint64_t) { return true; });
}
/// Both solvers agree with a closed form. Shooting: 200 Runge-Kutta steps, entry on chords, differences of 200 m: 1e-5; the metric about
/// the equator changes by 2e-5 in 40 km. Collocation: fourth order in 48 parts, far below that for fields that turn the heading by a
/// radian.
void check_closed_form(const planning::Problem& p, ocean::FieldRef field, double truth) {
  const auto by_shooting = shot(p, field);
  REQUIRE(by_shooting.arrives);
  CHECK(by_shooting.arrival_s - test::kT0 == Approx(truth).epsilon(1e-4));
  const auto by_collocation = planning::collocate({p, {field, field}}, start_of(p), planning::disc_of(p), p.horizon_s);
  REQUIRE(by_collocation);
  CHECK(by_collocation->arrival_s - test::kT0 == Approx(truth).epsilon(1e-4));
}

}  // namespace

TEST_CASE("zermelo keeps the contract of planners") { test::check_planner<planning::Zermelo>(); }

TEST_CASE("the extremals of a uniform current are straight") {
  const double x = 24e3, y = 18e3;
  for (const auto& c : {test::Uniform{0.1, 0.05}, test::Uniform{-0.2, 0.1}}) {
    double low = 0, high = 1e7;
    for (int i = 0; i < 200; ++i) {  // |d - c t| = U t + r
      const double t = 0.5 * (low + high);
      (std::hypot(x - c.east * t, y - c.north * t) > test::kSpeed * t + kGoalRadius ? low : high) = t;
    }
    check_closed_form(submerged(geo_point(0, 0), test::on_equator(x, y)), c, high);
  }
}

TEST_CASE("the extremals of a shear are those of Zermelo") {
  // As in the test of the bound: tan of the heading falls linearly with time (Bryson & Ho 2.7).
  const double k = 5e-6, theta0 = 1.1, t = 90e3;
  const double a0 = std::tan(theta0), a = a0 - k * t, theta = std::atan(a);
  const auto sec3 = [](double tan) { return 0.5 * (tan * std::hypot(1.0, tan) + std::asinh(tan)); };
  const double y = test::kSpeed / k * (1 / std::cos(theta0) - 1 / std::cos(theta));
  const double x =
      test::kSpeed * t / std::cos(theta0) + test::kSpeed / k * (std::asinh(a0) - std::asinh(a) + sec3(a) - sec3(a0));
  const auto field = plane_field([k](double, double north) { return std::pair{k * north, 0.0}; }, 1.2);
  check_closed_form(submerged(geo_point(0, 0), test::on_equator(x, y)), field,
                    t - kGoalRadius / (test::kSpeed + k * y * std::cos(theta)));
}

TEST_CASE("the extremals of a solid rotation are straight in the rotating frame") {
  const double omega = 1e-5, sx = -12e3, sy = 3e3, gx = 14e3, gy = 5e3;
  const auto field = plane_field([omega](double x, double y) { return std::pair{-omega * y, omega * x}; }, 2.0);
  double low = 0, high = 200e3;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.5 * (low + high), c = std::cos(omega * t), s = std::sin(omega * t);
    (std::hypot(c * gx + s * gy - sx, c * gy - s * gx - sy) > test::kSpeed * t + kGoalRadius ? low : high) = t;
  }
  check_closed_form(submerged(test::on_equator(sx, sy), test::on_equator(gx, gy)), field, high);
}

TEST_CASE("the heading of an extremal turns as in Eichhorn's general form") {
  // A field with divergence, in the plane: with the mathematical angle a of the heading da/dt = -u_y cos^2 a + (u_x - v_y) cos a sin a
  // + v_x sin^2 a; clockwise from north is pi/2 - a. The sphere adds tan(lat)/R of the speed, nothing on the equator.
  const double ux = 3e-6, uy = -2e-6, vx = 4e-6, vy = 5e-6;
  const auto field = plane_field([=](double x, double y) { return std::pair{ux * x + uy * y, vx * x + vy * y}; }, 2.0);
  const auto p = submerged(geo_point(0, 0), test::on_equator(20e3, 0));
  const planning::ExtremalFlow flow{p, {field, field}};
  for (const double psi : {0.2, 1.0, 2.5, 4.0, 5.5}) {
    const double a = 0.5 * kPi - psi, c = std::cos(a), s = std::sin(a);
    const auto rates = flow.rates({0, 0, psi}, test::kT0);
    REQUIRE(rates);
    CHECK(rates->psi == Approx(uy * c * c - (ux - vy) * c * s - vx * s * s).margin(1e-10));
  }
}

TEST_CASE("in weak currents the extremal takes the time of the bound") {
  // Two eddies of 0.1 m/s. The bound has its bar subtracted once, and the front is right to it.
  const auto field = plane_field(
      [](double x, double y) {
        const double s = kPi / 30e3;
        return std::pair{-0.1 * std::sin(s * x) * std::cos(s * y), 0.1 * std::cos(s * x) * std::sin(s * y)};
      },
      0.1);
  const auto p = submerged(test::on_equator(-25e3, -4e3), test::on_equator(27e3, 9e3));
  const auto bound = planning::lower_bound(p, {field, field}, chart::Chart{}, {});
  REQUIRE(bound);
  const auto found = shot(p, field);
  REQUIRE(found.arrives);
  const double travel = found.arrival_s - test::kT0;
  CHECK(travel >= bound->travel_s);
  CHECK(travel <= bound->travel_s + 2 * bound->error_s);
}

TEST_CASE("zermelo says when it does not apply") {
  const auto field = test::Uniform{-0.4, 0};
  const std::array<ocean::Ocean, 1> members{ocean::Ocean{field, field}};
  const auto p = submerged(geo_point(0, 0), test::on_equator(30e3, 0));
  const auto plan = planning::Zermelo{}.plan(p, members, chart::Chart{}, {}, {});
  if (plan) {
    CHECK_FALSE(plan->reaches_goal());
    CHECK(plan->reason.find("weak currents") != std::string::npos);
  } else {
    CHECK(plan.error().message.find("weak currents") != std::string::npos);
  }
}
