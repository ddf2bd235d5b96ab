#include "tests/support/mann_whitney.hpp"

#include <catch2/catch.hpp>

#include <numeric>

// The statistics that methods are compared with.

using namespace glidehelm;

namespace {

/// Two-sided exact p of a U for samples of n and m without ties.
double exact_p(std::size_t u, std::size_t n, std::size_t m) {
  const auto shares = test::u_distribution(n, m);
  return 2 * std::accumulate(shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(u) + 1, 0.0);
}

}  // namespace

TEST_CASE("the exact distribution of U reproduces the published critical values") {
  // Two-sided 5 %: the largest U that is still significant, as in every printed table after Mann and Whitney (1947).
  struct Row {
    std::size_t n, m, critical;
  };
  for (const auto& row :
       {Row{4, 4, 0}, {5, 5, 2}, {8, 8, 13}, {10, 10, 23}, {8, 12, 22}, {15, 15, 64}, {20, 20, 127}}) {
    INFO(row.n << ", " << row.m);
    CHECK(exact_p(row.critical, row.n, row.m) <= 0.05);
    CHECK(exact_p(row.critical + 1, row.n, row.m) > 0.05);
    const auto shares = test::u_distribution(row.n, row.m);
    CHECK(shares.size() == row.n * row.m + 1);
    CHECK(std::accumulate(shares.begin(), shares.end(), 0.0) == Approx(1).epsilon(1e-12));
  }
  CHECK(exact_p(2, 5, 5) == Approx(2 * 4 / 252.0).epsilon(1e-12));  // orders with U = 0, 1, 2, 2 among C(10, 5)
}

TEST_CASE("the normal approximation reproduces Thesis Table 5.4") {
  // 21 cases each. What the table calls U exceeds 21·21 = 441: it is the rank sum W = U + n(n + 1)/2. With that its p-values come
  // out, to the three digits printed, but one: 0.101 for W = 456 is the deviate z, and p is 0.920.
  const auto deviate = [](double w) { return test::normal_deviate(w - 21 * 22 / 2.0, 21, 21); };
  CHECK(test::two_sided(deviate(438.5)) == Approx(0.753).margin(5e-4));
  CHECK(test::two_sided(deviate(511)) == Approx(0.138).margin(5e-4));
  CHECK(test::two_sided(deviate(551)) == Approx(0.013).margin(5e-4));
  CHECK(test::two_sided(deviate(452)) == Approx(1.000).margin(5e-4));
  CHECK(test::two_sided(deviate(451)) == Approx(1.000).margin(5e-4));
  CHECK(deviate(456) == Approx(0.101).margin(5e-4));
  CHECK(test::two_sided(deviate(456)) == Approx(0.920).margin(5e-4));
}

TEST_CASE("U counts pairs, ties half, and both samples share them") {
  const std::vector<double> a{1, 3, 3, 7}, b{2, 3, 9};
  double pairs = 0;
  for (const double x : a)
    for (const double y : b) pairs += x > y ? 1 : x == y ? 0.5 : 0;
  const auto ab = test::mann_whitney(a, b), ba = test::mann_whitney(b, a);
  CHECK(ab.u == Approx(pairs));
  CHECK(ab.u + ba.u == Approx(12));
  CHECK(ab.p == Approx(ba.p));
  CHECK(ab.z == Approx(-ba.z));
  CHECK_FALSE(ab.exact);
  // Variance with a tie of three: 12/12·(8 − 24/42) = 7.4286; |5 − 6| − ½ = ½.
  CHECK(std::abs(ab.z) == Approx(0.5 / std::sqrt(8 - 24 / 42.0)));
  const auto same = test::mann_whitney({2, 2}, {2, 2, 2});
  CHECK(same.p == 1);
  CHECK(same.z == 0);
}

TEST_CASE("without ties small samples are judged exactly") {
  const auto r = test::mann_whitney({1, 2, 3, 4, 5}, {6, 7, 8, 9, 10});
  CHECK(r.exact);
  CHECK(r.u == 0);
  CHECK(r.p == Approx(2 / 252.0));
  // For samples of 30 exact and approximate p agree: the continuity-corrected approximation is good to 0.002 there.
  std::vector<double> x, y;
  for (int i = 0; i < 30; ++i) x.push_back(3 * i + (i % 7)), y.push_back(3 * i + 12.5);
  const auto both = test::mann_whitney(x, y);
  CHECK(both.exact);
  CHECK(both.p == Approx(test::two_sided(both.z)).margin(2e-3));
}
