#include "core/safety/list_reader.hpp"

#include <array>
#include <cstdlib>

#include "core/base/text.hpp"

namespace glidehelm::safety {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_comment_character(char c) {
  return is_digit(c) || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == ' ' || c == ':' || c == '.' ||
         c == '_' || c == '-';
}

/// The b_args that a list of ours writes out, in no fixed order.
struct Argument {
  std::string_view name, unit;
  std::optional<double> value;
};
enum ArgumentIndex { kLegs, kStartWhen, kStopWhen, kRadius, kInitial, kCount, kEndAction };

/// One line with a cursor: what the messages point at.
struct Line {
  std::string_view text;
  int number{};
  std::size_t at{};

  void skip_blanks() {
    while (at < text.size() && is_blank(text[at])) ++at;
  }
  [[nodiscard]] bool ended() const { return at >= text.size(); }
  bool take(std::string_view word) {
    if (text.substr(at, word.size()) != word) return false;
    at += word.size();
    return true;
  }
  /// The characters up to a blank, a comment or one of `stops`.
  std::string_view word(std::string_view stops) {
    const std::size_t from = at;
    while (!ended() && !is_blank(text[at]) && text[at] != '#' && stops.find(text[at]) == std::string_view::npos) ++at;
    return text.substr(from, at - from);
  }
  [[nodiscard]] Unexpected<ListProblem> wrong(std::string message) const {
    return unexpected(ListProblem{number, static_cast<int>(at) + 1, std::move(message)});
  }
};

/// A decimal number without sign '+', exponent or bare point: what our writer prints.
std::optional<double> plain_number(std::string_view text) {
  std::string_view digits = text;
  if (!digits.empty() && digits.front() == '-') digits.remove_prefix(1);
  if (digits.empty() || !is_digit(digits.front()) || !is_digit(digits.back()) || digits.size() > 12)
    return std::nullopt;
  int points = 0;
  for (const char c : digits) {
    if (c == '.')
      ++points;
    else if (!is_digit(c))
      return std::nullopt;
  }
  if (points > 1) return std::nullopt;
  return number_from(text);
}

/// [-]DDMM.mmmm in units of 1e-4 minute; the reason when it is not one. `degrees` is the largest allowed.
Expected<std::int64_t, std::string> ddmm(std::string_view text, int degrees_at_most) {
  const bool negative = !text.empty() && text.front() == '-';
  if (negative) text.remove_prefix(1);
  const auto point = text.find('.');
  if (point == std::string_view::npos || point < 1 || point > 5 || text.size() != point + 5)
    return unexpected(std::string{"is not [-]DDMM.mmmm with four decimals"});
  std::int64_t value = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (i == point) continue;
    if (!is_digit(text[i])) return unexpected(std::string{"is not [-]DDMM.mmmm with four decimals"});
    value = value * 10 + (text[i] - '0');
  }
  const std::int64_t whole_degrees = value / 1'000'000, minute_units = value % 1'000'000;
  if (minute_units >= 600'000) return unexpected(std::string{"has 60 minutes or more"});
  const std::int64_t units = whole_degrees * 600'000 + minute_units;
  if (units > degrees_at_most * std::int64_t{600'000})
    return unexpected("is beyond " + std::to_string(degrees_at_most) + " degrees");
  return negative ? -units : units;
}

class Reader {
 public:
  Reader(std::string_view bytes, int max_waypoints) : bytes_{bytes}, max_waypoints_{max_waypoints} {}

  Expected<GotoFile, ListProblem> read() {
    if (auto problem = check_bytes()) return unexpected(*problem);
    while (!bytes_.empty()) {
      const auto end = bytes_.find('\n');
      Line line{bytes_.substr(0, end), ++number_};
      bytes_.remove_prefix(end + 1);
      const auto taken = take(line);
      if (!taken) return unexpected(taken.error());
    }
    if (section_ != Section::done) return whole("the file ends before <end:waypoints>: it is cut");
    return finished();
  }

 private:
  enum class Section { name, header, arguments, between, points, done };

  static Unexpected<ListProblem> whole(std::string message) {
    return unexpected(ListProblem{0, 0, std::move(message)});
  }

  [[nodiscard]] std::optional<ListProblem> check_bytes() const {
    if (bytes_.size() > kLargestFile)
      return ListProblem{0, 0, std::to_string(bytes_.size()) + " bytes, allowed are " + std::to_string(kLargestFile)};
    if (bytes_.empty() || bytes_.back() != '\n') return ListProblem{0, 0, "the last line has no end: the file is cut"};
    int line = 1, column = 0;
    for (const char c : bytes_) {
      ++column;
      if (c == '\n') {
        ++line;
        column = 0;
      } else if ((c < ' ' && c != '\t') || c > '~') {
        return ListProblem{line, column,
                           "character code " + std::to_string(static_cast<unsigned char>(c)) +
                               " is not allowed: printable ASCII, tab and LF only"};
      } else if (column > static_cast<int>(kLongestLine)) {
        return ListProblem{line, column, "the line is longer than " + std::to_string(kLongestLine) + " characters"};
      }
    }
    return std::nullopt;
  }

  Expected<Done, ListProblem> take(Line& line) {
    if (section_ == Section::name) {
      if (line.text != "behavior_name=goto_list") return line.wrong("the first line must be behavior_name=goto_list");
      section_ = Section::header;
      return Done{};
    }
    if (section_ == Section::done) return line.wrong("nothing may follow <end:waypoints>");
    line.skip_blanks();
    if (line.ended() || line.text[line.at] == '#') return rest_is_comment(line);
    switch (section_) {
      case Section::header:
        return tag(line, "<start:b_arg>", Section::arguments);
      case Section::arguments:
        if (line.text[line.at] == '<') return tag(line, "<end:b_arg>", Section::between);
        return argument(line);
      case Section::between:
        return tag(line, "<start:waypoints>", Section::points);
      default:
        if (line.text[line.at] == '<') return tag(line, "<end:waypoints>", Section::done);
        return waypoint(line);
    }
  }

  Expected<Done, ListProblem> tag(Line& line, std::string_view expected, Section next) {
    if (line.text != expected) return line.wrong("expected " + std::string{expected} + " alone on its line");
    section_ = next;
    return Done{};
  }

  static Expected<Done, ListProblem> rest_is_comment(Line& line) {
    line.skip_blanks();
    if (line.ended()) return Done{};
    if (!line.take("#")) return line.wrong("expected the end of the line or a comment");
    for (; !line.ended(); ++line.at)
      if (!is_comment_character(line.text[line.at]))
        return line.wrong("a comment may hold letters, digits, blanks and : . _ - only");
    return Done{};
  }

  Expected<Done, ListProblem> argument(Line& line) {
    if (!line.take("b_arg:")) return line.wrong("expected b_arg: NAME(UNIT) VALUE");
    line.skip_blanks();
    Line start = line;
    const auto name = line.word("(");
    Argument* found = nullptr;
    for (auto& candidate : arguments_)
      if (candidate.name == name) found = &candidate;
    if (found == nullptr) return start.wrong("unknown b_arg '" + std::string{name} + "'");
    if (found->value) return start.wrong("b_arg " + std::string{name} + " is given twice");
    if (!line.take("(" + std::string{found->unit} + ")"))
      return line.wrong("the unit of " + std::string{name} + " must be (" + std::string{found->unit} + ")");
    line.skip_blanks();
    start = line;
    const auto text = line.word("");
    found->value = plain_number(text);
    if (!found->value) return start.wrong("'" + std::string{text} + "' is not a plain decimal number");
    const auto allowed = check_value(*found);
    if (!allowed.empty())
      return start.wrong(std::string{name} + " is " + std::string{text} + ", allowed is " + allowed);
    return rest_is_comment(line);
  }

  /// What would be allowed, when the value is not.
  [[nodiscard]] std::string check_value(const Argument& a) const {
    const double v = *a.value;
    if (&a == &arguments_[kLegs]) return v == -1 || v == -2 ? "" : "-1, or -2 with end_action 6";
    if (&a == &arguments_[kStartWhen]) return v == 0 ? "" : "0";
    if (&a == &arguments_[kStopWhen]) return v == 7 ? "" : "7";
    if (&a == &arguments_[kRadius]) return v >= 10 && v <= 100'000 ? "" : "10 to 100000";
    if (&a == &arguments_[kInitial]) return v == 0 ? "" : "0";
    if (&a == &arguments_[kCount])
      return v >= 1 && v <= max_waypoints_ && v == static_cast<int>(v) ? "" : "1 to " + std::to_string(max_waypoints_);
    return v == 0 || v == 6 ? "" : "0 or 6";
  }

  Expected<Done, ListProblem> waypoint(Line& line) {
    FilePoint point;
    point.line = line.number;
    const Line start = line;
    for (const bool longitude : {true, false}) {
      line.skip_blanks();
      const Line here = line;
      const auto text = line.word("");
      const auto units = ddmm(text, longitude ? 180 : 90);
      if (!units)
        return here.wrong(std::string{longitude ? "longitude '" : "latitude '"} + std::string{text} + "' " +
                          units.error());
      (longitude ? point.lon_units : point.lat_units) = *units;
    }
    if (point.lat_units == 0 && point.lon_units == 0) return start.wrong("0/0 is no waypoint");
    const auto at = GeoPoint::from_degrees(static_cast<double>(point.lat_units) / kUnitsPerDegree,
                                           static_cast<double>(point.lon_units) / kUnitsPerDegree);
    if (!at) return start.wrong(at.error().message());
    point.at = *at;
    if (static_cast<int>(file_.points.size()) == max_waypoints_)
      return start.wrong("more than " + std::to_string(max_waypoints_) + " waypoints");
    file_.points.push_back(point);
    return rest_is_comment(line);
  }

  Expected<GotoFile, ListProblem> finished() {
    for (const auto& a : arguments_)
      if (!a.value && &a != &arguments_[kEndAction])
        return whole("b_arg " + std::string{a.name} + " is missing: the glider would take its own default");
    const auto listed = static_cast<double>(file_.points.size());
    if (*arguments_[kCount].value != listed)
      return whole("num_waypoints is " + std::to_string(static_cast<int>(*arguments_[kCount].value)) + " but " +
                   std::to_string(file_.points.size()) + " are listed");
    const bool once = *arguments_[kLegs].value == -2;
    if (once && arguments_[kEndAction].value != 6.0)
      return whole("num_legs_to_run -2 without end_action 6 ends the mission after the last waypoint");
    file_.at_end = once ? model::AtEnd::wait : model::AtEnd::loop;
    file_.radius = Metres{*arguments_[kRadius].value};
    return file_;
  }

  std::string_view bytes_;
  int max_waypoints_;
  int number_{};
  Section section_{Section::name};
  GotoFile file_;
  std::array<Argument, 7> arguments_{{{"num_legs_to_run", "nodim", {}},
                                      {"start_when", "enum", {}},
                                      {"list_stop_when", "enum", {}},
                                      {"list_when_wpt_dist", "m", {}},
                                      {"initial_wpt", "enum", {}},
                                      {"num_waypoints", "nodim", {}},
                                      {"end_action", "enum", {}}}};
};

}  // namespace

std::string ListProblem::text() const {
  if (line == 0) return message;
  return "line " + std::to_string(line) + ", column " + std::to_string(column) + ": " + message;
}

Expected<GotoFile, ListProblem> read_list(std::string_view bytes, int max_waypoints) {
  return Reader{bytes, max_waypoints}.read();
}

std::string list_name(int slot) {
  if (slot < 0 || slot > 99) return {};
  std::string name = "goto_l00.ma";
  name[6] = static_cast<char>('0' + slot / 10);
  name[7] = static_cast<char>('0' + slot % 10);
  return name;
}

}  // namespace glidehelm::safety
