#include "core/chart/joined_areas.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace glidehelm::chart {

namespace {

constexpr auto kRound = static_cast<std::int64_t>(360 * kCoastUnitsPerDegree);

/// How far east of `west` a meridian lies, 0 to 360°.
std::int64_t east_of(std::int64_t west, std::int64_t meridian) {
  return ((meridian - west) % kRound + kRound) % kRound;
}

using Coasts = std::vector<std::shared_ptr<const Coast>>;

CoastArea box_from(const Coasts& coasts, std::int64_t west) {
  CoastArea box{west, west, coasts.front()->area().south, coasts.front()->area().north};
  for (const auto& coast : coasts) {
    const auto& a = coast->area();
    box.east = std::max(box.east, west + east_of(west, a.west) + a.width());
    box.south = std::min(box.south, a.south);
    box.north = std::max(box.north, a.north);
  }
  return box;
}

/// The narrowest box; it begins at the west of one of them.
CoastArea box_around(const Coasts& coasts) {
  CoastArea best = box_from(coasts, coasts.front()->area().west);
  for (const auto& coast : coasts)
    if (const auto box = box_from(coasts, coast->area().west); box.width() < best.width()) best = box;
  return best;
}

bool meet(const CoastArea& box, const CoastArea& a, const CoastArea& b) {
  const auto a_west = east_of(box.west, a.west), b_west = east_of(box.west, b.west);
  return a_west <= b_west + b.width() && b_west <= a_west + a.width() && a.south <= b.north && b.south <= a.north;
}

std::string words(const CoastArea& a) {
  return coast_degrees(a.west) + "/" + coast_degrees(a.east) + "/" + coast_degrees(a.south) + "/" +
         coast_degrees(a.north);
}

/// Marks the edges that run along the border of the box, and no others, as cut.
CoastRing in_box(std::vector<CoastPoint> points, const CoastArea& box) {
  CoastRing ring{std::move(points), {}};
  for (std::size_t i = 0; i < ring.points.size(); ++i) {
    const auto &p = ring.points[i], &q = ring.points[(i + 1) % ring.points.size()];
    const auto along = [](std::int64_t v, std::int64_t w, std::int64_t border) { return v == border && w == border; };
    ring.cut.push_back(along(p.x, q.x, 0) || along(p.x, q.x, box.width()) || along(p.y, q.y, box.south) ||
                       along(p.y, q.y, box.north));
  }
  return ring;
}

std::vector<CoastPoint> rectangle(std::int64_t west, std::int64_t east, std::int64_t south, std::int64_t north) {
  const auto w = static_cast<std::int32_t>(west), e = static_cast<std::int32_t>(east),
             s = static_cast<std::int32_t>(south), n = static_cast<std::int32_t>(north);
  return {{w, s}, {e, s}, {e, n}, {w, n}};
}

}  // namespace

Expected<std::shared_ptr<const Coast>, CoastError> joined_areas(const Coasts& coasts) {
  if (coasts.empty()) return unexpected(CoastError{0, 0, "there is no area"});
  if (coasts.size() == 1) return coasts.front();
  const auto box = box_around(coasts);
  if (box.width() > CoastArea::kWidest)
    return unexpected(CoastError{0, 0, "the areas lie more than 180 degrees apart: cut a coast file for each"});
  for (std::size_t i = 0; i < coasts.size(); ++i)
    for (std::size_t j = i + 1; j < coasts.size(); ++j)
      if (meet(box, coasts[i]->area(), coasts[j]->area()))
        return unexpected(CoastError{0, 0,
                                     "the areas " + words(coasts[i]->area()) + " and " + words(coasts[j]->area()) +
                                         " overlap or touch: give one area that holds both"});

  // Even-odd: the box is land, each area takes it away again, and its own rings make land inside.
  std::vector<CoastRing> rings{in_box(rectangle(0, box.width(), box.south, box.north), box)};
  for (const auto& coast : coasts) {
    const auto& a = coast->area();
    const auto shift = east_of(box.west, a.west);
    rings.push_back(in_box(rectangle(shift, shift + a.width(), a.south, a.north), box));
    for (const auto& ring : coast->rings()) {
      auto points = ring.points;
      for (auto& p : points) p.x += static_cast<std::int32_t>(shift);
      rings.push_back(in_box(std::move(points), box));
    }
  }
  return Coast::make(box, coasts.front()->source() + "; " + std::to_string(coasts.size()) + " areas", std::move(rings));
}

}  // namespace glidehelm::chart
