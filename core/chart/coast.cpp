#include "core/chart/coast.hpp"

#include <utility>

#include "core/chart/coast_check.hpp"

namespace glidehelm::chart {

namespace {

constexpr double kRadiansPerUnit = kPi / (180.0 * kCoastUnitsPerDegree);

/// The coordinates of a coast on the plane about the middle of its area.
std::vector<Plane> on_plane(const CoastArea& area, const std::vector<CoastPoint>& points) {
  const double half = 0.5 * static_cast<double>(area.width());
  std::vector<Plane> result;
  result.reserve(points.size());
  for (const auto& p : points) result.push_back({(p.x - half) * kRadiansPerUnit, p.y * kRadiansPerUnit});
  return result;
}

double middle_of(const CoastArea& area) { return 0.5 * static_cast<double>(area.west + area.east) * kRadiansPerUnit; }

Region land_of(const CoastArea& area, const std::vector<CoastRing>& rings) {
  Outline outline;
  outline.middle = middle_of(area);
  for (const auto& ring : rings) outline.add_ring(on_plane(area, ring.points), ring.cut);
  return Region{std::move(outline)};
}

Region area_of(const CoastArea& area) {
  const auto w = static_cast<std::int32_t>(area.width());
  const auto s = static_cast<std::int32_t>(area.south), n = static_cast<std::int32_t>(area.north);
  Outline outline;
  outline.middle = middle_of(area);
  outline.add_ring(on_plane(area, {{0, s}, {w, s}, {w, n}, {0, n}}));
  return Region{std::move(outline)};
}

}  // namespace

std::string CoastError::message() const {
  if (line == 0) return problem;
  return "line " + std::to_string(line) + (column == 0 ? "" : ", column " + std::to_string(column)) + ": " + problem;
}

Coast::Coast(CoastArea area, std::string source, std::vector<CoastRing> rings)
    : area_{area},
      source_{std::move(source)},
      rings_{std::move(rings)},
      middle_{middle_of(area)},
      land_{land_of(area, rings_)},
      charted_{area_of(area)} {
  east_ = 0.5 * static_cast<double>(area.width()) * kRadiansPerUnit;
  west_ = -east_;
  south_ = static_cast<double>(area.south) * kRadiansPerUnit;
  north_ = static_cast<double>(area.north) * kRadiansPerUnit;
}

Expected<std::shared_ptr<const Coast>, CoastError> Coast::make(CoastArea area, std::string source,
                                                               std::vector<CoastRing> rings) {
  if (auto problem = area.problem()) return unexpected(CoastError{0, 0, std::move(*problem)});
  if (auto problem = problem_of_source(source)) return unexpected(CoastError{0, 0, std::move(*problem)});
  RingCheck check{area};
  for (std::size_t r = 0; r < rings.size(); ++r)
    if (auto fault = check.next(rings[r]))
      return unexpected(CoastError{
          0, 0,
          "ring " + std::to_string(r + 1) + ", point " + std::to_string(fault->point + 1) + ": " + fault->problem});
  return std::shared_ptr<const Coast>{new Coast{area, std::move(source), std::move(rings)}};
}

std::size_t Coast::points() const {
  std::size_t count = 0;
  for (const auto& ring : rings_) count += ring.points.size();
  return count;
}

bool Coast::covers(double lat, double lon) const {
  const double x = folded(lon - middle_);
  return x >= west_ && x <= east_ && lat >= south_ && lat <= north_;
}

}  // namespace glidehelm::chart
