#include "core/chart/outline.hpp"

#include <catch2/catch.hpp>

#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

TEST_CASE("a ring is closed and its long edges are divided") {
  Outline outline;
  outline.middle = rad(179);
  outline.add_ring(std::vector<Plane>{{0, 0}, {rad(0.1), 0}, {rad(0.1), rad(0.1)}});
  REQUIRE(outline.size() > 4);
  CHECK(outline.plane.front().x == outline.plane.back().x);
  CHECK(outline.edge.back() == Edge::none);
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    CHECK(outline.edge[i] == Edge::barrier);
    const auto piece = outline.space[i + 1] - outline.space[i];
    CHECK(std::sqrt(dot(piece, piece)) <= longest_piece(outline.plane[i].y));
  }
}

TEST_CASE("chord, plane line and geodesic of a longest piece are one line to 0.1 m, up to 85 degrees") {
  for (const double lat : {0.0, 30.0, 60.0, 75.0, 80.0, 85.0})
    for (const double azimuth : {0.0, 45.0, 90.0}) {
      const auto from = geo_point(lat - 0.05, 12);
      const auto to = destination(from, Bearing{degrees(azimuth)}, Metres{longest_piece(rad(lat))});
      const auto half = GeoPoint::from_kernel(0.5 * (from.lat.radians() + to.lat.radians()),
                                              0.5 * (from.lon.radians() + to.lon.radians()));
      const auto on_geodesic = destination(from, Bearing{degrees(azimuth)}, 0.5 * Metres{longest_piece(rad(lat))});
      INFO(lat << ", " << azimuth);
      CHECK(distance(half, on_geodesic).si() < 0.1);
      const auto p = Space::at(half.lat.radians(), half.lon.radians());
      CHECK(std::sqrt(squared_distance(p, Space::at(from.lat.radians(), from.lon.radians()),
                                       Space::at(to.lat.radians(), to.lon.radians()))) < 0.13);
    }
}

TEST_CASE("cut edges are kept whole and marked") {
  Outline outline;
  outline.add_ring(std::vector<Plane>{{0, 0}, {0.1, 0}, {0.1, 0.00001}}, {true, false, false});
  CHECK(outline.edge[0] == Edge::cut);
  CHECK(outline.edge[1] == Edge::barrier);
  CHECK(outline.plane[1].x == 0.1);
}

TEST_CASE("chords are geodesics to 4e-6 up to 60 km, at every latitude and across 180 degrees") {
  for (const double lat : {0.0, 45.0, 75.0, -85.0})
    for (const double azimuth : {0.0, 60.0, 135.0, 270.0}) {
      const auto from = geo_point(lat, 179.9), to = destination(from, Bearing{degrees(azimuth)}, Metres{60'000});
      const auto way =
          Space::at(to.lat.radians(), to.lon.radians()) - Space::at(from.lat.radians(), from.lon.radians());
      // s³/24R² with the smallest radius of curvature, 6335 km
      CHECK(std::sqrt(dot(way, way)) == Approx(60'000).epsilon(3.8e-6));
    }
}
