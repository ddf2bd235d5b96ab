#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "core/planning/cts_astar.hpp"
#include "tests/bench/case_suite.hpp"
#include "tests/support/mann_whitney.hpp"

// ABS against CTS-A* with uniform headings and M = 18, in the form of Thesis Tables 5.1 to 5.4: 21 static seas of 650 km, U = 0.4 m/s,
// stints of 8 h. One search each, at the default cell; ABS with several seeds, whose mean stands in the tables. Speedup is uniform over
// ABS: above 100 % ABS is the better one. Times are of one thread's processor, the least of three runs.

using namespace glidehelm;

namespace {

constexpr int kCases = 21, kSeeds = 5;
constexpr std::array kSamples{18, 15, 8};

struct Result {
  double days{}, seconds{};
};

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Result run(const suite::Case& c, int headings, std::uint64_t seed, planning::HeadingSampling sampling) {
  auto problem = c.problem;
  problem.headings = headings;
  problem.seed = seed;
  planning::CtsSettings settings;
  settings.sampling = sampling;
  Result best{0, 1e9};
  for (int i = 0; i < 3; ++i) {
    const double before = processor_seconds();
    const auto found = planning::search(problem, c.ocean(), c.chart(), {}, settings);
    best.seconds = std::min(best.seconds, processor_seconds() - before);
    best.days = (found.arrival_s - problem.start.fix_s) / 86400;
  }
  return best;
}

struct Summary {
  double mean{}, deviation{};
};
Summary summary(const std::vector<double>& x) {
  Summary s;
  for (const double v : x) s.mean += v / static_cast<double>(x.size());
  for (const double v : x) s.deviation += (v - s.mean) * (v - s.mean) / static_cast<double>(x.size() - 1);
  s.deviation = std::sqrt(s.deviation);
  return s;
}

struct Column {
  std::string name;
  int samples;
  std::vector<double> days, seconds;  ///< per case
};

void print_speedups(const char* title, const Column& peer, const std::vector<Column>& columns,
                    std::vector<double> Column::*what) {
  std::printf("\n%s\n\n| case | M = 18 | M = 15 | M = 8 |\n|---|---|---|---|\n", title);
  std::array<std::vector<double>, kSamples.size()> all;
  for (std::size_t i = 0; i < kCases; ++i) {
    std::printf("| %zu |", i + 1);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      all[k].push_back(100 * (peer.*what)[i] / (columns[k].*what)[i]);
      std::printf(" %.1f %% |", all[k].back());
    }
    std::printf("\n");
  }
  std::printf("| mean (deviation) |");
  for (const auto& x : all) std::printf(" %.1f (%.1f) %% |", summary(x).mean, summary(x).deviation);
  std::printf("\n");
}

}  // namespace

int main() {
  const auto cases = suite::static_cases(MetresPerSecond{0.4}, kCases);
  Column uniform{"CTS-A*", 18, {}, {}};
  std::vector<Column> columns;
  for (const int m : kSamples) columns.push_back({"ABS CTS-A*", m, {}, {}});
  for (const auto& c : cases) {
    const auto one = run(c, 18, 1, planning::HeadingSampling::uniform);
    uniform.days.push_back(one.days);
    uniform.seconds.push_back(one.seconds);
    for (auto& column : columns) {
      Result mean;
      for (int seed = 1; seed <= kSeeds; ++seed) {
        const auto r = run(c, column.samples, static_cast<std::uint64_t>(seed), planning::HeadingSampling::adaptive);
        mean.days += r.days / kSeeds;
        mean.seconds += r.seconds / kSeeds;
      }
      column.days.push_back(mean.days);
      column.seconds.push_back(mean.seconds);
    }
  }
  print_speedups("Travel time, uniform M = 18 over ABS (Table 5.1)", uniform, columns, &Column::days);
  print_speedups("Computing time, uniform M = 18 over ABS (Table 5.2)", uniform, columns, &Column::seconds);
  std::printf("\nTravel time in days (Table 5.3)\n\n| method | M | mean | 95 %% CI of the mean |\n|---|---|---|---|\n");
  std::vector<Column> all{uniform};
  all.insert(all.end(), columns.begin(), columns.end());
  for (const auto& column : all) {
    const auto s = summary(column.days);
    const double half = 2.086 * s.deviation / std::sqrt(double{kCases});  // Student's t with 20 degrees of freedom
    std::printf("| %s | %d | %.2f | [%.2f, %.2f] |\n", column.name.c_str(), column.samples, s.mean, s.mean - half,
                s.mean + half);
  }
  std::printf(
      "\nMann–Whitney–Wilcoxon against uniform M = 18, 5 %% (Table 5.4)\n\n| M | U of time | p | | U of travel | p | "
      "|\n"
      "|---|---|---|---|---|---|---|\n");
  for (const auto& column : columns) {
    const auto time = test::mann_whitney(uniform.seconds, column.seconds);
    const auto days = test::mann_whitney(uniform.days, column.days);
    std::printf("| %d | %.1f | %.3f | %s | %.1f | %.3f | %s |\n", column.samples, time.u, time.p,
                time.p < 0.05 ? "H1" : "H0", days.u, days.p, days.p < 0.05 ? "H1" : "H0");
  }
}
