#include "config/yaml_reader.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

namespace glidehelm::config {

std::string ConfigError::text() const {
  std::string result = key.empty() ? problem : key + ": " + problem;
  if (!found.empty()) result += "; found " + found;
  if (!allowed.empty()) result += "; allowed: " + allowed;
  if (!nearest.empty()) result += "; did you mean " + nearest + "?";
  return result;
}

std::string ConfigError::message() const {
  std::string where = file;
  if (line > 0) where += ":" + std::to_string(line) + ":" + std::to_string(column);
  return where + ": " + text();
}

const Node* Node::find(std::string_view key) const {
  for (const auto& member : members)
    if (member.key == key) return &member.value;
  return nullptr;
}

std::string shown(std::string_view text, std::size_t at_most) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string result;
  std::size_t characters = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) != 0x80U && characters++ == at_most) return result + "…";
    if (byte < 0x20 || byte == 0x7F)
      result += {'\\', 'x', kHex[byte >> 4U], kHex[byte & 15U]};
    else
      result += c;
  }
  return result;
}

void Problems::add(Place at, std::string key, std::string problem, std::string found, std::string allowed,
                   std::string nearest) {
  ConfigError error;
  error.file = file_;
  error.line = at.line;
  error.column = at.column;
  error.key = std::move(key);
  error.problem = std::move(problem);
  error.found = std::move(found);
  error.allowed = std::move(allowed);
  error.nearest = std::move(nearest);
  add(std::move(error));
}

void Problems::add(ConfigError error) {
  if (errors_.size() >= kMostErrors) {
    more_ = true;
    return;
  }
  errors_.push_back(std::move(error));
}

std::vector<ConfigError> Problems::sorted() const {
  auto result = errors_;
  std::stable_sort(result.begin(), result.end(), [](const ConfigError& a, const ConfigError& b) {
    return std::pair{a.line, a.column} < std::pair{b.line, b.column};
  });
  if (more_) {
    ConfigError last;
    last.file = file_;
    last.problem = "more errors than the " + std::to_string(kMostErrors) + " shown";
    result.push_back(std::move(last));
  }
  return result;
}

namespace {

/// Where lines begin, to turn yaml-cpp's line and byte column into a character column.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_{text} {
    starts_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') starts_.push_back(i + 1);
  }

  [[nodiscard]] std::size_t offset(const YAML::Mark& mark) const {
    if (mark.line < 0 || mark.column < 0) return 0;
    const auto line = std::min(static_cast<std::size_t>(mark.line), starts_.size() - 1);
    return std::min(starts_[line] + static_cast<std::size_t>(mark.column), text_.size());
  }

  /// Places are asked for in the order of the text, mostly: counting goes on from the last one on a line, so that one
  /// line with all values of a file does not cost the square of its length.
  [[nodiscard]] Place place(std::size_t offset) {
    const auto next = std::upper_bound(starts_.begin(), starts_.end(), offset);
    const auto start = *(next - 1);
    if (counted_to_ < start || counted_to_ > offset) {
      counted_to_ = start;
      characters_ = 0;
    }
    for (; counted_to_ < offset; ++counted_to_)
      if ((static_cast<unsigned char>(text_[counted_to_]) & 0xC0U) != 0x80U) ++characters_;
    return {static_cast<int>(next - starts_.begin()), characters_ + 1};
  }

  /// False when a quoted text begins here and the file ends before it does: yaml-cpp takes that for the whole text.
  [[nodiscard]] bool quote_ends(std::size_t offset) const {
    const char quote = at(offset);
    if (quote != '"' && quote != '\'') return true;
    for (std::size_t i = offset + 1; i < text_.size(); ++i) {
      if (quote == '"' && text_[i] == '\\')
        ++i;
      else if (quote == '\'' && text_[i] == quote && at(i + 1) == quote)
        ++i;
      else if (text_[i] == quote)
        return true;
    }
    return false;
  }

  [[nodiscard]] char at(std::size_t offset) const { return offset < text_.size() ? text_[offset] : '\0'; }

 private:
  std::string_view text_;
  std::vector<std::size_t> starts_;
  std::size_t counted_to_{};
  int characters_{};  ///< from the start of the line to `counted_to_`
};

/// Length of the UTF-8 sequence at `i`; 0 when it is none (overlong, surrogate and too large included).
std::size_t utf8_length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(k < text.size() ? text[k] : '\0'); };
  const auto tail = [&](std::size_t k) { return (byte(k) & 0xC0U) == 0x80U; };
  const unsigned b = byte(i);
  if (b < 0x80) return 1;
  if (b >= 0xC2 && b <= 0xDF) return tail(i + 1) ? 2 : 0;
  if (b >= 0xE0 && b <= 0xEF) {
    const unsigned low = b == 0xE0 ? 0xA0 : 0x80, high = b == 0xED ? 0x9F : 0xBF;
    return byte(i + 1) >= low && byte(i + 1) <= high && tail(i + 2) ? 3 : 0;
  }
  if (b >= 0xF0 && b <= 0xF4) {
    const unsigned low = b == 0xF0 ? 0x90 : 0x80, high = b == 0xF4 ? 0x8F : 0xBF;
    return byte(i + 1) >= low && byte(i + 1) <= high && tail(i + 2) && tail(i + 3) ? 4 : 0;
  }
  return 0;
}

/// Reports bytes that no configuration holds. True when yaml-cpp may see the text (tabs replaced by blanks): it takes
/// the byte 04 for the end of the file and replaces broken UTF-8 without a word.
bool check_characters(std::string& text, Lines& lines, Problems& problems) {
  bool clean = true;
  int last_line = 0;  // one report per line is enough
  for (std::size_t i = 0; i < text.size();) {
    const auto length = utf8_length(text, i);
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool line_end = byte == '\n' || (byte == '\r' && i + 1 < text.size() && text[i + 1] == '\n');
    const bool c1 = length == 2 && byte == 0xC2 && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    const bool control = (byte < 0x20 && !line_end && byte != '\t') || byte == 0x7F || c1;
    if (length == 0 || control || byte == '\t') {
      const auto at = lines.place(i);
      if (at.line != last_line)
        problems.add(at, {},
                     length == 0 ? "not UTF-8 text"
                     : control   ? "control character"
                                 : "tab",
                     shown(text.substr(i, 1)), byte == '\t' ? "blanks" : "");
      last_line = at.line;
      if (byte == '\t')
        text[i] = ' ';
      else
        clean = false;
    }
    i += std::max<std::size_t>(length, 1);
  }
  return clean;
}

/// Ends yaml-cpp's parse from inside an event; caught in read_yaml.
struct Enough {};

class Builder : public YAML::EventHandler {
 public:
  Builder(Lines& lines, Problems& problems) : lines_{lines}, problems_{problems} {}

  Node root;
  bool complete{};  ///< `root` is the whole first document

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_++ == 0) return;
    problems_.add(place(mark), {}, "a second document in the file", {}, "one document");
    throw Enough{};
  }
  void OnDocumentEnd() override { complete = true; }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Node node = started(Node::Kind::empty, mark, "", anchor);
    node.place = place_of_empty(mark);
    attach(std::move(node));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    problems_.add(place(mark), path(), "aliases are not taken", "*", "the value itself");
    attach(counted(Node::Kind::broken, mark));
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    Node node = started(Node::Kind::scalar, mark, tag, anchor);
    node.quoted = tag == "!";
    node.text = value;
    if (!lines_.quote_ends(lines_.offset(mark)))
      problems_.add(node.place, path(), "a quote that does not end", shown(value));
    attach(std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(started(Node::Kind::list, mark, tag, anchor));
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(started(Node::Kind::map, mark, tag, anchor));
  }
  void OnMapEnd() override { close(); }

 private:
  struct Frame {
    Node node;
    bool key_next{true};
    std::optional<Member> pending;        ///< the key whose value comes next; none when the key was refused
    std::map<std::string, Place> seen{};  ///< keys so far
  };

  [[nodiscard]] Place place(const YAML::Mark& mark) { return lines_.place(lines_.offset(mark)); }

  /// yaml-cpp marks an absent value with the token after it: the key is what a reader looks for.
  [[nodiscard]] Place place_of_empty(const YAML::Mark& mark) {
    if (!frames_.empty() && frames_.back().node.is(Node::Kind::map) && frames_.back().pending)
      return frames_.back().pending->place;
    auto offset = lines_.offset(mark);
    const char here = lines_.at(offset);
    if (here == '~' || here == 'n' || here == 'N') return lines_.place(offset);
    while (offset > 0 && (lines_.at(offset) != '-' && lines_.at(offset) != ',' && lines_.at(offset) != '[')) --offset;
    return lines_.place(offset);
  }

  Node counted(Node::Kind kind, const YAML::Mark& mark) {
    if (++values_ > kMostValues) {
      problems_.add(place(mark), {}, "more than " + std::to_string(kMostValues) + " values");
      throw Enough{};
    }
    Node node;
    node.kind = kind;
    node.place = place(mark);
    return node;
  }

  Node started(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    Node node = counted(kind, mark);
    // `! text` gives the same tag as quotes; the mark stands on the property, so the source tells them apart.
    const bool tagged = (tag != "" && tag != "?" && tag != "!") || lines_.at(lines_.offset(mark)) == '!';
    if (tagged) problems_.add(node.place, path(), "tags are not taken", tag == "!" ? tag : shown(tag));
    if (anchor != 0) problems_.add(node.place, path(), "anchors are not taken");
    return node;
  }

  void open(Node node) {
    if (frames_.size() >= kDeepestNesting) {
      problems_.add(node.place, {}, "nested deeper than " + std::to_string(kDeepestNesting) + " levels");
      throw Enough{};
    }
    frames_.push_back(Frame{std::move(node), true, std::nullopt, {}});
  }

  void close() {
    Node node = std::move(frames_.back().node);
    frames_.pop_back();
    attach(std::move(node));
  }

  void attach(Node node) {
    if (frames_.empty()) {
      root = std::move(node);
      return;
    }
    Frame& frame = frames_.back();
    if (frame.node.is(Node::Kind::list)) {
      frame.node.items.push_back(std::move(node));
    } else if (frame.key_next) {
      take_key(frame, std::move(node));
      frame.key_next = false;
    } else {
      if (frame.pending) {
        frame.pending->value = std::move(node);
        frame.node.members.push_back(std::move(*frame.pending));
        frame.pending.reset();
      }
      frame.key_next = true;
    }
  }

  void take_key(Frame& frame, Node node) {
    if (!node.is(Node::Kind::scalar)) {
      if (!node.is(Node::Kind::broken)) problems_.add(node.place, path(), "a key must be one word", {}, "KEY: VALUE");
      return;
    }
    if (node.text == "<<" && !node.quoted) {
      problems_.add(node.place, path(), "merge keys are not taken", "<<", "the keys themselves");
      return;
    }
    const auto [first, is_new] = frame.seen.emplace(node.text, node.place);
    if (!is_new) {
      problems_.add(node.place, child_path(shown(node.text)),
                    "duplicate key; it stands first in line " + std::to_string(first->second.line));
      return;
    }
    frame.pending = Member{std::move(node.text), node.place, {}};
  }

  [[nodiscard]] std::string child_path(const std::string& key) const {
    const auto parent = path();
    return parent.empty() ? key : parent + "." + key;
  }

  /// Path of the value that is being read.
  [[nodiscard]] std::string path() const {
    std::string result;
    for (const auto& frame : frames_) {
      if (frame.node.is(Node::Kind::list)) {
        result += "[" + std::to_string(frame.node.items.size()) + "]";
      } else if (frame.pending) {
        if (!result.empty()) result += ".";
        result += shown(frame.pending->key);
      }
    }
    return result;
  }

  Lines& lines_;
  Problems& problems_;
  std::vector<Frame> frames_;
  std::size_t values_{};
  int documents_{};
};

/// True when the text is YAML to its end.
bool parse(const std::string& text, Lines& lines, Builder& builder, Problems& problems) {
  try {
    std::istringstream stream{text};
    YAML::Parser parser{stream};
    while (parser.HandleNextDocument(builder)) {
    }
    return true;
  } catch (const Enough&) {
    return builder.complete;
  } catch (const YAML::Exception& error) {
    problems.add(lines.place(lines.offset(error.mark)), {}, "not YAML: " + shown(error.msg, 200));
  } catch (const std::exception& error) {
    problems.add(Place{}, {}, std::string{"cannot be read as YAML: "} + error.what());
  }
  return false;
}

}  // namespace

Document read_yaml(std::string_view text, std::string file) {
  Document document;
  document.file = file;
  Problems problems{std::move(file)};
  if (text.size() > kLargestFile) {
    problems.add(Place{}, {}, "the file is too large", std::to_string(text.size()) + " bytes",
                 "up to " + std::to_string(kLargestFile) + " bytes");
    document.errors = problems.sorted();
    return document;
  }
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  std::string copy{text};
  Lines lines{text};
  if (check_characters(copy, lines, problems)) {
    Builder builder{lines, problems};
    document.readable = parse(copy, lines, builder, problems);
    document.root = std::move(builder.root);
  }
  document.errors = problems.sorted();
  return document;
}

}  // namespace glidehelm::config
