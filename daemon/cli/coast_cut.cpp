#include "daemon/cli/coast_cut.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace glidehelm::cli {

namespace {

constexpr std::int64_t kTurn = 3'600'000'000;

/// Two numbers that fill a line, with blanks between and around them.
std::optional<std::pair<double, double>> two_numbers(std::string_view line) {
  std::array<double, 2> values{};
  const char* at = line.data();
  const char* end = line.data() + line.size();
  const auto blanks = [&] {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
  };
  for (auto& value : values) {
    blanks();
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || !(std::abs(value) <= 720)) return std::nullopt;
    at = next;
  }
  blanks();
  if (at != end || std::abs(values[1]) > 90) return std::nullopt;
  return std::pair{values[0], values[1]};
}

bool is_closed(const ShoreLine& line) { return line.size() > 1 && line.front() == line.back(); }

/// The part of an edge inside the open box, as two parameters; nothing when there is none (Liang and Barsky).
std::optional<std::pair<double, double>> part_inside(const ShorePoint& a, const ShorePoint& b,
                                                     const chart::CoastArea& area) {
  const auto dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y);
  const std::array<double, 4> p{-dx, dx, -dy, dy};
  const std::array<double, 4> q{static_cast<double>(a.x), static_cast<double>(area.width() - a.x),
                                static_cast<double>(a.y - area.south), static_cast<double>(area.north - a.y)};
  double from = 0, to = 1;
  for (std::size_t k = 0; k < 4; ++k) {
    if (p[k] == 0) {
      if (q[k] <= 0) return std::nullopt;  // along or beyond this side
    } else if (p[k] < 0) {
      from = std::max(from, q[k] / p[k]);
    } else {
      to = std::min(to, q[k] / p[k]);
    }
  }
  if (!(from < to)) return std::nullopt;
  return std::pair{from, to};
}

/// The point at `t` of an edge, put exactly onto the side of the border that it meets.
ShorePoint on_border(const ShorePoint& a, const ShorePoint& b, double t, const chart::CoastArea& area) {
  const auto at = [&](std::int64_t from, std::int64_t to) {
    return from + std::llround(t * static_cast<double>(to - from));
  };
  ShorePoint p{std::clamp<std::int64_t>(at(a.x, b.x), 0, area.width()),
               std::clamp<std::int64_t>(at(a.y, b.y), area.south, area.north)};
  // Rounding may leave it one unit short of the side: the nearest side is the one.
  const std::array<std::int64_t, 4> off{p.x, area.width() - p.x, p.y - area.south, area.north - p.y};
  switch (std::min_element(off.begin(), off.end()) - off.begin()) {
    case 0:
      p.x = 0;
      break;
    case 1:
      p.x = area.width();
      break;
    case 2:
      p.y = area.south;
      break;
    default:
      p.y = area.north;
  }
  return p;
}

}  // namespace

Expected<Done, std::string> read_shore_lines(std::string_view text, const chart::CoastArea& area,
                                             std::vector<ShoreLine>& lines) {
  bool begun = false;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const auto line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '>') {
      begun = false;
      continue;
    }
    const auto degrees = two_numbers(line);
    if (!degrees)
      return unexpected("line " + std::to_string(number) + " is no longitude and latitude: '" +
                        std::string{line.substr(0, 60)} + "'");
    if (!begun) lines.emplace_back();
    begun = true;
    auto x = (std::llround(degrees->first * chart::kCoastUnitsPerDegree) - area.west) % kTurn;
    if (x < 0) x += kTurn;
    if (x >= kTurn / 4 * 3) x -= kTurn;
    lines.back().push_back({x, std::llround(degrees->second * chart::kCoastUnitsPerDegree)});
  }
  return Done{};
}

std::vector<ShoreLine> joined(const std::vector<ShoreLine>& pieces) {
  struct End {
    ShorePoint at;
    std::size_t piece;
    bool last;
    auto operator<=>(const End&) const = default;
  };
  std::vector<End> ends;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (pieces[i].size() > 1 && !is_closed(pieces[i])) {
      ends.push_back({pieces[i].front(), i, false});
      ends.push_back({pieces[i].back(), i, true});
    }
  std::sort(ends.begin(), ends.end());
  // Two ends at one place belong together: partner[2 i] is the partner of the first point of piece i, [2 i + 1] of the last.
  constexpr std::size_t kNone = ~std::size_t{0};
  const auto index = [](const End& e) { return 2 * e.piece + (e.last ? 1 : 0); };
  std::vector<std::size_t> partner(2 * pieces.size(), kNone);
  for (std::size_t k = 0; k + 1 < ends.size(); ++k)
    if (ends[k].at == ends[k + 1].at) {
      partner[index(ends[k])] = index(ends[k + 1]);
      partner[index(ends[k + 1])] = index(ends[k]);
      ++k;
    }

  std::vector<ShoreLine> lines;
  std::vector<bool> used(pieces.size(), false);
  const auto follow = [&](std::size_t entry) {
    // `entry` is the end at which the first piece is entered; each piece is left at its other end.
    ShoreLine line;
    while (entry != kNone && !used[entry / 2]) {
      const auto& piece = pieces[entry / 2];
      used[entry / 2] = true;
      const std::ptrdiff_t skip = line.empty() ? 0 : 1;  // the shared point stands once
      if (entry % 2 == 0)
        line.insert(line.end(), piece.begin() + skip, piece.end());
      else
        line.insert(line.end(), piece.rbegin() + skip, piece.rend());
      entry = partner[entry ^ 1U];
    }
    lines.push_back(std::move(line));
  };
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].size() < 2 || used[i]) continue;
    if (is_closed(pieces[i])) {
      used[i] = true;
      lines.push_back(pieces[i]);
    } else if (partner[2 * i] == kNone) {
      follow(2 * i);
    } else if (partner[2 * i + 1] == kNone) {
      follow(2 * i + 1);
    }
  }
  // What is left has a partner at both ends everywhere: closed lines made of several pieces.
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (pieces[i].size() > 1 && !used[i]) follow(2 * i);
  return lines;
}

bool CoastCut::inside(const ShorePoint& p) const {
  return p.x > 0 && p.x < area_.width() && p.y > area_.south && p.y < area_.north;
}

std::int64_t CoastCut::along(const ShorePoint& p) const {
  const auto w = area_.width(), h = area_.height();
  if (p.y == area_.south) return p.x;
  if (p.x == w) return w + (p.y - area_.south);
  if (p.y == area_.north) return w + h + (w - p.x);
  return 2 * w + h + (area_.north - p.y);
}

ShorePoint CoastCut::border_point(std::int64_t at, std::int64_t inwards) const {
  const auto w = area_.width(), h = area_.height();
  at = ((at % border_length()) + border_length()) % border_length();
  ShorePoint p;
  if (at <= w)
    p = {at, area_.south};
  else if (at <= w + h)
    p = {w, area_.south + (at - w)};
  else if (at <= 2 * w + h)
    p = {w - (at - w - h), area_.north};
  else
    p = {0, area_.north - (at - 2 * w - h)};
  return {std::clamp(p.x, inwards, w - inwards), std::clamp(p.y, area_.south + inwards, area_.north - inwards)};
}

void CoastCut::add_edge(const ShorePoint& a, const ShorePoint& b, ShoreLine& current) {
  const bool ends_inside = inside(b);
  if (inside(a)) {
    current.push_back(
        ends_inside ? b : on_border(a, b, part_inside(a, b, area_).value_or(std::pair{0.0, 1.0}).second, area_));
  } else {
    const auto part = part_inside(a, b, area_);
    if (!part && !ends_inside) return;
    current = {on_border(a, b, part ? part->first : 1.0, area_),
               ends_inside ? b : on_border(a, b, part->second, area_)};
  }
  if (!ends_inside) lines_.push_back(std::move(current));
}

void CoastCut::add(const ShoreLine& line) {
  const auto first_outside =
      std::find_if(line.begin(), line.end(), [&](const ShorePoint& p) { return !inside(p); }) - line.begin();
  if (first_outside == static_cast<std::ptrdiff_t>(line.size())) {
    closed_.push_back(line);
    closed_.back().pop_back();
    return;
  }
  // A closed line is walked from a point outside, so that no inner line begins in its middle; an open one begins there.
  const auto start = is_closed(line) ? static_cast<std::size_t>(first_outside) : 0;
  const auto count = line.size() - 1;
  ShoreLine current;
  for (std::size_t k = 0; k < count; ++k)
    add_edge(line[(start + k) % count], start + k + 1 == count ? line[count] : line[(start + k + 1) % count], current);
}

void CoastCut::sort_crossings() {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    crossings_.push_back({along(lines_[i].front()), i, false});
    crossings_.push_back({along(lines_[i].back()), i, true});
  }
  std::sort(crossings_.begin(), crossings_.end(), [](const Crossing& a, const Crossing& b) {
    return std::pair{a.along, 2 * a.line + (a.at_end ? 1 : 0)} < std::pair{b.along, 2 * b.line + (b.at_end ? 1 : 0)};
  });
  if (crossings_.empty()) stretches_ = {{0, border_length()}};
  for (std::size_t k = 0; k < crossings_.size(); ++k) {
    const bool last = k + 1 == crossings_.size();
    const auto next = last ? crossings_[0].along + border_length() : crossings_[k + 1].along;
    stretches_.push_back({crossings_[k].along, next - crossings_[k].along});
  }
}

Expected<CoastCut, std::string> CoastCut::make(const chart::CoastArea& area, const std::vector<ShoreLine>& lines) {
  CoastCut cut{area};
  for (const auto& line : lines) {
    if (line.size() < 2) continue;
    if (!is_closed(line))
      for (const auto& end : {line.front(), line.back()})
        if (cut.inside(end))
          return unexpected("a shoreline ends in the middle of the area, at " + chart::coast_degrees(end.y) + ", " +
                            chart::coast_degrees(area.west + end.x));
    cut.add(line);
  }
  cut.sort_crossings();
  return cut;
}

/// Collects the points of one ring and whether the edge that each begins is a cut edge.
struct CoastCut::Builder {
  std::vector<ShorePoint> points;
  std::vector<bool> cut;

  void add(const ShorePoint& p, bool edge_is_cut) {
    // An edge of no length goes, with its first point.
    if (!points.empty() && points.back() == p) {
      points.pop_back();
      cut.pop_back();
    }
    points.push_back(p);
    cut.push_back(edge_is_cut);
  }

  void finish(std::vector<chart::CoastRing>& rings) {
    while (points.size() > 1 && points.front() == points.back()) {
      points.pop_back();
      cut.pop_back();
    }
    if (points.size() < 3) return;
    chart::CoastRing ring;
    for (const auto& p : points)
      ring.points.push_back({static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y)});
    ring.cut = std::move(cut);
    rings.push_back(std::move(ring));
  }
};

std::vector<chart::CoastRing> CoastCut::rings(bool even_stretches_are_land) const {
  std::vector<chart::CoastRing> rings;
  for (const auto& line : closed_) {
    Builder ring;
    for (const auto& p : line) ring.add(p, false);
    ring.finish(rings);
  }
  const auto w = area_.width(), h = area_.height();
  const std::array<std::int64_t, 4> corners{0, w, w + h, 2 * w + h};
  if (crossings_.empty()) {
    Builder ring;
    if (even_stretches_are_land)
      for (const auto corner : corners) ring.add(border_point(corner, 0), true);
    ring.finish(rings);
    return rings;
  }

  const auto n = crossings_.size();
  std::vector<std::size_t> first(lines_.size()), last(lines_.size());  // crossing of each line's ends
  for (std::size_t k = 0; k < n; ++k) (crossings_[k].at_end ? last : first)[crossings_[k].line] = k;
  // The corners that a stretch passes, in its order.
  const auto corners_of = [&](const BorderStretch& s) {
    std::vector<std::int64_t> passed;
    for (const std::int64_t turn : {std::int64_t{0}, border_length()})
      for (const auto corner : corners)
        if (corner + turn > s.from && corner + turn < s.from + s.length) passed.push_back(corner);
    return passed;
  };
  std::vector<bool> used(lines_.size(), false);
  for (std::size_t begin = 0; begin < lines_.size(); ++begin) {
    if (used[begin]) continue;
    Builder ring;
    for (std::size_t entry = first[begin]; !used[crossings_[entry].line];) {
      // Along the line to its other end …
      const auto& line = lines_[crossings_[entry].line];
      used[crossings_[entry].line] = true;
      const bool backwards = crossings_[entry].at_end;
      for (std::size_t i = 0; i < line.size(); ++i)
        ring.add(line[backwards ? line.size() - 1 - i : i], i + 1 == line.size());
      // … and along the stretch of land that begins or ends there to the next line.
      const auto left_at = (backwards ? first : last)[crossings_[entry].line];
      const bool onwards = (left_at % 2 == 0) == even_stretches_are_land;
      const auto stretch = onwards ? left_at : (left_at + n - 1) % n;
      auto passed = corners_of(stretches_[stretch]);
      if (!onwards) std::reverse(passed.begin(), passed.end());
      for (const auto corner : passed) ring.add(border_point(corner, 0), true);
      entry = onwards ? (left_at + 1) % n : stretch;
    }
    ring.finish(rings);
  }
  return rings;
}

}  // namespace glidehelm::cli
