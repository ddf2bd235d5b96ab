#include "daemon/ingest/plausible.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "core/base/utc.hpp"

namespace glidehelm::ingest {

namespace {

constexpr double kRefusedSpeed = 5.0, kWarnedSpeed = 3.5;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

std::string place_text(const ocean::GridAxes& axes, std::size_t node) {
  const std::size_t columns = axes.lons_deg.size(), rows = axes.lats_deg.size(), depths = axes.depths_m.size();
  const std::size_t i = node % columns, j = node / columns % rows, z = node / columns / rows % depths,
                    t = node / columns / rows / depths;
  std::string text = printed("%.4f, %.4f", axes.lats_deg[j], axes.lons_deg[i]);
  if (axes.has_depth) text += printed(", %.1f m", axes.depths_m[z], 0);
  if (axes.has_time) text += ", " + utc_text(instant_at(axes.times_s[t]));
  return text;
}

/// What is known of the times after one pass.
struct Seen {
  std::vector<std::size_t> kept;        ///< times with a value
  std::vector<std::string> zero_times;  ///< times with nothing but zeros
  bool all_zero{true};
};

/// Pairs the missing values and looks for times of zeros.
Seen look_at_times(ocean::Grid& grid) {
  auto& values = grid.values;
  const auto& axes = grid.axes;
  const std::size_t plane = axes.nodes() / axes.times_s.size();
  Seen seen;
  for (std::size_t t = 0; t < axes.times_s.size(); ++t) {
    bool any = false, zero = true;
    for (std::size_t n = t * plane; n < (t + 1) * plane; ++n) {
      float &east = values[2 * n], &north = values[2 * n + 1];
      if (std::isnan(east) || std::isnan(north)) {
        east = north = kNone;
        continue;
      }
      any = true;
      zero = zero && east == 0 && north == 0;
    }
    if (any) seen.kept.push_back(t);
    if (any && zero) seen.zero_times.push_back(axes.has_time ? utc_text(instant_at(axes.times_s[t])) : "its only time");
    seen.all_zero = seen.all_zero && (!any || zero);
  }
  return seen;
}

/// The blocks of still nodes of one level: `block[n]` is the number of the block, from 1, or 0; `sizes` counts them.
std::vector<std::uint32_t> blocks_of(std::vector<bool> still, std::size_t columns, std::vector<std::size_t>& sizes) {
  std::vector<std::uint32_t> block(still.size(), 0);
  std::vector<std::size_t> open;
  sizes.assign(1, 0);
  for (std::size_t first = 0; first < still.size(); ++first) {
    if (!still[first]) continue;
    sizes.push_back(0);
    open.assign(1, first);
    still[first] = false;
    while (!open.empty()) {
      const std::size_t n = open.back(), i = n % columns;
      open.pop_back();
      block[n] = static_cast<std::uint32_t>(sizes.size() - 1);
      ++sizes.back();
      const auto visit = [&](bool inside, std::size_t next) {
        if (!inside || !still[next]) return;
        still[next] = false;
        open.push_back(next);
      };
      visit(i > 0, n - 1);
      visit(i + 1 < columns, n + 1);
      visit(n >= columns, n - columns);
      visit(n + columns < still.size(), n + columns);
    }
  }
  return block;
}

/// Refuses what is too fast for a sea, and warns of what nearly is.
Result<Done> check_speeds(const ocean::Grid& grid, std::vector<std::string>& warnings) {
  const auto& axes = grid.axes;
  double squared = 0;  // of doubles made of floats: no overflow
  std::size_t fastest_node = 0;
  for (std::size_t n = 0; n < axes.nodes(); ++n) {
    const double east = grid.values[2 * n], north = grid.values[2 * n + 1];
    const double of_node = east * east + north * north;
    if (of_node > squared) squared = of_node, fastest_node = n;  // false for NaN
  }
  const double fastest = std::sqrt(squared);
  if (fastest > kRefusedSpeed)
    return fault("a current of " + printed("%.2f m/s", fastest, 0) + " at " + place_text(axes, fastest_node) +
                 ", allowed is at most 5 m/s (is the unit right?)");
  if (fastest > kWarnedSpeed)
    warnings.push_back("a current of " + printed("%.2f m/s", fastest, 0) + " at " + place_text(axes, fastest_node));
  return Done{};
}

/// The rows or columns of one component at one time and level.
struct Lines {
  std::size_t count, across;          ///< how many, and how many nodes each has
  std::size_t to_next, to_neighbour;  ///< steps in nodes from line to line, along a line
};

/// How many nodes of a line are zero here and are something else at the other time; none when the line has a number here.
std::optional<std::size_t> zeros_of(const float* here, const float* other, const Lines& lines, std::size_t line) {
  std::size_t lost = 0;
  for (std::size_t k = 0; k < lines.across; ++k) {
    const std::size_t at = 2 * (line * lines.to_next + k * lines.to_neighbour);
    if (here[at] != 0 && !std::isnan(here[at])) return std::nullopt;
    if (here[at] == 0 && other[at] != 0 && !std::isnan(other[at])) ++lost;
  }
  return lost;
}

/// How many lines at one end (the last ones, or the first) are zero, with enough lost nodes in them; 0 when not.
std::size_t zero_lines(const float* here, const float* other, const Lines& lines, bool last) {
  constexpr std::size_t kLostAtLeast = 16;
  std::size_t lost = 0, found = 0;
  for (; found < lines.count; ++found) {
    const auto more = zeros_of(here, other, lines, last ? lines.count - 1 - found : found);
    if (!more) break;
    lost += *more;
  }
  return lost >= kLostAtLeast ? found : 0;
}

}  // namespace

std::string unwritten_end(const ocean::Grid& grid) {
  const auto& axes = grid.axes;
  const std::size_t times = axes.times_s.size(), depths = axes.depths_m.size(), rows = axes.lats_deg.size(),
                    columns = axes.lons_deg.size(), level = rows * columns;
  const std::array<Lines, 2> ways{Lines{rows, columns, columns, 1}, Lines{columns, rows, 1, columns}};
  for (std::size_t t = 0; t < times; ++t)
    for (std::size_t z = 0; z < depths; ++z)
      for (std::size_t side = 0; side < 2; ++side) {
        const float* const here = grid.values.data() + 2 * (t * depths + z) * level + side;
        for (const std::size_t neighbour : {t - 1, t + 1}) {  // t - 1 of the first time wraps, and is none
          if (neighbour >= times) continue;
          const float* const other = grid.values.data() + 2 * (neighbour * depths + z) * level + side;
          for (std::size_t way = 0; way < 2; ++way)
            for (const bool last : {true, false})
              // A component that is zero all over may be one at rest, unless nothing comes after it.
              if (const auto found = zero_lines(here, other, ways[way], last);
                  found > 0 && (found < ways[way].count || t + 1 == times)) {
                const std::string where = way == 0 ? (last ? "northernmost" : "southernmost")
                                          : last   ? "easternmost"
                                                   : "westernmost";
                return "the " + std::string{side == 0 ? "eastward" : "northward"} + " current of the " +
                       std::to_string(found) + " " + where + " of " + std::to_string(ways[way].count) +
                       (way == 0 ? " rows" : " columns") +
                       (axes.has_depth ? printed(" at %.1f m", axes.depths_m[z], 0) : "") + " is exactly zero at " +
                       utc_text(instant_at(axes.times_s[t])) + ", and is not at " +
                       utc_text(instant_at(axes.times_s[neighbour])) + ": its writer probably ended there";
              }
        }
      }
  return {};
}

std::size_t zeros_to_land(ocean::Grid& grid) {
  const auto& axes = grid.axes;
  const std::size_t times = axes.times_s.size(), columns = axes.lons_deg.size();
  const std::size_t level = axes.lats_deg.size() * columns, plane = axes.nodes() / times;
  const std::size_t block_at_least = times >= 3 ? 4 : 9;
  std::size_t land = 0;
  std::vector<std::size_t> sizes;
  for (std::size_t z = 0; z < axes.depths_m.size(); ++z) {
    std::vector<bool> still(level, true);
    for (std::size_t n = 0; n < level; ++n) {
      bool zero = false;
      for (std::size_t t = 0; t < times && still[n]; ++t) {
        const float* at = grid.values.data() + 2 * (t * plane + z * level + n);
        if (std::isnan(at[0])) continue;
        zero = at[0] == 0 && at[1] == 0;
        still[n] = zero;
      }
      still[n] = still[n] && zero;
    }
    const auto block = blocks_of(std::move(still), columns, sizes);
    for (std::size_t n = 0; n < level; ++n) {
      if (block[n] == 0 || sizes[block[n]] < block_at_least) continue;
      ++land;
      for (std::size_t t = 0; t < times; ++t) {
        float* at = grid.values.data() + 2 * (t * plane + z * level + n);
        at[0] = at[1] = kNone;
      }
    }
  }
  return land;
}

Result<Done> make_plausible(ocean::Grid& grid, std::vector<std::string>& warnings) {
  const auto seen = look_at_times(grid);
  auto& values = grid.values;
  auto& axes = grid.axes;
  if (seen.kept.empty()) return fault("every value is missing");
  if (seen.all_zero)
    return fault("every value is exactly zero: no sea is that still, the file was probably never filled");
  if (!seen.zero_times.empty())
    return fault("every value at " + seen.zero_times.front() + " is exactly zero (" +
                 std::to_string(seen.zero_times.size()) + " of " + std::to_string(axes.times_s.size()) +
                 " times): the file is probably still being written");
  if (auto what = unwritten_end(grid); !what.empty()) return fault(std::move(what));
  if (const auto land = zeros_to_land(grid); land > 0)
    warnings.push_back(std::to_string(land) + " of " + std::to_string(axes.nodes() / axes.times_s.size()) +
                       " nodes stand exactly still at every time: taken as land");
  if (auto slow = check_speeds(grid, warnings); !slow) return slow;
  const auto& kept = seen.kept;
  if (kept.size() == axes.times_s.size()) return Done{};

  warnings.push_back(std::to_string(axes.times_s.size() - kept.size()) + " of " + std::to_string(axes.times_s.size()) +
                     " times have no value at all and are left out");
  const std::size_t plane = axes.nodes() / axes.times_s.size();
  for (std::size_t k = 0; k < kept.size(); ++k) {
    axes.times_s[k] = axes.times_s[kept[k]];
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(2 * plane * kept[k]), 2 * plane,
                values.begin() + static_cast<std::ptrdiff_t>(2 * plane * k));
  }
  axes.times_s.resize(kept.size());
  values.resize(2 * plane * kept.size());
  return Done{};
}

}  // namespace glidehelm::ingest
