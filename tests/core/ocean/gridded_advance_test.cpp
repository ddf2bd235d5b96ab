#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/ocean/gridded.hpp"
#include "tests/support/fields.hpp"

// GriddedField::advance, the kernel: it must do what advance_by_samples does with sample(), only faster.

using namespace glidehelm;
using namespace glidehelm::ocean;
using test::kDry;

namespace {

Lanes lanes_in(double south, double north, double west, double east, std::uint64_t seed, int count = Lanes::kMax) {
  std::mt19937_64 random{seed};
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>{a, b}(random); };
  Lanes lanes{};
  lanes.count = count;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    lanes.lat[k] = between(south, north) * kPi / 180;
    lanes.lon[k] = between(west, east) * kPi / 180;
    const double heading = between(0, 2 * kPi);
    lanes.water_east[k] = 0.3 * std::sin(heading);
    lanes.water_north[k] = 0.3 * std::cos(heading);
    lanes.lost[k] = 0;
  }
  return lanes;
}

/// Steps both ways and compares. One step moves at most 2 m/s · 3600 s = 1.1e-3 rad of latitude; the metric table's 5e-7
/// and the float weights (6e-8 of a cell, times a difference of neighbours below 1 m/s) each change it by less than 1e-9.
void agree(const GriddedField& field, const Lanes& start, double t_s, double dt, int steps = 4) {
  Lanes lanes = start, slow = start;
  for (int n = 0; n < steps; ++n) {
    field.advance(lanes, t_s + n * dt, dt);
    advance_by_samples(field, slow, t_s + n * dt, dt);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(lanes.count); ++k) {
    INFO("lane " << k << " at " << slow.lat[k] * 180 / kPi << ", " << slow.lon[k] * 180 / kPi);
    CHECK(lanes.lost[k] == slow.lost[k]);
    CHECK(std::abs(lanes.lat[k] - slow.lat[k]) < 4e-9);
    CHECK(std::abs(lanes.lon[k] - slow.lon[k]) * std::cos(slow.lat[k]) < 4e-9);
  }
}

std::pair<double, double> waves(double lat, double lon) {
  return {std::sin(7 * lat) * std::cos(3 * lon), std::cos(5 * lat + 2 * lon)};
}

}  // namespace

TEST_CASE("the kernel and the samples move lanes alike: inside, near edges and near coasts") {
  for (const bool coast : {false, true}) {
    const auto value = [&](double lat, double lon) {
      return coast && std::sin(31 * lat) * std::sin(17 * lon) > 0.6 ? std::pair{kDry, kDry} : waves(lat, lon);
    };
    const auto even = test::make_field(test::steps(40, 0.05, 41), test::steps(-10, 0.05, 41), value);
    const auto uneven = test::make_field({40, 40.1, 40.15, 40.5, 40.9, 41.2, 41.5, 42},
                                         {-10, -9.8, -9.5, -9.45, -9.2, -9, -8.6, -8.3, -8}, value);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      agree(even, lanes_in(40, 42, -10, -8, seed), 0, 1800);
      agree(uneven, lanes_in(40, 42, -10, -8, seed), 0, 1800);
    }
    // Whole turns of the globe away: lanes let their longitude run on.
    agree(even, lanes_in(40.5, 41.5, 350.5, 351.5, 99), 0, 1800);
  }
}

TEST_CASE("the kernel and the samples move lanes alike in hourly, cycling, nearest and smooth fields") {
  GridAxes axes{test::steps(0, 3600, 30), {0.0}, test::steps(40, 0.1, 21), test::steps(170, 0.1, 161), true, false};
  const auto grid = test::make_grid(
      axes, [](double lat, double lon, double, double t) { return waves(lat + t * 1e-5, lon - t * 2e-5); });
  for (const auto how : {Interpolation::linear, Interpolation::nearest, Interpolation::cubic, Interpolation::akima})
    for (const auto policy : {OutsideTime::hold, OutsideTime::cycle, OutsideTime::forbid}) {
      const GriddedField field{grid, {policy, how, 1.5, false}};
      if (how != Interpolation::nearest) agree(field, lanes_in(40, 42, 178, 182, 5), 5000, 1700, 3);
      // Well inside: a lane that leaves area and time within one stage may be told either reason.
      agree(field, lanes_in(40.4, 41.6, 178, 182, 6), 28.7 * 3600, 1700, how == Interpolation::nearest ? 1 : 3);
    }
}

TEST_CASE("lanes cross the seam of a global field and the antimeridian without noticing") {
  const auto field =
      test::make_field(test::steps(-60, 0.5, 241), test::steps(0.25, 0.5, 720), [](double lat, double lon) {
        return std::pair{1.0 + 0.2 * std::sin(lon * kPi / 180), 0.1 * std::cos(lat * kPi / 180)};
      });
  agree(field, lanes_in(-59, 59, -0.3, 0.3, 1), 0, 3600);
  agree(field, lanes_in(-59, 59, 179.8, 180.2, 2), 0, 3600);
}

TEST_CASE("a uniform current carries still lanes along a parallel and a meridian") {
  const auto field = test::make_field(test::steps(50, 0.1, 21), test::steps(0, 0.1, 21), [](double, double) {
    return std::pair{0.5, 0.0};
  });
  Lanes lanes = lanes_in(51, 51, 0.5, 0.5, 3, 1);
  lanes.water_east[0] = lanes.water_north[0] = 0;
  const double lat = lanes.lat[0], lon = lanes.lon[0];
  for (int n = 0; n < 16; ++n) field.advance(lanes, 0, 1800);
  // Along a parallel the metric is constant: 14400 m / (N cos φ), to the table's 5e-7.
  CHECK(lanes.lat[0] == lat);
  CHECK((lanes.lon[0] - lon) * LocalMetric::at(lat).parallel_radius == Approx(0.5 * 16 * 1800).epsilon(1e-6));
}

TEST_CASE("the step is of fourth order: in a solid rotation halving it divides the error by sixteen") {
  // Angular velocity 2e-5 1/s about (0°, 0°) on a grid fine enough that interpolation is exact for a linear field.
  const double omega = 2e-5;
  const auto metric = LocalMetric::at(0);
  const auto field =
      test::make_field(test::steps(-0.5, 0.1, 11), test::steps(-0.5, 0.1, 11), [&](double lat, double lon) {
        return std::pair{-omega * lat * kPi / 180 * metric.meridian_radius,
                         omega * lon * kPi / 180 * metric.parallel_radius};
      });
  const auto error = [&](double dt) {
    Lanes lanes = lanes_in(0, 0, 0.3, 0.3, 3, 1);
    lanes.water_east[0] = lanes.water_north[0] = 0;
    const double start = lanes.lon[0] * metric.parallel_radius, turn = 4e5;
    for (double t = 0; t < turn - 1; t += dt) field.advance(lanes, t, dt);
    const double phase = omega * turn;  // the metric varies by (0.3°)²/2 ≈ 1.4e-5 over the field: 1e-4 of phase
    return std::hypot(lanes.lon[0] * metric.parallel_radius - start * std::cos(phase),
                      lanes.lat[0] * metric.meridian_radius - start * std::sin(phase)) /
           start;
  };
  // Eight radians; with steps of 1 rad and of 0.5 rad RK4's phase error is h⁴/120 per radian, 0.07 and 0.004 of the
  // radius: well above metric and float. At h = 1 the next order still shows.
  const double coarse = error(5e4), fine = error(2.5e4);
  CHECK(coarse / fine == Approx(16).margin(5));
}

TEST_CASE("a lane without a current is lost with the reason and stays where the step began") {
  const auto field = test::make_field(test::steps(0, 0.1, 11), test::steps(0, 0.1, 11),
                                      [](double, double lon) {
                                        return lon > 0.55 ? std::pair{kDry, kDry} : std::pair{1.0, 0.0};
                                      },
                                      {OutsideTime::hold, Interpolation::linear, 1.5, true});
  Lanes lanes = lanes_in(0.5, 0.5, 0.3, 0.3, 1, 3);
  lanes.lon[1] = 0.549 * kPi / 180;   // half a cell of dry water ahead, 1.3 m/s for an hour is 4.7 km = 0.042°
  lanes.lat[2] = 0.9999 * kPi / 180;  // 11 m below the edge
  for (std::size_t k = 0; k < 3; ++k) lanes.water_east[k] = 0.3, lanes.water_north[k] = k == 2 ? 0.3 : 0.0;
  const Lanes before = lanes;
  field.advance(lanes, 0, 3600);
  CHECK(lanes.lost[0] == 0);
  CHECK(lanes.lon[0] > before.lon[0]);
  CHECK(lanes.lost[1] == static_cast<std::uint8_t>(NoCurrent::land));
  CHECK(lanes.lon[1] == before.lon[1]);
  CHECK(lanes.lost[2] == static_cast<std::uint8_t>(NoCurrent::outside_area));
  CHECK(lanes.lat[2] == before.lat[2]);
  const Lanes after = lanes;
  field.advance(lanes, 3600, 3600);
  CHECK(lanes.lost[1] == after.lost[1]);  // a lost lane is left alone
  CHECK(lanes.lon[1] == after.lon[1]);
}

TEST_CASE("a forbidden time loses every lane") {
  GridAxes axes{{0, 3600}, {0.0}, {0, 1}, {0, 1}, true, false};
  const GriddedField field{test::make_grid(axes,
                                           [](double, double, double, double) {
                                             return std::pair{0.1, 0.1};
                                           }),
                           {OutsideTime::forbid, Interpolation::linear, 1.5, false}};
  Lanes lanes = lanes_in(0.5, 0.5, 0.5, 0.5, 1, 2);
  field.advance(lanes, 3000, 1200);
  CHECK(lanes.lost[0] == static_cast<std::uint8_t>(NoCurrent::outside_time));
  CHECK(lanes.lost[1] == static_cast<std::uint8_t>(NoCurrent::outside_time));
}

TEST_CASE("a position or speed that is no number is lost, not followed") {
  const auto field = test::make_field({0, 1, 2}, {0, 1, 2}, [](double, double) { return std::pair{0.1, 0.1}; });
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -1e300}) {
    Lanes lanes = lanes_in(1, 1, 1, 1, 1, 4);
    lanes.lat[0] = bad;
    lanes.lon[1] = std::isfinite(bad) ? 5 : bad;
    lanes.water_north[2] = bad;
    field.advance(lanes, 0, 1800);
    for (const std::size_t k : {0U, 1U, 2U}) CHECK(lanes.lost[k] == static_cast<std::uint8_t>(NoCurrent::outside_area));
    CHECK(lanes.lost[3] == 0);
  }
}
