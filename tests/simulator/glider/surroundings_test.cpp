#include "simulator/glider/surroundings.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/local_metric.hpp"
#include "tests/simulator/support.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using namespace glidehelm::simulator;

TEST_CASE("a receiver without noise reads the truth") {
  Gps gps{{}, Random{1}};
  gps.next_surfacing();
  CHECK(gps.fix(kHome) == kHome);
}

TEST_CASE("noise has the stated standard deviation in each component and the same draws for the same seed") {
  GpsSetup setup;
  setup.noise = Metres{5};
  Gps gps{setup, Random{3}}, twin{setup, Random{3}};
  constexpr int kDraws = 4000;
  double e = 0, n = 0, ee = 0, nn = 0;
  for (int i = 0; i < kDraws; ++i) {
    const auto p = gps.fix(kHome);
    REQUIRE(p == twin.fix(kHome));
    const auto d = local_offset(kHome.lat.radians(), kHome.lon.radians(), p.lat.radians(), p.lon.radians());
    e += d.east;
    n += d.north;
    ee += d.east * d.east;
    nn += d.north * d.north;
  }
  // Mean: 5/√4000 = 0.08 m; deviation: relative 1/√(2·4000) = 1.1 %. Four times either.
  CHECK(std::fabs(e / kDraws) < 0.32);
  CHECK(std::fabs(n / kDraws) < 0.32);
  CHECK(std::sqrt(ee / kDraws) == Approx(5).epsilon(0.045));
  CHECK(std::sqrt(nn / kDraws) == Approx(5).epsilon(0.045));
}

TEST_CASE("faults strike the surfacings that they name, a far fix is as far away as stated") {
  GpsSetup setup;
  setup.stale.surfacings = {2};
  setup.invalid.surfacings = {3};
  setup.far.surfacings = {4};
  Gps gps{setup, Random{1}};
  CHECK(gps.next_surfacing() == GpsFaults{});
  CHECK(gps.fix(kHome) == kHome);
  CHECK(gps.next_surfacing() == GpsFaults{true, false, false});
  CHECK(gps.next_surfacing() == GpsFaults{false, true, false});
  CHECK(gps.next_surfacing() == GpsFaults{false, false, true});
  CHECK(distance(gps.fix(kHome), kHome).si() == Approx(30'000).margin(1e-3));
  CHECK(gps.next_surfacing() == GpsFaults{});
}

TEST_CASE("a steady wind drives a glider to the other side by its share") {
  WindSetup setup;
  setup.speed = MetresPerSecond{10};
  setup.from = Bearing{degrees(270)};
  Wind wind{setup, Random{1}};
  const auto drift = wind.leeway(0);
  CHECK(drift.east.si() == Approx(0.2).epsilon(1e-12));
  CHECK(drift.north.si() == Approx(0).margin(1e-12));
}

TEST_CASE("gusts have their strength and are forgotten with their e-folding time") {
  WindSetup setup;
  setup.gusts = MetresPerSecond{4};
  setup.lasting_s = 3600;
  setup.leeway = 1;
  Wind wind{setup, Random{5}};
  constexpr int kSteps = 20'000;
  double sum = 0, lagged = 0, before = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double now = wind.leeway(3600.0 * i).east.si();
    sum += now * now;
    lagged += now * before;
    before = now;
  }
  // Neighbours correlate by 1/e, so the number of independent draws is n·(1 − e⁻²)/(1 + e⁻²) = 15 000: the variance is
  // good to √(2/15 000) = 1.2 %, the correlation to √((1 − e⁻²)/20 000) = 0.007. Four times either.
  CHECK(sum / kSteps == Approx(16).epsilon(0.05));
  CHECK(lagged / sum == Approx(std::exp(-1.0)).margin(0.03));
}
