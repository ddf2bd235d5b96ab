#include "core/chart/clearance_raster.hpp"

#include <catch2/catch.hpp>

#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

namespace {

constexpr double kFar = 60'000;

/// Signed distance to a point: 3 km around it are forbidden.
ClearanceRaster around(double lat0, double lon0, const RasterBox& box) {
  const auto centre = Space::at(rad(lat0), rad(lon0));
  return {box, -kFar, kFar, [=](double lat, double lon, double at_most) {
            const auto way = Space::at(lat, lon) - centre;
            return std::min(at_most, std::sqrt(dot(way, way)) - 3000);
          }};
}

}  // namespace

TEST_CASE("the raster is a lower bound, and in clear water no lower than promised") {
  for (const double lat0 : {0.0, 45.0, -75.0, 84.0}) {
    const double stretch = 1 / std::cos(rad(lat0));
    const RasterBox box{rad(179), rad(1.5 * stretch), rad(lat0 - 0.7), rad(1.4)};
    const double lon0 = 179 + 0.75 * stretch;
    const auto raster = around(lat0, lon0, box);
    CHECK(raster.cells() <= ClearanceRaster::kMostCells);
    CHECK(raster.evaluations() < raster.cells() / 2);
    // the diagonal of a cell, at the row where cells are widest
    const double widest = LocalMetric::at(rad(std::max(0.0, std::abs(lat0) - 0.7))).parallel_radius;
    const double diagonal =
        1.42 * std::max(252.0, raster.cell_height() * 6.4e6 * std::max(1.0, widest * std::cos(0.0) / widest));
    const auto centre = Space::at(rad(lat0), rad(lon0));
    std::mt19937_64 random{2};
    std::uniform_real_distribution<double> x{box.west, box.west + box.width}, y{box.south, box.south + box.height};
    for (int k = 0; k < 5000; ++k) {
      const double lat = y(random), lon = x(random);
      const auto way = Space::at(lat, lon) - centre;
      const double truth = std::min(kFar, std::sqrt(dot(way, way)) - 3000);
      const double bound = raster.at_least(lat, lon);
      CHECK(bound <= truth);
      CHECK(raster.at_least(lat, lon - 2 * kPi) == bound);
      if (truth > 0) CHECK(bound >= truth - std::max(diagonal, 0.25 * truth) - 1);
    }
  }
}

TEST_CASE("outside its box a raster says what it was told, and nothing good of a NaN") {
  const auto raster = around(10, 20, {rad(19), rad(2), rad(9), rad(2)});
  CHECK(raster.at_least(rad(11.01), rad(20)) == -kFar);
  CHECK(raster.at_least(rad(8.99), rad(20)) == -kFar);
  CHECK(raster.at_least(rad(10), rad(18.99)) == -kFar);
  CHECK(raster.at_least(rad(10), rad(21.01)) == -kFar);
  CHECK(raster.at_least(rad(10.9), rad(20.9)) > 0);
  CHECK(ClearanceRaster{5.0}.at_least(1, 2) == 5.0);
  CHECK(ClearanceRaster{5.0}.at_least(std::nan(""), 2) < 0);
  CHECK(ClearanceRaster{5.0}.at_least(1, std::nan("")) < 0);
}

TEST_CASE("strips and large boxes keep to the number of cells") {
  for (const auto& box : {RasterBox{0, rad(170), 0, rad(0.001)}, RasterBox{0, rad(0.001), rad(-85), rad(170)},
                          RasterBox{0, rad(179), rad(-85), rad(170)}}) {
    const ClearanceRaster raster{box, -kFar, kFar, [](double, double, double at_most) { return at_most; }};
    CHECK(raster.cells() <= ClearanceRaster::kMostCells);
    CHECK(raster.at_least(box.south + 0.5 * box.height, box.west + 0.5 * box.width) == kFar);
  }
}

TEST_CASE("a way is never longer than its upper bound, and the bound is near") {
  std::mt19937_64 random{8};
  std::uniform_real_distribution<double> lats{-84, 84}, step{-0.3, 0.3};
  for (int k = 0; k < 2000; ++k) {
    const double lat = lats(random), dlat = step(random), dlon = step(random) / std::cos(rad(lat));
    // the length of the way that is straight in latitude and longitude, by 200 chords
    double length = 0;
    auto last = Space::at(rad(lat), 0);
    for (int i = 1; i <= 200; ++i) {
      const double t = i / 200.0;
      const auto next = Space::at(rad(lat + t * dlat), rad(t * dlon));
      const auto way = next - last;
      length += std::sqrt(dot(way, way));
      last = next;
    }
    const double bound = ClearanceRaster::length_at_most(rad(lat), rad(dlat), rad(dlon));
    INFO(lat << " " << dlat << " " << dlon);
    CHECK(bound >= length);
    // 1 % for M(0) against the polar radius, and cos φ at the nearer end of 0.3°: tan φ · 0.3° ≤ 5 % at 84°
    CHECK(bound <= length * (1.012 + 0.0053 * std::tan(rad(std::min(84.3, std::abs(lat) + 0.3)))));
  }
}
