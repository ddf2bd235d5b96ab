#include "protocol/dialog_lines.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include "core/base/text.hpp"
#include "protocol/latlon.hpp"

namespace glidehelm::protocol {

namespace {

bool is_word(char c) { return is_letter(c) || is_digit(c) || c == '_'; }

/// A text with a place in it. Each `take` moves on and says true, or stays and says false.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_{text} {}

  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] bool ended() const { return at_ >= text_.size(); }
  [[nodiscard]] char peek() const { return ended() ? '\0' : text_[at_]; }

  std::size_t blanks() {
    const std::size_t from = at_;
    while (!ended() && text_[at_] == ' ') ++at_;
    return at_ - from;
  }
  bool take(std::string_view word) {
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }
  template <class Is>
  std::string_view while_is(Is&& is) {
    const std::size_t from = at_;
    while (!ended() && is(text_[at_])) ++at_;
    return text_.substr(from, at_ - from);
  }
  std::string_view until(char stop) {
    return while_is([stop](char c) { return c != stop; });
  }

  /// The longest `-?digits[.digits][e±digits]` from here; empty when there is none.
  std::string_view number() {
    const std::size_t from = at_;
    std::size_t i = at_;
    const auto digits = [&] {
      const std::size_t begin = i;
      while (i < text_.size() && is_digit(text_[i])) ++i;
      return i > begin;
    };
    if (i < text_.size() && text_[i] == '-') ++i;
    if (!digits()) return {};
    at_ = i;
    if (i < text_.size() && text_[i] == '.' && (++i, digits())) at_ = i;
    i = at_;
    if (i < text_.size() && (text_[i] == 'e' || text_[i] == 'E')) {
      ++i;
      if (i < text_.size() && (text_[i] == '+' || text_[i] == '-')) ++i;
      if (digits()) at_ = i;
    }
    return text_.substr(from, at_ - from);
  }
  /// A number with exactly so many decimals, as `%.Nf` prints it.
  bool fixed(std::string& text, std::size_t decimals) {
    const std::size_t from = at_;
    text = number();
    const auto point = text.find('.');
    if (point != std::string::npos && text.size() - point - 1 == decimals &&
        text.find_first_of("eE") == std::string::npos)
      return true;
    at_ = from;
    return false;
  }
  bool number(double& value) {
    const std::size_t from = at_;
    const auto text = number();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (!text.empty() && error == std::errc{} && end == text.data() + text.size() && std::isfinite(value)) return true;
    at_ = from;
    return false;
  }
  /// A whole number as `%*d` prints it: blanks up to the width, then the digits.
  bool field(int& value, std::size_t width) {
    const std::size_t from = at_;
    const std::size_t padding = blanks();
    if (whole(value) && padding == (at_ - from - padding < width ? width - (at_ - from - padding) : 0)) return true;
    at_ = from;
    return false;
  }
  /// Exactly `count` digits.
  bool digits(int& value, std::size_t count) {
    const std::size_t from = at_;
    if (whole(value) && at_ - from == count) return true;
    at_ = from;
    return false;
  }
  /// Exactly a whole number without sign of at most nine digits, unless `negative` allows one.
  bool whole(int& value, bool negative = false) {
    const std::size_t from = at_;
    const bool minus = negative && take("-");
    const auto text = while_is(is_digit);
    if (text.empty() || text.size() > 9) {
      at_ = from;
      return false;
    }
    value = 0;
    for (const char c : text) value = value * 10 + (c - '0');
    if (minus) value = -value;
    return true;
  }

 private:
  std::string_view text_;
  std::size_t at_{};
};

/// A printf field of at least `width`: blanks, then the number, in exactly the width that printf gives.
bool right_aligned(std::size_t blanks, std::size_t size, std::size_t width) {
  return blanks == (size < width ? width - size : 0);
}

template <class T>
std::optional<Parsed<T>> parsed(T value, const Cursor& c) {
  return Parsed<T>{std::move(value), c.at()};
}

constexpr std::array<std::string_view, 12> kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                   "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
constexpr std::array<std::string_view, 7> kDays{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};

}  // namespace

std::optional<Parsed<Location>> parse_location(std::string_view rest, std::size_t label_size) {
  constexpr std::size_t kLabelWidth = 13, kPositionWidth = 9, kAgeWidth = 10;
  Cursor c{rest};
  Location out;
  const auto coordinate = [&](std::string& text, char& letter, std::size_t extra) {
    const std::size_t blanks = c.blanks();
    text = c.while_is([](char x) { return is_digit(x) || x == '.' || x == '-'; });
    if (blanks < extra || !right_aligned(blanks - extra, text.size(), kPositionWidth)) return false;
    if (!is_dialog_coordinate(text) || !c.take(" ")) return false;
    letter = c.peek();
    return (letter >= 'A' && letter <= 'Z') && c.take(std::string_view{&letter, 1});
  };
  const std::size_t pad = label_size < kLabelWidth ? kLabelWidth - label_size : 0;
  if (!coordinate(out.lat_text, out.lat_letter, pad + 1) || !coordinate(out.lon_text, out.lon_letter, 1))
    return std::nullopt;
  if (!c.take(" measured ")) return std::nullopt;
  const std::size_t blanks = c.blanks();
  const std::size_t from = c.at();
  if (!c.number(out.age_s) || !right_aligned(blanks, c.at() - from, kAgeWidth)) return std::nullopt;
  // A lost line end leaves the next label, which begins with a capital, glued to a line that is whole all the same.
  if (!c.take(" secs ago") || is_digit(c.peek()) || (c.peek() >= 'a' && c.peek() <= 'z')) return std::nullopt;
  return parsed(std::move(out), c);
}

std::optional<Parsed<CurrTime>> parse_curr_time(std::string_view rest) {
  Cursor c{rest};
  if (!c.take(" ")) return std::nullopt;
  const auto day_name = c.while_is(is_letter);
  if (!c.take(" ")) return std::nullopt;
  const auto month_name = c.while_is(is_letter);
  const auto weekday = std::find(kDays.begin(), kDays.end(), day_name);
  const auto month = std::find(kMonths.begin(), kMonths.end(), month_name);
  if (weekday == kDays.end() || month == kMonths.end() || !c.take(" ")) return std::nullopt;
  int day{}, hour{}, minute{}, second{}, year{}, mission_time{};
  if (!c.field(day, 2) || !c.take(" ")) return std::nullopt;
  if (!c.digits(hour, 2) || !c.take(":") || !c.digits(minute, 2) || !c.take(":") || !c.digits(second, 2))
    return std::nullopt;
  if (!c.take(" ") || !c.digits(year, 4) || !c.take(" MT: ")) return std::nullopt;
  if (!c.field(mission_time, 7) || is_word(c.peek()) || c.peek() == '.') return std::nullopt;

  using namespace std::chrono;
  if (year < 1970 || year > 9999 || hour > 23 || minute > 59 || second > 60) return std::nullopt;
  const year_month_day date{std::chrono::year{year},
                            std::chrono::month{static_cast<unsigned>(month - kMonths.begin()) + 1U},
                            std::chrono::day{static_cast<unsigned>(day)}};
  if (!date.ok() || std::chrono::weekday{sys_days{date}}.c_encoding() != static_cast<unsigned>(weekday - kDays.begin()))
    return std::nullopt;
  const auto since_1970 = sys_days{date}.time_since_epoch() + hours{hour} + minutes{minute} + seconds{second};
  return parsed(CurrTime{GliderTime{duration_cast<seconds>(since_1970)}, mission_time}, c);
}

std::optional<Parsed<SensorReading>> parse_sensor(std::string_view rest, std::size_t indent) {
  constexpr std::size_t kLabel = 7, kAgeEnds = 57, kLongHead = 45, kIndent = 3;
  constexpr std::size_t kNewWidth = 13, kOldWidth = 11;  // of the age behind a long head, by firmware
  Cursor c{rest};
  SensorReading out;
  const auto name = c.while_is(is_word);
  if (name.empty() || !c.take("(")) return std::nullopt;
  const auto unit = c.while_is([](char x) { return x != ')' && x != '='; });
  if (!c.take(")=") || !c.number(out.value)) return std::nullopt;
  // The firmware counts its own three blanks; echo or a lost newline before them does not move the column.
  const std::size_t head = std::min(indent, kIndent) + kLabel + c.at();
  const std::size_t blanks = c.blanks();
  const std::size_t from = c.at();
  if (blanks == 0 && head <= kLongHead) return std::nullopt;
  if (!c.number(out.age_s)) return std::nullopt;
  const std::size_t size = c.at() - from;
  const bool aligned = head <= kLongHead
                           ? right_aligned(blanks, size, kAgeEnds - head)
                           : right_aligned(blanks, size, kNewWidth) || right_aligned(blanks, size, kOldWidth);
  if (!aligned) return std::nullopt;
  if (!c.take(" secs ago")) return std::nullopt;
  out.name = name;
  out.unit = unit;
  return parsed(std::move(out), c);
}

std::optional<Parsed<WaypointLine>> parse_waypoint(std::string_view rest) {
  Cursor c{rest};
  WaypointLine out;
  constexpr std::size_t kDecimals = 4;
  int range{}, bearing{}, hours{}, minutes{};
  if (!c.take(" (") || !c.fixed(out.lat_text, kDecimals) || !c.take(",") || !c.fixed(out.lon_text, kDecimals))
    return std::nullopt;
  if (!c.take(") Range: ") || !c.whole(range) || !c.take("m, Bearing: ")) return std::nullopt;
  if (!c.whole(bearing, true) || !c.take("deg, Age: ")) return std::nullopt;
  if (!c.whole(hours, true) || !c.take(":") || !c.whole(minutes, true) || !c.take("h:m")) return std::nullopt;
  out.range_m = range;
  out.bearing_deg = bearing;
  out.age_min = 60.0 * hours + minutes;
  return parsed(std::move(out), c);
}

std::optional<Parsed<BecauseLine>> parse_because(std::string_view rest) {
  constexpr std::string_view kBehavior = " [behavior ";
  BecauseLine out;
  const auto bracket = rest.find(kBehavior);
  if (bracket == std::string_view::npos || bracket == 0) return std::nullopt;
  out.text = trimmed(rest.substr(0, bracket));
  Cursor c{rest};
  c.take(rest.substr(0, bracket + kBehavior.size()));
  out.behavior = c.until(' ');
  if (out.behavior.empty() || !c.take(" start_when = ") || !c.number(out.start_when) || !c.take("]"))
    return std::nullopt;
  return parsed(std::move(out), c);
}

std::optional<Parsed<MissionLine>> parse_mission(std::string_view rest) {
  Cursor c{rest};
  MissionLine out;
  c.blanks();
  out.file = c.until(' ');
  if (out.file.empty() || !c.take(" MissionNum:")) return std::nullopt;
  out.number = c.until(' ');
  if (out.number.empty() || !c.take(" (")) return std::nullopt;
  const auto mission = c.while_is(is_digit);
  if (mission.size() < 4 || !c.take(".")) return std::nullopt;
  const auto segment = c.while_is(is_digit);
  if (segment.size() < 4 || !c.take(")")) return std::nullopt;
  out.segment = std::string{mission} + "." + std::string{segment};
  return parsed(std::move(out), c);
}

std::optional<Parsed<DevicesLine>> parse_devices(std::string_view rest) {
  Cursor c{rest};
  DevicesLine out;
  const auto three = [&](std::string_view label, std::array<int, 3>& counts) {
    c.blanks();
    if (!c.take(label)) return false;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      c.blanks();
      if (!c.whole(counts[i]) || (i + 1 < counts.size() && !c.take("/"))) return false;
    }
    return true;
  };
  if (!three("errs:", out.errors) || !three("warn:", out.warnings) || !three("odd:", out.oddities)) return std::nullopt;
  return parsed(std::move(out), c);
}

std::optional<Parsed<double>> parse_until_diving(std::string_view rest) {
  constexpr int kDay = 86'400;
  Cursor c{rest};
  int seconds{};
  c.blanks();
  if (!c.whole(seconds) || !c.take(" secs") || seconds > kDay) return std::nullopt;
  return parsed(static_cast<double>(seconds), c);
}

std::optional<Parsed<double>> parse_extension(std::string_view rest) {
  constexpr int kDay = 24 * 60;
  Cursor c{rest};
  int minutes{};
  if (!c.take(" ") || !c.whole(minutes) || !c.take(" minute") || minutes < 1 || minutes > kDay) return std::nullopt;
  return parsed(60.0 * minutes, c);
}

std::optional<Parsed<Prompt>> parse_prompt(std::string_view rest) {
  Cursor c{rest};
  Prompt out;
  out.state = c.peek();
  if (!(out.state >= 'A' && out.state <= 'Z') || !c.take(rest.substr(0, 1)) || !c.take(" ")) return std::nullopt;
  if (!c.whole(out.code, true) || !c.take(" >")) return std::nullopt;
  return parsed(out, c);
}

std::optional<std::string> vehicle_name(std::string_view text) {
  constexpr std::size_t kLongest = 32;
  auto name = lower(trimmed(text));
  if (name.empty() || name.size() > kLongest || name.front() == '_' || name.front() == '-') return std::nullopt;
  if (!std::all_of(name.begin(), name.end(), [](char c) { return is_word(c) || c == '-'; })) return std::nullopt;
  return name;
}

}  // namespace glidehelm::protocol
