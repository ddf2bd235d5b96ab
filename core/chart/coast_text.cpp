#include <algorithm>
#include <charconv>
#include <cstdio>
#include <utility>

#include "core/base/hash.hpp"
#include "core/chart/coast.hpp"
#include "core/chart/coast_check.hpp"

namespace glidehelm::chart {

namespace {

constexpr std::string_view kFirstLine = "# glidehelm coast v1\n";
/// "0.0000000 0.0000000\n": no point takes fewer bytes, so a count of points can be checked before memory is taken.
constexpr std::size_t kShortestPoint = 20;

void append_degrees(std::string& text, std::int64_t units) {
  char digits[24];
  char* out = digits + sizeof digits;
  auto rest = static_cast<std::uint64_t>(units < 0 ? -units : units);
  for (int decimals = 0; decimals < 7; ++decimals, rest /= 10) *--out = static_cast<char>('0' + rest % 10);
  *--out = '.';
  do *--out = static_cast<char>('0' + rest % 10);
  while ((rest /= 10) != 0);
  if (units < 0) *--out = '-';
  text.append(out, digits + sizeof digits);
}

std::string end_line(std::size_t rings, std::size_t points, std::uint32_t crc) {
  char hex[12];
  std::snprintf(hex, sizeof hex, "%08x", static_cast<unsigned>(crc));
  return "end " + std::to_string(rings) + " " + std::to_string(points) + " crc32c " + hex + "\n";
}

std::size_t line_of(std::string_view bytes, std::size_t offset) {
  return 1 +
         static_cast<std::size_t>(std::count(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
}

/// A cursor over the bytes that remembers the first problem. After one, every step fails.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_{bytes} {}

  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] const std::optional<CoastError>& error() const { return error_; }

  bool fail(std::string problem) {
    if (!error_) error_ = CoastError{line_, at_ - line_start_ + 1, std::move(problem)};
    return false;
  }
  bool fail_at_line(std::size_t line, std::string problem) {
    if (!error_) error_ = CoastError{line, 0, std::move(problem)};
    return false;
  }

  [[nodiscard]] bool next_is(std::string_view word) const { return bytes_.substr(at_, word.size()) == word; }
  bool skip(std::string_view word) {
    if (!next_is(word)) return fail("expected \"" + std::string{word} + "\"");
    at_ += word.size();
    return true;
  }
  bool end_of_line() {
    if (left() == 0 || bytes_[at_] != '\n') return fail("expected the end of the line");
    ++line_;
    line_start_ = ++at_;
    return true;
  }
  bool rest_of_line(std::string_view& words) {
    const auto end = bytes_.find('\n', at_);
    if (end == std::string_view::npos) return fail("the line does not end");
    words = bytes_.substr(at_, end - at_);
    at_ = end;
    return true;
  }
  bool count(std::size_t& value) {
    const char* begin = bytes_.data() + at_;
    const auto [end, error] = std::from_chars(begin, bytes_.data() + bytes_.size(), value);
    if (error != std::errc{}) return fail("expected a count");
    at_ += static_cast<std::size_t>(end - begin);
    return true;
  }
  /// Degrees with one to three digits before the point and seven after it.
  bool degrees(std::int64_t& units) {
    auto p = at_;
    const bool negative = p < bytes_.size() && bytes_[p] == '-';
    if (negative) ++p;
    std::int64_t value = 0;
    const auto digits = [&](int most) {
      int n = 0;
      for (; n < most && p < bytes_.size() && bytes_[p] >= '0' && bytes_[p] <= '9'; ++n)
        value = value * 10 + (bytes_[p++] - '0');
      return n;
    };
    const bool whole = digits(3) > 0 && p < bytes_.size() && bytes_[p++] == '.' && digits(7) == 7;
    if (!whole) return fail("expected degrees with seven decimals");
    units = negative ? -value : value;
    at_ = p;
    return true;
  }

 private:
  std::string_view bytes_;
  std::size_t at_{}, line_{1}, line_start_{};
  std::optional<CoastError> error_;
};

class Reader {
 public:
  explicit Reader(std::string_view body) : cursor_{body} {}

  bool read() {
    if (!header()) return false;
    RingCheck check{area};
    while (cursor_.left() > 0) {
      const auto line = cursor_.line();
      rings.emplace_back();
      if (!ring(rings.back())) return false;
      if (auto fault = check.next(rings.back()))
        return cursor_.fail_at_line(line + 1 + fault->point, std::move(fault->problem));
      points += rings.back().points.size();
    }
    return true;
  }
  [[nodiscard]] const CoastError& error() const { return *cursor_.error(); }

  CoastArea area;
  std::string source;
  std::vector<CoastRing> rings;
  std::size_t points{};

 private:
  bool header() {
    if (!cursor_.skip(kFirstLine.substr(0, kFirstLine.size() - 1)) || !cursor_.end_of_line()) return false;
    if (!(cursor_.skip("area ") && cursor_.degrees(area.west) && cursor_.skip(" ") && cursor_.degrees(area.east) &&
          cursor_.skip(" ") && cursor_.degrees(area.south) && cursor_.skip(" ") && cursor_.degrees(area.north)))
      return false;
    if (auto problem = area.problem()) return cursor_.fail(std::move(*problem));
    std::string_view words;
    if (!(cursor_.end_of_line() && cursor_.skip("source ") && cursor_.rest_of_line(words))) return false;
    if (auto problem = problem_of_source(words)) return cursor_.fail(std::move(*problem));
    source = words;
    return cursor_.end_of_line();
  }

  bool ring(CoastRing& ring) {
    std::size_t count = 0;
    if (!(cursor_.skip("ring ") && cursor_.count(count))) return false;
    if (count > cursor_.left() / kShortestPoint) return cursor_.fail("more points than the file can hold");
    if (!cursor_.end_of_line()) return false;
    ring.points.reserve(count);
    ring.cut.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
      if (!point(ring)) return false;
    return true;
  }

  bool point(CoastRing& ring) {
    std::int64_t lon = 0, lat = 0;
    if (!(cursor_.degrees(lon) && cursor_.skip(" ") && cursor_.degrees(lat))) return false;
    // Before the numbers become narrow: whatever three digits can say is caught here.
    if (lon < area.west || lon > area.east || lat < area.south || lat > area.north)
      return cursor_.fail("lies outside the area");
    const bool cut = cursor_.next_is(" cut");
    if (cut) cursor_.skip(" cut");
    ring.points.push_back({static_cast<std::int32_t>(lon - area.west), static_cast<std::int32_t>(lat)});
    ring.cut.push_back(cut);
    return cursor_.end_of_line();
  }

  Cursor cursor_;
};

}  // namespace

std::string coast_degrees(std::int64_t units) {
  std::string text;
  append_degrees(text, units);
  return text;
}

std::string Coast::text() const {
  std::string text{kFirstLine};
  text.reserve(256 + 26 * points());
  text += "area " + coast_degrees(area_.west) + " " + coast_degrees(area_.east) + " " + coast_degrees(area_.south) +
          " " + coast_degrees(area_.north) + "\nsource " + source_ + "\n";
  for (const auto& ring : rings_) {
    text += "ring " + std::to_string(ring.points.size()) + "\n";
    for (std::size_t i = 0; i < ring.points.size(); ++i) {
      append_degrees(text, area_.west + ring.points[i].x);
      text += ' ';
      append_degrees(text, ring.points[i].y);
      text += ring.cut[i] ? " cut\n" : "\n";
    }
  }
  return text + end_line(rings_.size(), points(), crc32c(text));
}

Expected<std::shared_ptr<const Coast>, CoastError> Coast::parse(std::string_view bytes) {
  if (bytes.size() > kLargestFile) return unexpected(CoastError{0, 0, "a coast file has at most 1 GiB"});
  if (bytes.substr(0, kFirstLine.size()) != kFirstLine)
    return unexpected(CoastError{1, 1, "no coast file: it does not begin with \"# glidehelm coast v1\""});
  const auto body_size = bytes.back() == '\n' ? bytes.rfind('\n', bytes.size() - 2) + 1 : std::string_view::npos;
  if (body_size == std::string_view::npos || bytes.substr(body_size, 4) != "end ")
    return unexpected(CoastError{line_of(bytes, bytes.size() - 1), 0,
                                 "the last line does not begin with \"end\": the file is cut off"});
  const auto body = bytes.substr(0, body_size);
  Reader reader{body};
  if (!reader.read()) return unexpected(reader.error());
  // Counts and checksum in one comparison: there is one right last line.
  const auto right = end_line(reader.rings.size(), reader.points, crc32c(body));
  if (bytes.substr(body_size) != right)
    return unexpected(CoastError{
        line_of(bytes, body_size), 1,
        "the file was changed or damaged: by its content this line is \"" + right.substr(0, right.size() - 1) + "\""});
  return std::shared_ptr<const Coast>{new Coast{reader.area, std::move(reader.source), std::move(reader.rings)}};
}

}  // namespace glidehelm::chart
