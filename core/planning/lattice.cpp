#include "core/planning/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "core/base/local_metric.hpp"

namespace glidehelm::planning {

namespace {

struct Range {
  double low, high;
};

/// Positions from `low` to `high` with one of them at `start`; `anchor` is its index.
struct Axis {
  std::vector<double> at;
  int anchor{};
};

double graded(double x, double start, double goal, double step) {
  const double off = std::min(std::abs(x - start), std::abs(x - goal));
  return std::clamp(0.5 * step + off / 8, 0.5 * step, 2 * step);
}

Axis axis(Range range, double start, double goal, double step, bool even) {
  Axis axis;
  const auto next = [&](double x) { return even ? step : graded(x, start, goal, step); };
  if (even) {
    const auto before = static_cast<int>(std::floor((start - range.low) / step));
    const auto after = static_cast<int>(std::floor((range.high - start) / step));
    for (int i = -before; i <= after; ++i) axis.at.push_back(start + i * step);
    axis.anchor = before;
    return axis;
  }
  for (double x = start - next(start); x >= range.low; x -= next(x)) axis.at.push_back(x);
  std::reverse(axis.at.begin(), axis.at.end());
  axis.anchor = static_cast<int>(axis.at.size());
  for (double x = start; x <= range.high; x += next(x)) axis.at.push_back(x);
  return axis;
}

/// Neighbours that a lattice step of p along the row and q rows up leads to: the ring they lie in.
int ring(int p, int q, bool triangles) {
  return triangles ? std::max({std::abs(p), std::abs(q), std::abs(p + q)}) : std::max(std::abs(p), std::abs(q));
}

}  // namespace

Lattice::Lattice(std::array<double, 2> start, std::array<double, 2> goal, double reach, double spacing,
                 const LatticeChoice& choice, const ocean::Coverage& coverage)
    : spacing_{spacing} {
  const double middle_lat = 0.5 * (start[0] + goal[0]), middle_lon = 0.5 * (start[1] + goal[1]);
  const auto metric = LocalMetric::at(middle_lat);
  const double lat_reach = reach / metric.meridian_radius;
  const double lon_reach = std::min(kPi, reach / std::max(1.0, metric.parallel_radius));
  Range lats{std::max({middle_lat - lat_reach, coverage.south, -0.4999 * kPi}),
             std::min({middle_lat + lat_reach, coverage.north, 0.4999 * kPi})};
  Range lons{middle_lon - lon_reach, middle_lon + lon_reach};
  if (coverage.east - coverage.west < 2 * kPi - 1e-9) {
    const double shift = 2 * kPi * std::round((middle_lon - 0.5 * (coverage.west + coverage.east)) / (2 * kPi));
    lons = {std::max(lons.low, coverage.west + shift), std::min(lons.high, coverage.east + shift)};
  }
  // The start belongs to the box, also where the numbers of its edge round.
  lats = {std::min(lats.low, start[0]), std::max(lats.high, start[0])};
  lons = {std::min(lons.low, start[1]), std::max(lons.high, start[1])};
  const bool triangles = choice.grid == GridKind::triangular, even = choice.grid != GridKind::irregular;
  const double area = (lats.high - lats.low) * metric.meridian_radius * (lons.high - lons.low) * metric.parallel_radius;
  // An irregular lattice has up to four times as many nodes.
  const double most = static_cast<double>(kMostNodes) / (even ? 1.3 : 4.0);
  spacing_ = std::max(spacing_, std::sqrt(area / most));
  const double lon_step = spacing_ / metric.parallel_radius;
  const double lat_step = (triangles ? std::sqrt(0.75) : 1.0) * spacing_ / metric.meridian_radius;
  auto north = axis(lats, start[0], goal[0], lat_step, even), east = axis(lons, start[1], goal[1], lon_step, even);
  lats_ = std::move(north.at);
  lons_ = std::move(east.at);
  start_row_ = north.anchor;
  start_column_ = east.anchor;
  half_ = triangles ? 0.5 * lon_step : 0.0;
  choose_steps(choice);
}

void Lattice::choose_steps(const LatticeChoice& choice) {
  const bool triangles = choice.grid == GridKind::triangular;
  const int base = choice.neighbours == 8 ? 1 : 2, wide = base * choice.radius;
  struct Offset2 {
    int p, q, ring;
  };
  std::vector<Offset2> offsets;
  for (int q = -wide; q <= wide; ++q)
    for (int p = -wide; p <= wide; ++p) {
      const int r = ring(p, q, triangles);
      const bool is_new = std::gcd(p, q) == 1, is_base = choice.neighbours == 24 && r <= base;
      if (r > 0 && r <= wide && (is_new || is_base)) offsets.push_back({p, q, r});
    }
  std::stable_sort(offsets.begin(), offsets.end(), [](const Offset2& a, const Offset2& b) { return a.ring < b.ring; });
  for (const auto& o : offsets) {
    if (!triangles) {
      for (auto& steps : steps_) steps.push_back({o.q, o.p});
    } else {
      // A node of a shifted row lies half a column further, and q rows up are q/2 columns along.
      for (const int from : {0, 1}) {
        const int to = (from + std::abs(o.q)) % 2;
        steps_[static_cast<std::size_t>(from)].push_back({o.q, o.p + (o.q + from - to) / 2});
      }
    }
    const double along = triangles ? o.p + 0.5 * o.q : o.p, up = triangles ? std::sqrt(0.75) * o.q : o.q;
    const double widest = choice.grid == GridKind::irregular ? 2 : 1;
    longest_step_ = std::max(longest_step_, widest * spacing_ * std::hypot(along, up));
  }
}

}  // namespace glidehelm::planning
