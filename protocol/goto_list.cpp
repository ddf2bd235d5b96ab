#include "protocol/goto_list.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "core/base/utc.hpp"
#include "protocol/latlon.hpp"
#include "protocol/mafile.hpp"

namespace glidehelm::protocol {

namespace {

std::string plain(std::string_view text) {
  constexpr std::size_t kMost = 60;
  std::string result;
  for (const char c : text.substr(0, kMost)) {
    const bool word = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    result += word || c == ' ' || c == ':' || c == '.' || c == '_' || c == '-' ? c : '_';
  }
  return result;
}

std::string argument(const char* name, const std::string& value, const char* comment = "") {
  return std::string{"\tb_arg: "} + name + " " + value + comment + "\n";
}

std::string tenths(Metres radius) {
  char text[48];
  const int n = std::snprintf(text, sizeof text, "%.1f", radius.si());
  return {text, static_cast<std::size_t>(n)};
}

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

std::string goto_list_name(int slot) {
  require(slot >= 0 && slot <= 99);
  char name[32];
  const int n = std::snprintf(name, sizeof name, "goto_l%02d.ma", slot);
  return {name, static_cast<std::size_t>(n)};
}

std::string write_goto_list(const model::WaypointList& list, const GotoListComment& comment) {
  require(!list.points.empty() && list.points.size() <= 99);
  require(list.radius.si() >= kSmallestRadius && list.radius.si() <= kLargestRadius);
  const bool loops = list.at_end == model::AtEnd::loop;
  std::string text = "behavior_name=goto_list\n";
  text += "# Written by Glidehelm on UTC: " + utc_text(comment.stamp) + "\n";
  text += "# plan: " + plain(comment.plan_id) + "\n";
  text += "# method: " + plain(comment.method) + "\n";
  text += "\n<start:b_arg>\n";
  text += argument("num_legs_to_run(nodim)", loops ? "-1" : "-2", loops ? " # loop for ever" : " # the list once");
  text += argument("start_when(enum)", "0", " # BAW_IMMEDIATELY");
  text += argument("list_stop_when(enum)", "7", " # BAW_WHEN_WPT_DIST");
  text += argument("list_when_wpt_dist(m)", tenths(list.radius));
  text += argument("initial_wpt(enum)", "0", " # the first of the list");
  text += argument("num_waypoints(nodim)", std::to_string(list.points.size()));
  text += argument("end_action(enum)", loops ? "0" : "6", loops ? " # never reached" : " # wait for Ctrl-F");
  text += "<end:b_arg>\n<start:waypoints>\n";
  for (const auto& point : list.points) text += ddmm(point.at.lon) + "\t" + ddmm(point.at.lat) + "\n";
  text += "<end:waypoints>\n";
  return text;
}

namespace {

/// The value of a b_arg that is there (the strict reader said so).
double value_of(const Mafile& file, std::string_view name) { return file.b_arg(name)->value.value(); }

/// The first b_arg whose value is legal but not what we send.
std::optional<BadList> not_ours(const Mafile& file) {
  const auto is = [&](std::string_view name, bool holds, const char* allowed) -> std::optional<BadList> {
    if (holds) return std::nullopt;
    return BadList{file.b_arg(name)->line,
                   std::string{name} + " is " + file.b_arg(name)->text + ", ours is " + allowed};
  };
  const double legs = value_of(file, "num_legs_to_run"), radius = value_of(file, "list_when_wpt_dist");
  if (auto bad = is("num_legs_to_run", legs == -1 || legs == -2, "-1 or -2")) return bad;
  if (auto bad = is("start_when", value_of(file, "start_when") == 0, "0")) return bad;
  if (auto bad = is("list_stop_when", value_of(file, "list_stop_when") == 7, "7")) return bad;
  if (auto bad = is("list_when_wpt_dist", radius <= kLargestRadius, "10 to 100000")) return bad;
  if (auto bad = is("initial_wpt", value_of(file, "initial_wpt") == 0, "0")) return bad;
  return is("end_action", value_of(file, "end_action") == (legs == -1 ? 0 : 6), legs == -1 ? "0" : "6");
}

}  // namespace

Expected<model::WaypointList, BadList> read_goto_list(std::string_view bytes) {
  if (bytes.size() > kLargestGotoList)
    return unexpected(
        BadList{0, std::to_string(bytes.size()) + " bytes, allowed are " + std::to_string(kLargestGotoList)});
  MafileOptions options;
  options.mode = MafileOptions::Mode::strict;
  options.max_waypoints = 99;
  const auto file = read_mafile(bytes, options);
  if (!file.problems.empty()) return unexpected(BadList{file.problems.front().line, file.problems.front().message});
  if (file.behavior != "goto_list")
    return unexpected(BadList{1, "the behaviour is " + file.behavior + ", not goto_list"});
  for (const auto& arg : file.b_args)
    if (arg.name.starts_with("primary_") || arg.name == "args_from_file")
      return unexpected(BadList{arg.line, arg.name + " is not ours"});
  if (auto bad = not_ours(file)) return unexpected(std::move(*bad));
  model::WaypointList list;
  list.radius = Metres{value_of(file, "list_when_wpt_dist")};
  list.at_end = value_of(file, "num_legs_to_run") == -1 ? model::AtEnd::loop : model::AtEnd::wait;
  for (const auto& waypoint : file.waypoints) {
    model::Waypoint point;
    point.at = *waypoint.at;
    list.points.push_back(point);
  }
  return list;
}

}  // namespace glidehelm::protocol
