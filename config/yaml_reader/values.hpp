#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/yaml_reader.hpp"
#include "core/base/time.hpp"

/// Strict readers of single values, and values as YAML.
namespace glidehelm::config {

/// Which numbers a key takes, in the unit of the key.
struct Range {
  double low{-std::numeric_limits<double>::infinity()}, high{std::numeric_limits<double>::infinity()};
  bool low_open{};  ///< `low` itself is not allowed
  [[nodiscard]] bool contains(double value) const { return (low_open ? value > low : value >= low) && value <= high; }
  /// "0 to 99", "above 0, up to 2".
  [[nodiscard]] std::string text() const;
};

/// Both ends are allowed.
inline Range from_to(double low, double high) { return {low, high}; }
/// The lower end itself is not allowed.
inline Range above(double low, double high) { return {low, high, true}; }

/// A form of text: the regular expression of the JSON Schema, the words of a message, and the same as code (a regular
/// expression engine may exhaust the stack on hostile text).
struct Pattern {
  const char* regex;
  const char* words;
  bool (*matches)(std::string_view);
};
extern const Pattern kAnyText;  ///< 1 to 4096 bytes
extern const Pattern kName;     ///< ^[a-z0-9][a-z0-9_-]{0,31}$ : gliders and missions, safe as a file name

/// The unit that the end of a key says: "m" for `radius_m`, "m/s", "°", …; empty when it says none.
std::string unit_of(std::string_view key);

/// What readers share while one file is read.
struct Reading {
  explicit Reading(std::string file) : problems{std::move(file)} {}
  Problems problems;
  std::map<std::string, Place> places;  ///< by path: every key that the file sets
  /// Place of a key, else of the nearest key around it, else the start of the file.
  [[nodiscard]] Place place_of(std::string path) const;
  void complain(const std::string& path, std::string problem, std::string found = {}, std::string allowed = {},
                std::string nearest = {});
};

/// One value under reading.
struct At {
  const Node& node;
  const Node* around{};  ///< the map that holds it
  std::string path;
  Reading& reading;
  void complain(std::string problem, std::string found = {}, std::string allowed = {}, std::string nearest = {}) const;
  [[nodiscard]] At item(std::size_t i) const;
  /// What stands here, for a message.
  [[nodiscard]] std::string found() const;
};

// Strict readers of one value; nothing, and an error, when it is not what is wanted.
// A number is a JSON number without quotes: no 010, .5, 1_000, 0x10, .nan or 12:30. A whole number also has no point.
std::optional<double> read_number(const At& at, const Range& range);
std::optional<std::int64_t> read_whole(const At& at, const Range& range);
/// `true` or `false`; yes, no, on and off are not taken.
std::optional<bool> read_flag(const At& at);
/// A text; words that YAML or its older versions take for a number, a truth value or nothing need quotes.
std::optional<std::string> read_text(const At& at, const Pattern& pattern);
/// Index of one of the words. A word of `later` is known but not available in this version.
std::optional<std::size_t> read_word(const At& at, const std::vector<std::string>& words,
                                     const std::vector<std::string>& later = {});
std::optional<Instant> read_time(const At& at);
/// A latitude or longitude in degrees; names a swap when the neighbour key says so.
std::optional<double> read_latitude(const At& at);
std::optional<double> read_longitude(const At& at);
bool expect_list(const At& at, int at_least, int at_most);
bool expect_map(const At& at);
/// True when a plain scalar would be read as a number by YAML.
bool looks_like_number(std::string_view text);

/// The words with commas between them.
std::string joined(const std::vector<std::string>& words);

// Texts of values as they stand in YAML.
std::string yaml_text(std::string_view text);
std::string yaml_list(const std::vector<std::string>& texts);
/// Shortest decimal that reads back to exactly `si` when multiplied by `unit`.
std::string yaml_number(double si, double unit = 1.0);
std::string yaml_time(Instant t);

}  // namespace glidehelm::config
