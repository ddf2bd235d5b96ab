#include "core/planning/search_grid.hpp"

#include <catch2/catch.hpp>

#include <map>

#include "core/base/local_metric.hpp"

using namespace glidehelm;
using planning::SearchGrid;

namespace {}  // namespace

TEST_CASE("positions of one cell lie within one cell's diagonal, at every latitude and across 180 degrees") {
  for (const double lat : {0.0, 28.0, 60.0, -75.0, 80.0})
    for (const double lon : {10.0, 179.99}) {
      const SearchGrid grid{lat * kDegree, lon * kDegree, 40e3, 4000, {}};
      CHECK(grid.cell_size() == 4000);
      struct Box {
        double south{10}, north{-10}, west{1e3}, east{-1e3};
      };
      std::map<std::int32_t, Box> boxes;
      for (double north = -20e3; north <= 20e3; north += 250)
        for (double east = -20e3; east <= 20e3; east += 250) {
          const auto metric = LocalMetric::at(lat * kDegree);
          const double at_lat = lat * kDegree + north / metric.meridian_radius;
          const double at_lon = lon * kDegree + east / metric.parallel_radius;
          const auto cell = grid.cell(at_lat, at_lon);
          REQUIRE(cell >= 0);
          REQUIRE(static_cast<std::size_t>(cell) < grid.cells());
          auto& box = boxes[cell];
          box = {std::min(box.south, at_lat), std::max(box.north, at_lat), std::min(box.west, at_lon),
                 std::max(box.east, at_lon)};
        }
      INFO(lat << " " << lon);
      for (const auto& [cell, box] : boxes) {
        const auto size = local_offset(box.south, box.west, box.north, box.east);
        // A row's columns are counted at its middle; towards the equator its cells are wider by 2 km·tan φ/R = 0.2 %.
        CHECK(size.east <= 4000 * 1.003);
        CHECK(size.north <= 4000 * 1.003);
      }
      // 40 km in cells of at most 4 km and hardly less: 10 to 12 each way.
      CHECK(boxes.size() >= 100);
      CHECK(boxes.size() <= 144);
    }
}

TEST_CASE("outside the reach and outside the field there is no cell") {
  ocean::Coverage box;
  box.south = 27 * kDegree;
  box.north = 29 * kDegree;
  box.west = 343 * kDegree;  // −17°: products count longitudes as they like
  box.east = 345 * kDegree;
  const SearchGrid grid{28 * kDegree, -16 * kDegree, 500e3, 5000, box};
  CHECK(grid.cell(28 * kDegree, -16 * kDegree) >= 0);
  CHECK(grid.cell(27.01 * kDegree, -16.99 * kDegree) >= 0);
  CHECK(grid.cell(26.9 * kDegree, -16 * kDegree) == -1);
  CHECK(grid.cell(28 * kDegree, -14.9 * kDegree) == -1);
  const SearchGrid small{28 * kDegree, -16 * kDegree, 50e3, 5000, {}};
  CHECK(small.cell(28.6 * kDegree, -16 * kDegree) == -1);
  CHECK(small.cell(std::nan(""), 0) == -1);
}

TEST_CASE("a grid is never larger than its limit: the cells grow instead") {
  const SearchGrid grid{0.3, 0, 2e7, 1000, {}};
  CHECK(static_cast<std::int64_t>(grid.cells()) <= SearchGrid::kMostCells);
  CHECK(grid.cell_size() > 1000);
  CHECK(grid.cell(-1.2, 3.0) >= 0);
}

TEST_CASE("a reach over a pole takes all longitudes") {
  const SearchGrid grid{85 * kDegree, 20 * kDegree, 800e3, 10e3, {}};
  CHECK(grid.cell(88 * kDegree, 195 * kDegree) >= 0);
  CHECK(grid.cell(80 * kDegree, 20 * kDegree) >= 0);
}
