#include "core/chart/coast_check.hpp"

#include <algorithm>

namespace glidehelm::chart {

std::optional<std::string> CoastArea::problem() const {
  if (west < kWest || west >= -kWest) return "west " + coast_degrees(west) + " is not in [-180, 180)";
  if (south < -kFarthest || north > kFarthest) return "the area reaches beyond 85 degrees north or south";
  if (east <= west || east - west > kWidest)
    return "east " + coast_degrees(east) + " is not between west and west + 180 degrees";
  if (north <= south) return "north " + coast_degrees(north) + " is not north of south";
  return std::nullopt;
}

bool RingCheck::on_border(const CoastPoint& a, const CoastPoint& b) const {
  const auto both = [](std::int32_t v, std::int32_t w, std::int64_t border) { return v == border && w == border; };
  return both(a.x, b.x, 0) || both(a.x, b.x, area_.width()) || both(a.y, b.y, area_.south) ||
         both(a.y, b.y, area_.north);
}

std::optional<RingFault> RingCheck::next(const CoastRing& ring) {
  const auto n = ring.points.size();
  if (n < 3) return RingFault{0, "a ring has at least three points"};
  if (ring.cut.size() != n) return RingFault{0, "the cut marks are not as many as the points"};
  const double k = kPi / (180.0 * kCoastUnitsPerDegree);
  for (std::size_t i = 0; i < n; ++i) {
    const auto& p = ring.points[i];
    const auto& q = ring.points[i + 1 < n ? i + 1 : 0];
    if (p.x < 0 || p.x > area_.width() || p.y < area_.south || p.y > area_.north)
      return RingFault{i, "lies outside the area"};
    if (ring.cut[i] && !on_border(p, q)) return RingFault{i, "a cut edge does not run along the border of the area"};
    points_ += ring.cut[i] ? 1 : pieces_of({p.x * k, p.y * k}, {q.x * k, q.y * k});
    if (points_ > Coast::kMostPoints) return RingFault{i, "more shore than there is on Earth"};
  }
  ++points_;
  return std::nullopt;
}

std::optional<std::string> problem_of_source(std::string_view source) {
  if (source.empty() || source.size() > 400) return "the source is not 1 to 400 characters long";
  if (!std::all_of(source.begin(), source.end(), [](char c) { return c >= ' ' && c <= '~'; }))
    return "the source holds a character that is not printable ASCII";
  return std::nullopt;
}

}  // namespace glidehelm::chart
