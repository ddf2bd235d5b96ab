#include "protocol/goto_list.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "protocol/latlon.hpp"

namespace glidehelm::protocol {

namespace {

std::string plain(std::string_view text) {
  std::string result;
  for (const char c : text.substr(0, 60)) {
    const bool letter = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    result += letter || c == ' ' || c == ':' || c == '.' || c == '_' || c == '-' ? c : '_';
  }
  return result;
}

std::string arg(const char* name, const std::string& value) {
  return std::string{"b_arg: "} + name + " " + value + "\n";
}

}  // namespace

std::string goto_list_name(int slot) {
  char name[32];
  std::snprintf(name, sizeof name, "goto_l%02d.ma", slot);
  return name;
}

std::string write_goto_list(const model::WaypointList& list, const GotoListComment& comment) {
  const bool loops = list.at_end == model::AtEnd::loop;
  char radius[40];
  std::snprintf(radius, sizeof radius, "%.0f", std::ceil(list.radius.si()));
  std::string text = "behavior_name=goto_list\n";
  text += "# Written by Glidehelm on UTC: " + utc_text(comment.stamp) + "\n";
  text += "# plan " + plain(comment.plan_id) + " method " + plain(comment.method) + "\n";
  text += "<start:b_arg>\n";
  text += arg("num_legs_to_run(nodim)", loops ? "-1" : "-2");
  text += arg("start_when(enum)", "0");
  text += arg("list_stop_when(enum)", "7");
  text += arg("list_when_wpt_dist(m)", radius);
  text += arg("initial_wpt(enum)", "0");
  text += arg("num_waypoints(nodim)", std::to_string(list.points.size()));
  text += arg("end_action(enum)", loops ? "0" : "6");
  text += "<end:b_arg>\n<start:waypoints>\n";
  for (const auto& point : list.points)
    text += ddmm_text(point.at.lon.degrees()) + " " + ddmm_text(point.at.lat.degrees()) + "\n";
  return text + "<end:waypoints>\n";
}

namespace {

/// Walks through lines that must be there.
class Lines {
 public:
  explicit Lines(std::string_view bytes) : rest_{bytes} {}
  bool next(std::string_view& line) {
    const auto end = rest_.find('\n');
    if (end == std::string_view::npos) return false;
    line = rest_.substr(0, end);
    rest_ = rest_.substr(end + 1);
    ++number_;
    return true;
  }
  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool done() const { return rest_.empty(); }

 private:
  std::string_view rest_;
  int number_{};
};

}  // namespace

Expected<model::WaypointList, BadList> read_goto_list(std::string_view bytes) {
  Lines lines{bytes};
  std::string_view line;
  const auto bad = [&](const std::string& what) { return unexpected(BadList{lines.number(), what}); };
  const auto expect = [&](std::string_view wanted) { return lines.next(line) && line == wanted; };
  if (!expect("behavior_name=goto_list")) return bad("the first line is not behavior_name=goto_list");
  for (int i = 0; i < 2; ++i)
    if (!lines.next(line) || line.empty() || line.front() != '#') return bad("the comment header is missing");
  if (!expect("<start:b_arg>")) return bad("<start:b_arg> is missing");
  constexpr std::array<std::string_view, 7> kNames{
      "num_legs_to_run(nodim)", "start_when(enum)",     "list_stop_when(enum)", "list_when_wpt_dist(m)",
      "initial_wpt(enum)",      "num_waypoints(nodim)", "end_action(enum)"};
  std::array<double, 7> values{};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const std::string start = "b_arg: " + std::string{kNames[i]} + " ";
    if (!lines.next(line) || line.substr(0, start.size()) != start) return bad(std::string{kNames[i]} + " is missing");
    const auto value = number_from(line.substr(start.size()));
    if (!value) return bad(std::string{kNames[i]} + " has no number");
    values[i] = *value;
  }
  model::WaypointList list;
  if (values[0] == -1 && values[6] == 0)
    list.at_end = model::AtEnd::loop;
  else if (values[0] == -2 && values[6] == 6)
    list.at_end = model::AtEnd::wait;
  else
    return bad("num_legs_to_run and end_action do not go together");
  if (values[1] != 0 || values[2] != 7 || values[4] != 0)
    return bad("start_when, list_stop_when or initial_wpt is not ours");
  if (!(values[3] >= 10)) return bad("list_when_wpt_dist is below 10 m");
  list.radius = Metres{values[3]};
  if (!expect("<end:b_arg>") || !expect("<start:waypoints>")) return bad("<end:b_arg> or <start:waypoints> is missing");
  while (lines.next(line) && line != "<end:waypoints>") {
    const auto blank = line.find(' ');
    if (blank == std::string_view::npos) return bad("a waypoint is not two numbers");
    const auto point = point_from_ddmm(line.substr(blank + 1), line.substr(0, blank));
    if (!point) return bad(point.error().message);
    list.points.push_back({*point, model::WaypointRole::aim});
  }
  if (line != "<end:waypoints>" || !lines.done()) return bad("<end:waypoints> is not the last line");
  if (static_cast<double>(list.points.size()) != values[5]) return bad("num_waypoints differs from the list");
  return list;
}

}  // namespace glidehelm::protocol
