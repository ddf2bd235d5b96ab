#include "core/planning/segment_time.hpp"

#include <catch2/catch.hpp>

#include "core/vehicle/constrained_motion.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;
using planning::MeanMotion;
using planning::NoPassage;
using planning::segment_time;

namespace {

Expected<double, NoPassage> eastwards(const MeanMotion& motion, double from_m, double to_m, double t_s = test::kT0) {
  std::uint64_t evaluations = 0;
  return segment_time(motion, 0, from_m / test::kEquator, 0, to_m / test::kEquator, t_s, evaluations);
}

}  // namespace

TEST_CASE("a segment in a uniform current takes what the constrained motion model says, in three samples") {
  const test::Uniform field{0.07, 0.1};
  const MeanMotion motion{test::always_under(), {field, field}};
  std::uint64_t evaluations = 0;
  const auto t = segment_time(motion, 0, 0, 0, 20e3 / test::kEquator, test::kT0, evaluations);
  REQUIRE(t);
  CHECK(*t == Approx(20e3 / (std::sqrt(0.3 * 0.3 - 0.1 * 0.1) + 0.07)).epsilon(1e-9));
  CHECK(evaluations == 3);
}

TEST_CASE("a segment is split until its pieces are even: the time is the integral to a thousandth") {
  // u grows along the way from 0 by a = 1e-5/s: ∫ dx/(U + a·x) = ln(1 + a·L/U)/a. Over a piece the mean of both ends stands for v,
  // which errs by (Δv/v)²/12 of the piece: with Δv ≤ 5 % of U that is 2e-4.
  const double a = 1e-5, length = 20e3;
  const test::FromFunction field{[a](double, double lon, double) {
                                   return std::pair{a * lon * test::kEquator, 0.0};
                                 },
                                 1};
  const MeanMotion motion{test::always_under(), {field, field}};
  CHECK(*eastwards(motion, 0, length) == Approx(std::log(1 + a * length / 0.3) / a).epsilon(2.5e-4));
  // An eddy has equal speeds on both sides of its centre: the cross current v = a·x makes √(U² − v²) of the speed:
  // ∫ dx/√(U² − a²x²) from −L/2 to L/2 = 2·asin(a·L/2U)/a. Near v = 0.2 of U = 0.3 the curve costs as little as above.
  const double b = 2e-5;
  const test::FromFunction eddy{[b](double, double lon, double) {
                                  return std::pair{0.0, b * lon * test::kEquator};
                                },
                                1};
  const MeanMotion round{test::always_under(), {eddy, eddy}};
  CHECK(*eastwards(round, -10e3, 10e3) == Approx(2 * std::asin(b * 10e3 / 0.3) / b).epsilon(1e-3));
}

TEST_CASE("currents count at the time at which the vehicle is there") {
  // The water begins to run along after an hour, at once: 0.1 m/s. One hour at U, the rest at U + 0.1. Splitting stops at 2^-7 of the
  // 20 km, where the half step may be wrong by 0.1 of 0.4 m/s for 400 s.
  const test::FromFunction field{[](double, double, double t) {
                                   return std::pair{t < test::kT0 + 3600 ? 0.0 : 0.1, 0.0};
                                 },
                                 0.1};
  const MeanMotion motion{test::always_under(), {field, field}};
  CHECK(*eastwards(motion, 0, 20e3) == Approx(3600 + (20e3 - 1080) / 0.4).margin(100));
}

TEST_CASE("surface drifts are part of the mean motion: still water takes the schedule's share longer") {
  const auto still = test::still_water();
  const test::Uniform wind{0.5, 0};
  auto p = test::problem_between(geo_point(0, 0), geo_point(0, 1));
  const double under = p.schedule.stint / (p.schedule.stint + p.schedule.surface);
  CHECK(*eastwards(MeanMotion{p, {still, still}}, 0, 10e3) == Approx(10e3 / (0.3 * under)).epsilon(1e-9));
  const MeanMotion motion{p, {still, wind}};
  CHECK(*eastwards(motion, 0, 10e3) == Approx(10e3 / (0.3 * under + 0.5 * (1 - under))).epsilon(1e-9));
  CHECK(motion.fastest() == Approx(0.3 * under + 0.5 * (1 - under)));
}

TEST_CASE("a segment that cannot be flown says why") {
  const test::Uniform against{-0.4, 0}, across{0, 0.35};
  for (const ocean::FieldRef field : {ocean::FieldRef{against}, ocean::FieldRef{across}}) {
    const auto t = eastwards(MeanMotion{test::always_under(), {field, field}}, 0, 10e3);
    REQUIRE_FALSE(t);
    CHECK(t.error() == NoPassage::too_strong);
  }
  const test::FromFunction small{[](double, double, double) {
                                   return std::pair{0.0, 0.0};
                                 },
                                 0, test::box_around(geo_point(0, 0), 0.05)};
  const auto t = eastwards(MeanMotion{test::always_under(), {small, small}}, 0, 10e3);
  REQUIRE_FALSE(t);
  CHECK(t.error() == NoPassage::no_current);
}
