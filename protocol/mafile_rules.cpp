#include "protocol/mafile_rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/base/text.hpp"
#include "protocol/latlon.hpp"

namespace glidehelm::protocol {

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// One b_arg of masterdata. `allowed` has bit n for each allowed value n of an enum; 0: the range decides.
struct Rule {
  std::string_view behavior, name, unit;
  double least, most;
  std::uint32_t allowed;
  bool whole;
  bool expected;  ///< left out, its default surprises
};

constexpr std::uint32_t bits(std::initializer_list<int> values) {
  std::uint32_t all = 0;
  for (const int v : values) all |= std::uint32_t{1} << v;
  return all;
}

constexpr std::array<Rule, 20> kRules{{
    {"goto_list", "num_legs_to_run", "nodim", -2, kNoLimit, 0, true, true},
    {"goto_list", "start_when", "enum", 0, 4, bits({0, 1, 2, 4}), true, true},
    {"goto_list", "list_stop_when", "enum", 1, 15, bits({1, 2, 5, 7, 15}), true, true},
    {"goto_list", "list_when_wpt_dist", "m", 10, kNoLimit, 0, false, true},
    {"goto_list", "initial_wpt", "enum", -2, 7, 0, true, true},
    {"goto_list", "num_waypoints", "nodim", 1, 99, 0, true, true},
    {"goto_list", "end_action", "enum", 0, 6, bits({0, 6}), true, false},
    {"goto_list", "primary_wpt", "enum", -kNoLimit, kNoLimit, 0, true, false},
    {"goto_list", "primary_stop_when", "enum", -kNoLimit, kNoLimit, 0, true, false},
    {"goto_list", "primary_when_wpt_dist", "m", -kNoLimit, kNoLimit, 0, false, false},
    {"goto_list", "args_from_file", "enum", -1, 99, 0, true, false},
    {"surface", "start_when", "enum", 0, 16, bits({0, 1, 2, 3, 6, 7, 8, 9, 10, 11, 12, 13, 16}), true, false},
    {"surface", "when_secs", "sec", 120, kNoLimit, 0, false, false},
    {"surface", "when_wpt_dist", "m", 5, kNoLimit, 0, false, false},
    {"surface", "end_action", "enum", 0, 5, bits({0, 1, 2, 3, 4, 5}), true, false},
    {"surface", "gps_wait_time", "sec", 120, kNoLimit, 0, false, false},
    {"surface", "keystroke_wait_time", "sec", 0, 900, 0, false, false},
    {"yo", "d_target_depth", "m", 3, 1000, 0, false, false},
    {"yo", "num_half_cycles_to_do", "nodim", -kNoLimit, kNoLimit, 0, true, false},
    {"sample", "state_to_sample", "enum", 0, 15, 0, true, false},
}};

const Rule* rule_of(std::string_view behavior, std::string_view name) {
  const auto found = std::find_if(kRules.begin(), kRules.end(),
                                  [&](const Rule& r) { return r.behavior == behavior && r.name == name; });
  return found == kRules.end() ? nullptr : &*found;
}

std::string number_text(double value) {
  char text[48];
  const int n = std::snprintf(text, sizeof text, "%.10g", value);
  return {text, static_cast<std::size_t>(n)};
}

std::string allowed_text(const Rule& rule) {
  if (rule.allowed != 0) {
    std::string text;
    for (int v = 0; v < 32; ++v)
      if ((rule.allowed >> v & 1U) != 0) text += (text.empty() ? "" : ", ") + std::to_string(v);
    return text;
  }
  if (rule.most == kNoLimit) return number_text(rule.least) + " or more";
  return number_text(rule.least) + " to " + number_text(rule.most);
}

/// Messages quote the file: without bytes that could forge a log line, and not without end.
std::string printable(std::string_view message) {
  constexpr std::size_t kMost = 300;
  std::string out{message.substr(0, kMost)};
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return out;
}

/// Mission parameters u_mission_param_a… are named by values from 1,000,000 on (slocum.md 2.2).
bool is_mission_parameter(double value) { return value >= 1e6; }

void check_value(const Rule& rule, const BArg& arg, ProblemList& problems) {
  const double v = *arg.value;
  if (is_mission_parameter(v)) return;
  if (rule.whole && v != std::floor(v)) {
    problems.add(arg.line, arg.column, "not-whole", Weight::doubt,
                 arg.name + " is " + arg.text + ", expected is a whole number");
    return;
  }
  const bool legs = rule.name == "num_legs_to_run";
  const bool listed = rule.allowed == 0 || (v >= 0 && v < 32 && (rule.allowed >> static_cast<unsigned>(v) & 1U) != 0);
  if (v >= rule.least && v <= rule.most && listed && !(legs && v == 0)) return;
  problems.add(arg.line, arg.column, "range", legs ? Weight::fault : Weight::doubt,
               arg.name + " is " + arg.text + ", allowed is " +
                   (legs ? "-2 (once), -1 (for ever) or a number of legs" : allowed_text(rule)));
}

void check_b_args(const Mafile& file, ProblemList& problems) {
  for (std::size_t i = 0; i < file.b_args.size(); ++i) {
    const auto& arg = file.b_args[i];
    const auto before = std::find_if(file.b_args.begin(), file.b_args.begin() + static_cast<std::ptrdiff_t>(i),
                                     [&](const BArg& other) { return other.name == arg.name; });
    if (before != file.b_args.begin() + static_cast<std::ptrdiff_t>(i))
      problems.add(arg.line, arg.column, "duplicate-b-arg", Weight::doubt,
                   arg.name + " was given on line " + std::to_string(before->line) + "; the last one counts here");
    const auto* rule = rule_of(file.behavior, arg.name);
    if (rule == nullptr) {
      if (file.behavior == "goto_list")
        problems.add(arg.line, arg.column, "unknown-b-arg", Weight::doubt, "goto_list has no b_arg " + arg.name);
      continue;
    }
    if (arg.unit != rule->unit)
      problems.add(arg.line, arg.column, "unit", Weight::note,
                   arg.name + " is in (" + arg.unit + "), masterdata says (" + std::string{rule->unit} + ")");
    if (arg.value) check_value(*rule, arg, problems);
  }
}

std::optional<double> value_of(const Mafile& file, std::string_view name) {
  const auto* arg = file.b_arg(name);
  return arg == nullptr ? std::nullopt : arg->value;
}

/// Counts, defaults and the end of a list.
void check_list(const Mafile& file, const MafileOptions& options, ProblemList& problems) {
  const auto listed = static_cast<int>(file.waypoints.size());
  if (listed == 0) problems.add(0, 0, "no-waypoints", Weight::fault, "the list has no waypoint");
  if (listed > options.max_waypoints)
    problems.add(file.waypoints[static_cast<std::size_t>(options.max_waypoints)].line, 1, "too-many-waypoints",
                 Weight::doubt,
                 std::to_string(listed) + " waypoints are listed, documented are at most " +
                     std::to_string(options.max_waypoints));
  const auto* count = file.b_arg("num_waypoints");
  if (count != nullptr && count->value && *count->value != listed)
    problems.add(
        count->line, count->column, "count-mismatch", Weight::doubt,
        "num_waypoints is " + count->text + ", listed are " + std::to_string(listed) + "; the listed ones count");
  for (const auto& rule : kRules)
    if (rule.behavior == "goto_list" && rule.expected && file.b_arg(rule.name) == nullptr)
      problems.add(
          0, 0, "missing-b-arg", Weight::doubt,
          std::string{rule.name} + " is not given: the glider takes masterdata's default, not the mission's value");
  const auto* initial = file.b_arg("initial_wpt");
  if (initial != nullptr && initial->value && listed > 0 && *initial->value >= listed && *initial->value <= 7)
    problems.add(initial->line, initial->column, "range", Weight::doubt,
                 "initial_wpt is " + initial->text + ", but " + std::to_string(listed) + " waypoints are listed");
  if (file.b_arg("end_action") == nullptr) problems.add(0, 0, "missing-b-arg", Weight::note, "end_action is not given");
  const auto* legs = file.b_arg("num_legs_to_run");
  if (legs != nullptr && legs->value && (*legs->value == -2 || *legs->value > 0) && value_of(file, "end_action") != 6.0)
    problems.add(legs->line, legs->column, "quits-at-end", Weight::doubt,
                 "num_legs_to_run " + legs->text + " without end_action 6: goto_list ends behind the last waypoint");
}

/// A number of the file read as decimal degrees.
std::optional<GeoPoint> in_degrees_as_written(std::string_view lat, std::string_view lon) {
  const auto a = number_from(lat), b = number_from(lon);
  if (!a || !b || std::abs(*b) > 180) return std::nullopt;
  const auto point = GeoPoint::from_degrees(*a, *b);
  if (!point) return std::nullopt;
  return *point;
}

std::string km(Metres d) {
  char text[48];
  const int n = std::snprintf(text, sizeof text, "%.0f km", d.si() / 1000);
  return {text, static_cast<std::size_t>(n)};
}

void check_places(const Mafile& file, const GeoPoint& glider, ProblemList& problems) {
  constexpr Metres kFar{500'000};
  for (const auto& waypoint : file.waypoints) {
    const auto as_meant = waypoint.at ? distance(glider, *waypoint.at) : Metres{kNoLimit};
    const auto say = [&](std::string_view code, Weight weight, const std::string& what) {
      problems.add(waypoint.line, waypoint.column, code, weight,
                   waypoint.lon_text + " " + waypoint.lat_text + " " + what);
    };
    const std::string here = waypoint.at ? " from the glider as it stands, " : " as it stands, ";
    const std::string lies = waypoint.at ? "lies " + km(as_meant) + here : "is no position" + here;
    const auto degrees = in_degrees_as_written(waypoint.lat_text, waypoint.lon_text);
    if (degrees && distance(glider, *degrees) < as_meant) {
      say("decimal-degrees", Weight::fault,
          "looks like decimal degrees: it " + lies + km(distance(glider, *degrees)) + " read as degrees");
      continue;
    }
    const auto lat = latitude_from_ddmm(waypoint.lon_text);
    const auto lon = longitude_from_ddmm(waypoint.lat_text);
    if (lat && lon && as_meant > kFar && distance(glider, GeoPoint{*lat, *lon}) < as_meant) {
      say("swapped", Weight::fault,
          "looks like latitude first: it " + lies + km(distance(glider, GeoPoint{*lat, *lon})) +
              " the other way round");
      continue;
    }
    if (waypoint.at && as_meant > kFar) say("far-away", Weight::doubt, "is " + km(as_meant) + " from the glider");
  }
}

}  // namespace

void ProblemList::add(int line, int column, std::string_view code, Weight weight, std::string_view message) {
  const bool strict = mode_ == MafileOptions::Mode::strict;
  if (weight == Weight::note && !strict) return;
  MafileProblem problem;
  problem.line = line;
  problem.column = column;
  problem.code = code;
  problem.severity = strict || weight == Weight::fault ? Severity::error : Severity::warning;
  problem.message = printable(message);
  problems_.push_back(std::move(problem));
}

std::vector<MafileProblem> ProblemList::take() {
  std::stable_sort(problems_.begin(), problems_.end(), [](const MafileProblem& a, const MafileProblem& b) {
    return std::pair{a.line, a.column} < std::pair{b.line, b.column};
  });
  return std::exchange(problems_, {});
}

bool is_mafile_behavior(std::string_view behavior) {
  constexpr std::array<std::string_view, 7> kKnown{"goto_list",      "surface",        "yo", "sample", "set_heading",
                                                   "drift_at_depth", "prepare_to_dive"};
  return std::find(kKnown.begin(), kKnown.end(), behavior) != kKnown.end();
}

void check_mafile(const Mafile& file, const MafileOptions& options, ProblemList& problems) {
  check_b_args(file, problems);
  if (file.behavior != "goto_list") return;
  check_list(file, options, problems);
  if (options.near) check_places(file, *options.near, problems);
}

}  // namespace glidehelm::protocol
