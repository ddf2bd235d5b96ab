#include "daemon/ingest/join.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"

namespace glidehelm::ingest {

namespace {

Result<Done> same_axis(const std::vector<double>& a, const std::vector<double>& b, const char* name, const Part& first,
                       const Part& other) {
  const auto differs = [&](const std::string& how) {
    return fault(std::string{"its "} + name + " differ from those of " + first.file + " (" + how +
                 "); files that are joined lie on the same grid");
  };
  if (a.size() != b.size()) return differs(std::to_string(b.size()) + " against " + std::to_string(a.size()));
  (void)other;
  const double cell = a.size() > 1 ? (a.back() - a.front()) / static_cast<double>(a.size() - 1) : 1.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (std::abs(a[k] - b[k]) > 1e-4 * std::abs(cell)) {
      char how[96];
      std::snprintf(how, sizeof how, "index %zu: %.6g against %.6g", k, b[k], a[k]);
      return differs(how);
    }
  return Done{};
}

Result<Done> same_grid(const Part& first, const Part& other) {
  const auto &a = first.grid.axes, &b = other.grid.axes;
  if (!a.has_time || !b.has_time)
    return fault("it " + std::string{b.has_time ? "has times, " + first.file + " has none" : "has no time axis"} +
                 "; several files are joined by their times");
  for (const auto& [x, y, name] :
       {std::tuple{&a.depths_m, &b.depths_m, "depths"}, std::tuple{&a.lats_deg, &b.lats_deg, "latitudes"},
        std::tuple{&a.lons_deg, &b.lons_deg, "longitudes"}})
    if (auto same = same_axis(*x, *y, name, first, other); !same) return same;
  return Done{};
}

/// Indices of the parts, oldest first.
std::vector<std::size_t> oldest_first(const std::vector<Part>& parts) {
  const bool referenced =
      std::all_of(parts.begin(), parts.end(), [](const Part& p) { return !std::isnan(p.grid.facts.reference_s); });
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t p) {
      const auto& grid = parts[p].grid;
      return std::tuple{referenced ? grid.facts.reference_s : 0.0, grid.axes.times_s.front(), p};
    };
    return key(a) < key(b);
  });
  return order;
}

/// One time of the joined grid: where its numbers stand, and the part and time whose marks of filled nodes count.
struct Slice {
  double time;
  const float* values;
  std::size_t part, index;
};
using Slices = std::vector<Slice>;  // by time, ascending

/// Cycles laid over each other, the oldest first.
class Joint {
 public:
  explicit Joint(std::size_t plane) : plane_{plane} {}
  /// Puts a part of the newest cycle so far (`same_cycle`) or of the next newer one on top.
  void add(const Part& part, std::size_t number, bool same_cycle) {
    if (!same_cycle) lay_over();
    Slices more;
    for (std::size_t k = 0; k < part.grid.axes.times_s.size(); ++k)
      more.push_back({part.grid.axes.times_s[k], part.grid.values.data() + plane_ * k, number, k});
    // Of equal times of one cycle the later part's counts.
    std::erase_if(top_, [&](const Slice& old) {
      return std::any_of(more.begin(), more.end(), [&](const Slice& s) { return s.time == old.time; });
    });
    top_.insert(top_.end(), more.begin(), more.end());
    std::sort(top_.begin(), top_.end(), earlier);
  }
  const Slices& finish() {
    lay_over();
    return under_;
  }

 private:
  static bool earlier(const Slice& a, const Slice& b) { return a.time < b.time; }

  /// The top cycle takes over from what lies under it, and gives back to it where that goes on for longer.
  void lay_over() {
    if (top_.empty()) return;
    if (!under_.empty()) {
      const double first = top_.front().time, last = top_.back().time;
      const double overlap = std::min(last, under_.back().time) - std::max(first, under_.front().time);
      const double length = std::min(kJoin_s, overlap);
      for (auto& slice : top_) {
        double weight = 1;
        if (length > 0 && under_.front().time < first) weight *= smooth((slice.time - first) / length);
        if (length > 0 && under_.back().time > last) weight *= smooth((last - slice.time) / length);
        if (weight < 1) slice.values = mixed(slice, weight);
      }
      Slices all;
      std::copy_if(under_.begin(), under_.end(), std::back_inserter(all),
                   [&](const Slice& s) { return s.time < first || s.time > last; });
      all.insert(all.end(), top_.begin(), top_.end());
      std::sort(all.begin(), all.end(), earlier);
      top_ = std::move(all);
    }
    under_ = std::move(top_);
    top_.clear();
  }

  static double smooth(double x) {
    x = std::clamp(x, 0.0, 1.0);
    return x * x * (3 - 2 * x);
  }

  /// A slice with `weight`, the rest from what lies under it at the same time. Where one of the two has no value the slice's own stays.
  const float* mixed(const Slice& slice, double weight) {
    const auto next = std::lower_bound(under_.begin(), under_.end(), slice, earlier);
    if (next == under_.end() || (next == under_.begin() && next->time != slice.time)) return slice.values;
    const auto before = next->time == slice.time ? next : next - 1;
    const double way = before == next ? 0 : (slice.time - before->time) / (next->time - before->time);
    auto& values = made_.emplace_back(plane_);
    for (std::size_t i = 0; i < plane_; ++i) {
      const double old = way > 0 ? before->values[i] + way * (static_cast<double>(next->values[i]) - before->values[i])
                                 : before->values[i];
      const double own = slice.values[i], both = old + weight * (own - old);
      values[i] = std::isnan(both) || own == old ? slice.values[i] : static_cast<float>(both);
    }
    return values.data();
  }

  static constexpr double kJoin_s = 6 * 3600.0;
  std::size_t plane_;  ///< floats of one time
  Slices under_, top_;
  std::deque<std::vector<float>> made_;
};

/// Beyond rounding by any packing: two files of one run cannot differ so.
constexpr double kContradiction = 0.05;  // m/s

/// Where two parts of one named run say something else about the same time; empty when they agree.
std::string contradiction(const Part& a, const Part& b) {
  const auto &x = a.grid, &y = b.grid;
  if (x.facts.reference_s != y.facts.reference_s) return {};  // also when one is not named
  const std::size_t plane = x.values.size() / x.axes.times_s.size();
  for (std::size_t k = 0; k < y.axes.times_s.size(); ++k) {
    const double time = y.axes.times_s[k];
    const auto same = std::lower_bound(x.axes.times_s.begin(), x.axes.times_s.end(), time);
    if (same == x.axes.times_s.end() || *same != time) continue;
    const float* mine = x.values.data() + plane * static_cast<std::size_t>(same - x.axes.times_s.begin());
    const float* other = y.values.data() + plane * k;
    double worst = 0;
    for (std::size_t i = 0; i < plane; ++i)
      worst = std::max(worst, std::abs(static_cast<double>(mine[i]) - static_cast<double>(other[i])));  // false for NaN
    if (worst > kContradiction) {
      char how[160];
      std::snprintf(how, sizeof how, ": they are of one model run and differ by up to %.2f m/s at ", worst);
      return a.file + " and " + b.file + " contradict each other" + how + utc_text(instant_at(time));
    }
  }
  return {};
}

/// Every warning once, with the file it came from, or how many files said the same.
std::vector<std::string> gathered_warnings(const std::vector<Part>& parts) {
  std::vector<std::pair<std::string, std::vector<std::size_t>>> by_text;
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const auto& text : parts[p].grid.facts.warnings) {
      auto at = std::find_if(by_text.begin(), by_text.end(), [&](const auto& entry) { return entry.first == text; });
      if (at == by_text.end()) at = by_text.insert(by_text.end(), {text, {}});
      at->second.push_back(p);
    }
  std::vector<std::string> warnings;
  for (const auto& [text, files] : by_text)
    warnings.push_back(files.size() == 1 ? std::string{base_name(parts[files[0]].file)} + ": " + text
                                         : std::to_string(files.size()) + " files: " + text);
  return warnings;
}

/// The mean of the parts' columns, each counting for its times, down to where the shortest ends; those without one do not count.
ocean::GridWater joined_water(const std::vector<Part>& parts) {
  ocean::GridWater joined;
  double all = 0;
  std::size_t counted = 0;
  for (const auto& part : parts) {
    const auto& water = part.grid.facts.water;
    if (water.layers.empty()) {
      if (all == 0 && joined.words.empty()) joined.words = water.words;
      continue;
    }
    ++counted;
    const auto times = static_cast<double>(part.grid.axes.times_s.size());
    all += times;
    if (all == times) {
      joined = water;
      continue;
    }
    auto& layers = joined.layers;
    layers.resize(std::min(layers.size(), water.layers.size()));
    for (std::size_t k = 0; k < layers.size(); ++k) {
      layers[k].temperature_c += times / all * (water.layers[k].temperature_c - layers[k].temperature_c);
      layers[k].salinity += times / all * (water.layers[k].salinity - layers[k].salinity);
    }
  }
  if (counted > 1) joined.words += "; the mean of " + std::to_string(counted) + " such files";
  return joined;
}

}  // namespace

Result<ocean::Grid> join(std::vector<Part> parts) {
  if (parts.size() == 1) {
    parts[0].grid.facts.warnings = gathered_warnings(parts);
    return std::move(parts[0].grid);
  }
  for (std::size_t p = 1; p < parts.size(); ++p)
    if (auto same = same_grid(parts[0], parts[p]); !same) return fault(parts[p].file + ": " + same.error().what);

  for (std::size_t p = 0; p < parts.size(); ++p)
    for (std::size_t q = p + 1; q < parts.size(); ++q)
      if (auto what = contradiction(parts[p], parts[q]); !what.empty()) return fault(std::move(what));

  const auto order = oldest_first(parts);
  ocean::Grid grid{parts[0].grid.axes, parts[order.back()].grid.facts, {}};
  grid.facts.warnings = gathered_warnings(parts);
  grid.facts.water = joined_water(parts);
  grid.facts.sources.clear();
  for (const auto& part : parts)
    for (const auto& source : part.grid.facts.sources)  // a grid file belongs to many parts, and is named once
      if (std::find(grid.facts.sources.begin(), grid.facts.sources.end(), source) == grid.facts.sources.end())
        grid.facts.sources.push_back(source);
  grid.axes.times_s.clear();
  const std::size_t plane = 2 * grid.axes.depths_m.size() * grid.axes.lats_deg.size() * grid.axes.lons_deg.size();
  Joint joint{plane};
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto& part = parts[order[k]];  // unnamed reference times are equal to none
    joint.add(part, order[k], k > 0 && part.grid.facts.reference_s == parts[order[k - 1]].grid.facts.reference_s);
  }
  const auto& chosen = joint.finish();
  grid.values.reserve(plane * chosen.size());
  std::vector<bool> filled(plane / 2 * chosen.size(), false);
  for (const auto& slice : chosen) {
    grid.axes.times_s.push_back(slice.time);
    grid.values.insert(grid.values.end(), slice.values, slice.values + plane);
    // The plane's filled nodes, at their new place.
    const std::size_t first = plane / 2 * slice.index, size = plane / 2;
    for (const auto& run : parts[slice.part].grid.filled) {
      const auto begin = std::max<std::uint64_t>(run.first, first);
      const auto end = std::min<std::uint64_t>(run.first + run.length, first + size);
      for (auto n = begin; n < end; ++n) filled[n - first + (grid.axes.times_s.size() - 1) * size] = true;
    }
  }
  grid.filled = ocean::runs_of(filled);
  return grid;
}

}  // namespace glidehelm::ingest
