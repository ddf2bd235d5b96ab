#include "daemon/ingest/join.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>

#include "core/base/utc.hpp"

namespace glidehelm::ingest {

namespace {

std::string base_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

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

/// Indices of the parts, newest first.
std::vector<std::size_t> newest_first(const std::vector<Part>& parts) {
  const bool referenced =
      std::all_of(parts.begin(), parts.end(), [](const Part& p) { return !std::isnan(p.grid.facts.reference_s); });
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t p) {
      const auto& grid = parts[p].grid;
      return std::tuple{referenced ? grid.facts.reference_s : 0.0, grid.axes.times_s.front(), p};
    };
    return key(a) > key(b);
  });
  return order;
}

struct Chosen {
  double time;
  std::size_t part, index;
};

std::vector<Chosen> choose_times(const std::vector<Part>& parts) {
  const auto order = newest_first(parts);
  std::vector<Chosen> chosen;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto& mine = parts[order[rank]].grid;
    for (std::size_t k = 0; k < mine.axes.times_s.size(); ++k) {
      const double time = mine.axes.times_s[k];
      const bool covered =
          std::any_of(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(rank), [&](std::size_t p) {
            const auto& newer = parts[p].grid;
            const auto& times = newer.axes.times_s;
            if (newer.facts.reference_s == mine.facts.reference_s)  // one cycle; false when either is not named
              return std::binary_search(times.begin(), times.end(), time);
            return time >= times.front() && time <= times.back();
          });
      if (!covered) chosen.push_back({time, order[rank], k});
    }
  }
  std::sort(chosen.begin(), chosen.end(), [](const Chosen& a, const Chosen& b) { return a.time < b.time; });
  return chosen;
}

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
    warnings.push_back(files.size() == 1 ? base_name(parts[files[0]].file) + ": " + text
                                         : std::to_string(files.size()) + " files: " + text);
  return warnings;
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

  const auto chosen = choose_times(parts);
  const auto& newest = parts[newest_first(parts).front()].grid;
  ocean::Grid grid{parts[0].grid.axes, newest.facts, {}};
  grid.facts.warnings = gathered_warnings(parts);
  grid.facts.sources.clear();
  for (const auto& part : parts)
    for (const auto& source : part.grid.facts.sources)  // a grid file belongs to many parts, and is named once
      if (std::find(grid.facts.sources.begin(), grid.facts.sources.end(), source) == grid.facts.sources.end())
        grid.facts.sources.push_back(source);
  grid.axes.times_s.clear();
  const std::size_t plane = 2 * grid.axes.depths_m.size() * grid.axes.lats_deg.size() * grid.axes.lons_deg.size();
  grid.values.reserve(plane * chosen.size());
  std::vector<bool> filled(plane / 2 * chosen.size(), false);
  for (const auto& time : chosen) {
    grid.axes.times_s.push_back(time.time);
    const auto from = parts[time.part].grid.values.begin() + static_cast<std::ptrdiff_t>(plane * time.index);
    grid.values.insert(grid.values.end(), from, from + static_cast<std::ptrdiff_t>(plane));
    // The plane's filled nodes, at their new place.
    const std::size_t first = plane / 2 * time.index, size = plane / 2;
    for (const auto& run : parts[time.part].grid.filled) {
      const auto begin = std::max<std::uint64_t>(run.first, first);
      const auto end = std::min<std::uint64_t>(run.first + run.length, first + size);
      for (auto n = begin; n < end; ++n) filled[n - first + (grid.axes.times_s.size() - 1) * size] = true;
    }
  }
  grid.filled = ocean::runs_of(filled);
  return grid;
}

}  // namespace glidehelm::ingest
