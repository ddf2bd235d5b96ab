#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "protocol/surface_block.hpp"

/// One reader per kind of dialog line (slocum.md 1.2). Each takes the text behind its label and answers with the value
/// and with how much of the text it understood, or with nothing when the line is not complete in every character that
/// matters. Numbers are `-?digits[.digits][e±digits]`, read without locale; nan, inf and overflow are no numbers.
namespace glidehelm::protocol {

template <class T>
struct Parsed {
  T value;
  std::size_t used{};  ///< characters of the text
};

/// Behind `GPS Location:` and its sisters. `label_size` is the length of the label, for the check of the line's layout
/// `"%-13s %9.3f N %9.3f E measured %10.6g secs ago"`.
std::optional<Parsed<Location>> parse_location(std::string_view rest, std::size_t label_size);

struct CurrTime {
  GliderTime time;
  std::int64_t mission_time_s{};
};
/// Behind `Curr Time:`: C's `ctime` and ` MT: %7d`, every field in its width. The day of the week must agree with the
/// date: a garbled digit seldom keeps that.
std::optional<Parsed<CurrTime>> parse_curr_time(std::string_view rest);

/// Behind `sensor:`. The age must end in column 57, or follow in a field of 13 (older
/// firmware: 11) when the head is longer than 45 characters. `indent` is how much of the line stands before the label.
std::optional<Parsed<SensorReading>> parse_sensor(std::string_view rest, std::size_t indent);

std::optional<Parsed<WaypointLine>> parse_waypoint(std::string_view rest);  ///< behind `Waypoint:`
std::optional<Parsed<BecauseLine>> parse_because(std::string_view rest);    ///< behind `Because:`
std::optional<Parsed<MissionLine>> parse_mission(std::string_view rest);    ///< behind `MissionName:`
std::optional<Parsed<DevicesLine>> parse_devices(std::string_view rest);    ///< behind `devices:(t/m/s)`

/// `N secs` behind `Time until diving is:`; whole seconds, 0 to 24 h.
std::optional<Parsed<double>> parse_until_diving(std::string_view rest);
/// ` 5 minutes` behind `Extending surface time by`: seconds, 1 min to 24 h.
std::optional<Parsed<double>> parse_extension(std::string_view rest);

/// `N -1 >` behind `GliderDos ` or `GliderLAB `.
struct Prompt {
  char state{};  ///< N normal, A after an abort, I initial
  int code{};    ///< of the abort, negative without one
};
std::optional<Parsed<Prompt>> parse_prompt(std::string_view rest);

/// A vehicle name in lower case: `[a-z0-9][a-z0-9_-]{0,31}` after folding; nothing for any other text.
std::optional<std::string> vehicle_name(std::string_view text);

}  // namespace glidehelm::protocol
