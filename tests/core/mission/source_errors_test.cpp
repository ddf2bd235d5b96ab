#include "core/mission/source_errors.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

using namespace glidehelm;
using namespace glidehelm::mission;

namespace {

const std::vector<SourceShare> kAlone{{"", 1.0}};

/// The n-th of dives that say nothing of each other: 2° apart, ρ < exp(−13) between neighbours, at one time.
CurrentResidual lone_dive(int n, double east, double north, std::vector<SourceShare> shares = kAlone,
                          double noise = 0) {
  CurrentResidual r;
  r.at = geo_point(n % 2 == 0 ? 10 : 12, 2.0 * (n % 60));
  r.at_s = 1.7e9;
  r.east = east;
  r.north = north;
  r.noise = noise;
  r.shares = std::move(shares);
  return r;
}

double square(MetresPerSecond v) { return v.si() * v.si(); }

}  // namespace

TEST_CASE("nothing learned is the prior, for every source, any mean and no shares") {
  const SourceErrors errors;
  CHECK(errors.spread("radar").si() == 0.10);
  CHECK(errors.spread(std::vector<SourceShare>{}).si() == 0.10);
  CHECK(errors.spread({{"radar", 0.25}, {"model", 0.75}}).si() == Approx(0.10).epsilon(1e-15));
  CHECK(errors.spread({{"radar", 0.25}, {"model", 0.75}}, true).si() == Approx(0.20).epsilon(1e-15));
}

TEST_CASE("independent residuals of one source give the closed form") {
  // q·σ² of one source is |r|²/2 − n², whatever σ was, so σ² = (8·0.01 + Σ(|r|² − 2n²))/(8 + 2N). Neighbours are at least
  // 220 km apart: ρ < exp(−26), f = 1 to the last bit.
  SourceErrors errors;
  double sum = 8 * 0.01;
  for (int n = 0; n < 12; ++n) {
    const double east = 0.05 + 0.01 * n, north = 0.12 - 0.02 * n;
    errors.see(lone_dive(n, east, north, kAlone, 0.02));
    sum += east * east + north * north - 2 * 0.02 * 0.02;
    CHECK(square(errors.spread("")) == Approx(sum / (8 + 2 * (n + 1))).epsilon(1e-12));
  }
  CHECK(errors.freedom("") == Approx(24).epsilon(1e-12));
}

TEST_CASE("the spread of residuals with a known one is found, the noise taken off") {
  // Σ|r|²/(σ² + n²) is χ² with 2N degrees of freedom: relative standard deviation 1/√N, of σ² (1 + n²/σ²)/√N. Four of
  // them; the prior counts with its 8 degrees. The cut at 18(V + n²) takes 1.2e-4, far less.
  const int count = 900;
  for (const double sigma : {0.05, 0.10, 0.25}) {
    const double noise = 0.03;
    std::mt19937_64 random{251};
    std::normal_distribution<double> error{0, std::hypot(sigma, noise)};
    SourceErrors errors;
    for (int n = 0; n < count; ++n) {
      const double east = error(random), north = error(random);
      errors.see(lone_dive(n, east, north, kAlone, noise));
    }
    const double expected = (8 * 0.01 + 2 * count * sigma * sigma) / (8 + 2 * count);
    const double tolerance = 4 * (sigma * sigma + noise * noise) / std::sqrt(count);
    INFO("sigma " << sigma);
    CHECK(std::abs(square(errors.spread("")) - expected) < tolerance);
  }
}

TEST_CASE("a good and a bad source are told apart by the places where one of them is nearly alone") {
  // Residuals of a mean have the spread Σ share·σ. 200 dives each in one, the other, and half of both. Those of one source
  // have χ² of 400 degrees or more: relative spread of σ below 1/√800 = 3.5 %; three of them, 11 %. The half-half dives
  // bring the mean's factor, whose error is no larger.
  const double good = 0.05, bad = 0.20;
  std::mt19937_64 random{252};
  std::normal_distribution<double> normal{0, 1};
  SourceErrors errors;
  for (int n = 0; n < 600; ++n) {
    const double of_good = n % 3 == 0 ? 1 : n % 3 == 1 ? 0 : 0.5;
    const double sigma = of_good * good + (1 - of_good) * bad;
    const double east = sigma * normal(random), north = sigma * normal(random);
    errors.see(lone_dive(n, east, north, {{"good", of_good}, {"bad", 1 - of_good}}));
  }
  CHECK(errors.spread("good").si() == Approx(good).epsilon(0.11));
  CHECK(errors.spread("bad").si() == Approx(bad).epsilon(0.11));
  CHECK(errors.spread({{"good", 0.5}, {"bad", 0.5}}).si() ==
        Approx(0.5 * errors.spread("good").si() + 0.5 * errors.spread("bad").si()).epsilon(1e-14));
}

TEST_CASE("a residual of a mean changes its sources by one factor and blames none") {
  // Both begin at the prior with equal shares: symmetry.
  SourceErrors errors;
  errors.see(lone_dive(0, 0.2, 0.1, {{"a", 0.5}, {"b", 0.5}}));
  CHECK(errors.spread("a") == errors.spread("b"));
  CHECK(square(errors.spread("a")) == Approx((8 * 0.01 + 0.5 * 0.05) / 9).epsilon(1e-14));
  CHECK(errors.spread("c").si() == 0.10);
}

TEST_CASE("where a value is borrowed the same residual says less") {
  // V is four times as large, so q a quarter: S = 0.05/4.
  SourceErrors errors;
  auto dive = lone_dive(0, 0.2, 0.1);
  dive.extrapolated = true;
  errors.see(dive);
  CHECK(square(errors.spread("")) == Approx((8 * 0.01 + 0.05 / 4) / 10).epsilon(1e-14));
}

TEST_CASE("one current that cannot be true moves little and a repeated one prevails") {
  // |r|² counts 18·0.01: σ² = (0.08 + 0.18)/10.
  SourceErrors errors;
  errors.see(lone_dive(0, 5, 0));
  CHECK(square(errors.spread("")) == Approx(0.026).epsilon(1e-12));
  for (int n = 1; n < 40; ++n) errors.see(lone_dive(n, 5, 0));
  CHECK(errors.spread("").si() > 2.0);
}

TEST_CASE("dives close to each other count as the fresh part of what they say") {
  // Same place, 4 h apart: ρ = exp(−1/6), f = (1 − ρ²)/(1 + ρ²) = tanh(1/6), and 4 h of forgetting between.
  SourceErrors errors;
  double expected = 0;
  for (int n = 0; n < 20; ++n) {
    auto dive = lone_dive(0, 0.1, 0);
    dive.at_s += 4 * 3600.0 * n;
    errors.see(dive);
    expected = expected * std::exp(-4.0 / 240) + 2 * (n == 0 ? 1 : std::tanh(1.0 / 6));
    CHECK(errors.freedom("") == Approx(expected).epsilon(1e-12));
  }
}

TEST_CASE("what is a month old counts a twentieth") {
  SourceErrors errors;
  for (int n = 0; n < 10; ++n) errors.see(lone_dive(n, 0.3, 0.3));
  auto later = lone_dive(31, 0.1, 0, {{"other", 1.0}});
  later.at_s += 30 * 86400.0;
  errors.see(later);
  CHECK(errors.freedom("") == Approx(20 * std::exp(-3.0)).epsilon(1e-12));
  CHECK(errors.freedom("other") == Approx(2).epsilon(1e-12));
}

TEST_CASE("the spread has a floor and leaves it with the first residual that is larger") {
  // Noise taken off residuals of zero would make S negative. At the floor V = 0.0009, so |r|² = 0.02 counts as 18·0.0009.
  SourceErrors errors;
  for (int n = 0; n < 400; ++n) errors.see(lone_dive(n, 0, 0, kAlone, 0.05));
  CHECK(errors.spread("").si() == Approx(SourceErrors::kFloor).epsilon(1e-12));
  errors.see(lone_dive(400, 0.1, 0.1));
  CHECK(square(errors.spread("")) == Approx((0.0009 * 808 + 18 * 0.0009) / 810).epsilon(1e-9));
}

TEST_CASE("residuals that are no numbers or name no source teach nothing") {
  SourceErrors errors;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  errors.see(lone_dive(0, nan, 0));
  errors.see(lone_dive(0, 0, 0, {}));
  errors.see(lone_dive(0, 0, 0, {{"a", 0.0}}));
  errors.see(lone_dive(0, 0, 0, {{"a", -1.0}, {"b", 2.0}}));
  CHECK(errors == SourceErrors{});
}
