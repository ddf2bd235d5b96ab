#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace glidehelm::test {

/// Outcome of a Mann–Whitney–Wilcoxon test of two independent samples.
struct MannWhitney {
  double u{};    ///< of the first sample: pairs in which it is the greater, ties counted half
  double p{};    ///< two-sided
  double z{};    ///< of the normal approximation, with ties and continuity corrected; 0 when everything is tied
  bool exact{};  ///< p by counting all orders, else by the normal approximation
};

/// Number of the orders of n and m values in which U is each of 0 … n·m, as a share of all of them. By recursion over the
/// largest value: it belongs to the first sample and beats all m of the second, or it does not. O(n²·m²) work.
inline std::vector<double> u_distribution(std::size_t n, std::size_t m) {
  // ways[j] holds, for i of the first and j of the second, the shares of U; i grows.
  std::vector<std::vector<double>> ways(m + 1, std::vector<double>{1.0});
  for (std::size_t i = 1; i <= n; ++i) {
    std::vector<std::vector<double>> next(m + 1);
    next[0] = {1.0};
    for (std::size_t j = 1; j <= m; ++j) {
      next[j].assign(i * j + 1, 0.0);
      const double first = static_cast<double>(i) / static_cast<double>(i + j);
      for (std::size_t u = 0; u < ways[j].size(); ++u) next[j][u + j] += first * ways[j][u];
      for (std::size_t u = 0; u < next[j - 1].size(); ++u) next[j][u] += (1 - first) * next[j - 1][u];
    }
    ways = std::move(next);
  }
  return ways[m];
}

/// Standard normal deviate of U, for samples of n and m values, corrected for continuity; `ties` is Σ(t³ − t) over groups of t equal
/// values. 0 when everything is tied.
inline double normal_deviate(double u, double n, double m, double ties = 0) {
  const double both = n + m, variance = n * m / 12 * (both + 1 - (both > 1 ? ties / (both * (both - 1)) : 0));
  const double off = std::max(0.0, std::abs(u - n * m / 2) - 0.5);
  return variance > 0 ? std::copysign(off / std::sqrt(variance), u - n * m / 2) : 0;
}
/// Two-sided p of a normal deviate.
inline double two_sided(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

/// Tests whether two samples come from one distribution (Mann and Whitney 1947; Thesis 5.4.3, Table 5.4). Without ties and with
/// at most 30 values in each the exact distribution; else the normal approximation with the variance
/// nm/12·((N + 1) − Σ(t³ − t)/(N(N − 1))) for ties of t values and a continuity correction of ½. Precondition: neither is empty.
inline MannWhitney mann_whitney(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<std::pair<double, bool>> all;
  for (const double x : a) all.emplace_back(x, true);
  for (const double x : b) all.emplace_back(x, false);
  std::sort(all.begin(), all.end());
  double rank_sum = 0, ties = 0;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i;
    double of_a = 0;
    while (end < all.size() && all[end].first == all[i].first) of_a += all[end++].second ? 1 : 0;
    const double t = static_cast<double>(end - i);
    rank_sum += of_a * (static_cast<double>(i + end + 1) / 2);
    ties += t * t * t - t;
    i = end;
  }
  const double n = static_cast<double>(a.size()), m = static_cast<double>(b.size());
  MannWhitney r;
  r.u = rank_sum - n * (n + 1) / 2;
  r.z = normal_deviate(r.u, n, m, ties);
  r.exact = ties == 0 && a.size() <= 30 && b.size() <= 30;
  if (!r.exact) {
    r.p = two_sided(r.z);
    return r;
  }
  const auto shares = u_distribution(a.size(), b.size());
  const auto tail = static_cast<std::size_t>(std::min(r.u, n * m - r.u));
  double sum = 0;
  for (std::size_t u = 0; u <= tail; ++u) sum += shares[u];
  r.p = std::min(1.0, 2 * sum);
  return r;
}

}  // namespace glidehelm::test
