#include "core/planning/registry.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;

TEST_CASE("every name of the list makes a planner that answers to it, and no other name does") {
  CHECK(planning::method_names() == std::vector<std::string>{"direct", "astar", "cts-astar", "abs-cts-astar", "tve",
                                                             "astar-tve", "ztve", "zastar-tve", "cts-astar-refined",
                                                             "rrt", "optimization", "iterative-optimization", "zermelo",
                                                             "best"});
  for (const auto& name : planning::method_names()) {
    const auto planner = planning::planner_named(name);
    REQUIRE(planner);
    CHECK(planner->name() == name);
  }
  for (const char* name : {"", "a-star", "Direct", "best "}) CHECK_FALSE(planning::planner_named(name));
}
