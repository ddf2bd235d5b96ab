#include "core/planning/optimal_course.hpp"

#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/planning.hpp"

using namespace glidehelm;
using planning::MeanMotion;
using planning::optimal_course;
using planning::WayPoint;

namespace {

const LocalMetric kMetric = LocalMetric::at(0);

WayPoint at(double x, double y, double t) {
  return {y / kMetric.meridian_radius, x / kMetric.parallel_radius, test::kT0 + t, 0};
}
/// A field on the equator from a function of x, y in metres.
test::FromFunction field(const std::function<std::pair<double, double>(double x, double y)>& current) {
  return {[current](double lat, double lon, double) {
            return current(lon * kMetric.parallel_radius, lat * kMetric.meridian_radius);
          },
          10};
}

struct Place {
  double x, y;
};
/// Degrees between the answer for the edge [p(0), p(dt)] of an exact optimal way and the way's course at 1.5·dt, where the next edge's middle is.
template <class Way>
double error_of(const test::FromFunction& current, const Way& p, double dt) {
  const Place a = p(0.0), b = p(dt), c = p(1.5 * dt - 1), d = p(1.5 * dt + 1);
  std::uint64_t samples = 0;
  const auto course =
      optimal_course({test::always_under(), {current, current}}, at(a.x, a.y, 0), at(b.x, b.y, dt), samples);
  REQUIRE(course);
  CHECK(samples == 9);
  return std::abs(in_degrees(*course - Course::of(d.x - c.x, d.y - c.y)));
}

}  // namespace

TEST_CASE("without a gradient the best course goes straight on") {
  const test::Uniform current{0.1, -0.15};
  std::uint64_t samples = 0;
  for (const double bearing : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
    const auto to = at(6e3 * std::sin(bearing), 6e3 * std::cos(bearing), 2e4);
    const auto course = optimal_course({test::always_under(), {current, current}}, at(0, 0, 0), to, samples);
    REQUIRE(course);
    // The metric changes by 1e-7 over 3 km at the equator.
    CHECK(std::abs((*course - Course{Radians{bearing}}).si()) < 1e-5);
  }
}

TEST_CASE("in an eddy that turns like a wheel the best way is straight in the frame that turns with it") {
  // Current (−ωy, ωx). In the turning frame the water rests, so the fastest way is straight there: p(t) = R(ωt)·(q + U·t·e). An edge is
  // a chord of it, whose direction is that of the way's middle but for terms of the second order: half the time, a quarter of the error.
  const double omega = 2e-5;
  const auto current = field([omega](double x, double y) { return std::pair{-omega * y, omega * x}; });
  const auto way = [&](double t) {
    const double x = 8e3 + test::kSpeed * t * std::cos(1.0), y = -3e3 + test::kSpeed * t * std::sin(1.0),
                 turn = omega * t;
    return Place{x * std::cos(turn) - y * std::sin(turn), x * std::sin(turn) + y * std::cos(turn)};
  };
  const double coarse = error_of(current, way, 1.6e4), fine = error_of(current, way, 0.8e4);
  CHECK(coarse < 2.0);
  CHECK(fine < 0.35 * coarse);
}

TEST_CASE("in a shear the tangent of the best heading falls steadily") {
  // u = a·y: Zermelo's formula gives d(tan θ)/dt = −a, a way that is integrated here in 1000 steps of the midpoint rule.
  const double a = 2e-5;
  const auto current = field([a](double, double y) { return std::pair{a * y, 0.0}; });
  const auto way = [&](double until) {
    double x = 0, y = 2e3;
    const int steps = 1000;
    const double dt = until / steps;
    for (int i = 0; i < steps; ++i) {
      const double theta = std::atan(0.8 - a * (i + 0.5) * dt);
      const double middle = y + 0.5 * dt * test::kSpeed * std::sin(theta);
      x += dt * (test::kSpeed * std::cos(theta) + a * middle);
      y += dt * test::kSpeed * std::sin(theta);
    }
    return Place{x, y};
  };
  const double coarse = error_of(current, way, 1.6e4), fine = error_of(current, way, 0.8e4);
  CHECK(coarse < 2.0);
  CHECK(fine < 0.35 * coarse);
}

TEST_CASE("where an edge cannot be held or a current is missing there is no best course") {
  std::uint64_t samples = 0;
  const test::Uniform across{0, 0.5};
  CHECK_FALSE(optimal_course({test::always_under(), {across, across}}, at(0, 0, 0), at(6e3, 0, 2e4), samples));
  const test::FromFunction small{[](double, double, double) {
                                   return std::pair{0.0, 0.0};
                                 },
                                 0, test::box_around(geo_point(0, 0), 0.05)};
  CHECK_FALSE(optimal_course({test::always_under(), {small, small}}, at(0, 0, 0), at(5e3, 0, 2e4), samples));
}
