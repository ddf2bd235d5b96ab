#include "core/chart/bathymetry.hpp"

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "core/base/local_metric.hpp"
#include "core/chart/chart.hpp"
#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

DepthGrid grid_of(std::size_t columns, std::size_t rows, double west, double south, double step) {
  DepthGrid grid{"test", "made", west, south, step, step, columns, rows, {}};
  grid.depths_m.assign(columns * rows, 100.0F);
  return grid;
}

/// Random depths of 0 to 1000 m; `unknown` of 100 nodes have none.
DepthGrid random_grid(std::mt19937& draw, std::size_t columns, std::size_t rows, unsigned unknown) {
  auto grid = grid_of(columns, rows, 170, -30, 0.25);
  for (float& depth : grid.depths_m)
    depth = draw() % 100 < unknown ? kNone : static_cast<float>(draw() % 100'000) / 100.0F;
  return grid;
}

double uniform(std::mt19937& draw, double low, double high) {
  return low + (high - low) * (static_cast<double>(draw()) / 4294967296.0);
}

/// The surface straight from its definition; degrees.
double surface(const DepthGrid& g, double lat, double lon) {
  const double x = (lon - g.west_deg) / g.lon_step_deg, y = (lat - g.south_deg) / g.lat_step_deg;
  if (x < 0 || y < 0 || x > static_cast<double>(g.columns - 1) || y > static_cast<double>(g.rows - 1))
    return Bathymetry::kUnknown;
  const auto c = std::min(static_cast<std::size_t>(x), g.columns - 2),
             r = std::min(static_cast<std::size_t>(y), g.rows - 2);
  const double fx = x - static_cast<double>(c), fy = y - static_cast<double>(r);
  const auto d = [&](std::size_t i, std::size_t j) { return static_cast<double>(g.depths_m[j * g.columns + i]); };
  const double sum =
      (1 - fy) * ((1 - fx) * d(c, r) + fx * d(c + 1, r)) + fy * ((1 - fx) * d(c, r + 1) + fx * d(c + 1, r + 1));
  return std::isnan(sum) ? Bathymetry::kUnknown : sum;
}

std::shared_ptr<const Bathymetry> bottom_of(DepthGrid grid) {
  auto made = Bathymetry::make(std::move(grid));
  REQUIRE(made);
  return *made;
}

}  // namespace

TEST_CASE("the depth is the bilinear surface, and unknown beside a node without a value") {
  std::mt19937 draw{1};
  const auto grid = random_grid(draw, 37, 21, 5);
  const auto bottom = bottom_of(grid);
  std::size_t unknown = 0;
  for (int k = 0; k < 5000; ++k) {
    const double lat = uniform(draw, -30.3, -24.7), lon = uniform(draw, 169.7, 179.3);
    const double expected = surface(grid, lat, lon), found = bottom->depth(rad(lat), rad(lon));
    if (std::isinf(expected)) {
      ++unknown;
      CHECK(found == Bathymetry::kUnknown);
    } else {
      CHECK(found == Approx(expected).margin(1e-6));  // 1e-13 of a turn in x, slopes of 1000 m a step
    }
  }
  CHECK(unknown > 500);
  CHECK(bottom->depth(rad(-29), rad(171 - 360)) == Approx(surface(grid, -29, 171)).margin(1e-6));
  CHECK(bottom->depth(std::nan(""), 0) == Bathymetry::kUnknown);
}

TEST_CASE("the shoalest of a box is that of the surface in it: no sample is shallower and one comes near") {
  std::mt19937 draw{2};
  for (int round = 0; round < 300; ++round) {
    const auto grid = random_grid(draw, 30, 24, round % 3 == 0 ? 1 : 0);
    const auto bottom = bottom_of(grid);
    const double size = round % 2 == 0 ? 3.0 : 0.2;
    const double lat0 = uniform(draw, -30, -27), lat1 = std::min(-24.25, lat0 + uniform(draw, 0, size));
    const double lon0 = uniform(draw, 170, 174), lon1 = lon0 + uniform(draw, 0, size);
    const double found = bottom->shoalest_in_box(rad(lat0), rad(lat1), rad(lon0), rad(lon1));
    // The minimum of a bilinear patch over a rectangle is at a corner, so all nodes, box corners and crossings of grid
    // lines with the sides, looked at one by one, hold it.
    std::vector<double> xs{lon0, lon1}, ys{lat0, lat1};
    for (int k = 0; k < 30; ++k) {
      if (const double x = 170 + 0.25 * k; x > lon0 && x < lon1) xs.push_back(x);
      if (const double y = -30 + 0.25 * k; y > lat0 && y < lat1) ys.push_back(y);
    }
    double expected = std::numeric_limits<double>::infinity();
    for (const double x : xs)
      for (const double y : ys) expected = std::min(expected, surface(grid, y, x));
    if (std::isinf(expected))
      CHECK(found == expected);
    else
      CHECK(found == Approx(expected).margin(1e-6));
    for (int k = 0; k < 200; ++k)
      CHECK(surface(grid, uniform(draw, lat0, lat1), uniform(draw, lon0, lon1)) >= found - 1e-6);
  }
}

TEST_CASE("nothing along a segment or within a disc is shallower than the answer, and nothing far away is blamed") {
  std::mt19937 draw{3};
  std::size_t deep = 0, shallow = 0;
  for (int round = 0; round < 400; ++round) {
    const auto grid = random_grid(draw, 30, 24, round % 4 == 0 ? 1 : 0);
    const auto bottom = bottom_of(grid);
    const double lat0 = uniform(draw, -29, -26), lat1 = uniform(draw, -29, -26);
    const double lon0 = uniform(draw, 171, 176), lon1 = uniform(draw, 171, 176);
    const double found = bottom->shoalest_along(rad(lat0), rad(lon0), rad(lat1), rad(lon1));
    double expected = std::numeric_limits<double>::infinity(), around = expected;
    for (int k = 0; k <= 4000; ++k) {
      const double t = k / 4000.0, lat = lat0 + t * (lat1 - lat0), lon = lon0 + t * (lon1 - lon0);
      expected = std::min(expected, surface(grid, lat, lon));
      for (const double dy : {-0.125, 0.0, 0.125})
        for (const double dx : {-0.125, 0.0, 0.125}) around = std::min(around, surface(grid, lat + dy, lon + dx));
    }
    CHECK(found <= expected + 1e-6);
    // Boxes around pieces of half a step lie within half a step; between samples of the surface, which has slopes of at
    // most 1000 m in 0.25 degrees, 1/4000 of 6 degrees and the eighth of a degree of the offsets are 500 m at most.
    if (!std::isinf(around)) CHECK(found >= around - 500);
    for (const double least : {5.0, 50.0, 300.0}) {
      const bool is_deep = bottom->is_deep_along(rad(lat0), rad(lon0), rad(lat1), rad(lon1), least);
      CHECK(is_deep == (found >= least));
      (is_deep ? deep : shallow) += 1;
    }
    const auto p = geo_point(lat0, lon0);
    const double radius = uniform(draw, 0, 40'000), disc = bottom->shoalest_within(p, Metres{radius});
    for (int k = 0; k < 100; ++k) {
      const auto q = destination(p, Bearing{Radians{uniform(draw, 0, 6.28)}}, Metres{uniform(draw, 0, radius)});
      CHECK(bottom->depth(q.lat.radians(), q.lon.radians()) >= disc - 1e-6);
    }
  }
  CHECK(deep > 50);
  CHECK(shallow > 50);
}

TEST_CASE("a grid across the antimeridian is one piece") {
  auto grid = grid_of(9, 5, 178, 10, 0.5);
  grid.depths_m[2 * 9 + 5] = 7;  // 11 N, 180.5 E
  const auto bottom = bottom_of(grid);
  CHECK(bottom->depth(rad(11), rad(-179.5)) == Approx(7));
  CHECK(bottom->shoalest_along(rad(11), rad(179.6), rad(11), rad(-179.6)) == Approx(7 + 0.2 * 93));
  CHECK(bottom->is_deep_along(rad(11.6), rad(178.1), rad(11.6), rad(-178.1), 99.9));  // 100 but for rounding
}

TEST_CASE("a depth file comes back bit by bit, and every damage is seen") {
  std::mt19937 draw{4};
  const auto grid = random_grid(draw, 7, 5, 20);
  const auto text = Bathymetry::text_of(grid);
  const auto read = Bathymetry::parse(text);
  REQUIRE(read);
  CHECK((*read)->grid().source == "test");
  CHECK((*read)->grid().decided == "made");
  CHECK((*read)->grid().lon_step_deg == grid.lon_step_deg);
  for (std::size_t n = 0; n < grid.depths_m.size(); ++n)
    CHECK(std::bit_cast<std::uint32_t>((*read)->grid().depths_m[n]) == std::bit_cast<std::uint32_t>(grid.depths_m[n]));
  for (std::size_t n = 0; n < text.size(); ++n) {
    CHECK_FALSE(Bathymetry::parse(text.substr(0, n)));
    auto damaged = text;
    damaged[n] = static_cast<char>(damaged[n] ^ 1);
    CHECK_FALSE(Bathymetry::parse(damaged));
  }
  CHECK_FALSE(Bathymetry::parse(text + " "));
}

TEST_CASE("grids that are none are refused") {
  const auto problem = [](const std::function<void(DepthGrid&)>& change) {
    auto grid = grid_of(4, 3, -10, 40, 1);
    change(grid);
    return !Bathymetry::make(std::move(grid));
  };
  CHECK_FALSE(problem([](DepthGrid&) {}));
  CHECK(problem([](DepthGrid& g) { g.depths_m.pop_back(); }));
  CHECK(problem([](DepthGrid& g) { g.lat_step_deg = -1; }));
  CHECK(problem([](DepthGrid& g) { g.lon_step_deg = std::nan(""); }));
  CHECK(problem([](DepthGrid& g) { g.south_deg = 89; }));
  CHECK(problem([](DepthGrid& g) { g.west_deg = 400; }));
  CHECK(problem([](DepthGrid& g) { g.columns = 1; }));
}

TEST_CASE("a chart with bathymetry lets no segment into shallow or unknown water but out of it") {
  // The depth grows eastwards by 10 m a tenth of a degree from 0 m at 1 W; the last columns are unknown.
  auto grid = grid_of(31, 5, -1, 40, 0.1);
  for (std::size_t n = 0; n < grid.depths_m.size(); ++n)
    grid.depths_m[n] = n % 31 > 28 ? kNone : static_cast<float>(10 * (n % 31));
  ChartSources sources;
  sources.bathymetry = bottom_of(grid);
  sources.least_depth = Metres{40};
  const Chart chart{std::move(sources)};
  const auto clear = [&](double lon0, double lon1) {
    return chart.segment_is_clear(rad(40.2), rad(lon0), rad(40.2), rad(lon1), 2000);
  };
  CHECK(chart.least_depth() == Metres{40});
  CHECK(clear(-0.55, 1.7));          // 45 m and deeper
  CHECK_FALSE(clear(-0.55, -0.65));  // into 35 m
  CHECK_FALSE(clear(1.7, 1.85));     // into the unknown
  CHECK(clear(-0.8, -0.7));          // out of 20 m
  CHECK_FALSE(clear(-0.7, -0.8));
  CHECK_FALSE(clear(1.95, 1.9));  // from unknown to unknown
  CHECK(clear(1.95, 1.7));
  CHECK(Chart{}.bathymetry() == nullptr);
}
