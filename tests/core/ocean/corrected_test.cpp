#include "core/ocean/corrected.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ocean;

namespace {

LocalCorrection eastward(double speed = 0.2) {
  LocalCorrection c;
  c.at = geo_point(28.5, -15.3);
  c.at_s = 1.7e9;
  c.added = {MetresPerSecond{speed}, MetresPerSecond{0}};
  c.spread = MetresPerSecond{0.02};
  return c;
}

}  // namespace

TEST_CASE("a correction counts whole at its centre and falls with the square of the distance and with time") {
  const test::Uniform forecast{0.1, -0.05};
  const auto c = eastward();
  const CorrectedField field{forecast, c};
  const auto at_centre = field.sample(c.at, Depth{Metres{150}}, c.at_s);
  REQUIRE(at_centre);
  CHECK(at_centre->current.east.si() == Approx(0.3));
  CHECK(at_centre->current.north.si() == Approx(-0.05));
  // exp(−1/2) one length away, exp(−1) one time later or earlier.
  const auto away = destination(c.at, Bearing{degrees(60)}, c.length);
  CHECK(field.sample(away, Depth{}, c.at_s)->current.east.si() == Approx(0.1 + 0.2 * std::exp(-0.5)).epsilon(0.002));
  for (const double sign : {-1.0, 1.0})
    CHECK(field.sample(c.at, Depth{}, c.at_s + sign * c.time.count())->current.east.si() ==
          Approx(0.1 + 0.2 * std::exp(-1.0)));
  CHECK(field.fastest().si() >= 0.3);
}

TEST_CASE("a correction is the same on both sides of the antimeridian") {
  auto c = eastward();
  c.at = geo_point(10, 179.9);
  const auto still = test::still_water();
  const CorrectedField field{still, c};
  const auto east = destination(c.at, Bearing{degrees(90)}, Metres{20'000}),
             west = destination(c.at, Bearing{degrees(270)}, Metres{20'000});
  CHECK(field.sample(east, Depth{}, c.at_s)->current.east.si() ==
        Approx(field.sample(west, Depth{}, c.at_s)->current.east.si()).epsilon(1e-6));
}

TEST_CASE("where the forecast knows nothing a correction invents nothing") {
  test::FromFunction box{[](double, double, double) { return std::pair{0.0, 0.0}; }, 0.0, {}};
  box.box = {0.4, 0.5, 0.1, 0.2};
  const CorrectedField field{box, eastward()};
  const auto outside = field.sample(geo_point(0, 0), Depth{}, 1.7e9);
  REQUIRE_FALSE(outside);
  CHECK(outside.error() == NoCurrent::outside_area);
  CHECK(field.coverage() == box.box);
}

TEST_CASE("lanes are moved as samples say, to the second order of the step") {
  const test::Uniform forecast{0.05, 0.1};
  const auto c = eastward();
  const CorrectedField field{forecast, c};
  const FieldRef ref{field};
  const auto flown = [&](bool by_kernel, double dt) {
    Lanes lanes{};
    lanes.count = 2;
    for (std::size_t k = 0; k < 2; ++k) {
      lanes.lat[k] = c.at.lat.radians();
      lanes.lon[k] = c.at.lon.radians() + 0.002;
      lanes.water_east[k] = k == 0 ? 0.3 : 0.0;
      lanes.water_north[k] = k == 0 ? 0.0 : -0.3;
      lanes.lost[k] = 0;
    }
    for (double t = 0; t < 4 * 3600 - 1; t += dt)
      if (by_kernel)
        ref.advance(lanes, c.at_s + t, dt);
      else
        advance_by_samples(field, lanes, c.at_s + t, dt);
    CHECK(lanes.water_east[0] == 0.3);  // given back as it was
    return lanes;
  };
  const auto truth = flown(false, 300);
  const auto error = [&](const Lanes& lanes) {
    return std::hypot(lanes.lat[0] - truth.lat[0], lanes.lon[0] - truth.lon[0]) * 6.37e6;
  };
  const double coarse = error(flown(true, 3600)), fine = error(flown(true, 1800));
  // Trapezoidal rule: dt²/12·w''·added over the time flown, with w'' ≤ (v/L)² + 2·(v/L)/T + 1/T² = (2e-5 + 1.2e-5)² 1/s²:
  // 0.2 m/s · 4 h · 3600²/12 · 1e-9 = 3.2 m at most.
  CHECK(coarse < 3.2);
  CHECK(fine < 0.3 * coarse + 0.01);
}

TEST_CASE("nonsense is no correction") {
  CHECK(eastward().plausible());
  CHECK_FALSE(eastward(1.2).plausible());
  CHECK_FALSE(eastward(std::numeric_limits<double>::quiet_NaN()).plausible());
  auto c = eastward();
  c.length = Metres{0};
  CHECK_FALSE(c.plausible());
  c = eastward();
  c.time = Seconds{std::numeric_limits<double>::infinity()};
  CHECK_FALSE(c.plausible());
}
