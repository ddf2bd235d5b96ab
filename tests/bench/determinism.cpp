#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/planning/registry.hpp"
#include "tests/bench/case_suite.hpp"

// Do two builds plan the same? (issue 5: "dev and release builds: the same stints to 1e-9 rad away from stagnation")
//
//   determinism [CASES]        a line for every plan of the suite's cases and for every stint of it: kind of sea, case, method, heading with
//                              17 digits, and how near to stagnation the stint comes. CASES: most of each kind (default: all)
//   determinism --compare A B  two such outputs side by side; fails where a stint away from stagnation differs by more than 1e-9 rad
//
// A stint is near stagnation where, at any of 17 places on its chord, the speed of the current is within 5 % of the speed through water: there a
// rounding of 1e-16 may decide between holding a place and losing it, and the stints after it fly from elsewhere.

using namespace glidehelm;

namespace {

constexpr std::array kMethods{"cts-astar", "best"};
constexpr double kNear = 0.05, kTolerance = 1e-9;
constexpr int kPlaces = 17;

/// The least |‖c‖ − U|/U on the chord of a stint; 1 where there is no current to be told.
double nearness(const vehicle::Stint& stint, const ocean::Ocean& ocean, double speed) {
  double least = 1;
  const double turn = std::remainder(stint.surface.lon.radians() - stint.dive.lon.radians(), 2 * kPi);
  for (int i = 0; i < kPlaces; ++i) {
    const double share = static_cast<double>(i) / (kPlaces - 1);
    const double lat = stint.dive.lat.radians() + share * (stint.surface.lat.radians() - stint.dive.lat.radians());
    const auto at = GeoPoint::from_kernel(lat, stint.dive.lon.radians() + share * turn);
    const auto found = ocean.dive.sample(at, stint.dive_s + share * (stint.surface_s - stint.dive_s));
    if (found) least = std::min(least, std::abs(found->current.speed().si() - speed) / speed);
  }
  return least;
}

void print_plan(const char* kind, const suite::Case& c, const char* method) {
  const std::array<ocean::Ocean, 1> members{c.ocean()};
  const auto found = planning::planner_named(method)->plan(c.problem, members, c.chart(), {}, {});
  const planning::Plan plan = found ? *found : planning::Plan{};
  std::printf("plan\t%s\t%s\t%s\t%s\t%.17g\t%zu\n", kind, c.name.c_str(), method,
              found ? plan.method.c_str() : "no plan", plan.arrival_s, plan.stints.size());
  for (const auto& stint : plan.stints)
    std::printf("stint\t%.17g\t%.17g\n", stint.heading.from_north().si(),
                nearness(stint, members.front(), c.problem.glider.horizontal_speed.si()));
}

void print_all(int count) {
  const auto print = [](const char* kind, const std::vector<suite::Case>& cases) {
    for (const auto& c : cases)
      for (const char* method : kMethods) print_plan(kind, c, method);
  };
  print("static 0.4 m/s", suite::static_cases(MetresPerSecond{0.4}, std::min(count, 20)));
  print("static 0.2 m/s", suite::static_cases(MetresPerSecond{0.2}, std::min(count, 20)));
  print("dynamic 0.4 m/s", suite::dynamic_cases(MetresPerSecond{0.4}, std::min(count, 45)));
  print("dynamic 0.2 m/s", suite::dynamic_cases(MetresPerSecond{0.2}, std::min(count, 45)));
  auto jet = suite::jet_cases();
  jet.erase(jet.begin() + std::min<std::ptrdiff_t>(count, std::ssize(jet)), jet.end());
  print("jet", jet);
}

struct Told {
  double heading{}, nearness{};
};
/// A plan as another build has told it.
struct ToldPlan {
  std::string kind, name, method, stage;
  double arrival_s{};
  std::vector<Told> stints;
  std::string bytes;  ///< all its lines
};

std::vector<ToldPlan> read(const char* path) {
  std::ifstream in{path};
  std::vector<ToldPlan> plans;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> words;
    std::istringstream fields{line};
    for (std::string word; std::getline(fields, word, '\t');) words.push_back(word);
    const auto number = [&](std::size_t k) { return std::strtod(words[k].c_str(), nullptr); };
    if (words.size() == 7 && words[0] == "plan")
      plans.push_back({words[1], words[2], words[3], words[4], number(5), {}, {}});
    else if (words.size() == 3 && words[0] == "stint" && !plans.empty())
      plans.back().stints.push_back({number(1), number(2)});
    else
      continue;
    plans.back().bytes += line + "\n";
  }
  return plans;
}

/// What two builds say about one kind of sea and one method.
struct Tally {
  int plans{}, equal{}, wrong{};
  std::size_t stints{}, left_out{};
  double most{}, most_left_out{}, most_arrival_s{};

  void add(const ToldPlan& a, const ToldPlan& b) {
    ++plans;
    equal += a.bytes == b.bytes ? 1 : 0;
    bool differs = a.name != b.name || a.stage != b.stage || a.stints.size() != b.stints.size();
    for (std::size_t k = 0; k < std::min(a.stints.size(), b.stints.size()); ++k) {
      const double off = std::abs(std::remainder(a.stints[k].heading - b.stints[k].heading, 2 * kPi));
      const bool near = std::min(a.stints[k].nearness, b.stints[k].nearness) <= kNear;
      ++stints;
      left_out += near ? 1 : 0;
      (near ? most_left_out : most) = std::max(near ? most_left_out : most, off);
      differs = differs || (!near && !(off <= kTolerance));
    }
    if (!std::isnan(a.arrival_s) && !std::isnan(b.arrival_s))
      most_arrival_s = std::max(most_arrival_s, std::abs(a.arrival_s - b.arrival_s));
    if (!differs) return;
    ++wrong;
    std::printf("DIFFERENT: %s by %s (%s, %zu stints) and (%s, %zu stints)\n", a.name.c_str(), a.method.c_str(),
                a.stage.c_str(), a.stints.size(), b.stage.c_str(), b.stints.size());
  }
};

int compare(const char* one, const char* other) {
  const auto a = read(one), b = read(other);
  if (a.empty() || a.size() != b.size()) {
    std::fprintf(stderr, "determinism: %zu plans in %s, %zu in %s\n", a.size(), one, b.size(), other);
    return 2;
  }
  std::vector<std::string> order;
  std::map<std::string, Tally> tallies;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::string row = a[i].kind + ", " + a[i].method;
    if (tallies.find(row) == tallies.end()) order.push_back(row);
    tallies[row].add(a[i], b[i]);
  }
  std::printf("%-28s %6s %14s %8s %16s %18s %18s %14s\n", "sea, method", "plans", "equal bytes", "stints",
              "near stagnation", "most elsewhere", "most near it", "most arrival");
  int wrong = 0;
  for (const auto& row : order) {
    const auto& t = tallies[row];
    std::printf("%-28s %6d %14d %8zu %16zu %14.2g rad %14.2g rad %12.2g s\n", row.c_str(), t.plans, t.equal, t.stints,
                t.left_out, t.most, t.most_left_out, t.most_arrival_s);
    wrong += t.wrong;
  }
  std::printf("%d of %zu plans differ by more than %.0e rad in a stint away from stagnation\n", wrong, a.size(),
              kTolerance);
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4 && std::string{argv[1]} == "--compare") return compare(argv[2], argv[3]);
  print_all(argc > 1 ? std::max(1, std::atoi(argv[1])) : 1000);
}
