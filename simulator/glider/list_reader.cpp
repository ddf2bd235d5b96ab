#include "simulator/glider/list_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <set>

#include "core/base/text.hpp"

namespace glidehelm::simulator {
namespace {

constexpr std::size_t kMostWaypoints = 8;

/// Of the BAW_ enum (slocum.md 2.6), what a goto list may name.
struct When {
  int value;
  std::string_view name;
};
constexpr std::array<When, 9> kWhen{When{0, "IMMEDIATELY"},
                                    {1, "STK_IDLE"},
                                    {2, "PITCH_IDLE"},
                                    {4, "UPDWN_IDLE"},
                                    {5, "NEVER"},
                                    {7, "WHEN_WPT_DIST"},
                                    {15, "WHEN_WPT_EXCEEDS_DIST"},
                                    {17, "PRIMARY_WPT within"},
                                    {18, "PRIMARY_WPT exceeds"}};

std::optional<BehaviourError> none() { return std::nullopt; }

/// The next word of `text` (up to a blank or tab), cut off its front.
std::string_view cut_word(std::string_view& text) {
  text = trimmed(text);
  const auto end = text.find_first_of(" \t");
  const auto word = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view{} : trimmed(text.substr(end));
  return word;
}

/// DDDMM.mmmm with the sign on the number → degrees; nothing when the minutes reach 60 or the limit is passed.
std::optional<double> degrees_from(double ddmm, double limit) {
  const double size = std::fabs(ddmm);
  const double whole = std::floor(size / 100.0);
  const double minutes = size - 100.0 * whole;
  const double deg = whole + minutes / 60.0;
  if (minutes >= 60.0 || deg > limit) return std::nullopt;
  return std::signbit(ddmm) ? -deg : deg;
}

class ListReader {
 public:
  Expected<GotoList, BehaviourError> read(std::string_view bytes) {
    while (!bytes.empty()) {
      ++line_;
      const auto end = bytes.find('\n');
      auto text = bytes.substr(0, end);
      line_begin_ = text.data();
      bytes = end == std::string_view::npos ? std::string_view{} : bytes.substr(end + 1);
      text = trimmed(text.substr(0, text.find('#')));
      if (text.empty()) continue;
      where_in_line_ = text;
      if (auto error = take(text)) return unexpected(std::move(*error));
    }
    line_begin_ = nullptr;
    if (auto error = at_end()) return unexpected(std::move(*error));
    return list_;
  }

 private:
  enum class Where { before_name, between, bargs, waypoints };

  /// At the word that was looked at last.
  std::optional<BehaviourError> fail(std::string reason) const {
    const int column = line_begin_ == nullptr ? 0 : static_cast<int>(where_in_line_.data() - line_begin_) + 1;
    return BehaviourError{line_, column, std::move(reason)};
  }

  std::optional<BehaviourError> take(std::string_view text) {
    switch (where_) {
      case Where::before_name:
        return name(text);
      case Where::between:
        return open(text);
      case Where::bargs:
        if (text != "<end:b_arg>") return b_arg(text);
        break;
      case Where::waypoints:
        if (text != "<end:waypoints>") return waypoint(text);
        break;
    }
    where_ = Where::between;
    return none();
  }

  std::optional<BehaviourError> name(std::string_view text) {
    const auto equals = text.find('=');
    if (equals == std::string_view::npos || trimmed(text.substr(0, equals)) != "behavior_name")
      return fail("behavior_name= expected first");
    if (!equal_without_case(trimmed(text.substr(equals + 1)), "goto_list"))
      return fail("behavior_name is not goto_list");
    where_ = Where::between;
    return none();
  }

  std::optional<BehaviourError> open(std::string_view text) {
    if (text == "<start:b_arg>") {
      where_ = Where::bargs;
    } else if (text == "<start:waypoints>" && !listed_) {
      where_ = Where::waypoints;
      listed_ = true;
    } else {
      return fail("unexpected text: " + std::string{text});
    }
    return none();
  }

  std::optional<BehaviourError> b_arg(std::string_view text) {
    if (text.substr(0, 6) != "b_arg:") return fail("b_arg: expected, found " + std::string{text});
    text = trimmed(text.substr(6));
    const auto open = text.find('('), close = text.find(')');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open)
      return fail("b_arg without (unit): " + std::string{text});
    where_in_line_ = trimmed(text.substr(0, open));
    const std::string name{where_in_line_};
    auto rest = text.substr(close + 1);
    const auto word = cut_word(rest);
    const auto value = number_from(word);
    if (!value || !rest.empty()) return fail("b_arg " + name + " has no number");
    if (!seen_.insert(name).second) return fail("b_arg " + name + " is given twice");
    if (!is_known(name)) return fail("unknown b_arg " + name);
    where_in_line_ = word;
    return assign(name, *value);
  }

  std::optional<BehaviourError> whole(const std::string& name, double value, int low, int high, int& into) const {
    if (value != std::floor(value) || value < low || value > high) {
      return fail("b_arg " + name + " is outside " + std::to_string(low) + " … " + std::to_string(high));
    }
    into = static_cast<int>(value);
    return none();
  }

  std::optional<BehaviourError> one_of(const std::string& name, double value, std::initializer_list<int> allowed,
                                       int& into) const {
    for (const int each : allowed)
      if (value == each) {
        into = each;
        return none();
      }
    std::string all;
    for (const int each : allowed) all += (all.empty() ? "" : ", ") + std::to_string(each);
    return fail("b_arg " + name + " is none of " + all);
  }

  static bool is_known(std::string_view name) {
    static constexpr std::array<std::string_view, 10> kKnown{
        "num_legs_to_run", "start_when", "list_stop_when", "list_when_wpt_dist", "initial_wpt",
        "num_waypoints",   "end_action", "primary_wpt",    "primary_stop_when",  "primary_when_wpt_dist"};
    return std::find(kKnown.begin(), kKnown.end(), name) != kKnown.end();
  }

  /// Of what the masterdata allow, what is flown here; the rest is refused by its name.
  std::optional<BehaviourError> simulated(const std::string& name, int value, std::initializer_list<int> flown) const {
    if (std::find(flown.begin(), flown.end(), value) != flown.end()) return none();
    const auto called = std::find_if(kWhen.begin(), kWhen.end(), [&](const auto& w) { return w.value == value; });
    return fail(name + " " + std::to_string(value) +
                (called == kWhen.end() ? "" : " (" + std::string{called->name} + ")") + " is not simulated");
  }

  std::optional<BehaviourError> assign(const std::string& name, double value) {
    if (name == "num_legs_to_run") {
      if (value == 0) return fail("b_arg num_legs_to_run is 0");
      return whole(name, value, -2, 1'000'000, list_.legs);
    }
    if (name == "initial_wpt") return whole(name, value, -2, 7, list_.initial);
    if (name == "num_waypoints") return whole(name, value, 1, static_cast<int>(kMostWaypoints), list_.declared);
    if (name == "end_action") {
      if (value != 0 && value != 6) return fail("b_arg end_action is neither 0 nor 6");
      list_.end_action = static_cast<int>(value);
      return none();
    }
    if (name == "list_when_wpt_dist") {
      if (value < 10) return fail("b_arg list_when_wpt_dist is below 10");
      list_.radius = Metres{value};
      return none();
    }
    return assign_when(name, value);
  }

  std::optional<BehaviourError> assign_when(const std::string& name, double value) {
    int word = 0;
    std::optional<BehaviourError> error;
    if (name == "start_when") {
      error = one_of(name, value, {0, 1, 2, 4}, word);
      return error ? error : simulated(name, word, {0});
    }
    if (name == "list_stop_when") {
      error = one_of(name, value, {1, 2, 5, 7, 15}, list_.stop_when);
      return error ? error : simulated(name, list_.stop_when, {5, 7, 15});
    }
    if (name == "primary_wpt") {
      error = whole(name, value, -2, 8, word);
      return error || word == 0 ? error : fail("primary_wpt " + std::to_string(word) + " is not simulated");
    }
    if (name == "primary_stop_when") {
      error = one_of(name, value, {1, 2, 5, 7, 15, 17, 18}, word);
      return error ? error : simulated(name, word, {15});
    }
    if (value < 10) return fail("b_arg primary_when_wpt_dist is below 10");
    return none();  // of a station that there is not: primary_wpt is 0
  }

  std::optional<BehaviourError> waypoint(std::string_view text) {
    const auto lon = number_from(cut_word(text));
    const auto lat = number_from(cut_word(text));
    if (lon && lat && !text.empty()) where_in_line_ = text;
    if (!lon || !lat) return fail("a waypoint is two numbers, longitude first");
    if (!text.empty()) return fail("text after a waypoint: " + std::string{text});
    const auto lon_deg = degrees_from(*lon, 180.0), lat_deg = degrees_from(*lat, 90.0);
    if (!lon_deg || !lat_deg) return fail("not a position in DDDMM.mmmm, longitude first");
    if (list_.waypoints.size() == kMostWaypoints) return fail("more than 8 waypoints");
    list_.waypoints.push_back(GeoPoint::from_degrees(*lat_deg, *lon_deg).value());
    return none();
  }

  std::optional<BehaviourError> at_end() const {
    if (where_ == Where::before_name) return fail("empty file");
    if (where_ != Where::between) return fail("the file ends inside a section");
    if (list_.waypoints.empty()) return fail("no waypoint");
    if (list_.initial >= static_cast<int>(list_.waypoints.size())) return fail("initial_wpt is beyond the list");
    return none();
  }

  GotoList list_;
  std::set<std::string> seen_;
  Where where_{Where::before_name};
  bool listed_{};
  int line_{};
  const char* line_begin_{};  ///< null behind the last line
  std::string_view where_in_line_;
};

}  // namespace

Expected<GotoList, BehaviourError> read_goto_list(std::string_view bytes) { return ListReader{}.read(bytes); }

}  // namespace glidehelm::simulator
