#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/base/geo.hpp"
#include "core/chart/coast.hpp"

/// Shapes and brute force for the tests of the chart.
namespace glidehelm::test {

inline std::int64_t units(double deg) { return std::llround(deg * chart::kCoastUnitsPerDegree); }
inline chart::CoastArea area_of(double west, double east, double south, double north) {
  return {units(west), units(east), units(south), units(north)};
}

using LonLat = std::vector<std::pair<double, double>>;

/// A ring of shore through (longitude, latitude); longitudes lie between the area's west and east.
inline chart::CoastRing ring_of(const chart::CoastArea& area, const LonLat& points) {
  chart::CoastRing ring;
  for (const auto& [lon, lat] : points) {
    ring.points.push_back({static_cast<std::int32_t>(units(lon) - area.west), static_cast<std::int32_t>(units(lat))});
    ring.cut.push_back(false);
  }
  return ring;
}

inline LonLat box_of(double west, double east, double south, double north) {
  return {{west, south}, {east, south}, {east, north}, {west, north}};
}

inline std::shared_ptr<const chart::Coast> coast_of(const chart::CoastArea& area, const std::vector<LonLat>& rings) {
  std::vector<chart::CoastRing> made;
  for (const auto& ring : rings) made.push_back(ring_of(area, ring));
  return chart::Coast::make(area, "drawn by a test", std::move(made)).value();
}

/// A wobbly closed line around a centre: every ray from it meets the line once.
inline LonLat star(double lon, double lat, double radius_deg, int corners, std::mt19937_64& random) {
  std::uniform_real_distribution<double> wobble{0.4, 1.0};
  LonLat points;
  for (int k = 0; k < corners; ++k) {
    const double a = 2 * kPi * k / corners, r = radius_deg * wobble(random);
    points.emplace_back(lon + r * std::cos(a) / std::cos(lat * kPi / 180), lat + r * std::sin(a));
  }
  return points;
}

/// Geodesic distance from a position to the way between two points that is straight in longitude and latitude, by
/// golden section with GeographicLib: a method that shares nothing with the chart's. The distance along a piece shorter
/// than 100 km has one minimum.
inline double brute_distance(const GeoPoint& p, double lon0, double lat0, double lon1, double lat1) {
  const auto at = [&](double t) {
    return distance(
               p, GeoPoint::from_kernel((lat0 + t * (lat1 - lat0)) * kPi / 180, (lon0 + t * (lon1 - lon0)) * kPi / 180))
        .si();
  };
  constexpr double kGolden = 0.6180339887498949;
  double low = 0, high = 1;
  double a = high - kGolden, b = low + kGolden, fa = at(a), fb = at(b);
  for (int step = 0; step < 40; ++step) {
    if (fa < fb) {
      high = b, b = a, fb = fa;
      a = high - kGolden * (high - low), fa = at(a);
    } else {
      low = a, a = b, fa = fb;
      b = low + kGolden * (high - low), fb = at(b);
    }
  }
  return std::min({at(0.0), at(1.0), fa, fb});
}
inline double brute_distance(const GeoPoint& p, const std::vector<LonLat>& rings) {
  double least = 1e9;
  for (const auto& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto& [lon0, lat0] = ring[i];
      const auto& [lon1, lat1] = ring[(i + 1) % ring.size()];
      least = std::min(least, brute_distance(p, lon0, lat0, lon1, lat1));
    }
  return least;
}

/// The winding-free crossing count with long doubles and no bands, ray to the north: another ray than the chart's.
inline bool brute_inside(double lon, double lat, const std::vector<LonLat>& rings) {
  bool inside = false;
  for (const auto& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto& a = ring[i];
      const auto& b = ring[(i + 1) % ring.size()];
      if ((a.first > lon) == (b.first > lon)) continue;
      const long double t = (static_cast<long double>(lon) - a.first) / (static_cast<long double>(b.first) - a.first);
      if (a.second + t * (static_cast<long double>(b.second) - a.second) > lat) inside = !inside;
    }
  return inside;
}

inline double rad(double deg) { return deg * kPi / 180; }

/// What the chart promises of a distance: 0.2 m plus 1e-5 of it.
inline double promised(double distance) { return 0.2 + 1e-5 * std::abs(distance); }

}  // namespace glidehelm::test
