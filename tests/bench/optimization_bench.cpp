#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/planning/flight.hpp"
#include "core/planning/optimization.hpp"
#include "core/planning/registry.hpp"
#include "tests/bench/case_suite.hpp"

// The kernels of optimization on the dynamic cases of the suite, in the form of Thesis Tables 4.1 and 4.2: distance left at the
// horizon, time and flights of each kernel, from the straight first way and from the searched one.
//
//   optimization_bench [CASES]     dynamic cases at each speed (default 9 of 45)

using namespace glidehelm;

namespace {

struct Result {
  double remaining_km{}, wall_s{};
  std::uint64_t work{};
};

Result run(const planning::Planner& planner, const suite::Case& c) {
  auto problem = c.problem;
  problem.objective = planning::MinDistanceAt{problem.horizon_s};
  const std::array<ocean::Ocean, 1> members{c.ocean()};
  const auto begin = std::chrono::steady_clock::now();
  const auto plan = planner.plan(problem, members, c.chart(), {}, {});
  Result r;
  r.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  // Without a plan the glider stays where it is.
  r.remaining_km = distance(problem.start.fix, planning::disc_of(problem).centre).si() / 1000;
  if (!plan) return r;
  r.remaining_km = plan->remaining.si() / 1000;
  r.work = plan->statistics.expansions;
  return r;
}

struct Column {
  std::string name;
  std::vector<Result> results;
};

void print(const char* title, const std::vector<suite::Case>& cases, const std::vector<Column>& columns,
           double (*value)(const Result&), const char* format, const Column* reference) {
  std::printf("\n%s\n%-24s", title, "case");
  for (const auto& c : columns) std::printf(" %14s", c.name.c_str());
  std::printf("\n");
  std::vector<double> sums(columns.size());
  const auto row = [&](std::size_t k, double v, double against) {
    sums[k] += v;
    std::printf(format, reference != nullptr ? v - against : v);
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    std::printf("%-24s", cases[i].name.c_str());
    for (std::size_t k = 0; k < columns.size(); ++k)
      row(k, value(columns[k].results[i]), reference != nullptr ? value(reference->results[i]) : 0);
    std::printf("\n");
  }
  double base = 0;
  if (reference != nullptr)
    for (const auto& r : reference->results) base += value(r);
  std::printf("%-24s", "mean");
  for (const double sum : sums) std::printf(format, (sum - base) / static_cast<double>(cases.size()));
  std::printf("\n");
}

void compare(double speed, int count) {
  const auto cases = suite::dynamic_cases(MetresPerSecond{speed}, count);
  Column best{"best", {}};
  for (const auto& c : cases) best.results.push_back(run(*planning::planner_named("best"), c));
  for (const auto first : {planning::FirstWay::straight, planning::FirstWay::searched}) {
    std::vector<Column> columns;
    for (const auto kernel : planning::kKernels) {
      planning::OptimizationSettings settings;
      settings.kernel = kernel;
      settings.first = first;
      Column column{std::string{planning::word(kernel)}, {}};
      for (const auto& c : cases) column.results.push_back(run(planning::Optimization{settings}, c));
      columns.push_back(std::move(column));
      std::fprintf(stderr, "U = %.1f, %s\n", speed, columns.back().name.c_str());
    }
    std::printf("\n==== U = %.1f m/s, first way %s\n", speed,
                first == planning::FirstWay::straight ? "straight" : "of a coarse CTS-A*");
    print(
        "distance left at the horizon less that of best, km (Table 4.1): positive is worse", cases, columns,
        [](const Result& r) { return r.remaining_km; }, " %14.2f", &best);
    print(
        "time, seconds (Table 4.2)", cases, columns, [](const Result& r) { return r.wall_s; }, " %14.3f", nullptr);
    print(
        "flights of the kernel and expansions of the search", cases, columns,
        [](const Result& r) { return static_cast<double>(r.work); }, " %14.0f", nullptr);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int count = std::clamp(argc > 1 ? std::atoi(argv[1]) : 9, 1, 45);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  for (const double speed : {0.4, 0.2}) compare(speed, count);
}
