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
#include "protocol/mafile_b_args.hpp"

namespace glidehelm::protocol {

namespace {

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

void check_value(const BArgRule& rule, const BArg& arg, ProblemList& problems) {
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

void unknown_b_arg(const std::string& behavior, const BArg& arg, ProblemList& problems) {
  const bool of_mission = behavior == "goto_list" && arg.name.starts_with("wpt_");
  const auto other = other_behavior_with(behavior, arg.name);
  std::string message = "no b_arg " + arg.name + " of " + behavior + " is known";
  if (of_mission)
    message += "; it counts inside a mission only";
  else if (!other.empty())
    message += "; " + std::string{other} + " has one";
  problems.add(arg.line, arg.column, "unknown-b-arg", Weight::doubt, message);
}

void check_b_args(const Mafile& file, ProblemList& problems) {
  for (std::size_t i = 0; i < file.b_args.size(); ++i) {
    const auto& arg = file.b_args[i];
    const auto before = std::find_if(file.b_args.begin(), file.b_args.begin() + static_cast<std::ptrdiff_t>(i),
                                     [&](const BArg& other) { return other.name == arg.name; });
    if (before != file.b_args.begin() + static_cast<std::ptrdiff_t>(i))
      problems.add(arg.line, arg.column, "duplicate-b-arg", Weight::doubt,
                   arg.name + " was given on line " + std::to_string(before->line) + "; the last one counts here");
    const auto* rule = b_arg_rule(file.behavior, arg.name);
    if (rule == nullptr) {
      if (knows_all_b_args(file.behavior)) unknown_b_arg(file.behavior, arg, problems);
      continue;
    }
    if (arg.unit != rule->unit)
      problems.add(arg.line, arg.column, "unit", Weight::note,
                   arg.name + " is in (" + arg.unit + "), masterdata says (" + std::string{rule->unit} + ")");
    if (arg.value) check_value(*rule, arg, problems);
  }
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
  for (const auto* rule : b_arg_rules("goto_list"))
    if (rule->expected && file.b_arg(rule->name) == nullptr)
      problems.add(0, 0, "missing-b-arg", Weight::doubt,
                   std::string{rule->name} + " is not given: the glider takes masterdata's default, " +
                       number_text(*rule->fallback) + ", not the mission's value");
  const auto* initial = file.b_arg("initial_wpt");
  if (initial != nullptr && initial->value && listed > 0 && *initial->value >= listed && *initial->value <= 7)
    problems.add(initial->line, initial->column, "range", Weight::doubt,
                 "initial_wpt is " + initial->text + ", but " + std::to_string(listed) + " waypoints are listed");
  if (file.b_arg("end_action") == nullptr) problems.add(0, 0, "missing-b-arg", Weight::note, "end_action is not given");
  const auto* legs = file.b_arg("num_legs_to_run");
  if (legs != nullptr && legs->value && (*legs->value == -2 || *legs->value > 0) && file.in_force("end_action") != 6.0)
    problems.add(legs->line, legs->column, "quits-at-end", Weight::doubt,
                 "num_legs_to_run " + legs->text + " without end_action 6: goto_list ends behind the last waypoint");
}

/// A pitch in radians that points the wrong way, or that is a number of degrees.
void check_pitch(const Mafile& file, const char* use_name, const char* value_name, bool dives, ProblemList& problems) {
  const auto* arg = file.b_arg(value_name);
  const auto use = file.in_force(use_name);
  // 2 and 3 steer to an angle; 1 and 4 mean inches and cubic centimetres.
  if (arg == nullptr || !arg->value || is_mission_parameter(*arg->value) || !(use == 2.0 || use == 3.0)) return;
  const double pitch = dives ? -*arg->value : *arg->value;
  if (pitch > 0 && pitch < kPi / 2) return;
  problems.add(arg->line, arg->column, "range", Weight::doubt,
               arg->name + " is " + arg->text + ", expected are radians, " +
                   (dives ? "-1.57 to 0: the nose points down in a dive" : "0 to 1.57: the nose points up in a climb"));
}

/// What several b_args say together.
void check_flight(const Mafile& file, ProblemList& problems) {
  check_pitch(file, "d_use_pitch", "d_pitch_value", true, problems);
  check_pitch(file, "c_use_pitch", "c_pitch_value", false, problems);
  const auto* shallow = file.b_arg("c_target_depth");
  const auto deep = file.in_force("d_target_depth");
  if (file.behavior != "yo" || shallow == nullptr || !shallow->value || !deep) return;
  if (is_mission_parameter(*shallow->value) || is_mission_parameter(*deep) || *shallow->value < *deep) return;
  problems.add(shallow->line, shallow->column, "range", Weight::doubt,
               "c_target_depth is " + shallow->text + ", not above d_target_depth, which is " + number_text(*deep));
}

/// A number of the file read as decimal degrees.
std::optional<GeoPoint> in_degrees_as_written(std::string_view lat, std::string_view lon) {
  const auto a = number_from(lat), b = number_from(lon);
  if (!a || !b || std::abs(*b) > 180) return std::nullopt;
  const auto point = GeoPoint::from_degrees(*a, *b);
  if (!point) return std::nullopt;
  return *point;
}

/// The first waypoint is hit where the glider is: it never flies there.
void check_radius(const Mafile& file, const GeoPoint& glider, ProblemList& problems) {
  const auto radius = file.in_force("list_when_wpt_dist");
  if (file.waypoints.empty() || !file.waypoints.front().at || !radius || is_mission_parameter(*radius)) return;
  const auto& first = file.waypoints.front();
  const double metres = distance(glider, *first.at).si();
  if (metres >= *radius) return;
  problems.add(first.line, first.column, "inside-radius", Weight::doubt,
               "the first waypoint is " + number_text(std::round(metres)) +
                   " m from the glider, within the radius of " + number_text(*radius) +
                   " m: it counts as reached at once");
}

std::string km(Metres d) {
  char text[48];
  const int n = std::snprintf(text, sizeof text, "%.0f km", d.si() / 1000);
  return {text, static_cast<std::size_t>(n)};
}

void check_places(const Mafile& file, const GeoPoint& glider, ProblemList& problems) {
  constexpr Metres kFar{500'000};
  for (const auto& waypoint : file.waypoints) {
    const auto as_meant =
        waypoint.at ? distance(glider, *waypoint.at) : Metres{std::numeric_limits<double>::infinity()};
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
  check_flight(file, problems);
  if (file.behavior != "goto_list") return;
  check_list(file, options, problems);
  if (!options.near) return;
  check_places(file, *options.near, problems);
  check_radius(file, *options.near, problems);
}

}  // namespace glidehelm::protocol
