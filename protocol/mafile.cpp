#include "protocol/mafile.hpp"

#include <algorithm>
#include <utility>

#include "core/base/text.hpp"
#include "protocol/latlon.hpp"
#include "protocol/mafile_b_args.hpp"
#include "protocol/mafile_lexer.hpp"
#include "protocol/mafile_rules.hpp"

namespace glidehelm::protocol {

namespace {

/// Text of the file for a message.
std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 40;
  return "'" + std::string{text.substr(0, kMost)} + (text.size() > kMost ? "...'" : "'");
}

class Reader {
 public:
  explicit Reader(const MafileOptions& options) : options_{options}, problems_{options.mode} {}

  Mafile read(std::string_view bytes) {
    if (bytes.size() > kLargestMafile) {
      problems_.add(0, 0, "size", Weight::fault,
                    std::to_string(bytes.size()) + " bytes, read are at most " + std::to_string(kLargestMafile));
      bytes = bytes.substr(0, kLargestMafile);
    }
    int number = 0;
    bool newline = true;
    while (!bytes.empty()) {
      const auto end = bytes.find('\n');
      newline = end != std::string_view::npos;
      take(bytes.substr(0, end), ++number);
      bytes.remove_prefix(newline ? end + 1 : bytes.size());
    }
    if (!newline) problems_.add(number, 1, "line-ends", Weight::note, "the last line has no end");
    finish(number);
    file_.problems = problems_.take();
    return std::move(file_);
  }

 private:
  enum class Section { none, b_args, waypoints };

  void take(std::string_view text, int number) {
    if (text.size() > kLongestMafileLine) {
      problems_.add(number, 1, "size", Weight::fault,
                    "the line has " + std::to_string(text.size()) + " bytes, read are at most " +
                        std::to_string(kLongestMafileLine));
      return;
    }
    check_bytes(text, number);
    const auto line = lex_mafile_line(text, number);
    if (line.crlf && !std::exchange(crlf_said_, true))
      problems_.add(number, static_cast<int>(text.size()), "line-ends", Weight::note,
                    "lines end with CR LF, ours with LF");
    if (line.kind == MafileLine::Kind::blank) return;
    if (!std::exchange(begun_, true) && line.kind != MafileLine::Kind::behavior_name)
      problems_.add(number, 1, "behavior-name", Weight::fault, "the file does not begin with behavior_name=WORD");
    switch (line.kind) {
      case MafileLine::Kind::behavior_name:
        return behavior(line);
      case MafileLine::Kind::tag:
        return tag(line);
      case MafileLine::Kind::b_arg:
        return b_arg(line);
      case MafileLine::Kind::bad_b_arg:
        problems_.add(number, line.name.column, "b-arg-form", Weight::fault, "expected is b_arg: NAME(UNIT) NUMBER");
        return;
      default:
        return words(line);
    }
  }

  /// Bytes beyond ASCII occur in comments only; the glider's DOS does not know what they mean.
  void check_bytes(std::string_view text, int number) {
    const auto comment = std::min(text.find('#'), text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
      const auto c = static_cast<unsigned char>(text[i]);
      if ((c >= 0x20 && c < 0x7f) || c == '\t' || c == '\r') continue;
      problems_.add(number, static_cast<int>(i) + 1, "encoding", i > comment ? Weight::doubt : Weight::fault,
                    "byte " + std::to_string(c) + " is not printable ASCII");
      return;
    }
  }

  void behavior(const MafileLine& line) {
    if (!file_.behavior.empty()) {
      problems_.add(line.number, line.name.column, "behavior-name", Weight::fault, "behavior_name is given twice");
      return;
    }
    if (line.name.text.empty()) {
      problems_.add(line.number, line.name.column, "behavior-name", Weight::fault, "behavior_name= without a name");
      return;
    }
    file_.behavior = lower(line.name.text);
    if (!is_mafile_behavior(file_.behavior))
      problems_.add(line.number, line.name.column, "unknown-behavior", Weight::doubt,
                    "no behaviour " + quoted(line.name.text) + " is known to read a mafile");
    if (line.name.text != file_.behavior)
      problems_.add(line.number, line.name.column, "behavior-name", Weight::note, "the name is not in lower case");
    no_more(line, 0);
  }

  void tag(const MafileLine& line) {
    const auto wrong = [&](const std::string& message) {
      problems_.add(line.number, line.name.column, "section", Weight::fault, message);
    };
    const auto opens = [&](Section section, bool& seen) {
      if (section_ != Section::none) wrong(quoted(line.name.text) + " inside another section");
      if (std::exchange(seen, true)) wrong(quoted(line.name.text) + " a second time");
      section_ = section;
    };
    const auto closes = [&](Section section) {
      if (section_ != section) wrong(quoted(line.name.text) + " without its beginning");
      section_ = Section::none;
    };
    const auto name = line.name.text;
    if (name == "<start:b_arg>")
      opens(Section::b_args, b_args_seen_);
    else if (name == "<end:b_arg>")
      closes(Section::b_args);
    else if (name == "<start:waypoints>")
      opens(Section::waypoints, waypoints_seen_);
    else if (name == "<end:waypoints>")
      closes(Section::waypoints);
    else
      wrong("unknown tag " + quoted(name));
    no_more(line, 0);
  }

  /// Nothing but a comment may follow the first `from` words.
  void no_more(const MafileLine& line, std::size_t from) {
    if (line.words.size() > from)
      problems_.add(line.number, line.words[from].column, "text-after-value", Weight::doubt,
                    quoted(line.words[from].text) + " without a # before it");
  }

  void b_arg(const MafileLine& line) {
    if (section_ != Section::b_args)
      problems_.add(line.number, line.name.column, "section", Weight::fault,
                    "b_arg outside <start:b_arg> ... <end:b_arg>");
    BArg arg;
    arg.name = line.name.text;
    arg.unit = line.unit.text;
    arg.line = line.number;
    arg.column = line.words.empty() ? line.unit.column : line.words.front().column;
    if (!line.words.empty()) {
      arg.text = line.words.front().text;
      arg.value = number_from(arg.text);
    }
    if (!arg.value)
      problems_.add(arg.line, arg.column, "bad-number", Weight::fault,
                    arg.name + (arg.text.empty() ? " has no value" : " has no number but " + quoted(arg.text)));
    if (line.words.size() > 1 && number_from(line.words[1].text))
      problems_.add(line.number, line.words[1].column, "bad-number", Weight::fault,
                    arg.name + " has a second number " + quoted(line.words[1].text));
    else
      no_more(line, 1);
    file_.b_args.push_back(std::move(arg));
  }

  void words(const MafileLine& line) {
    if (section_ != Section::waypoints) {
      problems_.add(line.number, line.words.front().column, "stray-text", Weight::fault,
                    quoted(line.words.front().text) + " is neither tag nor b_arg nor comment");
      return;
    }
    MafileWaypoint waypoint;
    waypoint.line = line.number;
    waypoint.column = line.words.front().column;
    waypoint.lon_text = line.words.front().text;
    if (line.words.size() < 2 || !number_from(line.words[1].text)) {
      problems_.add(line.number, waypoint.column, "coordinate", Weight::fault,
                    "a waypoint is two numbers, longitude and latitude; found is " + quoted(line.words.front().text));
      return;
    }
    waypoint.lat_text = line.words[1].text;
    position(line, waypoint);
    if (line.words.size() > 2 && number_from(line.words[2].text))
      problems_.add(line.number, line.words[2].column, "third-number", Weight::fault,
                    "a third number " + quoted(line.words[2].text) + " behind longitude and latitude");
    else
      no_more(line, 2);
    file_.waypoints.push_back(std::move(waypoint));
  }

  void position(const MafileLine& line, MafileWaypoint& waypoint) {
    const auto lon = longitude_from_ddmm(waypoint.lon_text);
    const auto lat = latitude_from_ddmm(waypoint.lat_text);
    const auto bad = [&](const NoCoordinate& why, int column) {
      auto shown = why;
      shown.found = shown.found.substr(0, 40);
      problems_.add(line.number, column, "coordinate", Weight::fault, shown.message());
    };
    if (!lon) bad(lon.error(), line.words[0].column);
    if (!lat) bad(lat.error(), line.words[1].column);
    if (!lon || !lat) return;
    if (lon->radians() == 0 && lat->radians() == 0)
      problems_.add(line.number, waypoint.column, "null-position", Weight::fault, "0/0 is no waypoint");
    waypoint.at = GeoPoint{*lat, *lon};
  }

  void finish(int last) {
    if (!begun_) problems_.add(0, 0, "behavior-name", Weight::fault, "the file says nothing");
    if (section_ != Section::none)
      problems_.add(last, 1, "section", Weight::fault,
                    std::string{section_ == Section::b_args ? "<end:b_arg>" : "<end:waypoints>"} +
                        " is missing: the file may be cut");
    if (begun_ && !b_args_seen_) problems_.add(0, 0, "section", Weight::fault, "there is no <start:b_arg>");
    check_mafile(file_, options_, problems_);
  }

  const MafileOptions& options_;
  ProblemList problems_;
  Mafile file_;
  Section section_{Section::none};
  bool begun_{}, crlf_said_{}, b_args_seen_{}, waypoints_seen_{};
};

}  // namespace

std::string MafileProblem::text() const {
  std::string out;
  if (line > 0) out = "line " + std::to_string(line) + ", column " + std::to_string(column) + ": ";
  return out + (severity == Severity::error ? "error: " : "warning: ") + message + " [" + code + "]";
}

bool Mafile::valid() const {
  return std::none_of(problems.begin(), problems.end(),
                      [](const MafileProblem& p) { return p.severity == Severity::error; });
}

const BArg* Mafile::b_arg(std::string_view name) const {
  const auto found = std::find_if(b_args.rbegin(), b_args.rend(), [&](const BArg& a) { return a.name == name; });
  return found == b_args.rend() ? nullptr : &*found;
}

std::optional<double> Mafile::in_force(std::string_view name) const {
  if (const auto* given = b_arg(name)) return given->value;
  const auto* rule = b_arg_rule(behavior, name);
  return rule == nullptr ? std::nullopt : rule->fallback;
}

Mafile read_mafile(std::string_view bytes, const MafileOptions& options) { return Reader{options}.read(bytes); }

}  // namespace glidehelm::protocol
