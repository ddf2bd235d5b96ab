#include "core/planning/registry.hpp"

#include "core/planning/abs_cts_astar.hpp"
#include "core/planning/astar.hpp"
#include "core/planning/cts_astar.hpp"
#include "core/planning/direct_to_goal.hpp"
#include "core/planning/ladder.hpp"
#include "core/planning/optimization.hpp"
#include "core/planning/refined_cts.hpp"
#include "core/planning/rrt.hpp"
#include "core/planning/tve.hpp"
#include "core/planning/zermelo.hpp"

namespace glidehelm::planning {

std::vector<std::string> method_names() {
  return {"direct",  "astar",      "cts-astar",         "abs-cts-astar", "tve",          "astar-tve",
          "ztve",    "zastar-tve", "cts-astar-refined", "rrt",           "optimization", "iterative-optimization",
          "zermelo", "best"};
}

std::unique_ptr<const Planner> planner_named(std::string_view name) {
  if (name == "direct") return std::make_unique<DirectToGoal>();
  if (name == "astar") return std::make_unique<AStar>();
  if (name == "cts-astar") return std::make_unique<CtsAStar>();
  if (name == "abs-cts-astar") return std::make_unique<AbsCtsAStar>();
  if (name == "tve") return std::make_unique<Tve>(Tve::Method::tve);
  if (name == "astar-tve") return std::make_unique<Tve>(Tve::Method::astar_tve);
  if (name == "ztve") return std::make_unique<Tve>(Tve::Method::ztve);
  if (name == "zastar-tve") return std::make_unique<Tve>(Tve::Method::zastar_tve);
  if (name == "cts-astar-refined") return std::make_unique<RefinedCts>();
  if (name == "rrt") return std::make_unique<Rrt>();
  if (name == "optimization") return std::make_unique<Optimization>();
  if (name == "iterative-optimization") return std::make_unique<IterativeOptimization>();
  if (name == "zermelo") return std::make_unique<Zermelo>();
  if (name == "best") return std::make_unique<Ladder>();
  return nullptr;
}

}  // namespace glidehelm::planning
