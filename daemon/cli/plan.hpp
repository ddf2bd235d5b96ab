#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <utility>

#include "daemon/world/world.hpp"

namespace glidehelm::cli {

/// `glidehelm plan MISSION.yaml [--method NAME] [--from LAT,LON] [--at TIME] [--water E,N] [--seed N] [--budget SECONDS]
/// [--member K | --members N] [--each] [--goto FILE] [--json]`.
struct PlanOptions {
  std::string mission;
  std::string method;                             ///< empty: the mission's
  std::optional<std::pair<double, double>> from;  ///< degrees: latitude, longitude
  std::optional<Instant> at;
  std::optional<std::pair<double, double>> water;  ///< measured current, east and north, m/s
  std::optional<std::uint64_t> seed;
  std::optional<Seconds> budget;        ///< none: every stage runs to its work limit, the answer is deterministic
  std::optional<std::uint32_t> member;  ///< of the forecast's ensemble, from 0; none: 0
  int members{};                        ///< the plan is flown in so many members; 0: in all of the mission's ensemble
  bool each{};                          ///< a plan of its own is made in each of those members; without `budget`
  std::string goto_file;                ///< write the verified list there; empty: none
  bool json{};
};

/// Plans once, offline. The start is --from, else the mission's; the time is --at, else the mission's, else now, else (said on `err`) the
/// first time of the forecast when that does not reach to now. JSON as in product.md 9 (schema glidehelm/plan/v1). With --goto the list is
/// judged as the daemon's files are, and written only when it is accepted.
/// Of a body (vehicle.force_balance) the inputs say in whose water it is weighed, and the table has a line of it.
/// With --members, or an ensemble in the mission, the plan of member 0 is flown in the members 0 to N − 1 too (plan_members.hpp); the answer says
/// so in the key `ensemble`. With --each a plan is made in each of them (plan_each.hpp): the key `ensemble_plans`.
/// Returns 0 reaches_goal, 1 any other status, 2 misuse, 4 the verifier refuses the list, 5 the budget ended with nothing.
int run_plan(const PlanOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
