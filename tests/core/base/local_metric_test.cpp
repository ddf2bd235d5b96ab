#include "core/base/local_metric.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm;

namespace {

/// Walks `length` metres in `steps` midpoint steps at constant azimuth with the local metric.
GeoPoint walk(GeoPoint from, double azimuth_deg, double length, int steps) {
  const auto a = Bearing{degrees(azimuth_deg)};
  const double step = length / steps;
  double lat = from.lat.radians(), lon = from.lon.radians();
  for (int i = 0; i < steps; ++i) {
    const double middle = lat + 0.5 * step * a.north() / LocalMetric::at(lat).meridian_radius;
    const auto metric = LocalMetric::at(middle);
    lat += step * a.north() / metric.meridian_radius;
    lon += step * a.east() / metric.parallel_radius;
  }
  return GeoPoint::from_kernel(lat, lon);
}

}  // namespace

TEST_CASE("one stint walked with the local metric ends where the geodesic says, at every latitude and across 180") {
  // A constant azimuth is a loxodrome, the geodesic of the same length and middle azimuth differs from it by the
  // sagitta: length²·tan φ/(8 R), and their end distances agree to (length·tan φ/R)²/24 relative. At 80° and 30 km that is
  // (30/6370·5.67)²/24 = 3e-5; the product asks for 1e-3, this metric is held to 1e-4.
  const double length = 30'000.0;
  for (const double lat : {-80.0, -75.0, -45.0, -1.0, 0.0, 28.0, 60.0, 80.0})
    for (const double lon : {0.0, 179.95, -179.95})
      for (double azimuth = 0; azimuth < 360; azimuth += 15) {
        const auto from = geo_point(lat, lon);
        const auto to = walk(from, azimuth, length, 8);
        CAPTURE(lat, lon, azimuth);
        CHECK(distance(from, to).si() == Approx(length).epsilon(1e-4));
        const auto back = geodesic(from, to);
        // Direction: the geodesic leaves at the azimuth minus half the convergence over the leg.
        const double half_convergence =
            0.5 * length * std::sin(degrees(azimuth).si()) * std::tan(degrees(lat).si()) / 6371000.0;
        const double turn = (back.departing - Bearing{degrees(azimuth)}).si();
        CHECK(std::abs(turn + half_convergence) < 2e-4);
      }
}

TEST_CASE("sines and cosines near an angle are the library's, beside it and far away") {
  for (const double angle : {-1.4, -0.3, 0.0, 0.02, 0.7, 1.55}) {
    const AnglesNear near{angle};
    for (int i = -60; i <= 60; ++i) {
      const double d = i * AnglesNear::kReach / 40;  // a third of them beyond the reach
      CAPTURE(angle, d);
      // The series stops 0.02⁷/5040 = 3e-16 short, and four roundings of numbers up to 1 are 4e-16.
      CHECK(std::abs(near.at(angle + d).sine - std::sin(angle + d)) <= 1e-15);
      CHECK(std::abs(near.at(angle + d).cosine - std::cos(angle + d)) <= 1e-15);
    }
  }
}

TEST_CASE("the local offset of two near positions has the geodesic's length") {
  for (const double lat : {-78.0, 0.0, 45.0, 78.0})
    for (double azimuth = 0; azimuth < 360; azimuth += 30) {
      const auto from = geo_point(lat, 179.9);
      const auto to = destination(from, Bearing{degrees(azimuth)}, Metres{40'000});
      const auto offset = local_offset(from.lat.radians(), from.lon.radians(), to.lat.radians(), to.lon.radians());
      CAPTURE(lat, azimuth);
      CHECK(offset.length() == Approx(40'000).epsilon(1e-4));
    }
}

TEST_CASE("the lower bound of the distance is never above the geodesic and at most 0.7 % below") {
  for (double lat0 = -85; lat0 <= 85; lat0 += 17)
    for (double lat1 = -85; lat1 <= 85; lat1 += 13)
      for (double dlon = 0; dlon <= 360; dlon += 23) {
        const auto a = geo_point(lat0, 10), b = geo_point(lat1, 10 + dlon > 360 ? dlon - 350 : 10 + dlon);
        const double exact = distance(a, b).si();
        const double bound = distance_lower_bound(a.lat.radians(), a.lon.radians(), b.lat.radians(), b.lon.radians());
        CAPTURE(lat0, lat1, dlon);
        CHECK(bound <= exact + 1e-6);
        // The largest radius of curvature is 6399594 m at the poles: 6335439/6399594 = 0.99; between 0.7 % (equator along
        // the parallel) and 1 % below.
        CHECK(bound >= 0.99 * exact - 1e-6);
      }
}
