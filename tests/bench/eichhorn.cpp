#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/planning/mean_motion.hpp"
#include "core/planning/travel_time.hpp"
#include "core/planning/tve.hpp"
#include "tests/support/eichhorn.hpp"

// Eichhorn's Tables 4 and 5 on his jet (tests/support/eichhorn.hpp): calls of the cost function and of the current model by method and
// start, the times of the ways that the four methods find and how far these lie apart, and what smoothing makes of them.

using namespace glidehelm;
using test::EichhornJet;
using Method = planning::Tve::Method;

namespace {

struct Start {
  double x, y;
};
/// On a line across the jet, all about as far from the goal.
constexpr std::array kAcross{Start{0, -3}, Start{0, -1.5}, Start{0, 0}, Start{0, 1.5}, Start{0, 3}};
/// Nearer and nearer to the goal, in line with it.
constexpr std::array kNearer{Start{0, 0}, Start{2, 0}, Start{4, 0}, Start{6, 0}, Start{8, 0}};

struct Row {
  const char* name;
  Method method;
  bool beyond_goal;
};
constexpr std::array kRows{Row{"TVE, every node", Method::tve, true}, Row{"TVE", Method::tve, false},
                           Row{"A*TVE", Method::astar_tve, false},    Row{"ZTVE, every node", Method::ztve, true},
                           Row{"ZTVE", Method::ztve, false},          Row{"ZA*TVE", Method::zastar_tve, false}};

planning::LatticeWay found(const EichhornJet& jet, const planning::Problem& p, const Row& row) {
  auto rules = planning::rules_of(row.method, p.sector_grid);
  rules.beyond_goal = row.beyond_goal;
  return planning::search_lattice(p, jet.ocean(), chart::Chart{}, {}, rules);
}

double units(double metres) { return metres / EichhornJet::kUnit; }
double time_of(const std::vector<planning::WayPoint>& way) { return (way.back().t_s - test::kT0) / EichhornJet::kTime; }
double length_of(const std::vector<planning::WayPoint>& way) {
  double sum = 0;
  for (std::size_t i = 1; i < way.size(); ++i)
    sum += local_offset(way[i - 1].lat, way[i - 1].lon, way[i].lat, way[i].lon).length();
  return units(sum);
}

/// The largest distance of a node of one way from the nearest leg of the other.
double apart(const std::vector<planning::WayPoint>& a, const std::vector<planning::WayPoint>& b) {
  double most = 0;
  for (const auto& p : a) {
    double least = 1e18;
    for (std::size_t i = 1; i < b.size(); ++i) {
      const auto leg = local_offset(b[i - 1].lat, b[i - 1].lon, b[i].lat, b[i].lon);
      const auto here = local_offset(b[i - 1].lat, b[i - 1].lon, p.lat, p.lon);
      const double l2 = std::max(1e-9, leg.east * leg.east + leg.north * leg.north);
      const double share = std::clamp((here.east * leg.east + here.north * leg.north) / l2, 0.0, 1.0);
      least = std::min(least, std::hypot(here.east - share * leg.east, here.north - share * leg.north));
    }
    most = std::max(most, least);
  }
  return units(most);
}

void table4(const EichhornJet& jet, const char* title, const std::array<Start, 5>& starts) {
  std::printf("\n%s: calls of cost function / current model\n  %-18s", title, "");
  for (const auto& s : starts)
    std::printf("   (%4.1f, %4.1f) %5.2f away", s.x, s.y, std::hypot(EichhornJet::kGoal_x - s.x, s.y));
  std::vector<std::vector<planning::LatticeWay>> ways;
  for (const auto& row : kRows) {
    std::printf("\n  %-18s", row.name);
    auto& found_by = ways.emplace_back();
    for (const auto& s : starts) {
      found_by.push_back(found(jet, EichhornJet::problem(s.x, s.y), row));
      const auto& n = found_by.back().statistics;
      std::printf("      %8llu / %8llu", static_cast<unsigned long long>(n.cost_evaluations),
                  static_cast<unsigned long long>(n.current_evaluations));
    }
  }
  std::printf("\n  %-18s", "TVE : ZA*TVE");
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const auto ratio = [&](const auto& count) {
      return static_cast<double>(count(ways.front()[i])) / static_cast<double>(count(ways.back()[i]));
    };
    std::printf("      %8.2f / %8.2f", ratio([](const auto& w) { return w.statistics.cost_evaluations; }),
                ratio([](const auto& w) { return w.statistics.current_evaluations; }));
  }
  std::printf("\n%s: time of the way found, and how far it lies from that of TVE at most", title);
  for (std::size_t m = 0; m < kRows.size(); ++m) {
    std::printf("\n  %-18s", kRows[m].name);
    for (std::size_t i = 0; i < starts.size(); ++i)
      std::printf("       %9.5f, %6.3f", time_of(ways[m][i].points), apart(ways[m][i].points, ways.front()[i].points));
  }
  std::printf("\n");
}

void table5(const EichhornJet& jet, const std::array<Start, 5>& starts) {
  std::printf(
      "\nPath smoothing, ways of ZA*TVE\n  %-14s %30s %39s %18s %12s\n  %-14s %9s %9s %10s %9s %12s %9s %9s %8s %9s "
      "%12s\n",
      "", "travel time", "", "path length", "waypoints", "start", "unsmooth", "smooth", "straight", "no current",
      "unsmooth", "smooth", "straight", "before", "after", "cost calls");
  const planning::MeanMotion motion{EichhornJet::problem(0, 0), jet.ocean()};
  for (const auto& s : starts) {
    const auto p = EichhornJet::problem(s.x, s.y);
    const auto way = found(jet, p, kRows.back()).points;
    planning::Statistics spent;
    const auto smooth = planning::smooth_way(way, p, jet.ocean(), chart::Chart{}, spent);
    const double direct = length_of({way.front(), way.back()});
    std::uint64_t samples = 0;
    const auto straight = planning::travel_time(motion, way.front().lat, way.front().lon, way.back().lat,
                                                way.back().lon, test::kT0, samples);
    std::printf("  (%4.1f, %4.1f)   %9.5f %9.5f %10.5f %10.5f %11.3f %9.3f %9.3f %8zu %9zu %12llu\n", s.x, s.y,
                time_of(way), time_of(smooth), straight ? *straight / EichhornJet::kTime : std::nan(""),
                direct / EichhornJet::kSpeed, length_of(way), length_of(smooth), direct, way.size(), smooth.size(),
                static_cast<unsigned long long>(spent.cost_evaluations));
  }
}

}  // namespace

int main() {
  const EichhornJet jet;
  std::printf(
      "Eichhorn's jet, U = 0.5, goal (10, 0), 3-sector grid of 0.4 over [0, 12] x [-5, 5], no dive schedule; largest "
      "current %.3f.\n"
      "Goal, area and starts are ours: the paper prints none. Its Table 4 has 12124/80838 to 12112/83757 for TVE from "
      "five starts, 7629/46916 to\n"
      "638/5559 for A*TVE, 3076/27734 to 2824/25295 for ZTVE, 1883/17502 to 141/1409 for ZA*TVE: TVE : ZA*TVE is 6.4 "
      "to 86, less from afar.\n"
      "Counts that do not depend on the start belong to searches that go on to every node; both are counted here.\n"
      "A way of ZTVE that is earlier than that of TVE: where the current is stronger than the vehicle, an edge that is "
      "closed may open later, and\n"
      "Dijkstra's earliest arrival at its beginning is then the worse one.\n",
      jet.field.fastest().si());
  table4(jet, "Starts across the jet", kAcross);
  table4(jet, "Starts nearer and nearer", kNearer);
  table5(jet, kAcross);
  table5(jet, kNearer);
}
