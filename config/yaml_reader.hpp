#pragma once

#include <compare>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Configuration: text in, checked values out, or every error at once. No file is touched in here.
namespace glidehelm::config {

/// Line and column of a character, both from 1; columns count characters, as editors do.
struct Place {
  int line{1}, column{1};
  friend auto operator<=>(const Place&, const Place&) = default;
};

/// One thing that is wrong in a file, as facts.
struct ConfigError {
  std::string file;
  int line{}, column{};  ///< 0 when the file as a whole is meant (it could not be read, two files disagree)
  std::string key;  ///< path of the key: `planning.headings`, `gliders[1].name` (lists count from 0); empty: the file
  std::string problem;  ///< what is wrong, in words
  std::string found;    ///< what stands there, as written; empty when nothing does
  std::string allowed;  ///< what may stand there; empty when `problem` says it
  std::string nearest;  ///< the valid key or word nearest to what was found; empty when none is near

  /// `planning.headigns: unknown key; did you mean headings?`, without the place.
  [[nodiscard]] std::string text() const;
  /// `FILE:LINE:COLUMN: ` and `text()`; without line and column when they are 0.
  [[nodiscard]] std::string message() const;
  friend bool operator==(const ConfigError&, const ConfigError&) = default;
};

struct Member;

/// One value of a YAML document, with its place. Nothing is interpreted yet: a number is still text.
struct Node {
  enum class Kind {
    empty,   ///< nothing, `~` or `null`
    scalar,  ///< `text`
    list,    ///< `items`
    map,     ///< `members`, in the order of the file, keys unique
    broken,  ///< already reported (an alias, say): readers pass over it
  };
  Kind kind{Kind::empty};
  Place place;  ///< first character; of an empty value, the key it belongs to
  std::string text;
  bool quoted{};  ///< in quotes or as a block: a text whatever it looks like
  std::vector<Node> items;
  std::vector<Member> members;

  [[nodiscard]] bool is(Kind wanted) const { return kind == wanted; }
  /// The value of a key of a map; null when there is none.
  [[nodiscard]] const Node* find(std::string_view key) const;
};

struct Member {
  std::string key;
  Place place;
  Node value;
};

/// A file as read. With `readable` false the text is no YAML and `root` is not to be looked at; otherwise `root` can be
/// checked further even when there are errors, so that all of them are told at once.
struct Document {
  std::string file;
  Node root;
  bool readable{};
  std::vector<ConfigError> errors;
};

inline constexpr std::size_t kLargestFile = 1U << 20;  ///< bytes
inline constexpr std::size_t kMostValues = 1U << 16;   ///< of one document
inline constexpr std::size_t kDeepestNesting = 16;
inline constexpr std::size_t kMostErrors = 100;  ///< of one file; then one more says that there are more

/// Reads one YAML document more strictly than YAML: duplicate keys, anchors, aliases, tags, merge keys, keys that are
/// no plain words, tabs, control characters, text that is not UTF-8, a second document, nesting beyond
/// `kDeepestNesting`, more than `kMostValues` values and more than `kLargestFile` bytes are errors. A UTF-8 byte-order
/// mark at the start and CR LF line ends are taken. Linear in the length but for yaml-cpp itself; throws nothing.
Document read_yaml(std::string_view text, std::string file);

/// Something of a file for a message: at most `at_most` characters, control characters escaped, so that no file can forge a
/// line of a log.
std::string shown(std::string_view text, std::size_t at_most = 60);

/// Collects the errors of one file up to `kMostErrors`.
class Problems {
 public:
  explicit Problems(std::string file) : file_{std::move(file)} {}
  void add(Place at, std::string key, std::string problem, std::string found = {}, std::string allowed = {},
           std::string nearest = {});
  void add(ConfigError error);
  [[nodiscard]] bool empty() const { return errors_.empty(); }
  [[nodiscard]] const std::string& file() const { return file_; }
  /// All errors, by line and column; errors of equal place in the order they were found.
  [[nodiscard]] std::vector<ConfigError> sorted() const;

 private:
  std::string file_;
  std::vector<ConfigError> errors_;
  bool more_{};
};

}  // namespace glidehelm::config
