#include "core/planning/travel_time.hpp"

#include <catch2/catch.hpp>

#include <cmath>

#include "core/vehicle/constrained_motion.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;
using planning::MeanMotion;
using planning::NoPassage;
using planning::travel_time;

namespace {

struct Passage {
  double seconds;
  std::uint64_t samples;
};
Passage eastwards(ocean::FieldRef field, double from_m, double to_m,
                  double tolerance = planning::kTravelTimeTolerance) {
  Passage p{};
  const auto t = travel_time({test::always_under(), {field, field}}, 0, from_m / test::kEquator, 0,
                             to_m / test::kEquator, test::kT0, p.samples, tolerance);
  REQUIRE(t);
  p.seconds = *t;
  return p;
}

/// A current along or across the way as a function of the distance from 0°E (metres) and the time since departure.
test::FromFunction along(double (*u)(double x, double t)) {
  return {[u](double, double lon, double t) { return std::pair{u(lon * test::kEquator, t - test::kT0), 0.0}; }, 1};
}
test::FromFunction across(double (*v)(double x, double t)) {
  return {[v](double, double lon, double t) { return std::pair{0.0, v(lon * test::kEquator, t - test::kT0)}; }, 1};
}

}  // namespace

TEST_CASE("a travel time in a uniform current is Eichhorn's eq. 3 to 6, in one step") {
  const test::Uniform field{0.07, 0.1};
  const auto p = eastwards(field, 0, 20e3);
  CHECK(p.seconds == Approx(20e3 / (std::sqrt(test::kSpeed * test::kSpeed - 0.1 * 0.1) + 0.07)).epsilon(1e-9));
  CHECK(p.samples == 3);
}

TEST_CASE("the step is controlled so that a travel time errs by less than half its tolerance") {
  // u grows along the way by a = 4e-5/s: ∫ dx/(U + a·x) = ln(1 + a·L/U)/a. The mean of both ends errs by C·h³, that of two halves by a quarter of
  // it, so what is measured is three times the error: a third of the tolerance, and half of it where C changes within a step.
  const double a = 4e-5, length = 20e3, exact = std::log(1 + a * length / test::kSpeed) / a;
  const auto field = along([](double x, double) { return 4e-5 * x; });
  std::uint64_t before = 0;
  for (const double tolerance : {4e-3, 1e-3, 2.5e-4, 6.25e-5}) {
    INFO(tolerance);
    const auto p = eastwards(field, 0, length, tolerance);
    CHECK(std::abs(p.seconds / exact - 1) <= 0.5 * tolerance);
    // A quarter of the tolerance takes twice the steps, give or take the first and the last of them and refused ones.
    if (before > 0) CHECK(static_cast<double>(p.samples) <= 2.0 * static_cast<double>(before) + 6);
    CHECK(p.samples > before);
    before = p.samples;
  }
}

TEST_CASE("a shear across the way takes its closed form") {
  // v = b·x across makes √(U² − v²) of the speed: ∫ from −L/2 to L/2 is 2·asin(b·L/2U)/b. The currents of both ends are opposite and their mean is
  // none, as if the water rested: only the halves find it.
  const double b = 2e-5;
  const auto shear = across([](double x, double) { return 2e-5 * x; });
  CHECK(eastwards(shear, -10e3, 10e3).seconds == Approx(2 * std::asin(b * 10e3 / test::kSpeed) / b).epsilon(0.5e-3));
}

TEST_CASE("currents count at the time at which the vehicle comes to them") {
  // u = a·t, the same everywhere: U·T + a·T²/2 = L. Half the tolerance for the steps, as above, and as much again for times that are
  // guessed: a sample is taken anew only where its guess could cost a tolerance.
  const double a = 5e-6, length = 20e3,
               exact = (std::sqrt(test::kSpeed * test::kSpeed + 2 * a * length) - test::kSpeed) / a;
  const auto growing = along([](double, double t) { return 5e-6 * t; });
  CHECK(eastwards(growing, 0, length).seconds == Approx(exact).epsilon(1e-3));
  CHECK(eastwards(growing, 0, length, 1e-4).seconds == Approx(exact).epsilon(1e-4));
}

TEST_CASE("a jet in the middle of a way is not stepped over") {
  // ∫ dx/(U + J·sech²(x/w)) over ±10 km by a fine midpoint sum; w = 1 km, a twentieth of the way.
  const auto jet = along([](double x, double) { return 0.3 / std::pow(std::cosh(x / 1000), 2); });
  double exact = 0;
  for (double x = -10e3 + 0.5; x < 10e3; x += 1) exact += 1 / (test::kSpeed + 0.3 / std::pow(std::cosh(x / 1000), 2));
  CHECK(eastwards(jet, -10e3, 10e3).seconds == Approx(exact).epsilon(0.5e-3));
}

TEST_CASE("on every analytic sea a travel time agrees with a march of ten thousand steps") {
  // The midpoint rule with U·√(1 − s²) + along, written out here: its own error is the square of a step, 1e-8. Half the tolerance
  // as above; the guesses of times cost nothing beside.
  int compared = 0;
  for (const auto& sea : test::analytic_seas()) {
    const MeanMotion motion{sea.problem, {sea.field, sea.field}};
    for (const double bearing : {20.0, 110.0, 200.0, 290.0}) {
      const auto from = sea.problem.start.fix, to = destination(from, Bearing{degrees(bearing)}, Metres{15e3});
      const double lat0 = from.lat.radians(), lon0 = from.lon.radians();
      const double dlat = to.lat.radians() - lat0, dlon = to.lon.radians() - lon0;
      std::uint64_t samples = 0;
      const auto t = travel_time(motion, lat0, lon0, lat0 + dlat, lon0 + dlon, test::kT0, samples);
      const auto way = local_offset(lat0, lon0, lat0 + dlat, lon0 + dlon);
      const double east = way.east / way.length(), north = way.north / way.length();
      const int steps = 10000;
      double exact = 0, speed = motion.speed();
      for (int i = 0; i < steps && speed > 0; ++i) {
        const double share = (i + 0.5) / steps, half = 0.5 * way.length() / steps / speed;
        const auto c = motion.current(lat0 + share * dlat, lon0 + share * dlon, test::kT0 + exact + half);
        speed = vehicle::speed_on_course(east, north, motion.speed(), c->east.si(), c->north.si());
        exact += way.length() / steps / speed;
      }
      INFO(sea.name << ", bearing " << bearing);
      CHECK(t.has_value() == (speed > 0));
      if (!t || !(speed > 0)) continue;
      ++compared;
      CHECK(*t == Approx(exact).epsilon(0.5e-3));
    }
  }
  CHECK(compared >= 30);
}

TEST_CASE("a way on which the course cannot be held is infeasible, wherever that is") {
  const test::Uniform against{-0.4, 0}, crossing{0, 0.35};
  const auto far_side = across([](double x, double) { return x < 15e3 ? 0.0 : 0.35; });
  for (const ocean::FieldRef field : {ocean::FieldRef{against}, ocean::FieldRef{crossing}, ocean::FieldRef{far_side}}) {
    std::uint64_t samples = 0;
    const auto t =
        travel_time({test::always_under(), {field, field}}, 0, 0, 0, 20e3 / test::kEquator, test::kT0, samples);
    REQUIRE_FALSE(t);
    CHECK(t.error() == NoPassage::too_strong);
  }
  // Erratum of eq. 6: against a current of 0.4 the larger root is −0.1 m/s, a real number and still no way.
  CHECK_FALSE(vehicle::crossing_time({1000, 0}, test::kSpeed, -0.4, 0));
  const test::FromFunction small{[](double, double, double) {
                                   return std::pair{0.0, 0.0};
                                 },
                                 0, test::box_around(geo_point(0, 0), 0.05)};
  std::uint64_t samples = 0;
  const auto out =
      travel_time({test::always_under(), {small, small}}, 0, 0, 0, 10e3 / test::kEquator, test::kT0, samples);
  REQUIRE_FALSE(out);
  CHECK(out.error() == NoPassage::no_current);
}

TEST_CASE("no way takes no time") {
  const test::Uniform field{0.1, 0.1};
  CHECK(eastwards(field, 500, 500).seconds == 0);
}
