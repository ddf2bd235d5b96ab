#include "core/planning/heading_sampling.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/vehicle/constrained_motion.hpp"

using namespace glidehelm;
using planning::kCourses;

namespace {

constexpr double kStep = 2 * kPi / kCourses;

Current current(double speed, double towards) {
  return {MetresPerSecond{speed * std::sin(towards)}, MetresPerSecond{speed * std::cos(towards)}};
}

/// Probability of the candidates −n … n around number `middle`.
double mass(const planning::CourseWeights& w, int middle, int n) {
  double sum = 0;
  for (int i = middle - n; i <= middle + n; ++i) sum += w[static_cast<std::size_t>((i + 2 * kCourses) % kCourses)];
  return sum;
}

/// ∫ from 0 to x of √(1 − k² sin² t) + k cos t dt: the speed over ground in units of U_g, x from the current's direction.
double speed_integral(double k, double x) { return std::ellint_2(k, x) + k * std::sin(x); }

}  // namespace

TEST_CASE("the goal's density is the Gaussian of 4.16, wrapped") {
  // Candidates −n … n stand for ±(n + ½) spacings. The midpoint rule errs by at most h²/24·∫|f''| with ∫|f''| = 4·max|f'|
  // = 4/(σ²√(2πe)) for a Gaussian: 0.0873²/24 · 4/0.1745/4.1327 = 1.8e-3. The tail beyond π, 7.5 σ, is nothing.
  const auto w = planning::goal_weights();
  const double sigma = std::sqrt(0.1745);
  CHECK(std::accumulate(w.begin(), w.end(), 0.0) == Approx(1).epsilon(1e-12));
  for (int n = 0; n < kCourses / 2; ++n) {
    INFO(n);
    CHECK(mass(w, 0, n) == Approx(std::erf((n + 0.5) * kStep / sigma / std::sqrt(2.0))).margin(1.8e-3));
  }
  for (std::size_t i = 1; i < kCourses; ++i) CHECK(w[i] == Approx(w[kCourses - i]).epsilon(1e-12));  // it wraps
}

TEST_CASE("the current's density is the speed over ground, an elliptic integral") {
  // F(x) = (E(x, k) + k sin x)/(2·E(π, k)) for −x … x counted from the current, k = U_c/U_g < 1. |f''| of √(1 − k² sin²) + k cos is
  // at most k²/√(1 − k²) + k: at k = 0.8 that is 1.87, and the midpoint rule over half a turn errs by π·h²/24·1.87 = 1.9e-3 of an
  // integral of 2·E(π, 0.8) = 5.1: 7.3e-4 for both sides.
  const double towards = 1.1;
  for (const double k : {0.0, 0.3, 0.8}) {
    const auto w = planning::speed_weights(towards, 0.3, current(0.3 * k, towards));
    for (int n = 0; n < kCourses / 2; ++n) {
      INFO(k << ", " << n);
      const double x = (n + 0.5) * kStep;
      CHECK(mass(w, 0, n) == Approx(speed_integral(k, x) / speed_integral(k, kPi)).margin(8e-4));
    }
  }
}

TEST_CASE("in a current stronger than the vehicle all weight lies in its cone") {
  // k > 1: E(x, k) = k·E(β, 1/k) − (k² − 1)/k·F(β, 1/k) with sin β = k sin x, up to x = asin(1/k). At the edge of the cone the
  // density drops to k cos x, and the rule errs by up to half a candidate's weight there: h/2·f(edge)/∫f on each side; inside,
  // the root's infinite slope at the edge costs less than that once more.
  const double towards = 2.0;
  for (const double k : {1.2, 2.0, 4.0}) {
    const double edge = std::asin(1 / k);
    const auto integral = [&](double x) {
      const double beta = std::asin(std::min(1.0, k * std::sin(x)));
      return k * std::ellint_2(1 / k, beta) - (k * k - 1) / k * std::ellint_1(1 / k, beta) + k * std::sin(x);
    };
    const double tolerance = 2 * kStep * k * std::cos(edge) / (2 * integral(edge)) + 0.01;
    const auto w = planning::speed_weights(towards, 0.3, current(0.3 * k, towards));
    for (int n = 0; n < kCourses / 2; ++n) {
      INFO(k << ", " << n);
      CHECK(mass(w, 0, n) == Approx(integral(std::min(edge, (n + 0.5) * kStep)) / integral(edge)).margin(tolerance));
      if (n * kStep > edge) CHECK(w[static_cast<std::size_t>(n)] == 0);
    }
  }
  // Current against the first candidate and stronger: nothing there, although |s| ≤ 1.
  CHECK(planning::speed_weights(towards, 0.3, current(0.4, towards + kPi))[0] == 0);
  // A cone between two candidates holds none of them.
  const auto none = planning::speed_weights(towards + 0.5 * kStep, 0.3, current(0.3 * 40, towards));
  CHECK(*std::max_element(none.begin(), none.end()) == 0);
}

TEST_CASE("the current's density turns with the current") {
  // Turning current and candidates together changes nothing but rounding; turning the current alone by one spacing shifts it.
  const auto at = [](double first, double towards) {
    return planning::speed_weights(first, 0.3, current(0.2, towards));
  };
  const auto a = at(0.3, 1.0), together = at(1.3, 2.0), shifted = at(0.3, 1.0 + kStep);
  for (std::size_t i = 0; i < kCourses; ++i) {
    CHECK(together[i] == Approx(a[i]).epsilon(1e-12));
    CHECK(shifted[(i + 1) % kCourses] == Approx(a[i]).epsilon(1e-12));
  }
}

TEST_CASE("systematic resampling keeps every count within one of its share, and is right on average") {
  const auto weights = planning::goal_weights();
  for (const int m : {1, 8, 15, 18, 72}) {
    std::vector<int> chosen(static_cast<std::size_t>(m)), total(kCourses, 0);
    constexpr int kDraws = 1000;
    for (int d = 0; d < kDraws; ++d) {
      planning::resample(weights, (d + 0.5) / kDraws, chosen);
      CHECK(std::is_sorted(chosen.begin(), chosen.end()));
      std::vector<int> counts(kCourses, 0);
      for (const int i : chosen) ++counts[static_cast<std::size_t>(i)], ++total[static_cast<std::size_t>(i)];
      for (std::size_t i = 0; i < kCourses; ++i)
        if (std::abs(counts[i] - m * weights[i]) >= 1) FAIL("count " << counts[i] << " of share " << m * weights[i]);
    }
    // r runs evenly over [0, 1), so the mean count is the share itself, to one draw at either end of the index's interval.
    for (std::size_t i = 0; i < kCourses; ++i)
      CHECK(total[i] / double{kDraws} == Approx(m * weights[i]).margin(2.0 / kDraws));
  }
}

TEST_CASE("duplicates are spread between the midpoints to their neighbours, the first of them stays") {
  planning::Draws draws{1, 0};
  std::vector<double> angles{0.0, 0.1, 0.1, 0.1, 0.4, 6.0, 6.0};
  planning::repair_duplicates(angles, draws);
  for (const double kept : {0.0, 0.1, 0.4, 6.0}) CHECK(std::count(angles.begin(), angles.end(), kept) == 1);
  for (std::size_t i : {1U, 2U, 3U}) CHECK((angles[i] >= 0.05 && angles[i] <= 0.25));
  // Across the closing of the circle: the neighbour after 6.0 is 0.0 + 2π.
  for (std::size_t i : {5U, 6U}) CHECK((angles[i] >= 3.2 && angles[i] <= 0.5 * (6.0 + 2 * kPi)));
  CHECK(std::is_sorted(angles.begin(), angles.end()));
  CHECK(std::adjacent_find(angles.begin(), angles.end()) == angles.end());
  // All the same: the whole circle is theirs.
  std::vector<double> same(50, 1.0);
  planning::repair_duplicates(same, draws);
  CHECK(same.back() - same.front() > 4);  // 49 uniform draws on 2π span less with a chance of 1e-7
  CHECK(std::adjacent_find(same.begin(), same.end()) == same.end());
  // The draws are uniform: their mean over the interval of width 2π is 1.0 with deviation 2π/√12/√49 = 0.26; five of these.
  CHECK(std::accumulate(same.begin(), same.end(), 0.0) / 50 == Approx(1.0).margin(1.3));
}

TEST_CASE("drawn headings follow the mixed density, keep the goal's direction and depend on seed and stream alone") {
  const double to_goal = 0.7;
  const auto c = current(0.15, 2.5);
  const planning::AdaptiveHeadings a{MetresPerSecond{0.3}, 5}, other{MetresPerSecond{0.3}, 6};
  std::vector<double> first(18), again(18);
  a.draw(to_goal, c, 3, first);
  a.draw(to_goal, c, 3, again);
  CHECK(first == again);
  a.draw(to_goal, c, 4, again);
  CHECK(first != again);
  other.draw(to_goal, c, 3, again);
  CHECK(first != again);

  // Courses made good by the headings: over many draws the share in each sector of 30° (6 candidates) is the density's. Systematic
  // sampling puts at most one more or less into it than its share, with a mean error that falls as 1/√draws: 1/18/√400 = 0.3 %
  // per draw of M = 18; moving one sample to the goal shifts up to 1/18 into the goal's sector from beside it, within its
  // spacing of at most 1/18 of the probability.
  const auto by_goal = planning::goal_weights(), by_speed = planning::speed_weights(to_goal, 0.3, c);
  std::vector<double> share(12), wanted(12);
  for (std::size_t i = 0; i < kCourses; ++i) wanted[i / 6] += 0.5 * (by_goal[i] + by_speed[i]);
  constexpr int kDraws = 400;
  for (int d = 0; d < kDraws; ++d) {
    a.draw(to_goal, c, static_cast<std::uint64_t>(d), first);
    bool goal_held = false;
    for (const double heading : first) {
      const double east = 0.3 * std::sin(heading) + c.east.si(), north = 0.3 * std::cos(heading) + c.north.si();
      const double off = std::remainder(std::atan2(east, north) - to_goal, 2 * kPi);
      goal_held = goal_held || std::abs(off) < 1e-9;
      const double turn = off + 1e-9 < 0 ? off + 1e-9 + 2 * kPi : off + 1e-9;  // candidates lie on the sectors' borders
      ++share[std::min<std::size_t>(11, static_cast<std::size_t>(turn / (kPi / 6)))];
    }
    CHECK(goal_held);
  }
  for (std::size_t s = 0; s < 12; ++s) {
    INFO("sector " << s);
    CHECK(share[s] / (18.0 * kDraws) == Approx(wanted[s]).margin(0.003 + (s == 0 || s == 11 ? 1.0 / 18 : 0.0)));
  }
}

TEST_CASE("courses that cannot be held serve as headings") {
  // Strong current abeam of the goal: its course is outside the cone.
  const planning::AdaptiveHeadings a{MetresPerSecond{0.3}, 1};
  std::vector<double> headings(8);
  a.draw(0.5, current(2.0, 0.5 + kPi / 2), 0, headings);
  CHECK(std::count_if(headings.begin(), headings.end(), [](double h) { return std::abs(h - 0.5) < 1e-12; }) == 1);
}
