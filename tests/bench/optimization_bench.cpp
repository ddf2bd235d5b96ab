#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "core/planning/flight.hpp"
#include "core/planning/optimization.hpp"
#include "core/planning/registry.hpp"
#include "tests/bench/case_suite.hpp"

// The kernels of optimization (Thesis 4.6.3), from the straight first way and from the searched one:
//  - iterative-optimization on static cases of 650 km at 0.4 m/s, in the form of Tables 4.1 and 4.2: travel time and computing time (of the processor) as
//    percentages, sqp (the Thesis's fmincon) over the kernel, so that less than 100 % is worse;
//  - optimization on its own problem, the dynamic cases: distance left at the horizon less that of best.
//
//   optimization_bench [STATIC [DYNAMIC]]     cases of each (default 10 and, at each speed, 45)

using namespace glidehelm;

namespace {

/// Of this thread: other programs do not count.
double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Result {
  double travel_s{std::nan("")}, remaining_km{}, processor_s{};
  std::uint64_t work{};
};

Result run(const planning::Planner& planner, const suite::Case& c, const planning::Problem& problem) {
  const std::array<ocean::Ocean, 1> members{c.ocean()};
  const double before = processor_seconds();
  const auto plan = planner.plan(problem, members, c.chart(), {}, {});
  Result r;
  r.processor_s = processor_seconds() - before;
  // Without a plan the glider stays where it is.
  r.remaining_km = distance(problem.start.fix, planning::disc_of(problem).centre).si() / 1000;
  if (!plan) return r;
  r.remaining_km = plan->remaining.si() / 1000;
  r.work = plan->statistics.expansions;
  if (plan->reaches_goal()) r.travel_s = plan->arrival_s - problem.start.fix_s;
  return r;
}

struct Column {
  std::string name;
  std::vector<Result> results;
};
using Value = double (*)(const Result&);

template <class Method>
std::vector<Column> kernels(const std::vector<suite::Case>& cases, planning::FirstWay first, const char* title,
                            planning::Problem (*asked)(const suite::Case&)) {
  std::vector<Column> columns;
  for (const auto kernel : planning::kKernels) {
    planning::OptimizationSettings settings;
    settings.kernel = kernel;
    settings.first = first;
    Column column{std::string{planning::word(kernel)}, {}};
    for (const auto& c : cases) column.results.push_back(run(Method{settings}, c, asked(c)));
    columns.push_back(std::move(column));
    std::fprintf(stderr, "%s, %s\n", title, columns.back().name.c_str());
  }
  return columns;
}

void print_head(const char* title, const std::vector<Column>& columns) {
  std::printf("\n%s\n%-26s", title, "case");
  for (const auto& c : columns) std::printf(" %14s", c.name.c_str());
  std::printf("\n");
}

/// The value of a column's case; of `relative` that of the last column, the reference, over it, in per cent.
double entry(const std::vector<Column>& columns, std::size_t column, std::size_t i, Value value, bool relative) {
  const double mine = value(columns[column].results[i]);
  return relative ? 100 * value(columns.back().results[i]) / mine : mine;
}

void print_entry(double v, int digits, bool relative) {
  if (std::isnan(v)) {
    std::printf(" %14s", "-");
    return;
  }
  const double unit = std::pow(10.0, digits);
  const double rounded = std::round(v * unit) / unit + 0.0;  // no minus before a nought
  std::printf(" %*.*f%s", relative ? 12 : 14, digits, rounded, relative ? " %" : "");
}

/// A row for each case, then the mean over the cases in which every column has a value; NaN: "-".
void print(const char* title, const std::vector<suite::Case>& cases, const std::vector<Column>& columns, Value value,
           int digits, bool relative) {
  print_head(title, columns);
  std::vector<double> sums(columns.size());
  int complete = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    std::vector<double> row;
    for (std::size_t k = 0; k < columns.size(); ++k) row.push_back(entry(columns, k, i, value, relative));
    std::printf("%-26s", cases[i].name.c_str());
    for (const double v : row) print_entry(v, digits, relative);
    std::printf("\n");
    if (std::any_of(row.begin(), row.end(), [](double v) { return std::isnan(v); })) continue;
    for (std::size_t k = 0; k < columns.size(); ++k) sums[k] += row[k];
    ++complete;
  }
  std::printf("mean of %-18d", complete);
  for (const double sum : sums) print_entry(complete > 0 ? sum / complete : std::nan(""), digits, relative);
  std::printf("\n");
}

const char* word(planning::FirstWay first) {
  return first == planning::FirstWay::straight ? "straight" : "of a coarse CTS-A*";
}
constexpr std::array kFirstWays{planning::FirstWay::straight, planning::FirstWay::searched};

double travel_hours(const Result& r) { return r.travel_s / 3600; }
double computing_seconds(const Result& r) { return r.processor_s; }
double work(const Result& r) { return static_cast<double>(r.work); }

void least_time(int count) {
  const auto cases = suite::static_cases(MetresPerSecond{0.4}, count);
  for (const auto first : kFirstWays) {
    const auto columns = kernels<planning::IterativeOptimization>(cases, first, "least time",
                                                                  [](const suite::Case& c) { return c.problem; });
    std::printf("\n==== iterative-optimization, static, 650 km, U = 0.4 m/s, first way %s\n", word(first));
    print("travel time, sqp over the kernel (Table 4.1): less than 100 % is worse", cases, columns, travel_hours, 2,
          true);
    print("computing time, sqp over the kernel (Table 4.2): less than 100 % is worse", cases, columns,
          computing_seconds, 2, true);
    print("travel time, hours; -: does not arrive", cases, columns, travel_hours, 2, false);
    print("computing time, seconds", cases, columns, computing_seconds, 3, false);
    print("flights of the kernel and expansions of the search", cases, columns, work, 0, false);
  }
}

planning::Problem least_distance_at_horizon(const suite::Case& c) {
  auto problem = c.problem;
  problem.objective = planning::MinDistanceAt{problem.horizon_s};
  return problem;
}

void least_distance(double speed, int count) {
  const auto cases = suite::dynamic_cases(MetresPerSecond{speed}, count);
  std::vector<Result> best;
  for (const auto& c : cases) best.push_back(run(*planning::planner_named("best"), c, least_distance_at_horizon(c)));
  for (const auto first : kFirstWays) {
    auto columns = kernels<planning::Optimization>(cases, first, "least distance", least_distance_at_horizon);
    for (auto& column : columns)
      for (std::size_t i = 0; i < cases.size(); ++i) column.results[i].remaining_km -= best[i].remaining_km;
    std::printf("\n==== optimization, dynamic, U = %.1f m/s, first way %s\n", speed, word(first));
    print(
        "distance left at the horizon less that of best, km: positive is worse", cases, columns,
        [](const Result& r) { return r.remaining_km; }, 2, false);
    print("computing time, seconds", cases, columns, computing_seconds, 3, false);
    print("flights of the kernel and expansions of the search", cases, columns, work, 0, false);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int still = std::clamp(argc > 1 ? std::atoi(argv[1]) : 10, 0, 20);
  const int moving = std::clamp(argc > 2 ? std::atoi(argv[2]) : 45, 0, 45);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  if (still > 0) least_time(still);
  if (moving > 0)
    for (const double speed : {0.4, 0.2}) least_distance(speed, moving);
}
