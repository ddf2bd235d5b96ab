#include "simulator/ocean_error.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulator/support.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using simulator::MesoscaleNoise;
using simulator::OceanError;
using simulator::PerturbedField;

namespace {

constexpr double kT0 = 1.7e9;

OceanError noise_of(double speed) {
  OceanError e;
  e.noise_m_per_s = speed;
  e.seed = 3;
  return e;
}

/// A field whose eastward current is the longitude in degrees and whose northward one is the hour.
struct Ramp {
  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth, double t_s) const {
    if (p.lon.degrees() < 4) return unexpected(ocean::NoCurrent::land);
    return ocean::Sample{{MetresPerSecond{p.lon.degrees()}, MetresPerSecond{(t_s - kT0) / 3600}}, false};
  }
  [[nodiscard]] ocean::Coverage coverage() const { return {}; }
  [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{10}; }
};

}  // namespace

TEST_CASE("the added eddies have the stated speed in the mean and never more than their bound") {
  const MesoscaleNoise noise{noise_of(0.1), 0.7, 0.1, kT0};
  double sum = 0, largest = 0;
  int count = 0;
  // A box of ten longest waves each way, sampled finer than the shortest: the mean of 64 squared sines errs by about
  // 1/sqrt(100 independent areas) of the energy of the longest waves.
  for (double x = -400e3; x < 400e3; x += 3.1e3)
    for (double y = -400e3; y < 400e3; y += 3.3e3) {
      const auto c = noise.at(GeoPoint::from_kernel(0.7 + y / 6.36e6, 0.1 + x / 4.88e6), Depth{}, kT0);
      const double v = std::hypot(c.east.si(), c.north.si());
      sum += v * v;
      largest = std::max(largest, v);
      ++count;
    }
  CHECK(std::sqrt(sum / count) == Approx(0.1).epsilon(0.05));
  CHECK(largest <= noise.bound());
}

TEST_CASE("the energy of the added eddies falls with the wave number as stated") {
  auto spec = noise_of(0.1);
  spec.slope = -3;
  const MesoscaleNoise noise{spec, 0.7, 0.1, kT0};
  const auto& waves = noise.waves();
  REQUIRE(waves.size() == 64);
  const auto k = [](const MesoscaleNoise::Wave& w) { return std::hypot(w.kx, w.ky); };
  CHECK(2 * kPi / k(waves.front()) < 80e3);
  CHECK(2 * kPi / k(waves.back()) > 10e3);
  // Steps of equal log k: E(k)·k goes as speed², so speed² ratio is (k ratio)^(slope + 1).
  const double ratio = std::pow(waves.back().speed / waves.front().speed, 2);
  CHECK(ratio == Approx(std::pow(k(waves.back()) / k(waves.front()), -2)).epsilon(1e-9));
}

TEST_CASE("the added eddies are free of divergence in their plane") {
  const MesoscaleNoise noise{noise_of(0.2), 0.7, 0.1, kT0};
  const auto metric = LocalMetric::at(0.7);
  const auto at = [&](double x, double y) {
    return noise.at(GeoPoint::from_kernel(0.7 + y / metric.meridian_radius, 0.1 + x / metric.parallel_radius), Depth{},
                    kT0);
  };
  constexpr double h = 50;
  for (double x = -50e3; x < 50e3; x += 9.7e3)
    for (double y = -50e3; y < 50e3; y += 11.3e3) {
      const double divergence =
          (at(x + h, y).east.si() - at(x - h, y).east.si() + at(x, y + h).north.si() - at(x, y - h).north.si()) /
          (2 * h);
      // Derivatives are up to 0.2 m/s · 2π/10 km = 1e-4 1/s; central differences err by (kh)²/6 = 1.6e-4 of that.
      CHECK(std::fabs(divergence) < 1e-7);
    }
}

TEST_CASE("the added eddies fade with depth and change with time") {
  auto spec = noise_of(0.1);
  spec.fading_m = 100;
  const MesoscaleNoise noise{spec, 0.7, 0.1, kT0};
  const auto p = GeoPoint::from_kernel(0.702, 0.103);
  const auto top = noise.at(p, Depth{}, kT0), deep = noise.at(p, Depth{Metres{100}}, kT0);
  CHECK(deep.east.si() == Approx(top.east.si() * std::exp(-1.0)));
  const auto later = noise.at(p, Depth{}, kT0 + 30 * 86400.0);
  CHECK(std::hypot(later.east.si() - top.east.si(), later.north.si() - top.north.si()) > 0.01);
}

TEST_CASE("shifted and late, the water at a place is the model's elsewhere and before") {
  const Ramp model;
  OceanError e;
  e.shift_km = 10;
  e.shift_toward_deg = 90;
  e.late_h = 2;
  const PerturbedField truth{model, e, kT0};
  const auto p = geo_point(40, 5);
  const auto s = truth.sample(p, Depth{}, kT0 + 5 * 3600);
  REQUIRE(s);
  const auto west = destination(p, Bearing{degrees(270)}, Metres{10e3});
  // The metric at one latitude against the geodesic: 1e-6 of a degree.
  CHECK(s->current.east.si() == Approx(west.lon.degrees()).margin(1e-5));
  CHECK(s->current.north.si() == Approx(3).margin(1e-9));
  // A shift makes no land where the model has none, and leaves what is land.
  CHECK(truth.sample(geo_point(40, 4.01), Depth{}, kT0));
  CHECK_FALSE(truth.sample(geo_point(40, 3.9), Depth{}, kT0));
}

TEST_CASE("the added tide is an ellipse of the stated axes with the period of M2") {
  OceanError e;
  e.tide_m_per_s = 0.2;
  e.tide_toward_deg = 30;
  e.tide_ratio = 0.5;
  const PerturbedField truth{kStill, e, kT0};
  const auto at = [&](double t) { return truth.sample(geo_point(40, 5), Depth{}, kT0 + t)->current; };
  double most = 0, least = 1;
  constexpr double kM2 = 12.4206012 * 3600;
  for (int i = 0; i < 720; ++i) {
    const auto c = at(kM2 * i / 720);
    most = std::max(most, std::hypot(c.east.si(), c.north.si()));
    least = std::min(least, std::hypot(c.east.si(), c.north.si()));
  }
  // Steps of half a degree: cos(0.25°) = 1 − 1e-5.
  CHECK(most == Approx(0.2).epsilon(2e-5));
  CHECK(least == Approx(0.1).epsilon(1e-4));
  CHECK(at(kM2).east.si() == Approx(at(0).east.si()).margin(1e-9));
}

TEST_CASE("without an error the water is the model, and the same seed gives the same error") {
  const PerturbedField same{kUniform, OceanError{}, kT0};
  const auto p = geo_point(40, 5);
  CHECK(same.sample(p, Depth{}, kT0)->current == kUniform.sample(p, Depth{}, kT0)->current);
  const PerturbedField one{kUniform, noise_of(0.1), kT0}, two{kUniform, noise_of(0.1), kT0};
  CHECK(one.sample(p, Depth{}, kT0 + 1e5)->current == two.sample(p, Depth{}, kT0 + 1e5)->current);
  auto other = noise_of(0.1);
  other.seed = 4;
  CHECK(one.sample(p, Depth{}, kT0)->current != PerturbedField(kUniform, other, kT0).sample(p, Depth{}, kT0)->current);
}
