#include "core/planning/optimized_way.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/planning/cts_astar.hpp"
#include "core/planning/flight.hpp"

namespace glidehelm::planning {

namespace {

constexpr int kMostPasses = 60;
constexpr double kWorthwhilePass = 5.0;      // seconds
constexpr double kCoarse = 2.0;              // times the usual cell
constexpr Metres kWide{1000}, kNarrow{250};  // buffers

double start_clearance(const Problem& problem, const chart::Chart& chart) {
  return chart.clearance(problem.start.fix.lat.radians(), problem.start.fix.lon.radians());
}

}  // namespace

bool better_way(const OptimizedWay& a, const OptimizedWay& b) {
  if (a.safe != b.safe) return a.safe;
  if (a.arrives() != b.arrives()) return a.arrives();
  return a.arrives() ? a.arrival_s < b.arrival_s : a.remaining_m < b.remaining_m;
}

WayOptimizer::WayOptimizer(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Metres spare,
                           const OptimizationSettings& settings, Purse& purse)
    : problem_{problem},
      ocean_{ocean},
      chart_{chart},
      spare_{spare},
      margin_{std::max(0.0, std::min((problem.coast_margin + spare).si(), start_clearance(problem, chart) - 1.0))},
      settings_{settings},
      purse_{purse},
      flight_{problem, ocean, chart, margin_},
      // A stint that the horizon ends may still arrive; the last surfacing is all that counts for a least distance.
      most_{stints_within(problem) + (wants_least_distance(problem) ? 0 : 1)} {}

OptimizedWay WayOptimizer::measured(std::vector<double> headings) {
  OptimizedWay way;
  HeldLanes lane;
  lane.begin(1, problem_.start.fix.lat.radians(), problem_.start.fix.lon.radians());
  way.end_s = problem_.start.fix_s;
  headings.resize(std::min(headings.size(), static_cast<std::size_t>(std::max(0, most_))));
  const std::uint64_t before = flight_.evaluations();
  for (std::size_t k = 0; k < headings.size() && lane.flies(0); ++k) {
    const int stint = static_cast<int>(k);
    flight_.fly(lane, stint, {headings[k]}, problem_.horizon_s, true);
    way.end_s = std::min(problem_.horizon_s, flight_.dive_s(stint) + problem_.schedule.stint_length(stint).count());
    if (lane.arrival_s[0] < HeldLanes::kNever) {
      way.arrival_s = lane.arrival_s[0];
      headings.resize(k + 1);
    }
  }
  purse_.take({0, headings.size(), flight_.evaluations() - before}, false);
  way.safe = lane.flies(0) || way.arrives();
  way.lat = lane.at.lat[0];
  way.lon = lane.at.lon[0];
  way.remaining_m = distance(GeoPoint::from_kernel(way.lat, way.lon), flight_.goal().centre).si();
  way.headings = std::move(headings);
  return way;
}

OptimizedWay WayOptimizer::lengthened(OptimizedWay way, int stints) {
  const auto& goal = flight_.goal().centre;
  for (int i = 0; i < stints && way.safe && !way.arrives(); ++i) {
    if (way.headings.size() >= static_cast<std::size_t>(std::max(0, most_))) break;
    auto longer = way.headings;
    longer.push_back(geodesic(GeoPoint::from_kernel(way.lat, way.lon), goal).departing.from_north().si());
    way = measured(std::move(longer));
  }
  return way;
}

OptimizedWay WayOptimizer::straight() { return lengthened(measured({}), most_); }

OptimizedWay WayOptimizer::searched() {
  CtsSettings settings;
  settings.allowance = spare_;
  settings.cell = kCoarse * cell_of(problem_);
  auto found = search(problem_, ocean_, chart_, purse_.rest(), settings);
  purse_.take(found.statistics, found.cut_at != 0);
  if (std::isnan(found.arrival_s) && found.exhausted && !purse_.is_empty()) {
    settings.nearest = true;
    found = search(problem_, ocean_, chart_, purse_.rest(), settings);
    purse_.take(found.statistics, found.cut_at != 0);
  }
  std::vector<double> headings;
  for (const auto h : found.headings) headings.push_back(h.from_north().si());
  return lengthened(measured(std::move(headings)), most_);
}

OptimizedWay WayOptimizer::improve(OptimizedWay way) {
  way = improve_with(std::move(way), kWide);
  // In a strait narrower than the wide buffer, and along coasts, the narrow one has more to give.
  return paid_toll_ ? improve_with(std::move(way), kNarrow) : way;
}

OptimizedWay WayOptimizer::improve_with(OptimizedWay way, Metres buffer) {
  double lead = 0;
  for (int round = 0; round < kMostPasses && !purse_.is_empty() && !way.headings.empty(); ++round) {
    const double until_s = (way.arrives() ? way.arrival_s : way.end_s) - lead;
    auto next = lengthened(measured(kernel(way.headings, until_s, buffer)), way.arrives() ? 1 : 0);
    if (!better_way(next, way)) {
      if (lead == 0) break;
      lead = 0;
      continue;
    }
    const bool once = !next.arrives();  // at the same instant again: nothing is left
    const double gained = way.arrives() ? way.arrival_s - next.arrival_s : 0;
    const bool done = way.arrives() && gained < kWorthwhilePass && lead == 0;
    way = std::move(next);
    if (once || done) break;
    lead = gained < kWorthwhilePass ? 0 : std::min(gained, 0.25 * (way.arrival_s - problem_.start.fix_s));
  }
  return way;
}

OptimizedWay WayOptimizer::grow() {
  auto way = measured({});
  const double fastest = problem_.glider.horizontal_speed.si() + ocean_.dive.fastest().si();
  while (!purse_.is_empty()) {
    const double missing = std::max(0.0, way.remaining_m - flight_.goal().radius.si());
    const double stints = std::ceil(missing / (fastest * problem_.schedule.stint.count()));
    const auto before = way.headings.size();
    way = lengthened(std::move(way), std::max(1, static_cast<int>(stints)));
    if (way.arrives()) break;
    if (way.headings.size() == before) return way;  // the horizon
    way = measured(kernel(way.headings, way.end_s, kWide));
    if (way.arrives()) break;
    if (!way.safe) return way;
  }
  return improve(std::move(way));
}

std::vector<double> WayOptimizer::kernel(std::vector<double> headings, double until_s, Metres buffer) {
  std::size_t n = 0;
  while (n < headings.size() && flight_.dive_s(static_cast<int>(n)) < until_s) ++n;
  if (n == 0) return headings;
  FlightEndings endings{problem_, ocean_, chart_, margin_, buffer};
  const Budget budget = purse_.rest();
  Statistics spent;
  bool cut = false;
  KernelTask task;
  task.kernel = settings_.kernel;
  task.unit_m = (problem_.glider.horizontal_speed * problem_.schedule.stint).si();
  task.near_enough_m = 0.02 * flight_.goal().radius.si();
  const bool simplex = task.kernel == Kernel::simplex || task.kernel == Kernel::subplex;
  task.evaluations = settings_.evaluations * (simplex ? n : 1);
  task.fly = [&](std::span<const double> tried, bool with_slopes, FlightEnd& end) {
    if (cut || spent.expansions >= budget.work) return false;
    if (budget.expired && budget.expired()) {
      cut = true;
      return false;
    }
    ++spent.expansions;
    spent.cost_evaluations += tried.size() * (with_slopes ? 7 : 1);
    end = with_slopes ? endings.end_with_slopes(tried, until_s) : endings.end(tried, until_s);
    paid_toll_ = paid_toll_ || end.toll > 0;
    return true;
  };
  const auto best = run_kernel(task, std::span{headings}.first(n));
  std::copy(best.begin(), best.end(), headings.begin());
  spent.current_evaluations = endings.evaluations();
  purse_.take(spent, cut);
  return headings;
}

}  // namespace glidehelm::planning
