#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "core/planning/lower_bound.hpp"
#include "core/planning/planner.hpp"
#include "daemon/cli/plan.hpp"

namespace glidehelm::cli {

/// `glidehelm compare MISSION… [--methods NAME,…] [--from LAT,LON] [--at TIME] [--seed N] [--budget SECONDS] [--no-bound]
/// [--html FILE] [--json]`.
struct CompareOptions {
  std::vector<std::string> missions;
  std::vector<std::string> methods;  ///< empty: all
  PlanOptions plan;                  ///< start, time, seed and budget; mission and method are of no account
  bool bound{true};                  ///< compute the certificate too
  std::string html;                  ///< write one page with table and map to this new file; empty: none
  bool json{};
};

/// One method's answer to one mission.
struct Compared {
  std::string method;  ///< as asked
  std::optional<planning::Plan> plan;
  std::string problem;  ///< why there is no plan
  double wall_s{};
};

/// All answers to one mission.
struct Comparison {
  std::string mission, forecast;
  GeoPoint start, goal;
  Metres goal_radius;
  double start_s{};
  std::optional<planning::Bound> bound;
  std::vector<Compared> answers;  ///< in the order asked
  [[nodiscard]] double way_m() const { return distance(start, goal).si(); }
};

/// Plans each mission with every method and the same currents, one after the other: travel time, effective speed, gap to the
/// certified bound, distance left, wall time, work. The table is sorted by what was reached; JSON (schema glidehelm/comparison/v1)
/// keeps the order asked. Methods that cannot answer say why. Progress goes to `err`.
/// Returns 0 some method reaches every goal, 1 none reaches one of them, 2 misuse.
int run_compare(const CompareOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
