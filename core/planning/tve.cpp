#include "core/planning/tve.hpp"

#include <utility>

#include "core/planning/flight.hpp"
#include "core/planning/searched_plan.hpp"
#include "core/planning/smoothing.hpp"
#include "core/planning/travel_time.hpp"
#include "core/planning/way_headings.hpp"

namespace glidehelm::planning {

namespace {

std::string_view name_of(Tve::Method method) {
  switch (method) {
    case Tve::Method::tve:
      return "tve";
    case Tve::Method::astar_tve:
      return "astar-tve";
    case Tve::Method::ztve:
      return "ztve";
    case Tve::Method::zastar_tve:
      return "zastar-tve";
  }
  return "?";
}

/// The same search without Zermelo's formula.
Tve::Method without_cone(Tve::Method method) {
  return method == Tve::Method::ztve         ? Tve::Method::tve
         : method == Tve::Method::zastar_tve ? Tve::Method::astar_tve
                                             : method;
}

Found search_and_smooth(Tve::Method method, const Problem& problem, const ocean::Ocean& ocean,
                        const chart::Chart& chart, Purse& purse, Metres allowance) {
  const auto run = [&](Tve::Method m) {
    auto rules = rules_of(m, problem.sector_grid);
    rules.allowance = allowance;
    auto way = search_lattice(problem, ocean, chart, purse.rest(), rules);
    purse.take(way.statistics, way.cut_at != 0);
    return way;
  };
  auto way = run(method);
  if (!way.arrives && way.exhausted && without_cone(method) != method) {
    method = without_cone(method);
    way = run(method);
  }
  const auto margin = problem.coast_margin + allowance;
  Found found{std::string{name_of(method)},
              {headings_along(way.points, problem, ocean, chart, margin)},
              way.arrives,
              way.exhausted,
              way.stopped.margin,
              reason_for(way)};
  if (!way.arrives) return found;
  Statistics statistics;
  const auto smooth = smooth_way(way.points, problem, ocean, chart, statistics);
  purse.take(statistics, false);
  if (smooth.size() < way.points.size()) found.ways.push_back(headings_along(smooth, problem, ocean, chart, margin));
  return found;
}

}  // namespace

std::string_view Tve::name() const noexcept { return name_of(method_); }

LatticeRules rules_of(Tve::Method method, const SectorGrid& grid) {
  LatticeRules rules;
  rules.grid = grid.lattice();
  rules.spacing = grid.spacing.value_or(Metres{0});
  rules.estimates = method == Tve::Method::astar_tve || method == Tve::Method::zastar_tve;
  if (without_cone(method) != method) rules.cone = grid.cone();
  rules.step_control = true;
  return rules;
}

std::vector<WayPoint> smooth_way(const std::vector<WayPoint>& way, const Problem& problem, const ocean::Ocean& ocean,
                                 const chart::Chart& chart, Statistics& statistics) {
  const MeanMotion motion{problem, ocean};
  return smooth(way, [&](const WayPoint& from, const WayPoint& to, double t_s) -> std::optional<double> {
    if (!chart.segment_is_clear(from.lat, from.lon, to.lat, to.lon, from.margin_m)) return std::nullopt;
    ++statistics.cost_evaluations;
    const auto seconds = travel_time(motion, from.lat, from.lon, to.lat, to.lon, t_s, statistics.current_evaluations);
    return seconds ? std::optional{*seconds} : std::nullopt;
  });
}

Expected<Plan, PlanFailure> Tve::plan(const Problem& problem, Members members, const chart::Chart& chart,
                                      const Budget& budget, const std::function<void(const Plan&)>& better) const {
  if (wants_least_distance(problem)) return unexpected(only_least_time(name()));
  return plan_by_search(problem, members, chart, budget, better, [&](const ocean::Ocean& ocean) -> Search {
    return [&](Purse& purse, Metres allowance) {
      return search_and_smooth(method_, problem, ocean, chart, purse, allowance);
    };
  });
}

}  // namespace glidehelm::planning
