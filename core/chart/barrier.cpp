#include "core/chart/barrier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glidehelm::chart {

namespace {

constexpr std::uint32_t kRun = 8;
/// The tree halves its runs, of which there are fewer than 2³²: no stack grows deeper.
constexpr std::size_t kDeepest = 64;

float below(double v) { return std::nextafter(static_cast<float>(v), -std::numeric_limits<float>::infinity()); }
float above(double v) { return std::nextafter(static_cast<float>(v), std::numeric_limits<float>::infinity()); }

void widen(Space& low, Space& high, const Space& p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

double gap(double low, double high, double v) { return std::max({low - v, v - high, 0.0}); }
double gap(double low, double high, double v, double w) {
  return std::max({low - std::max(v, w), std::min(v, w) - high, 0.0});
}

}  // namespace

std::vector<Barrier::Run> Barrier::runs_of(const Outline& outline) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < outline.size();) {
    if (outline.edge[i] != Edge::barrier) {
      ++i;
      continue;
    }
    Run run{outline.space[i], outline.space[i], static_cast<std::uint32_t>(i), 0};
    for (; run.count < kRun && outline.edge[i] == Edge::barrier; ++i, ++run.count)
      widen(run.low, run.high, outline.space[i + 1]);
    runs.push_back(run);
  }
  return runs;
}

Barrier::Barrier(const Outline& outline) {
  auto runs = runs_of(outline);
  if (runs.empty()) return;
  nodes_.reserve(2 * runs.size());
  build(runs, 0, runs.size());
}

void Barrier::build(std::vector<Run>& runs, std::size_t begin, std::size_t end) {
  Space low = runs[begin].low, high = runs[begin].high;
  for (std::size_t i = begin; i < end; ++i) {
    widen(low, high, runs[i].low);
    widen(low, high, runs[i].high);
  }
  const auto here = nodes_.size();
  nodes_.push_back({{below(low.x), below(low.y), below(low.z)}, {above(high.x), above(high.y), above(high.z)}, 0, 0});
  if (end - begin == 1) {
    nodes_[here].next = runs[begin].first;
    nodes_[here].count = runs[begin].count;
    return;
  }
  const Space size = high - low;
  const auto middle_of = [&](const Run& r) {
    if (size.x >= size.y && size.x >= size.z) return r.low.x + r.high.x;
    return size.y >= size.z ? r.low.y + r.high.y : r.low.z + r.high.z;
  };
  const auto half = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return runs.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(half), at(end), [&](const Run& a, const Run& b) {
    const double x = middle_of(a), y = middle_of(b);
    return x != y ? x < y : a.first < b.first;
  });
  build(runs, begin, half);
  nodes_[here].next = static_cast<std::uint32_t>(nodes_.size());
  build(runs, half, end);
}

double Barrier::distance(const Outline& outline, const Space& p, double at_most) const {
  if (nodes_.empty()) return at_most;
  struct Waiting {
    std::uint32_t node;
    double near2;
  };
  const auto near2 = [&](const Node& n) {
    const double x = gap(n.low[0], n.high[0], p.x), y = gap(n.low[1], n.high[1], p.y),
                 z = gap(n.low[2], n.high[2], p.z);
    return x * x + y * y + z * z;
  };
  std::array<Waiting, kDeepest> stack;
  std::size_t waiting = 0;
  double best = at_most * at_most;
  stack[waiting++] = {0, near2(nodes_[0])};
  while (waiting > 0) {
    const auto [index, lower] = stack[--waiting];
    if (lower >= best) continue;
    const auto& node = nodes_[index];
    if (node.count > 0) {
      for (std::uint32_t i = node.next; i < node.next + node.count; ++i)
        best = std::min(best, squared_distance(p, outline.space[i], outline.space[i + 1]));
      continue;
    }
    // The nearer child last, so that it is taken first and spares the other.
    Waiting one{index + 1, near2(nodes_[index + 1])}, other{node.next, near2(nodes_[node.next])};
    if (one.near2 < other.near2) std::swap(one, other);
    if (one.near2 < best) stack[waiting++] = one;
    if (other.near2 < best) stack[waiting++] = other;
  }
  return std::min(at_most, std::sqrt(best));
}

bool Barrier::touches(const Outline& outline, const Piece& piece, double margin) const {
  if (nodes_.empty()) return false;
  // Chords that cross on the surface may pass each other in space by their sag, up to 0.1 m each.
  const double reach2 = (margin + 1.0) * (margin + 1.0), margin2 = margin * margin;
  const auto& a = piece.from;
  const auto& b = piece.to;
  std::array<std::uint32_t, kDeepest> stack;
  std::size_t waiting = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const auto index = stack[--waiting];
    const auto& n = nodes_[index];
    const double x = gap(n.low[0], n.high[0], a.x, b.x), y = gap(n.low[1], n.high[1], a.y, b.y),
                 z = gap(n.low[2], n.high[2], a.z, b.z);
    if (x * x + y * y + z * z > reach2) continue;
    if (n.count == 0) {
      stack[waiting++] = n.next;
      stack[waiting++] = index + 1;
      continue;
    }
    for (std::uint32_t i = n.next; i < n.next + n.count; ++i) {
      // Two pieces that do not cross are nearest to each other at an end of one of them.
      if (cross(piece.a, piece.b, outline.plane[i], outline.plane[i + 1])) return true;
      const auto& c = outline.space[i];
      const auto& d = outline.space[i + 1];
      if (squared_distance(a, c, d) < margin2 || squared_distance(b, c, d) < margin2 ||
          squared_distance(c, a, b) < margin2 || squared_distance(d, a, b) < margin2)
        return true;
    }
  }
  return false;
}

}  // namespace glidehelm::chart
