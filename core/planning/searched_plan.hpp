#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/planning/planner.hpp"
#include "core/planning/purse.hpp"

namespace glidehelm::planning {

/// What a search found, before it is flown.
struct Found {
  std::string method;  ///< label of the plan
  std::vector<std::vector<Heading>>
      ways;            ///< headings of stints; each way is flown, and the best flight counts, the first of equals
  bool arrives{};      ///< by the search's own reckoning
  bool exhausted{};    ///< ended by itself, not by the budget
  bool met_margin{};   ///< the chart's margin ended ways
  std::string reason;  ///< in words, why it does not arrive
};
/// One search, paid from the purse, that keeps `allowance` of clearance beyond the coastal margin.
using Search = std::function<Found(Purse& purse, Metres allowance)>;

/// What every planner that searches first does with what it found (docs/decisions/023): checks both ends of the way, searches, flies what
/// was found as the lists that will be emitted (fly_path), and makes the answer of it.
///
/// The first search keeps `allowance(problem)`. When the margin stopped it or grounded its flight it is repeated once: with three times
/// that where the flight did not arrive although the search did, with none where nothing arrived. Without an arrival the plan is the
/// closest approach, flown to its last heading only.
Expected<Plan, PlanFailure> plan_by_search(const Problem& problem, Members members, const chart::Chart& chart,
                                           const Budget& budget, const std::function<void(const Plan&)>& better,
                                           const std::function<Search(const ocean::Ocean&)>& search_in);

}  // namespace glidehelm::planning
