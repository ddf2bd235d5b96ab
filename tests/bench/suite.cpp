#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/lower_bound.hpp"
#include "core/planning/refined_cts.hpp"
#include "core/planning/refinement.hpp"
#include "core/planning/registry.hpp"
#include "core/planning/to_go.hpp"
#include "tests/bench/case_suite.hpp"
#include "tests/bench/real_cases.hpp"
#include "tests/support/random_sea.hpp"

// Every method on every case of the suite, in the form of the Thesis's tables 5.5, 5.6, 5.8 to 5.11, 5.13 and 5.14, and how far each is
// from the best plan of constant-heading stints that many searches, each refined, have found. The certificate stands beside every case that
// can be arrived in. A plan earlier than its bound is printed as WRONG, and so is a case in which `best` is well behind another method; the
// program then ends with 1.
//
//   suite [--real] [CASES [STARTS]]     cases of each kind (default: all), searches behind the best known plan (default 12)
//
// The last sheet is that of the published currents (real_cases.hpp), where GLIDEHELM_DATA names the folder of the samples; with --real it is
// the only one. A line for each of its ways says where it leads, or why it is left out.

using namespace glidehelm;

namespace {

/// How far `best` may be behind a single method: as a share of the travel time, and in metres left at the horizon.
constexpr double kMostBehind = 0.01, kMostMetresBehind = 1000;

struct Answer {
  bool arrives{};
  double travel_s{}, remaining_m{}, wall_s{};
  planning::Statistics statistics;
};

/// One kind of case: its answers by method, in the order of the cases.
struct Sheet {
  std::string title;
  std::vector<suite::Case> cases;
  std::map<std::string, std::vector<Answer>> answers;
  std::vector<double> best_known;                      ///< seconds; NaN where nothing arrives
  std::vector<std::optional<planning::Bound>> bounds;  ///< none: not asked for
};

Answer ask(const suite::Case& c, const std::string& method) {
  const std::array<ocean::Ocean, 1> members{c.ocean()};
  const auto begin = std::chrono::steady_clock::now();
  const auto plan = planning::planner_named(method)->plan(c.problem, members, c.chart(), {}, {});
  Answer a;
  a.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  a.remaining_m = distance(c.problem.start.fix, planning::disc_of(c.problem).centre).si();
  if (!plan) return a;
  a.arrives = plan->reaches_goal();
  a.travel_s = plan->arrival_s - c.problem.start.fix_s;
  a.remaining_m = plan->remaining.si();
  a.statistics = plan->statistics;
  return a;
}

/// What `cts-astar-refined` polishes, before it is flown as lists: each heading held for its whole stint, as the best known plans are.
const std::string kHeld = "(refined and held)";
Answer ask_held(const suite::Case& c) {
  const std::array<ocean::Ocean, 1> members{c.ocean()};
  const auto begin = std::chrono::steady_clock::now();
  const auto plan = planning::planner_named("cts-astar")->plan(c.problem, members, c.chart(), {}, {});
  Answer a;
  if (!plan) return a;
  const planning::Budget endless;
  planning::Purse purse{endless};
  planning::SharedToGo to_go{c.problem, members, c.chart()};
  const auto refined = planning::refined({&*plan, 1}, c.problem, members[0], c.chart(), purse, to_go);
  a.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  a.arrives = !std::isnan(refined.held_arrival_s);
  a.travel_s = refined.held_arrival_s - c.problem.start.fix_s;
  a.statistics = purse.spent();
  return a;
}

/// The earliest arrival that refinement finds from `starts` ways: searches with cells from a third of a stint to one and a half and
/// with 12 to 40 headings, each way besides turned at random by up to 30° a stint.
double best_known(const suite::Case& c, int starts) {
  test::Dice dice{0xC0FFEEULL};
  const auto ocean = c.ocean();
  double best = std::nan("");
  const auto polish = [&](const std::vector<Heading>& headings) {
    const auto refined = planning::refine(headings, c.problem, ocean, c.chart(), c.problem.coast_margin, {});
    if (!std::isnan(refined.arrival_s) && !(refined.arrival_s >= best)) best = refined.arrival_s;
  };
  for (int i = 0; i < starts; ++i) {
    auto problem = c.problem;
    problem.headings = static_cast<int>(std::lround(dice.between(12, 40)));
    const auto cell = dice.between(0.6, 3.0) * planning::cell_of(problem);
    const auto found = planning::search(problem, ocean, c.chart(), {}, {planning::allowance(problem), cell, 1e18});
    if (std::isnan(found.arrival_s)) continue;
    polish(found.headings);
    auto shaken = found.headings;
    for (auto& h : shaken) h = h + Radians{dice.between(-kPi / 6, kPi / 6)};
    polish(shaken);
  }
  return best - c.problem.start.fix_s;
}

/// The certificate, looking closely only below the best arrival that is known.
std::optional<planning::Bound> bound_of(const suite::Case& c, double earliest_s) {
  planning::BoundSettings settings;
  if (!std::isnan(earliest_s)) settings.earlier_than_s = c.problem.start.fix_s + earliest_s;
  const auto bound = planning::lower_bound(c.problem, c.ocean(), c.chart(), {}, settings);
  if (!bound) return std::nullopt;
  return *bound;
}

std::string days(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%d d %4.1f h", static_cast<int>(seconds / 86400), std::fmod(seconds, 86400) / 3600);
  return text;
}

struct Mean {
  double sum{}, squares{};
  int n{};
  void add(double x) {
    sum += x;
    squares += x * x;
    ++n;
  }
  [[nodiscard]] double mean() const { return n > 0 ? sum / n : std::nan(""); }
  [[nodiscard]] double deviation() const {
    return n > 1 ? std::sqrt(std::max(0.0, (squares - sum * sum / n) / (n - 1))) : 0;
  }
};

double way_of(const suite::Case& c) { return distance(c.problem.start.fix, planning::disc_of(c.problem).centre).si(); }

/// Travel times where every method arrives that arrives anywhere in half the cases: a mean over different cases would compare nothing.
void print_arrivals(const Sheet& sheet) {
  const auto n = sheet.cases.size();
  std::vector<bool> common(n, true);
  for (const auto& [method, answers] : sheet.answers) {
    const auto arrivals = std::count_if(answers.begin(), answers.end(), [](const Answer& a) { return a.arrives; });
    if (2 * static_cast<std::size_t>(arrivals) < n) continue;
    for (std::size_t i = 0; i < n; ++i) common[i] = common[i] && answers[i].arrives;
  }
  std::printf("\n%s: %zu cases; travel times and speeds over the %td in which the methods that mostly arrive all do\n",
              sheet.title.c_str(), n, std::count(common.begin(), common.end(), true));
  std::printf("  %-20s %6s %14s %18s %22s %10s %12s %12s\n", "method", "NA", "travel time", "km/day (sd)",
              "above best known, max", "wall s", "expansions", "evaluations");
  std::vector<std::pair<double, std::string>> rows;
  for (const auto& [method, answers] : sheet.answers) {
    Mean time, speed, gap, wall, expansions, evaluations;
    double worst = 0;
    int missing = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto& a = answers[i];
      wall.add(a.wall_s);
      expansions.add(static_cast<double>(a.statistics.expansions));
      evaluations.add(static_cast<double>(a.statistics.current_evaluations));
      if (!a.arrives) {
        ++missing;
        continue;
      }
      if (!std::isnan(sheet.best_known[i])) {
        gap.add(a.travel_s / sheet.best_known[i] - 1);
        worst = std::max(worst, a.travel_s / sheet.best_known[i] - 1);
      }
      if (!common[i]) continue;
      time.add(a.travel_s);
      speed.add(way_of(sheet.cases[i]) / 1000 / (a.travel_s / 86400));
    }
    char line[256];
    std::snprintf(line, sizeof line, "  %-20s %4.0f %% %14s %9.2f (%5.2f) %12.3f %% %6.2f %% %10.3f %12.0f %12.3g\n",
                  method.c_str(), 100.0 * missing / static_cast<double>(n),
                  time.n > 0 ? days(time.mean()).c_str() : "-", speed.mean(), speed.deviation(), 100 * gap.mean(),
                  100 * worst, wall.mean(), expansions.mean(), evaluations.mean());
    rows.emplace_back(missing * 1e9 + time.mean(), line);
  }
  std::sort(rows.begin(), rows.end());
  for (const auto& row : rows) std::fputs(row.second.c_str(), stdout);
}

/// Distances left at the horizon, less those of the reference method. In how many answers another leaves so much less that it is wrong.
int print_distances(const Sheet& sheet, const std::string& reference) {
  int wrong = 0;
  std::printf("\n%s: %zu cases, distance left at the horizon less that of %s, km: positive is worse\n",
              sheet.title.c_str(), sheet.cases.size(), reference.c_str());
  std::printf("  %-20s %20s %20s %10s\n", "method", "offshore (sd)", "among islands (sd)", "wall s");
  const auto& base = sheet.answers.at(reference);
  for (const auto& [method, answers] : sheet.answers) {
    Mean open, coast, wall;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const double more = answers[i].remaining_m - base[i].remaining_m;
      (sheet.cases[i].has_islands() ? coast : open).add(more / 1000);
      if (more < -kMostMetresBehind) {
        ++wrong;
        std::printf("  WRONG: %s leaves %.2f km more than %s in %s\n", reference.c_str(), -more / 1000, method.c_str(),
                    sheet.cases[i].name.c_str());
      }
      wall.add(answers[i].wall_s);
    }
    std::printf("  %-20s %11.2f (%6.2f) %11.2f (%6.2f) %10.3f\n", method.c_str(), open.mean(), open.deviation(),
                coast.mean(), coast.deviation(), wall.mean());
  }
  return wrong;
}

void fill(Sheet& sheet, int starts) {
  for (std::size_t i = 0; i < sheet.cases.size(); ++i) {
    std::fprintf(stderr, "%s %zu/%zu\n", sheet.title.c_str(), i + 1, sheet.cases.size());
    const auto& c = sheet.cases[i];
    for (const auto& method : planning::method_names()) sheet.answers[method].push_back(ask(c, method));
    if (starts > 0) sheet.answers[kHeld].push_back(ask_held(c));
    sheet.best_known.push_back(starts > 0 ? best_known(c, starts) : std::nan(""));
    if (starts == 0) continue;
    double earliest = sheet.best_known.back();
    for (const auto& [method, answers] : sheet.answers)
      if (answers.back().arrives && !(answers.back().travel_s >= earliest)) earliest = answers.back().travel_s;
    sheet.bounds.push_back(bound_of(c, earliest));
  }
  std::fprintf(stderr, "\n");
}

void print_cases(const Sheet& sheet) {
  std::printf("\n%-34s %10s", sheet.title.c_str(), "best known");
  for (const auto& [method, answers] : sheet.answers) std::printf(" %18s", method.c_str());
  std::printf("   hours, and above the best known\n");
  for (std::size_t i = 0; i < sheet.cases.size(); ++i) {
    std::printf("%-34s %8.2f h", sheet.cases[i].name.c_str(), sheet.best_known[i] / 3600);
    for (const auto& [method, answers] : sheet.answers) {
      const auto& a = answers[i];
      if (a.arrives)
        std::printf(" %8.2f %+7.3f %%", a.travel_s / 3600, 100 * (a.travel_s / sheet.best_known[i] - 1));
      else
        std::printf(" %18s", "-");
    }
    std::printf("\n");
  }
}

/// Plan of `best` over certified bound, every case; how many plans of all methods lie below it; and how far `best` is behind the best. Returns in
/// how many plans the one or the other is wrong.
int print_certificates(const Sheet& sheet) {
  int early = 0, beaten = 0;
  double worst_gap = 0, worst_bar = 0, behind = 0;
  std::string behind_whom = "none";
  std::printf("\n%-34s %10s %10s %8s %8s   the certificate\n", sheet.title.c_str(), "best", "bound", "bar", "gap");
  for (std::size_t i = 0; i < sheet.bounds.size(); ++i) {
    const auto& best = sheet.answers.at("best")[i];
    const auto& bound = sheet.bounds[i];
    const bool bounded = bound && bound->kind == planning::Bound::Kind::arrival;
    for (const auto& [method, answers] : sheet.answers) {
      const auto& a = answers[i];
      if (!a.arrives) continue;
      const bool proven_not = bound && bound->kind == planning::Bound::Kind::unreachable;
      if (proven_not || (bounded && a.travel_s < bound->travel_s)) {
        ++early;
        std::printf("  WRONG: %s arrives before the bound in %s\n", method.c_str(), sheet.cases[i].name.c_str());
      }
      if (method == kHeld) continue;  // no file says it
      const double late = best.arrives ? best.travel_s / a.travel_s - 1 : 1;
      if (late > kMostBehind) {
        ++beaten;
        std::printf("  WRONG: best is %.2f %% of the travel time behind %s in %s%s\n", 100 * late, method.c_str(),
                    sheet.cases[i].name.c_str(), best.arrives ? "" : " (it does not arrive)");
      }
      if (late > behind) behind = late, behind_whom = method + " in " + sheet.cases[i].name;
    }
    if (!bounded || !best.arrives) {
      std::printf("%-34s %s\n", sheet.cases[i].name.c_str(), bound ? bound->reason.c_str() : "no bound");
      continue;
    }
    const double gap = best.travel_s / bound->travel_s - 1, bar = bound->error_s / bound->travel_s;
    worst_gap = std::max(worst_gap, gap);
    worst_bar = std::max(worst_bar, bar);
    std::printf("%-34s %8.2f h %8.2f h %6.3f %% %6.3f %%\n", sheet.cases[i].name.c_str(), best.travel_s / 3600,
                bound->travel_s / 3600, 100 * bar, 100 * gap);
  }
  std::printf(
      "  worst gap %.3f %%, worst bar %.3f %%; plans earlier than the bound: %d; `best` behind a single method by at "
      "most "
      "%.2g of the travel time (%s)\n",
      100 * worst_gap, 100 * worst_bar, early, behind, behind_whom.c_str());
  return early + beaten;
}

/// A sheet of cases that can be arrived in, filled and printed. In how many plans something is wrong.
int run_arrivals(const std::string& title, std::vector<suite::Case> cases, int starts) {
  Sheet sheet{title, std::move(cases), {}, {}, {}};
  fill(sheet, starts);
  print_cases(sheet);
  print_arrivals(sheet);
  return print_certificates(sheet);
}

int run_synthetic(int count, int starts) {
  int wrong = 0;
  for (const double speed : {0.4, 0.2}) {
    char title[64];
    std::snprintf(title, sizeof title, "static 650 km, U = %.1f m/s", speed);
    wrong += run_arrivals(title, suite::static_cases(MetresPerSecond{speed}, std::min(count, 20)), starts);
    std::snprintf(title, sizeof title, "dynamic 3-4 days, U = %.1f m/s", speed);
    Sheet moving{title, suite::dynamic_cases(MetresPerSecond{speed}, std::min(count, 45)), {}, {}, {}};
    fill(moving, 0);
    wrong += print_distances(moving, "best");
  }
  wrong += run_arrivals("jet", suite::jet_cases(), starts);
  return wrong + run_arrivals("analytic fields", suite::analytic_cases(), starts);
}

int run_real(int count, int starts) {
  const char* folder = std::getenv("GLIDEHELM_DATA");
  std::error_code unreadable;
  if (folder == nullptr || !std::filesystem::is_directory(std::string{folder} + "/currents", unreadable)) {
    std::printf("\nreal fields: left out; set GLIDEHELM_DATA to the folder of the samples, which holds currents/\n");
    return 0;
  }
  auto real = suite::real_cases(folder);
  std::printf("\nreal fields, the ways (U = 0.3 m/s, stints of 8 h; a field is held after its last time)\n");
  for (const auto& note : real.notes) std::printf("  %s\n", note.c_str());
  if (static_cast<std::size_t>(count) < real.cases.size())
    real.cases.erase(real.cases.begin() + count, real.cases.end());
  return real.cases.empty() ? 0 : run_arrivals("real fields", std::move(real.cases), starts);
}

}  // namespace

int main(int argc, char** argv) {
  const bool only_real = argc > 1 && std::strcmp(argv[1], "--real") == 0;
  const int first = only_real ? 2 : 1;
  const int count = argc > first ? std::atoi(argv[first]) : 1000;
  const int starts = argc > first + 1 ? std::atoi(argv[first + 1]) : 12;
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  int wrong = only_real ? 0 : run_synthetic(count, starts);
  wrong += run_real(count, starts);
  return wrong == 0 ? 0 : 1;
}
