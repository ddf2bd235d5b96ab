#pragma once

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <vector>

#include "core/planning/member_flight.hpp"
#include "daemon/cli/plan_case.hpp"

namespace glidehelm::cli {

/// In how many members the plan is to be flown: --members, else all of the mission's ensemble, none with --member. Refused, with the line of
/// `currents.ensemble`, when members have no file: all of them are named.
Expected<int, Trouble> members_to_fly(const Case& c, const PlanOptions& options, world::World& world);

/// The forecast of one member of the case. Refused, with the line of `currents.ensemble`, when it is of another cycle than the case's own: that
/// is the reference time, or the first time where the files name none.
Expected<std::shared_ptr<const daemon::OceanSource>, Trouble> load_member(const Case& c, std::uint32_t member,
                                                                          world::World& world);

/// Flies `plan` in the members 0 to `members` − 1 of the case's forecast, one after the other: one at a time is in memory. The
/// failure names the member. `progress`: a bar on `err`.
Expected<std::vector<planning::MemberFlight>, Trouble> fly_in_members(const Case& c, const planning::Plan& plan,
                                                                      int members, bool progress, world::World& world,
                                                                      std::ostream& err);

/// The key `ensemble` of the plan's document.
nlohmann::ordered_json members_json(const std::vector<planning::MemberFlight>& flights);
/// The same in sentences.
void print_members(const std::vector<planning::MemberFlight>& flights, std::ostream& out);

}  // namespace glidehelm::cli
