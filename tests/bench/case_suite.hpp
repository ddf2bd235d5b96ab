#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/ocean/analytic.hpp"
#include "core/ocean/forecast.hpp"
#include "core/ocean/gridded.hpp"
#include "core/planning/planner.hpp"

/// The cases that all methods are compared on: synthetic, seeded, the same on every machine. Those on published currents: real_cases.hpp.
namespace glidehelm::suite {

/// A sea with its chart, and the way through it.
class Case {
 public:
  Case(std::string name, planning::Problem problem, ocean::GriddedField field, std::vector<chart::Area> islands = {});
  Case(std::string name, planning::Problem problem, ocean::AnalyticField field);
  Case(std::string name, planning::Problem problem, ocean::Forecast forecast);

  std::string name;
  planning::Problem problem;
  [[nodiscard]] ocean::Ocean ocean() const;
  [[nodiscard]] const chart::Chart& chart() const { return *chart_; }
  [[nodiscard]] bool has_islands() const { return has_islands_; }

 private:
  std::shared_ptr<const ocean::GriddedField> gridded_;
  std::shared_ptr<const ocean::AnalyticField> analytic_;
  std::optional<ocean::Forecast> forecast_;
  std::shared_ptr<const chart::Chart> chart_;
  bool has_islands_{};
};

/// From a fix to within 2 km of a goal in stints of 8 h; departure and horizon are left to who asks.
planning::Problem problem_of(GeoPoint from, GeoPoint to, MetresPerSecond speed);

/// What the long cases are made of. Eddies of 28 to 62 km radius (where their flow is fastest) on a grid of 1/20°, the fastest flow of
/// each between 0.1 and 0.35 m/s, either way round; where they overlap the flow is up to about twice that.
inline constexpr double kLongWay = 650e3;  ///< metres

/// Twenty static cases of 650 km at the given speed through water, in random directions, stints of 8 h; every second one has
/// islands, one of them on the straight way (Thesis 5.4.4, 5.6.1, whose fields are not published: these are ours).
std::vector<Case> static_cases(MetresPerSecond speed, int count = 20);

/// 45 cases of three to four days in hourly fields with drifting eddies of 15 to 40 km: the goal is far beyond what can be reached,
/// and the least distance left at the horizon counts (Thesis 5.5, 5.6.2). Every third lies among islands.
std::vector<Case> dynamic_cases(MetresPerSecond speed, int count = 45);

/// One member of an ensemble: the same way of 650 km and the same sixty eddies for all of them (28 to 62 km, as the static cases), each eddy
/// of a member but the control up to 30 km off in east and north and 0.7 to 1.3 times as fast. `hours` 0: static; else hourly, and they drift.
Case ensemble_case(MetresPerSecond speed, int member, int hours = 0);

/// Eichhorn's meandering jet with U = 0.5 of its speed scale: starts (0, −3), (0, −1.5), (0, 0), (0, 1.5), (0, 3), goal (10, 0), in units
/// of 20 km and V = 0.6 m/s. Starts and goal are ours; the paper gives none.
std::vector<Case> jet_cases();

/// The analytic fields of the tests (tests/support/planning.hpp), 31 km each.
std::vector<Case> analytic_cases();

}  // namespace glidehelm::suite
