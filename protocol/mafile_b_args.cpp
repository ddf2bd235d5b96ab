#include "protocol/mafile_b_args.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <initializer_list>
#include <limits>

namespace glidehelm::protocol {

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr auto kNone = std::nullopt;
constexpr double kPitch = 0.4538;      // 26 degrees
constexpr double kLargestPump = 1000;  // cubic centimetres

constexpr std::uint32_t bits(std::initializer_list<int> values) {
  std::uint32_t all = 0;
  for (const int v : values) all |= std::uint32_t{1} << v;
  return all;
}

constexpr BArgRule range(std::string_view behavior, std::string_view name, std::string_view unit,
                         std::optional<double> fallback, double least, double most = kNoLimit) {
  return {behavior, name, unit, fallback, least, most, 0, false, false};
}
constexpr BArgRule count(std::string_view behavior, std::string_view name, std::string_view unit,
                         std::optional<double> fallback, double least = -kNoLimit, double most = kNoLimit) {
  return {behavior, name, unit, fallback, least, most, 0, true, false};
}
constexpr BArgRule choice(std::string_view behavior, std::string_view name, std::optional<double> fallback,
                          std::uint32_t allowed) {
  return {behavior, name, "enum", fallback, 0, 31, allowed, true, false};
}
constexpr BArgRule any(std::string_view behavior, std::string_view name, std::string_view unit,
                       std::optional<double> fallback = kNone) {
  return {behavior, name, unit, fallback, -kNoLimit, kNoLimit, 0, false, false};
}
constexpr BArgRule expected(BArgRule rule) {
  rule.expected = true;
  return rule;
}

constexpr std::string_view kList = "goto_list", kSurface = "surface", kYo = "yo", kSample = "sample",
                           kDrift = "drift_at_depth", kHeading = "set_heading";
constexpr int kLastBaw = 18;  // of the BAW_ values of start_when

constexpr auto kRules = std::to_array<BArgRule>({
    expected(count(kList, "num_legs_to_run", "nodim", -1, -2)),
    expected(choice(kList, "start_when", 0, bits({0, 1, 2, 4}))),
    expected(choice(kList, "list_stop_when", 7, bits({1, 2, 5, 7, 15}))),
    expected(range(kList, "list_when_wpt_dist", "m", 10, 10)),
    expected(count(kList, "initial_wpt", "enum", -2, -2, 7)),
    expected(count(kList, "num_waypoints", "nodim", 0, 1, 99)),
    choice(kList, "end_action", 0, bits({0, 6})),
    count(kList, "primary_wpt", "enum", 0),
    count(kList, "primary_stop_when", "enum", 15),
    any(kList, "primary_when_wpt_dist", "m", 10),
    count(kList, "args_from_file", "enum", kNone, -1, 99),

    choice(kSurface, "start_when", 12, bits({0, 1, 2, 3, 6, 7, 8, 9, 10, 11, 12, 13, 16})),
    range(kSurface, "when_secs", "sec", 1200, 120),
    range(kSurface, "when_wpt_dist", "m", 10, 5),
    choice(kSurface, "end_action", 1, bits({0, 1, 2, 3, 4, 5})),
    any(kSurface, "report_all", "bool", 0),
    range(kSurface, "gps_wait_time", "sec", 300, 120),
    range(kSurface, "keystroke_wait_time", "sec", 300, 0, 900),
    range(kSurface, "gps_postfix_wait_time", "sec", 60, 0),
    range(kSurface, "printout_cycle_time", "sec", 60, 0),
    range(kSurface, "min_time_between_gps_fixes", "sec", 300, 0),
    count(kSurface, "c_use_pitch", "enum", kNone),
    any(kSurface, "c_pitch_value", "X", kPitch),
    count(kSurface, "c_use_bpump", "enum", kNone),
    range(kSurface, "c_bpump_value", "X", kNone, -kLargestPump, kLargestPump),
    count(kSurface, "c_use_thruster", "enum", kNone),
    any(kSurface, "c_thruster_value", "X"),
    any(kSurface, "c_stop_when_air_pump", "bool"),
    any(kSurface, "end_wpt_dist", "m"),
    any(kSurface, "strobe_on", "bool"),
    any(kSurface, "force_iridium_use", "nodim"),
    any(kSurface, "when_utc_min", "min"),
    any(kSurface, "when_utc_hour", "hour"),
    any(kSurface, "when_utc_day", "day"),
    any(kSurface, "when_utc_month", "month"),
    count(kSurface, "args_from_file", "enum", kNone, -1, 99),

    count(kYo, "start_when", "enum", 2, 0, kLastBaw),
    count(kYo, "num_half_cycles_to_do", "nodim", -1),
    range(kYo, "d_target_depth", "m", 12, 3, 1000),
    any(kYo, "d_target_altitude", "m", 5),
    count(kYo, "d_use_bpump", "enum", kNone),
    range(kYo, "d_bpump_value", "X", kNone, -kLargestPump, kLargestPump),
    count(kYo, "d_use_pitch", "enum", 3),
    any(kYo, "d_pitch_value", "X", -kPitch),
    any(kYo, "d_stop_when_hover_for", "sec"),
    any(kYo, "d_stop_when_stalled_for", "sec"),
    count(kYo, "d_use_thruster", "enum", kNone),
    any(kYo, "d_thruster_value", "X"),
    any(kYo, "c_target_depth", "m"),
    any(kYo, "c_target_altitude", "m"),
    count(kYo, "c_use_bpump", "enum", kNone),
    range(kYo, "c_bpump_value", "X", kNone, -kLargestPump, kLargestPump),
    count(kYo, "c_use_pitch", "enum", 3),
    any(kYo, "c_pitch_value", "X", kPitch),
    any(kYo, "c_stop_when_hover_for", "sec"),
    any(kYo, "c_stop_when_stalled_for", "sec"),
    count(kYo, "c_use_thruster", "enum", kNone),
    any(kYo, "c_thruster_value", "X"),
    count(kYo, "end_action", "enum", 2),
    any(kYo, "when_secs", "sec"),
    any(kYo, "when_wpt_dist", "m"),
    count(kYo, "args_from_file", "enum", kNone, -1, 99),

    count(kSample, "sensor_type", "enum", kNone, 0),
    count(kSample, "state_to_sample", "enum", kNone, 0, 15),
    any(kSample, "sample_time_after_state_change", "s"),
    any(kSample, "intersample_time", "s"),
    count(kSample, "nth_yo_to_sample", "nodim", kNone),
    any(kSample, "intersample_depth", "m"),
    any(kSample, "min_depth", "m"),
    any(kSample, "max_depth", "m"),
    count(kSample, "args_from_file", "enum", kNone, -1, 99),

    any(kDrift, "target_depth", "m"),
    any(kDrift, "target_altitude", "m"),
    any(kDrift, "target_deadband", "m"),
    any(kDrift, "depth_ctrl", "enum"),
    any(kDrift, "use_pitch", "enum"),
    any(kDrift, "pitch_value", "X"),
    any(kDrift, "use_thruster", "enum"),
    any(kDrift, "thruster_value", "X"),
    any(kDrift, "enable_steering", "bool"),
    any(kDrift, "stop_when_hover_for", "sec"),
    any(kDrift, "est_time_to_settle", "s"),

    any(kHeading, "use_heading", "bool"),
    any(kHeading, "heading_value", "X"),
});

}  // namespace

const BArgRule* b_arg_rule(std::string_view behavior, std::string_view name) {
  const auto found = std::find_if(kRules.begin(), kRules.end(),
                                  [&](const BArgRule& r) { return r.behavior == behavior && r.name == name; });
  return found == kRules.end() ? nullptr : &*found;
}

std::vector<const BArgRule*> b_arg_rules(std::string_view behavior) {
  std::vector<const BArgRule*> rules;
  for (const auto& rule : kRules)
    if (rule.behavior == behavior) rules.push_back(&rule);
  return rules;
}

bool knows_all_b_args(std::string_view behavior) {
  return behavior == kList || behavior == kSurface || behavior == kYo || behavior == kSample;
}

std::string_view other_behavior_with(std::string_view behavior, std::string_view name) {
  const auto found = std::find_if(kRules.begin(), kRules.end(),
                                  [&](const BArgRule& r) { return r.behavior != behavior && r.name == name; });
  return found == kRules.end() ? std::string_view{} : found->behavior;
}

std::string number_text(double value) {
  char text[48];
  const int n = std::snprintf(text, sizeof text, "%.10g", value);
  return {text, static_cast<std::size_t>(n)};
}

std::string allowed_text(const BArgRule& rule) {
  if (rule.allowed != 0) {
    std::string text;
    for (int v = 0; v < 32; ++v)
      if ((rule.allowed >> v & 1U) != 0) text += (text.empty() ? "" : ", ") + std::to_string(v);
    return text;
  }
  if (rule.most == kNoLimit) return number_text(rule.least) + " or more";
  return number_text(rule.least) + " to " + number_text(rule.most);
}

}  // namespace glidehelm::protocol
