#include "daemon/ingest/ascii_grid.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "core/base/text.hpp"

namespace glidehelm::ingest {

namespace {

constexpr double kMostCells = 1 << 27;

/// Words of a text with their places.
class Words {
 public:
  explicit Words(std::string_view text) : text_{text} { next(); }
  [[nodiscard]] bool end() const { return word_.empty(); }
  [[nodiscard]] std::string_view word() const { return word_; }
  void next() {
    while (at_ < text_.size() && is_blank(text_[at_])) {
      if (text_[at_] == '\n') ++line_, line_start_ = at_ + 1;
      ++at_;
    }
    const std::size_t from = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    word_ = text_.substr(from, at_ - from);
    column_ = from - line_start_ + 1;
  }
  [[nodiscard]] std::string place() const {
    return "line " + std::to_string(line_) + ", column " + std::to_string(column_) + ": ";
  }
  [[nodiscard]] std::string quoted() const { return "'" + std::string{word_.substr(0, 40)} + "'"; }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
  std::string_view text_, word_;
  std::size_t at_{}, line_{1}, line_start_{}, column_{};
};

Result<double> number_at(const Words& words, const std::string& what) {
  const auto value = words.end() ? std::nullopt : number_from(words.word());
  if (value) return *value;
  if (words.end()) return fault(words.place() + "the file ends where " + what + " is expected");
  if (words.word().find(',') != std::string_view::npos)
    return fault(words.place() + words.quoted() + " has a decimal comma; numbers have a point");
  return fault(words.place() + words.quoted() + " is no number, expected is " + what);
}

bool is_key(std::string_view word) {
  return !word.empty() && ((word[0] >= 'a' && word[0] <= 'z') || (word[0] >= 'A' && word[0] <= 'Z')) &&
         !equal_without_case(word, "nan") && !equal_without_case(word, "inf");
}

using Keys = std::map<std::string, double>;

Result<Keys> read_keys(Words& words) {
  Keys keys;
  while (!words.end() && is_key(words.word())) {
    const std::string key = lower(words.word());
    static const char* const known[] = {"ncols",     "nrows",    "xllcorner", "xllcenter", "yllcorner",
                                        "yllcenter", "cellsize", "dx",        "dy",        "nodata_value"};
    bool found = false;
    for (const auto* name : known) found = found || key == name;
    if (!found)
      return fault(words.place() + "key " + words.quoted() +
                   " is not known; allowed are ncols, nrows, xllcorner, xllcenter, yllcorner, yllcenter, cellsize, dx, "
                   "dy, NODATA_value");
    if (keys.count(key) != 0) return fault(words.place() + "key " + words.quoted() + " stands here a second time");
    words.next();
    const auto value = number_at(words, "the value of " + key);
    if (!value) return unexpected(value.error());
    keys[key] = *value;
    words.next();
  }
  return keys;
}

std::optional<double> value_of(const Keys& keys, const char* name) {
  const auto found = keys.find(name);
  return found == keys.end() ? std::nullopt : std::optional{found->second};
}

/// One axis: `centre` or `corner` key and the cell's size.
Result<double> origin(const Keys& keys, const char* centre, const char* corner, double size, bool& is_corner) {
  const auto at_centre = value_of(keys, centre), at_corner = value_of(keys, corner);
  if (at_centre && at_corner) return fault(std::string{"both "} + centre + " and " + corner + " are given");
  if (!at_centre && !at_corner) return fault(std::string{"neither "} + centre + " nor " + corner + " is given");
  is_corner = at_corner.has_value();
  return at_centre ? *at_centre : *at_corner + 0.5 * size;
}

Result<AsciiGrid> head_of(const Keys& keys) {
  AsciiGrid grid;
  for (const auto& [name, size] : {std::pair{"ncols", &grid.columns}, std::pair{"nrows", &grid.rows}}) {
    const auto value = value_of(keys, name);
    if (!value || !(*value >= 2 && *value <= kMostCells && *value == std::floor(*value)))
      return fault(std::string{name} + " must be given, a whole number from 2");
    *size = static_cast<std::size_t>(*value);
  }
  const auto cell = value_of(keys, "cellsize"), dx = value_of(keys, "dx"), dy = value_of(keys, "dy");
  if (cell ? dx || dy : !dx || !dy) return fault("the size of a cell is cellsize, or dx and dy");
  grid.dx = cell ? *cell : *dx;
  grid.dy = cell ? *cell : *dy;
  if (!(grid.dx > 0 && grid.dy > 0)) return fault("the size of a cell must be positive");
  bool corner_y = false;
  const auto x = origin(keys, "xllcenter", "xllcorner", grid.dx, grid.corner);
  if (!x) return unexpected(x.error());
  const auto y = origin(keys, "yllcenter", "yllcorner", grid.dy, corner_y);
  if (!y) return unexpected(y.error());
  grid.x = *x;
  grid.y = *y;
  return grid;
}

}  // namespace

bool is_ascii_grid(std::string_view text) {
  const Words words{text.substr(0, 200)};
  return equal_without_case(words.word(), "ncols");
}

Result<AsciiGrid> read_ascii_grid(std::string_view text) {
  Words words{text};
  const auto keys = read_keys(words);
  if (!keys) return unexpected(keys.error());
  auto grid = head_of(*keys);
  if (!grid) return unexpected(Fault{"head of the grid: " + grid.error().what});
  const auto nodata = value_of(*keys, "nodata_value");
  const std::size_t count = grid->columns * grid->rows;
  // Each number takes a digit and a blank: what cannot be there is not reserved.
  if (count > text.size() / 2 + 1)
    return fault("the file ends too early: " + std::to_string(grid->rows) + " rows of " +
                 std::to_string(grid->columns) + " numbers are more than its bytes");
  grid->values.reserve(count);
  for (; !words.end() && grid->values.size() < count; words.next()) {
    if (equal_without_case(words.word(), "nan")) {
      grid->values.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const auto value = number_at(words, "a depth or a height");
    if (!value) return unexpected(value.error());
    grid->values.push_back(nodata && *value == *nodata ? std::numeric_limits<double>::quiet_NaN() : *value);
  }
  if (grid->values.size() < count)
    return fault(words.place() + "the file ends after " + std::to_string(grid->values.size()) + " numbers, expected " +
                 std::to_string(count));
  if (!words.end())
    return fault(words.place() + "more than the " + std::to_string(count) + " numbers of the grid: " + words.quoted());
  return grid;
}

}  // namespace glidehelm::ingest
