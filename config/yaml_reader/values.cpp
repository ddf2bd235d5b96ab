#include "config/yaml_reader/values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"

namespace glidehelm::config {

namespace {

std::string number_words(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed).ptr;
  return {buffer.data(), end};
}

/// `[-]digits[.digits][e[±]digits]` without superfluous leading zeros: the numbers of JSON.
bool is_json_number(std::string_view text) {
  const auto digits = [&] {
    std::size_t n = 0;
    while (n < text.size() && is_digit(text[n])) ++n;
    text.remove_prefix(n);
    return n;
  };
  if (!text.empty() && text.front() == '-') text.remove_prefix(1);
  const bool zero = !text.empty() && text.front() == '0';
  const auto whole = digits();
  if (whole == 0 || (zero && whole > 1)) return false;
  if (!text.empty() && text.front() == '.') {
    text.remove_prefix(1);
    if (digits() == 0) return false;
  }
  if (!text.empty() && (text.front() == 'e' || text.front() == 'E')) {
    text.remove_prefix(1);
    if (!text.empty() && (text.front() == '+' || text.front() == '-')) text.remove_prefix(1);
    if (digits() == 0) return false;
  }
  return text.empty();
}

bool has_leading_zero(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  return text.size() > 1 && text[0] == '0' && is_digit(text[1]);
}

bool is_not_finite(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  const auto word = lower(text);
  return word == ".nan" || word == ".inf" || word == "nan" || word == "inf" || word == "infinity";
}

bool is_truth_word(std::string_view text) {
  static constexpr std::array<std::string_view, 8> kWords{"y", "n", "yes", "no", "on", "off", "true", "false"};
  const auto word = lower(text);
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

std::string last_key(const std::string& path) {
  const auto dot = path.find_last_of('.');
  return dot == std::string::npos ? path : path.substr(dot + 1);
}

std::string range_words(const std::string& path, const Range& range) {
  const auto unit = unit_of(last_key(path));
  const auto text = range.text();
  if (text.empty()) return unit.empty() ? "a number" : "a number in " + unit;
  return unit.empty() ? text : text + " " + unit;
}

bool matches_any_text(std::string_view text) { return !text.empty() && text.size() <= 4096; }

bool matches_name(std::string_view text) {
  const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || is_digit(c); };
  if (text.empty() || text.size() > 32 || !plain(text.front())) return false;
  return std::all_of(text.begin(), text.end(), [&](char c) { return plain(c) || c == '_' || c == '-'; });
}

}  // namespace

std::string joined(const std::vector<std::string>& words) {
  std::string result;
  for (const auto& word : words) result += (result.empty() ? "" : ", ") + word;
  return result;
}

const Pattern kAnyText{"^[\\s\\S]{1,4096}$", "a text of 1 to 4096 bytes", matches_any_text};
const Pattern kName{"^[a-z0-9][a-z0-9_-]{0,31}$", "1 to 32 of a–z, 0–9, _ and -, the first a letter or digit",
                    matches_name};

std::string Range::text() const {
  const bool lowest = std::isinf(low), highest = std::isinf(high);
  if (lowest && highest) return {};
  if (highest) return (low_open ? "above " : "from ") + number_words(low);
  if (lowest) return "up to " + number_words(high);
  if (low_open) return "above " + number_words(low) + ", up to " + number_words(high);
  return number_words(low) + " to " + number_words(high);
}

std::string unit_of(std::string_view key) {
  static constexpr std::array<std::pair<std::string_view, const char*>, 7> kUnits{
      {{"_m_per_s", "m/s"}, {"_km", "km"}, {"_m", "m"}, {"_min", "min"}, {"_s", "s"}, {"_h", "h"}, {"_deg", "°"}}};
  for (const auto& [ending, unit] : kUnits)
    if (key.size() > ending.size() && key.substr(key.size() - ending.size()) == ending) return unit;
  return {};
}

Place Reading::place_of(std::string path) const {
  while (!path.empty()) {
    if (const auto found = places.find(path); found != places.end()) return found->second;
    const auto end = path.find_last_of(".[");
    path.erase(end == std::string::npos ? 0 : end);
  }
  const auto root = places.find("");
  return root == places.end() ? Place{} : root->second;
}

void Reading::complain(const std::string& path, std::string problem, std::string found, std::string allowed,
                       std::string nearest) {
  problems.add(place_of(path), path, std::move(problem), std::move(found), std::move(allowed), std::move(nearest));
}

void At::complain(std::string problem, std::string found_text, std::string allowed, std::string nearest) const {
  reading.problems.add(node.place, path, std::move(problem), std::move(found_text), std::move(allowed),
                       std::move(nearest));
}

At At::item(std::size_t i) const { return At{node.items[i], &node, path + "[" + std::to_string(i) + "]", reading}; }

std::string At::found() const {
  switch (node.kind) {
    case Node::Kind::empty:
      return "nothing";
    case Node::Kind::list:
      return "a list";
    case Node::Kind::map:
      return "a map of keys";
    case Node::Kind::scalar:
    case Node::Kind::broken:
      break;
  }
  return node.quoted ? "\"" + shown(node.text) + "\"" : shown(node.text);
}

bool looks_like_number(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  if (is_not_finite(text) && text.front() == '.') return true;
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'o'))
    return text.find_first_not_of("0123456789abcdefABCDEF_", 2) == std::string_view::npos;
  std::size_t points = 0, digits = 0, i = 0;
  for (; i < text.size(); ++i) {
    if (is_digit(text[i]))
      ++digits;
    else if (text[i] == '.')
      ++points;
    else if ((text[i] != '_' && text[i] != ':') || digits == 0)
      break;
  }
  if (digits == 0 || points > 1) return false;
  if (i == text.size()) return true;
  if (text[i] != 'e' && text[i] != 'E') return false;
  text.remove_prefix(i + 1);
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  return !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
}

std::optional<double> read_number(const At& at, const Range& range) {
  const auto& text = at.node.text;
  const auto allowed = range_words(at.path, range);
  if (at.node.is(Node::Kind::broken)) return std::nullopt;
  if (!at.node.is(Node::Kind::scalar)) {
    at.complain("not a number", at.found(), allowed);
  } else if (at.node.quoted) {
    at.complain("a text, not a number", at.found(), allowed + ", without quotes");
  } else if (is_not_finite(text)) {
    at.complain("not a finite number", at.found(), allowed);
  } else if (has_leading_zero(text)) {
    at.complain("a number with a leading zero, which YAML may read as octal", at.found(),
                allowed + ", without the zero");
  } else if (!is_json_number(text)) {
    at.complain("not a number", at.found(), allowed);
  } else if (const auto value = number_from(text); !value) {
    at.complain("not a finite number", at.found(), allowed);
  } else if (!range.contains(*value)) {
    at.complain("out of range", at.found(), allowed);
  } else {
    return value;
  }
  return std::nullopt;
}

std::optional<std::int64_t> read_whole(const At& at, const Range& range) {
  if (at.node.is(Node::Kind::scalar) && !at.node.quoted && is_json_number(at.node.text) &&
      at.node.text.find_first_of(".eE") != std::string::npos) {
    at.complain("not a whole number", at.found(), range_words(at.path, range));
    return std::nullopt;
  }
  // Ranges of whole numbers end at 2^53, so that the double is exact.
  const auto value = read_number(at, range);
  if (!value) return std::nullopt;
  return static_cast<std::int64_t>(*value);
}

std::optional<bool> read_flag(const At& at) {
  if (at.node.is(Node::Kind::broken)) return std::nullopt;
  if (at.node.is(Node::Kind::scalar) && !at.node.quoted && (at.node.text == "true" || at.node.text == "false"))
    return at.node.text == "true";
  at.complain("neither true nor false", at.found(), "true, false");
  return std::nullopt;
}

std::optional<std::string> read_text(const At& at, const Pattern& pattern) {
  if (at.node.is(Node::Kind::broken)) return std::nullopt;
  if (!at.node.is(Node::Kind::scalar)) {
    at.complain("not a text", at.found(), pattern.words);
  } else if (!at.node.quoted && is_truth_word(at.node.text)) {
    at.complain("YAML reads this word as true or false", at.found(), "a text: put it in quotes");
  } else if (!at.node.quoted && looks_like_number(at.node.text)) {
    at.complain("YAML reads this as a number", at.found(), "a text: put it in quotes");
  } else if (!pattern.matches(at.node.text)) {
    at.complain("not of the form that is needed", at.node.text.empty() ? "\"\"" : at.found(), pattern.words);
  } else {
    return at.node.text;
  }
  return std::nullopt;
}

std::optional<std::size_t> read_word(const At& at, const std::vector<std::string>& words,
                                     const std::vector<std::string>& later) {
  if (at.node.is(Node::Kind::broken)) return std::nullopt;
  const auto& text = at.node.text;
  if (at.node.is(Node::Kind::scalar)) {
    for (std::size_t i = 0; i < words.size(); ++i)
      if (words[i] == text) return i;
    if (std::find(later.begin(), later.end(), text) != later.end()) {
      at.complain("not available in this version; available: " + joined(words), at.found());
      return std::nullopt;
    }
  }
  const bool near = at.node.is(Node::Kind::scalar) && text.size() <= 64;
  at.complain("not one of the words", at.found(), joined(words), near ? nearest_word(text, words).value_or("") : "");
  return std::nullopt;
}

std::optional<Instant> read_time(const At& at) {
  if (at.node.is(Node::Kind::broken)) return std::nullopt;
  if (at.node.is(Node::Kind::scalar))
    if (const auto time = utc_from_text(at.node.text)) return time;
  at.complain("not a time", at.found(), "UTC as 2026-11-25T10:20:30Z");
  return std::nullopt;
}

namespace {

/// The value as a plain number, without a word about it when it is none.
std::optional<double> quietly(const Node* node) {
  if (node == nullptr || !node->is(Node::Kind::scalar) || node->quoted || !is_json_number(node->text))
    return std::nullopt;
  return number_from(node->text);
}

}  // namespace

std::optional<double> read_latitude(const At& at) {
  Range range;
  range.low = -90;
  range.high = 90;
  const auto value = quietly(&at.node),
             longitude = quietly(at.around == nullptr ? nullptr : at.around->find("lon_deg"));
  if (value && longitude && !range.contains(*value) && std::abs(*value) <= 360 && std::abs(*longitude) <= 90) {
    at.complain("latitude out of range; latitude and longitude swapped?", at.found(), range_words(at.path, range));
    return std::nullopt;
  }
  return read_number(at, range);
}

std::optional<double> read_longitude(const At& at) {
  Range range;
  range.low = -360;
  range.high = 360;
  return read_number(at, range);
}

bool expect_list(const At& at, int at_least, int at_most) {
  if (at.node.is(Node::Kind::broken)) return false;
  const auto wanted = [&]() -> std::string {
    if (at_most == std::numeric_limits<int>::max())
      return at_least > 0 ? "a list of at least " + std::to_string(at_least) : "a list";
    if (at_least == at_most) return "a list of " + std::to_string(at_least);
    return "a list of " + std::to_string(at_least) + " to " + std::to_string(at_most);
  };
  if (!at.node.is(Node::Kind::list)) {
    at.complain("not a list", at.found(), wanted());
    return false;
  }
  const auto size = at.node.items.size();
  if (size < static_cast<std::size_t>(at_least) || size > static_cast<std::size_t>(at_most)) {
    at.complain("a list of another length", std::to_string(size), wanted());
    return false;
  }
  return true;
}

bool expect_map(const At& at) {
  if (at.node.is(Node::Kind::map)) return true;
  if (!at.node.is(Node::Kind::broken))
    at.complain("not a map of keys", at.found(), "KEY: VALUE lines, or {KEY: VALUE, …}");
  return false;
}

std::string yaml_text(std::string_view text) {
  const auto plain_first = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '/';
  };
  const auto plain = [&](char c) { return plain_first(c) || is_digit(c) || c == '.' || c == '-'; };
  const auto word = lower(text);
  if (!text.empty() && plain_first(text.front()) && std::all_of(text.begin(), text.end(), plain) &&
      !is_truth_word(text) && word != "null")
    return std::string{text};
  constexpr char kHex[] = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      result += {'\\', c};
    else if (byte < 0x20)
      result += {'\\', 'x', kHex[byte >> 4U], kHex[byte & 15U]};
    else
      result += c;
  }
  return result + "\"";
}

std::string yaml_list(const std::vector<std::string>& texts) {
  std::string result = "[";
  for (const auto& text : texts) result += (result.size() == 1 ? "" : ", ") + yaml_text(text);
  return result + "]";
}

std::string yaml_number(double si, double unit) {
  std::array<char, 32> buffer{};
  const auto text = [&](double value, int digits) {
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, digits).ptr;
    return std::string{buffer.data(), end};
  };
  for (const int digits : {6, 12, 15, 16, 17}) {
    auto candidate = text(si / unit, digits);
    if (number_from(candidate).value_or(0) * unit == si) return candidate;
  }
  return text(si / unit, 17);
}

std::string yaml_time(Instant t) { return utc_text(t, t.time_since_epoch().count() % 1000 != 0); }

}  // namespace glidehelm::config
