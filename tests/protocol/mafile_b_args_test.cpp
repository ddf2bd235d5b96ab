#include "protocol/mafile_b_args.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>

using namespace glidehelm::protocol;

TEST_CASE("defaults are those of slocum.md 2.2 and 2.6") {
  const auto fallback = [](const char* behavior, const char* name) {
    const auto* rule = b_arg_rule(behavior, name);
    REQUIRE(rule != nullptr);
    return rule->fallback;
  };
  const std::pair<const char*, double> list[] = {{"num_legs_to_run", -1},   {"start_when", 0},
                                                 {"list_stop_when", 7},     {"list_when_wpt_dist", 10},
                                                 {"initial_wpt", -2},       {"num_waypoints", 0},
                                                 {"end_action", 0},         {"primary_wpt", 0},
                                                 {"primary_stop_when", 15}, {"primary_when_wpt_dist", 10}};
  for (const auto& [name, value] : list) CHECK(fallback("goto_list", name) == value);
  const std::pair<const char*, double> surface[] = {{"start_when", 12},
                                                    {"when_secs", 1200},
                                                    {"when_wpt_dist", 10},
                                                    {"end_action", 1},
                                                    {"gps_wait_time", 300},
                                                    {"keystroke_wait_time", 300},
                                                    {"gps_postfix_wait_time", 60},
                                                    {"printout_cycle_time", 60},
                                                    {"min_time_between_gps_fixes", 300},
                                                    {"report_all", 0},
                                                    {"c_pitch_value", 0.4538}};
  for (const auto& [name, value] : surface) CHECK(fallback("surface", name) == value);
  const std::pair<const char*, double> yo[] = {{"start_when", 2},          {"num_half_cycles_to_do", -1},
                                               {"d_target_depth", 12},     {"d_target_altitude", 5},
                                               {"d_use_pitch", 3},         {"c_use_pitch", 3},
                                               {"d_pitch_value", -0.4538}, {"c_pitch_value", 0.4538},
                                               {"end_action", 2}};
  for (const auto& [name, value] : yo) CHECK(fallback("yo", name) == value);
  CHECK_FALSE(fallback("sample", "state_to_sample"));
}

TEST_CASE("every default lies in its own range, and no rule is given twice") {
  std::set<std::string> names;
  for (const char* behavior : {"goto_list", "surface", "yo", "sample", "drift_at_depth", "set_heading"}) {
    CHECK_FALSE(b_arg_rules(behavior).empty());
    for (const auto* rule : b_arg_rules(behavior)) {
      INFO(behavior << " " << rule->name);
      CHECK(names.insert(std::string{behavior} + " " + std::string{rule->name}).second);
      CHECK(b_arg_rule(behavior, rule->name) == rule);
      if (!rule->fallback || rule->name == "num_waypoints") continue;  // 0 there: "not used with a file"
      CHECK((*rule->fallback >= rule->least && *rule->fallback <= rule->most));
      if (rule->whole) CHECK(*rule->fallback == std::floor(*rule->fallback));
      if (rule->allowed != 0) CHECK((rule->allowed >> static_cast<unsigned>(*rule->fallback) & 1U) == 1);
    }
  }
  CHECK(b_arg_rules("dance").empty());
}

TEST_CASE("what is allowed is said in words") {
  CHECK(allowed_text(*b_arg_rule("goto_list", "list_stop_when")) == "1, 2, 5, 7, 15");
  CHECK(allowed_text(*b_arg_rule("surface", "when_secs")) == "120 or more");
  CHECK(allowed_text(*b_arg_rule("yo", "d_target_depth")) == "3 to 1000");
}

TEST_CASE("a b_arg of another behaviour is found there") {
  CHECK(b_arg_rule("yo", "target_depth") == nullptr);
  CHECK(other_behavior_with("yo", "target_depth") == "drift_at_depth");
  CHECK(other_behavior_with("yo", "colour").empty());
  CHECK(knows_all_b_args("sample"));
  CHECK_FALSE(knows_all_b_args("set_heading"));
}
