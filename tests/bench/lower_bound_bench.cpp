#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "core/planning/lower_bound.hpp"
#include "core/planning/registry.hpp"
#include "daemon/world/workers.hpp"
#include "tests/bench/case_suite.hpp"
#include "tests/support/isochrones.hpp"

// The sandwich: plan and bound on the same seas. For every case the bound with its bar, the share of the bar, how far the best
// plan lies above the bound, and what the bound cost: steps of markers, most markers at once, time on the wall and of the processor.
// A plan below its bound is printed as WRONG, and the program then fails. A surfacing of the plan that the front leaves outside is one that it
// has lost, or is late for: how far the farthest lies beyond it is told.
// Arguments: cases per speed (default 20); part of a name, when only some are wanted.

using namespace glidehelm;

namespace {

/// What something took: on the wall, and of the processor over all threads.
class Watch {
 public:
  [[nodiscard]] double wall() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  [[nodiscard]] double processor() const { return static_cast<double>(std::clock() - clock_) / CLOCKS_PER_SEC; }

 private:
  std::chrono::steady_clock::time_point begin_{std::chrono::steady_clock::now()};
  std::clock_t clock_{std::clock()};
};

struct Worst {
  double gap{}, bar{}, island_gap{}, island_bar{}, wall{}, processor{}, outside{};
  int cases{}, bounded{}, wrong{};
};

/// How far the farthest of a plan's surfacings lies outside the front at its instant, metres.
double farthest_outside(const planning::Plan& plan, const planning::Bound& bound) {
  double farthest = 0;
  for (const auto& stint : plan.stints)
    for (const auto& isochrone : bound.isochrones)
      if (std::abs(isochrone.t_s - stint.surface_s) < 1 && !test::encloses(isochrone, stint.surface))
        farthest = std::max(farthest, test::distance_to(isochrone, stint.surface));
  return farthest;
}

void run(const suite::Case& c, Worst& worst) {
  const std::array<ocean::Ocean, 1> members{c.ocean()};
  const auto plan = planning::planner_named("best")->plan(c.problem, members, c.chart(), {}, {});
  const bool arrives = plan && plan->reaches_goal();
  const double travel = arrives ? plan->arrival_s - c.problem.start.fix_s : std::nan("");
  planning::BoundSettings settings;
  if (arrives) settings.earlier_than_s = plan->arrival_s;
  settings.at_once = [](std::size_t runs, const std::function<void(std::size_t)>& body) {
    world::for_each_index(runs, 0, body);
  };
  settings.surfacings_per_isochrone = 1;
  const Watch watch;
  const auto bound = planning::lower_bound(c.problem, c.ocean(), c.chart(), {}, settings);
  const double wall = watch.wall(), processor = watch.processor();
  ++worst.cases;
  worst.wall = std::max(worst.wall, wall);
  worst.processor = std::max(worst.processor, processor);
  if (!bound || bound->kind != planning::Bound::Kind::arrival) {
    const bool wrong = bound && bound->kind == planning::Bound::Kind::unreachable && arrives;
    worst.wrong += wrong ? 1 : 0;
    std::printf("%-28s plan %8.2f h, %s %s in %.2f s\n", c.name.c_str(), travel / 3600,
                wrong ? "WRONG:" : "no bound:", bound ? bound->reason.c_str() : bound.error().message.c_str(), wall);
    return;
  }
  ++worst.bounded;
  const double gap = travel / bound->travel_s - 1, bar = bound->error_s / bound->travel_s;
  const bool wrong = gap < 0;
  worst.wrong += wrong ? 1 : 0;
  double& worst_gap = c.has_islands() ? worst.island_gap : worst.gap;
  double& worst_bar = c.has_islands() ? worst.island_bar : worst.bar;
  worst_gap = std::max(worst_gap, gap);
  worst_bar = std::max(worst_bar, bar);
  const double outside = arrives ? farthest_outside(*plan, *bound) : 0.0;
  worst.outside = std::max(worst.outside, outside);
  std::printf(
      "%-28s plan %8.3f h, bound %8.3f h with bar %5.3f %%, gap %6.3f %%, %5.2f M steps, %5zu markers, %5.2f s, "
      "processor %5.2f s, surfacings outside by %.0f m%s\n",
      c.name.c_str(), travel / 3600, bound->travel_s / 3600, 100 * bar, 100 * gap,
      1e-6 * static_cast<double>(bound->statistics.expansions), bound->most_markers, wall, processor, outside,
      wrong ? " WRONG" : "");
  std::fflush(stdout);
}

void print(const char* title, const Worst& w) {
  std::printf(
      "%s: %d cases, %d bounded; worst gap and bar in open water %.3f %%, %.3f %%, among islands %.3f %%, %.3f %%; "
      "slowest %.2f s, processor %.2f s; surfacings outside by up to %.0f m; %d wrong\n",
      title, w.cases, w.bounded, 100 * w.gap, 100 * w.bar, 100 * w.island_gap, 100 * w.island_bar, w.wall, w.processor,
      w.outside, w.wrong);
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::max(1, std::atoi(argv[1])) : 20;
  const std::string only = argc > 2 ? argv[2] : "";
  const auto run_all = [&](const std::vector<suite::Case>& cases, Worst& worst) {
    for (const auto& c : cases)
      if (c.name.find(only) != std::string::npos) run(c, worst);
  };
  int wrong = 0;
  for (const double speed : {0.4, 0.2}) {
    Worst worst;
    run_all(suite::static_cases(MetresPerSecond{speed}, count), worst);
    print(speed > 0.3 ? "650 km at 0.4 m/s" : "650 km at 0.2 m/s", worst);
    wrong += worst.wrong;
  }
  Worst jets;
  run_all(suite::jet_cases(), jets);
  print("jet", jets);
  return wrong + jets.wrong == 0 ? 0 : 1;
}
