#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "core/planning/member_plans.hpp"
#include "daemon/cli/plan_case.hpp"

namespace glidehelm::cli {

/// The plan that was made in one member, beside the control's.
struct EachPlan {
  planning::MemberPlan beside;
  std::string method;  ///< honest label; empty: there is no plan
  std::string reason;  ///< in words, when the goal is not reached
};

/// A full plan by the mission's method in each of the members 0 to `members` − 1, as if that member were the forecast. `control` is the plan of
/// member 0, made already; none: it has none. Plans are made on `threads` threads (0: one per processor), members are read one after the other: as
/// many members are in memory as there are threads, and the control. The answer does not depend on their number. A failure names the member
/// that comes first. `progress`: a bar on `err`.
Expected<std::vector<EachPlan>, Trouble> plan_in_members(const Case& c, const std::optional<planning::Plan>& control,
                                                         int members, bool progress, world::World& world,
                                                         std::ostream& err, unsigned threads = 0);

/// The key `ensemble_plans` of the plan's document.
nlohmann::ordered_json each_json(const std::vector<EachPlan>& plans);
/// The same in sentences.
void print_each(const std::vector<EachPlan>& plans, std::ostream& out);

}  // namespace glidehelm::cli
