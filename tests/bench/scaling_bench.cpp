#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"
#include "tests/bench/case_suite.hpp"

// What CTS-A* costs as its problem grows: processor time of one thread (the least of some runs), expansions and current evaluations of one search
// against grid cells, headings, stints and, in hourly fields, the horizon. Each row is the geometric mean over the seas; each exponent is the
// slope of a straight line through the logarithms by least squares, with the standard error that its residuals give.
//
//   scaling_bench [SEAS]     seas of each kind (default 3)

using namespace glidehelm;

namespace {

constexpr double kSpeed = 0.3;  // m/s
constexpr double kStint = 8 * 3600.0;
constexpr double kCell = 0.5 * kSpeed * kStint;  // metres, the default of the searches
constexpr int kHours = 192;                      // of the hourly fields

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Sums of logarithms of what one search of each sea costs.
struct Cost {
  double size{}, seconds{}, expansions{}, evaluations{};  ///< `size`: what the cost is held against
  int seas{};

  void add(double how_large, double took, const planning::Statistics& s) {
    size += std::log(how_large);
    seconds += std::log(took);
    expansions += std::log(static_cast<double>(s.expansions));
    evaluations += std::log(static_cast<double>(s.current_evaluations));
    ++seas;
  }
  [[nodiscard]] Cost mean() const { return {size / seas, seconds / seas, expansions / seas, evaluations / seas, seas}; }
};

struct Led {
  planning::Heuristic by;
  const char* name;
};
constexpr std::array kLed{Led{planning::Heuristic::envelope, "led by envelope"},
                          Led{planning::Heuristic::cost_to_go, "led by cost_to_go, whose making is included"}};

/// One step of a series: a problem made larger, and its size as the search itself tells it or as it was asked.
struct Step {
  planning::Problem problem;
  std::function<double(const planning::CtsSearch&)> size;
  bool nearest{};  ///< every label is expanded, also where the goal seems within reach
};
using Steps = std::function<std::vector<Step>(const suite::Case&)>;

/// The least of three runs, of one where it takes longer than half a second.
void measure(const suite::Case& c, const Step& step, planning::Heuristic by, Cost& cost) {
  auto problem = step.problem;
  problem.guidance.heuristic = by;
  double least = 1e9;
  planning::CtsSearch found;
  planning::CtsSettings settings;
  settings.nearest = step.nearest;
  for (int run = 0; run < 3; ++run) {
    const double before = processor_seconds();
    found = planning::search(problem, c.ocean(), c.chart(), {}, settings);
    least = std::min(least, processor_seconds() - before);
    if (least > 0.5) break;
  }
  if (!found.exhausted) std::printf("  CUT SHORT: %s\n", c.name.c_str());
  cost.add(step.size(found), least, found.statistics);
}

struct Exponent {
  double slope{}, error{};
};
Exponent exponent(const std::vector<Cost>& costs, double Cost::*what) {
  const auto n = static_cast<double>(costs.size());
  double x = 0, y = 0, xx = 0, xy = 0, rest = 0;
  for (const auto& c : costs) x += c.size / n, y += c.*what / n;
  for (const auto& c : costs) xx += (c.size - x) * (c.size - x), xy += (c.size - x) * (c.*what - y);
  const double slope = xy / xx;
  for (const auto& c : costs) rest += std::pow(c.*what - y - slope * (c.size - x), 2);
  return {slope, std::sqrt(rest / (n - 2) / xx)};
}

struct Series {
  std::string title, size;
  Steps steps;
  std::array<std::vector<Cost>, kLed.size()> costs{};

  void add(const suite::Case& c) {
    const auto all = steps(c);
    for (std::size_t h = 0; h < kLed.size(); ++h) {
      costs[h].resize(all.size());
      for (std::size_t k = 0; k < all.size(); ++k) measure(c, all[k], kLed[h].by, costs[h][k]);
    }
    std::fprintf(stderr, "%s, %s\n", size.c_str(), c.name.c_str());
  }
  void print() const {
    for (std::size_t h = 0; h < kLed.size(); ++h) print(kLed[h].name, costs[h]);
  }
  void print(const char* led, const std::vector<Cost>& all) const {
    std::vector<Cost> means;
    for (const auto& c : all) means.push_back(c.mean());
    std::printf("\n%s, %s; mean of %d seas\n  %14s %14s %14s %16s\n", title.c_str(), led, all.front().seas,
                size.c_str(), "processor s", "expansions", "evaluations");
    for (const auto& c : means)
      std::printf("  %14.6g %14.4f %14.0f %16.4g\n", std::exp(c.size), std::exp(c.seconds), std::exp(c.expansions),
                  std::exp(c.evaluations));
    std::printf("  %14s", "exponent");
    for (auto what : {&Cost::seconds, &Cost::expansions, &Cost::evaluations}) {
      const auto e = exponent(means, what);
      std::printf("   %5.2f +- %4.2f", e.slope, e.error);
    }
    std::printf("\n");
  }
};

std::function<double(const planning::CtsSearch&)> always(double size) {
  return [size](const planning::CtsSearch&) { return size; };
}

std::vector<Step> finer_cells(const suite::Case& c) {
  std::vector<Step> steps;
  for (double cell = 2 * kCell; cell > kCell / 4.1; cell /= std::sqrt(2.0)) {
    auto p = c.problem;
    p.cell = Metres{cell};
    steps.push_back({p, [](const planning::CtsSearch& found) { return static_cast<double>(found.cells); }});
  }
  return steps;
}

std::vector<Step> more_headings(const suite::Case& c) {
  std::vector<Step> steps;
  for (const int headings : {6, 9, 12, 18, 24, 36, 48, 72}) {
    auto p = c.problem;
    p.headings = headings;
    steps.push_back({p, always(headings)});
  }
  return steps;
}

std::vector<Step> longer_ways(const suite::Case& c) {
  const auto from = c.problem.start.fix, to = std::get<planning::PointGoal>(c.problem.goal).at;
  const auto way = geodesic(from, to);
  std::vector<Step> steps;
  for (const double share : {0.125, 0.177, 0.25, 0.354, 0.5, 0.707, 1.0}) {
    auto p = c.problem;
    p.goal = planning::PointGoal{destination(from, way.departing, share * way.length), Metres{2000}};
    p.horizon_s = p.start.fix_s + planning::automatic_horizon(p).count();
    steps.push_back({p, always(share * way.length.si() / (kSpeed * kStint))});
  }
  return steps;
}

std::vector<Step> shorter_stints(const suite::Case& c) {
  std::vector<Step> steps;
  for (double stint = 2 * kStint; stint > kStint / 4.1; stint /= std::sqrt(2.0)) {
    auto p = c.problem;
    p.schedule.stint = p.schedule.first_stint = Seconds{stint};
    p.cell = Metres{kCell};
    p.horizon_s = p.start.fix_s + planning::automatic_horizon(p).count();
    steps.push_back({p, always(suite::kLongWay / (kSpeed * stint))});
  }
  return steps;
}

/// The goal is far beyond the horizon: what can be reached until then is searched for the place nearest to it.
std::vector<Step> longer_horizons(const suite::Case& c, bool least_distance) {
  std::vector<Step> steps;
  for (const int hours : {24, 32, 48, 64, 96, 128, 192}) {
    auto p = c.problem;
    p.horizon_s = p.start.fix_s + 3600.0 * hours;
    if (least_distance) p.objective = planning::MinDistanceAt{p.horizon_s};
    steps.push_back({p, always(hours), true});
  }
  return steps;
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::clamp(std::atoi(argv[1]), 1, 10) : 3;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::printf(
      "CTS-A*, one search on one thread, U = %.1f m/s, 650 km; M = 18, stints of 8 h and cells of %.2f km where they "
      "do not "
      "vary\n",
      kSpeed, kCell / 1000);
  std::array still{Series{"Static seas, finer cells", "cells", finer_cells},
                   Series{"Static seas, more headings", "headings", more_headings},
                   Series{"Static seas, longer ways of stints of 8 h", "stints", longer_ways},
                   Series{"Static seas, shorter stints, cells as they are", "stints", shorter_stints}};
  auto seas = suite::static_cases(MetresPerSecond{kSpeed}, 2 * count);
  for (int k = 0; k < count; ++k)  // every second one has islands: those are left out
    for (auto& series : still) series.add(seas[static_cast<std::size_t>(2 * k)]);
  for (const auto& series : still) series.print();
  std::array moving{
      Series{"Hourly seas, later horizons, the place nearest to a goal beyond them (closest approach)", "hours",
             [](const suite::Case& c) { return longer_horizons(c, false); }},
      Series{"Hourly seas, later horizons, least distance at the horizon (a label for each number of stints)", "hours",
             [](const suite::Case& c) { return longer_horizons(c, true); }}};
  for (int k = 0; k < count; ++k) {
    const auto sea = suite::ensemble_case(MetresPerSecond{kSpeed}, k, kHours);
    for (auto& series : moving) series.add(sea);
  }
  for (const auto& series : moving) series.print();
}
