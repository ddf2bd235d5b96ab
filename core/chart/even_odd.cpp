#include "core/chart/even_odd.hpp"

namespace glidehelm::chart {

namespace {
bool level(const Outline& o, std::size_t i) { return o.edge[i] == Edge::none || o.plane[i].y == o.plane[i + 1].y; }
}  // namespace

std::size_t EvenOdd::band(double y) const {
  const auto last = static_cast<double>(first_.size() - 2);
  return static_cast<std::size_t>(std::clamp((y - south_) * bands_per_radian_, 0.0, last));
}

EvenOdd::EvenOdd(const Outline& outline) {
  if (outline.size() == 0) return;
  south_ = north_ = outline.plane[0].y;
  west_ = east_ = outline.plane[0].x;
  double heights = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& p = outline.plane[i];
    south_ = std::min(south_, p.y);
    north_ = std::max(north_, p.y);
    west_ = std::min(west_, p.x);
    east_ = std::max(east_, p.x);
    if (!level(outline, i)) heights += std::abs(outline.plane[i + 1].y - p.y);
  }
  // Few edges per band, and no more than 8 entries per edge even when all of them are tall.
  const auto edges = static_cast<double>(outline.size());
  const double height = north_ - south_;
  const double most = heights > 0 ? 7.0 * edges * (height / heights) : 1.0;
  const double bands = std::clamp(std::floor(std::min(edges / 8, most)), 1.0, 65536.0);
  bands_per_radian_ = height > 0 ? bands / height : 0;
  first_.assign(static_cast<std::size_t>(bands) + 1, 0);

  const auto for_each_band = [&](std::size_t i, const auto& act) {
    const double a = outline.plane[i].y, b = outline.plane[i + 1].y;
    for (std::size_t k = band(std::min(a, b)), last = band(std::max(a, b)); k <= last; ++k) act(k);
  };
  for (std::size_t i = 0; i < outline.size(); ++i)
    if (!level(outline, i)) for_each_band(i, [&](std::size_t k) { ++first_[k + 1]; });
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  edges_.resize(first_.back());
  auto next = first_;
  for (std::size_t i = 0; i < outline.size(); ++i)
    if (!level(outline, i)) for_each_band(i, [&](std::size_t k) { edges_[next[k]++] = static_cast<std::uint32_t>(i); });
}

bool EvenOdd::contains(const Outline& outline, Plane p) const {
  if (!(p.y >= south_ && p.y <= north_ && p.x >= west_ && p.x <= east_)) return false;
  const auto k = band(p.y);
  bool inside = false;
  for (std::size_t e = first_[k]; e < first_[k + 1]; ++e) {
    const auto& a = outline.plane[edges_[e]];
    const auto& b = outline.plane[edges_[e] + 1];
    const bool up = b.y > p.y;
    if ((a.y > p.y) == up) continue;
    // The ray runs east: an edge that goes up is met when p lies left of it, one that goes down when p lies right.
    if (up ? turn(a, b, p) > 0 : turn(a, b, p) < 0) inside = !inside;
  }
  return inside;
}

}  // namespace glidehelm::chart
