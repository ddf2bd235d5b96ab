#include "daemon/ingest/plausible.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>

#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;

// What is refused stands in glidehelm_ingest_test.cpp, on files; here are the zeros that are land.

namespace {

/// Nodes without a value at the first time and level, as "row,column".
std::string dry(const ocean::Grid& grid, std::size_t level = 0) {
  std::string text;
  const std::size_t columns = grid.axes.lons_deg.size(), size = grid.axes.lats_deg.size() * columns;
  for (std::size_t n = 0; n < size; ++n)
    if (std::isnan(grid.values[2 * (level * size + n)]))
      text += (text.empty() ? "" : " ") + std::to_string(n / columns) + "," + std::to_string(n % columns);
  return text;
}

ocean::GridAxes axes(std::size_t times) {
  return {test::steps(0, 3600, times), {0.0}, test::steps(0, 1, 5), test::steps(0, 1, 6), true, false};
}

}  // namespace

TEST_CASE("a block of nodes that stand still at every time is land, a single node is not") {
  auto grid = test::make_grid(axes(3), [](double lat, double lon, double, double t) {
    const bool block = lat <= 1 && lon <= 1, single = lat == 4 && lon == 5, touching_by_corner = lat == 2 && lon == 2;
    // Still at one time only: water.
    const bool slack = lat >= 3 && lon <= 1 && t == 0;
    return std::pair{block || single || touching_by_corner || slack ? 0.0 : 0.1, 0.0};
  });
  std::vector<std::string> warnings;
  REQUIRE(make_plausible(grid, warnings));
  CHECK(dry(grid) == "0,0 0,1 1,0 1,1");
  CHECK(warnings == std::vector<std::string>{"4 of 30 nodes stand exactly still at every time: taken as land"});
}

TEST_CASE("one component that is zero is water") {
  auto grid = test::make_grid(axes(3), [](double, double lon, double, double) {
    return std::pair{lon < 4 ? 0.0 : 0.1, 0.2};
  });
  CHECK(zeros_to_land(grid) == 0);
}

TEST_CASE("with fewer than three times a block needs nine nodes") {
  for (const int rows : {2, 3}) {
    auto grid = test::make_grid(axes(1), [&](double lat, double lon, double, double) {
      return std::pair{lat < rows && lon < 3 ? 0.0 : 0.1, 0.0};
    });
    CHECK(zeros_to_land(grid) == (rows == 3 ? 9 : 0));
  }
}

TEST_CASE("every level has its own land, and missing times do not speak against it") {
  auto wanted = axes(4);
  wanted.depths_m = {0, 100};
  wanted.has_depth = true;
  auto grid = test::make_grid(wanted, [](double, double lon, double z, double t) {
    if (t == 3600 && lon < 3) return std::pair{test::kDry, test::kDry};
    return std::pair{(z > 0 && lon < 3) || (z == 0 && lon < 1) ? 0.0 : 0.3, 0.0};
  });
  CHECK(zeros_to_land(grid) == 5 + 15);
  CHECK(dry(grid) == "0,0 1,0 2,0 3,0 4,0");
}

TEST_CASE("a time that ends in zeros was not written to its end, wherever the writer stopped") {
  // 12 by 20 nodes, three times, a land of zeros in the south-west. A classic file has its rows from south to north, so what is missing is
  // the north; a file turned round lacks the south, one with longitude first a side.
  const auto sea = [](std::size_t time, std::size_t side, const std::function<bool(double, double)>& lost) {
    ocean::GridAxes axes{test::steps(0, 3600, 3), {0.0}, test::steps(0, 1, 12), test::steps(0, 1, 20), true, false};
    auto grid = test::make_grid(std::move(axes), [](double lat, double lon, double, double t) {
      const bool land = lat < 3 && lon < 4;
      return land ? std::pair{0.0, 0.0} : std::pair{0.2 + 0.01 * std::sin(t + lat), 0.1 * std::cos(t + 3 * lon)};
    });
    for (std::size_t n = 0; n < 240; ++n)
      if (lost(static_cast<double>(n / 20), static_cast<double>(n % 20))) grid.values[2 * (240 * time + n) + side] = 0;
    return grid;
  };
  for (std::size_t time = 0; time < 3; ++time)
    for (std::size_t side = 0; side < 2; ++side)
      for (int rows = 1; rows <= (time == 2 ? 12 : 11); ++rows) {
        const auto north = unwritten_end(sea(time, side, [&](double lat, double) { return lat >= 12 - rows; }));
        CHECK(north.find(std::string{side == 0 ? "eastward" : "northward"}) != std::string::npos);
        CHECK(north.find(std::to_string(rows) + " northernmost of 12 rows is exactly zero at 1970-01-01T0" +
                         std::to_string(time)) != std::string::npos);
        CHECK_FALSE(unwritten_end(sea(time, side, [&](double lat, double) { return lat < rows; })).empty());
        CHECK_FALSE(unwritten_end(sea(time, side, [&](double, double lon) { return lon >= 19 - rows; })).empty());
      }
  // All over zero at the first time: a component at rest.
  CHECK(unwritten_end(sea(0, 1, [](double, double) { return true; })).empty());
  // Cut in the middle of a row: the whole rows behind it tell.
  CHECK_FALSE(
      unwritten_end(sea(2, 1, [](double lat, double lon) { return lat > 8 || (lat == 8 && lon > 7); })).empty());
  // Whole seas, and slack water somewhere inside, are no unwritten ends; nor is less than a row.
  CHECK(unwritten_end(sea(0, 0, [](double, double) { return false; })).empty());
  CHECK(unwritten_end(sea(1, 0, [](double lat, double lon) {
          return lat > 4 && lat < 9 && lon > 2 && lon < 18;
        })).empty());
  CHECK(unwritten_end(sea(1, 1, [](double lat, double lon) { return lat == 11 && lon > 1; })).empty());
  // One time has nothing to be compared with.
  auto one = test::make_grid({{0.0}, {0.0}, test::steps(0, 1, 12), test::steps(0, 1, 20), true, false},
                             [](double lat, double, double, double) {
                               return std::pair{0.1, lat > 6 ? 0.0 : 0.2};
                             });
  CHECK(unwritten_end(one).empty());
}
