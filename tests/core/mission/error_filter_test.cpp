#include "core/mission/error_filter.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/units.hpp"

using namespace glidehelm;
using namespace glidehelm::mission;

namespace {

/// Dives along a way that turns by `turn` degrees from one to the next; `residual(h)` is (east, north) of a dive with heading h.
template <class Residual>
ErrorFilter flown(ErrorFilter filter, int dives, double first, double turn, double apart_m, const Residual& residual) {
  GeoPoint at = geo_point(40, 5);
  for (int k = 0; k < dives; ++k) {
    const double h = degrees(first + turn * k).si();
    DiveResidual d;
    d.at = at;
    d.at_s = 1.7e9 + 15300.0 * k;
    d.heading_east = std::sin(h);
    d.heading_north = std::cos(h);
    d.spread = 0.02;
    std::tie(d.east, d.north) = residual(h);
    filter.see(d);
    at = destination(at, Bearing{Radians{h}}, Metres{apart_m});
  }
  return filter;
}

/// Dives of a glider whose speed is off by `speed` and whose heading by `bias` in water whose forecast is off by (`east`,
/// `north`); the wanted heading turns by `turn` degrees from dive to dive.
ErrorFilter fly(int dives, double speed, double bias, double east, double north, double turn, double apart_m = 5000) {
  return flown(ErrorFilter{}, dives, 20, turn, apart_m, [&](double h) {
    const double u = 0.3 + speed;
    return std::pair{u * std::sin(h + bias) - 0.3 * std::sin(h) + east,
                     u * std::cos(h + bias) - 0.3 * std::cos(h) + north};
  });
}

}  // namespace

TEST_CASE("on a winding way speed, heading bias and the error of the forecast are told apart") {
  // Headings over the whole circle: what turns with the glider cannot be in the water. After 24 dives the spreads of the
  // filter itself are the tolerance: three of them.
  const double speed = -0.03, bias = degrees(4).si(), east = 0.06, north = -0.04;
  const auto f = fly(24, speed, bias, east, north, 75);
  CHECK(std::abs(f.speed_error() - speed) < 3 * f.speed_spread());
  CHECK(std::abs(f.bias() - bias) < 3 * f.bias_spread());
  CHECK(std::abs(f.error().east.si() - east) < 3 * f.error_spread());
  CHECK(std::abs(f.error().north.si() - north) < 3 * f.error_spread());
  CHECK(f.speed_spread() < 0.5 * 0.03);  // half of the first guess's
  CHECK(in_degrees(Radians{f.bias_spread()}) < 0.5 * 5);
  CHECK(f.speed_error() < -0.02);
  CHECK(in_degrees(Radians{f.bias()}) > 2.5);
}

TEST_CASE("one dive goes to the water, not to the glider") {
  // Prior variances: water 0.01, speed 0.0009: of a residual along the heading the water takes eleven parts of twelve.
  const auto f = fly(1, 0, 0, 0.06, 0.16, 0);
  CHECK(std::hypot(f.error().east.si(), f.error().north.si()) > 0.85 * std::hypot(0.06, 0.16));
  CHECK(std::abs(f.speed_error()) < 0.02);
}

TEST_CASE("where truth is the forecast nothing is learned") {
  const auto f = fly(20, 0, 0, 0, 0, 30);
  CHECK(std::abs(f.speed_error()) < 1e-12);
  CHECK(std::abs(f.bias()) < 1e-12);
  CHECK(f.error().speed().si() < 1e-12);
}

TEST_CASE("one bad dive moves little, one that is repeated prevails") {
  auto f = fly(6, 0, 0, 0.05, 0, 40);
  const auto before = f;
  DiveResidual bad;
  bad.at = f.at();
  bad.at_s = f.at_s() + 15300;
  bad.heading_north = 1;
  bad.spread = 0.02;
  bad.east = 3.0;
  f.see(bad);
  // At most 9/n standard deviations of innovation with n > 20: well below one of the forecast's spread.
  CHECK(std::abs(f.error().east.si() - before.error().east.si()) < 0.1);
  CHECK(std::abs(f.speed_error() - before.speed_error()) < 0.01);
  for (int k = 0; k < 12; ++k) {
    bad.at_s += 15300;
    bad.east = 0.5;
    f.see(bad);
  }
  CHECK(f.error().east.si() > 0.3);
}

TEST_CASE("far away the error of the forecast is forgotten, the speed is not") {
  auto near = fly(24, -0.03, 0, 0.08, 0, 75);
  const double speed = near.speed_error();
  DiveResidual far;
  far.at = destination(near.at(), Bearing{degrees(90)}, Metres{300'000});
  far.at_s = near.at_s() + 20 * 86400.0;
  far.heading_north = 1;
  far.spread = 10;  // tells nothing
  near.see(far);
  CHECK(near.error().speed().si() < 1e-4);  // the gain of a dive with a spread of 10 m/s
  CHECK(near.error_spread() == Approx(0.10).epsilon(0.01));
  CHECK(near.speed_error() == Approx(speed).margin(1e-4));
}

TEST_CASE("another first guess of the speed counts as if it had been there from the beginning") {
  // The filter is linear in the guess but for the bias, whose column has U0. Without a first spread only its wander is left of it: 2.9e-5 rad² over these
  // dives, times the change of U0², 0.0061, is 2e-7 of variances around 0.01, so 2e-5 of a gain and of an innovation of 0.02 m/s.
  const auto guessed = [](double guess) {
    return flown(ErrorFilter{{guess, 0.03, 0, 0.10, 30'000, 24 * 3600.0}}, 5, 0, 70, 5000, [&](double h) {
      const double speed = 0.32;
      return std::pair{(speed - guess) * std::sin(h) + 0.04, (speed - guess) * std::cos(h) - 0.02};
    });
  };
  const auto wanted = guessed(0.31);
  auto moved = guessed(0.30);
  const double shown = 0.30 + moved.speed_error();
  moved.move_guess(0.31, 0.03);
  CHECK(moved.setup() == wanted.setup());
  CHECK(std::abs(moved.speed_error() - wanted.speed_error()) < 4e-7);
  CHECK(std::abs(moved.error().east.si() - wanted.error().east.si()) < 4e-7);
  CHECK(std::abs(moved.error().north.si() - wanted.error().north.si()) < 4e-7);
  CHECK(moved.speed_spread() == Approx(wanted.speed_spread()).epsilon(2e-5));
  // Five dives on a turning way have told most of the speed: of the guess's 0.01 m/s less than half is left in it.
  CHECK(0.31 + moved.speed_error() - shown > 0);
  CHECK(0.31 + moved.speed_error() - shown < 0.005);

  ErrorFilter fresh{{0.30, 0.03, 0.0873, 0.10, 30'000, 24 * 3600.0}};
  fresh.move_guess(0.35, 0.035);
  CHECK(fresh.speed_error() == 0);  // nothing was seen: it is the guess
}
