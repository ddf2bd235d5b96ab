#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/planning/lower_bound.hpp"
#include "core/planning/registry.hpp"
#include "tests/bench/case_suite.hpp"

// The sandwich: plan and bound on the same seas. For every case the bound with its bar, the share of the bar, how far the best
// plan lies above the bound, and the time of both. A plan below its bound is printed as WRONG, and the program then fails.
// Arguments: cases per speed (default 20).

using namespace glidehelm;

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

struct Worst {
  double gap{}, bar{}, seconds{};
  int cases{}, bounded{}, wrong{};
};

void run(const suite::Case& c, Worst& worst) {
  const std::array<ocean::Ocean, 1> members{c.ocean()};
  const auto plan = planning::planner_named("best")->plan(c.problem, members, c.chart(), {}, {});
  const bool arrives = plan && plan->reaches_goal();
  const double travel = arrives ? plan->arrival_s - c.problem.start.fix_s : std::nan("");
  planning::BoundSettings settings;
  if (arrives) settings.earlier_than_s = plan->arrival_s;
  const auto begin = std::chrono::steady_clock::now();
  const auto bound = planning::lower_bound(c.problem, c.ocean(), c.chart(), {}, settings);
  const double took = seconds_since(begin);
  ++worst.cases;
  worst.seconds = std::max(worst.seconds, took);
  if (!bound || bound->kind != planning::Bound::Kind::arrival) {
    const bool wrong = bound && bound->kind == planning::Bound::Kind::unreachable && arrives;
    worst.wrong += wrong ? 1 : 0;
    std::printf("%-28s plan %8.2f h, %s %s in %.2f s\n", c.name.c_str(), travel / 3600,
                wrong ? "WRONG:" : "no bound:", bound ? bound->reason.c_str() : bound.error().message.c_str(), took);
    return;
  }
  ++worst.bounded;
  const double gap = travel / bound->travel_s - 1, bar = bound->error_s / bound->travel_s;
  const bool wrong = gap < 0;
  worst.wrong += wrong ? 1 : 0;
  if (!c.has_islands()) {
    worst.gap = std::max(worst.gap, gap);
    worst.bar = std::max(worst.bar, bar);
  }
  std::printf("%-28s plan %8.2f h, bound %8.2f h with bar %5.3f %%, gap %6.3f %%, %5.2f M steps in %5.2f s%s%s\n",
              c.name.c_str(), travel / 3600, bound->travel_s / 3600, 100 * bar, 100 * gap,
              1e-6 * static_cast<double>(bound->statistics.expansions), took, c.has_islands() ? ", islands" : "",
              wrong ? " WRONG" : "");
  std::fflush(stdout);
}

void print(const char* title, const Worst& w) {
  std::printf("%s: %d cases, %d bounded; open water: worst gap %.3f %%, worst bar %.3f %%; slowest %.2f s; %d wrong\n",
              title, w.cases, w.bounded, 100 * w.gap, 100 * w.bar, w.seconds, w.wrong);
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::max(1, std::atoi(argv[1])) : 20;
  int wrong = 0;
  for (const double speed : {0.4, 0.2}) {
    Worst worst;
    for (const auto& c : suite::static_cases(MetresPerSecond{speed}, count)) run(c, worst);
    print(speed > 0.3 ? "650 km at 0.4 m/s" : "650 km at 0.2 m/s", worst);
    wrong += worst.wrong;
  }
  Worst jets;
  for (const auto& c : suite::jet_cases()) run(c, jets);
  print("jet", jets);
  return wrong + jets.wrong == 0 ? 0 : 1;
}
