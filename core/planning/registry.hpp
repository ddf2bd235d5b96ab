#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// The methods of this version by the names of configuration and command line: "direct", "astar", "cts-astar",
/// "abs-cts-astar", "tve", "astar-tve", "ztve", "zastar-tve", "cts-astar-refined", "rrt", "optimization",
/// "iterative-optimization", "zermelo", "best".
std::vector<std::string> method_names();
/// The planner of a name; null when there is none of it.
std::unique_ptr<const Planner> planner_named(std::string_view name);

}  // namespace glidehelm::planning
