#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "core/planning/member_plans.hpp"
#include "core/planning/registry.hpp"
#include "daemon/world/workers.hpp"
#include "tests/bench/case_suite.hpp"

// A full plan by the daemon's default method in each member of an ensemble: 650 km, stints of 8 h, 1/20 degree. Wall and processor time of the
// planning (members are made before, in batches that are not counted), memory, and what the plans say. The plans of one member are made
// again on one thread and compared. Arguments: members (100), threads (2), hours of the fields (0: static), method (best).

using namespace glidehelm;

namespace {

constexpr int kBatch = 20;
constexpr std::uint64_t kStageWork = 2'000'000;  // as the daemon

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}
/// Of this process and all its threads.
double processor_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto of = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return of(used.ru_utime) + of(used.ru_stime);
}
double peak_mebibytes() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_maxrss) / 1024;
}

planning::Plan plan_in(const suite::Case& c, const planning::Planner& planner) {
  const std::array<ocean::Ocean, 1> members{c.ocean()};
  const auto plan = planner.plan(c.problem, members, c.chart(), {kStageWork, {}}, {});
  return plan ? *plan : planning::Plan{};
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int k, int otherwise) { return argc > k ? std::max(0, std::atoi(argv[k])) : otherwise; };
  const int members = std::max(1, argument(1, 100)), threads = std::max(1, argument(2, 2)), hours = argument(3, 0);
  const auto planner = planning::planner_named(argc > 4 ? argv[4] : "best");
  if (!planner) return 2;
  const auto seas = [&](int first, int count) {
    std::vector<std::optional<suite::Case>> made(static_cast<std::size_t>(count));
    world::for_each_index(made.size(), static_cast<unsigned>(threads), [&](std::size_t k) {
      made[k].emplace(suite::ensemble_case(MetresPerSecond{0.3}, first + static_cast<int>(k), hours));
    });
    return made;
  };
  std::vector<planning::Plan> plans(static_cast<std::size_t>(members));
  double wall = 0, processor = 0, before_mib = 0;
  int differ = 0;
  planning::Problem problem;
  for (int first = 0; first < members; first += kBatch) {
    const auto made = seas(first, std::min(kBatch, members - first));
    if (first == 0) before_mib = peak_mebibytes();
    const auto begin = std::chrono::steady_clock::now();
    const double used = processor_seconds();
    world::for_each_index(made.size(), static_cast<unsigned>(threads), [&](std::size_t k) {
      plans[static_cast<std::size_t>(first) + k] = plan_in(*made[k], *planner);
    });
    wall += seconds_since(begin);
    processor += processor_seconds() - used;
    differ += plan_in(*made.front(), *planner) == plans[static_cast<std::size_t>(first)] ? 0 : 1;
    problem = made.front()->problem;
  }
  std::vector<planning::MemberPlan> beside;
  for (const auto& plan : plans) beside.push_back(planning::member_plan(plan, plans.front(), problem));
  const auto all = planning::summary_of(beside);
  std::printf("%s, %d members, %d threads, %s: %.1f s wall, %.1f s processor, %.0f ms processor a plan\n",
              std::string{planner->name()}.c_str(), members, threads, hours > 0 ? "hourly fields" : "static fields",
              wall, processor, 1000 * processor / members);
  std::printf("memory: %.0f MiB at the most, %.0f MiB with the first %d members made and nothing planned\n",
              peak_mebibytes(), before_mib, std::min(kBatch, members));
  std::printf("%zu of %zu arrive", all.arrived, all.plans);
  if (all.median)
    std::printf(", after %.1f h (median; 10 to 90 %%: %.1f to %.1f h)", all.median->count() / 3600,
                all.tenth->count() / 3600, all.ninetieth->count() / 3600);
  if (all.apart_median)
    std::printf("; first heading %+.0f to %+.0f degrees from the control's, ways %.0f km apart (median; at most %.0f)",
                in_degrees(*all.turned_left), in_degrees(*all.turned_right), all.apart_median->si() / 1000,
                all.apart_most->si() / 1000);
  std::printf("\n%d of %d plans made again differ\n", differ, (members + kBatch - 1) / kBatch);
  return differ == 0 ? 0 : 1;
}
