#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/geo.hpp"
#include "core/chart/chart.hpp"
#include "core/chart/region.hpp"

namespace glidehelm::chart {

/// Why a polygon is no area. `edge` and `other` count from 0; edge i leads from corner i to the next.
struct AreaProblem {
  enum class What {
    too_few_corners,   ///< fewer than three
    too_many_corners,  ///< more than kMostCorners
    repeated_corner,   ///< edge `edge` has no length
    crosses_itself,    ///< edges `edge` and `other` cross, touch or run along each other
    too_wide,          ///< 180° of longitude or more
    too_far_north      ///< corner `edge` lies beyond 85° north or south
  } what{};
  std::string area;
  std::size_t edge{}, other{};
  [[nodiscard]] std::string message() const;
  friend bool operator==(const AreaProblem&, const AreaProblem&) = default;
};

inline constexpr std::size_t kMostCorners = 100'000;

/// An area from untrusted corners: a simple polygon less than 180° wide, within 85° of the equator. A last corner that
/// repeats the first is dropped. O(n²) in the worst case, O(n log n) for polygons whose edges spread in longitude.
Expected<Area, AreaProblem> checked_area(std::string name, std::vector<GeoPoint> corners);

/// The inside of an area, its edges laid along geodesics. Takes any area (`checked_area` says whether it makes sense);
/// fewer than three corners have no inside.
Region region_of(const Area& area);

}  // namespace glidehelm::chart
