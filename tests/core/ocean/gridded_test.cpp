#include "core/ocean/gridded.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ocean;
using test::kDry;

namespace {

/// Bilinear in latitude and longitude, so linear interpolation is exact up to float rounding: values below 2 m/s have a
/// rounding of 2^-24·2 = 1.2e-7, three float operations and the float weights give at most 1e-6.
constexpr double kFloat = 1e-6;
std::pair<double, double> plane(double lat, double lon) {
  return {0.01 * lat - 0.02 * lon + 0.001 * lat * lon, 0.3 + 0.05 * lat};
}

double eastward(const Expected<Sample, NoCurrent>& s) {
  REQUIRE(s);
  return s->current.east.si();
}
NoCurrent reason_of(const Expected<Sample, NoCurrent>& s) {
  REQUIRE_FALSE(s);
  return s.error();
}
Depth at_depth(double m) { return Depth{Metres{m}}; }

/// Nodes at whole degrees 0…4; dry where asked, else the node's column number plus ten times its row.
GriddedField chequered(const std::vector<std::pair<int, int>>& dry, const GriddedOptions& options = {}) {
  return test::make_field(
      test::steps(0, 1, 5), test::steps(0, 1, 5),
      [&](double lat, double lon) {
        for (const auto& [row, column] : dry)
          if (row == static_cast<int>(lat) && column == static_cast<int>(lon)) return std::pair{kDry, kDry};
        return std::pair{lon + 10 * lat, 0.0};
      },
      options);
}

}  // namespace

TEST_CASE("between nodes the current is bilinear, on even and on uneven axes") {
  const auto even = test::make_field(test::steps(-2, 0.5, 9), test::steps(10, 0.5, 9), plane);
  const auto uneven = test::make_field({-2, -1.9, 0, 0.3, 2}, {10, 12, 12.5, 13, 14}, plane);
  for (double lat = -2; lat <= 2; lat += 0.137)
    for (double lon = 10; lon <= 14; lon += 0.111) {
      const auto [east, north] = plane(lat, lon);
      for (const auto* field : {&even, &uneven}) {
        const auto s = field->sample(geo_point(lat, lon), Depth{}, 0);
        REQUIRE(s);
        CHECK(s->current.east.si() == Approx(east).margin(kFloat));
        CHECK(s->current.north.si() == Approx(north).margin(kFloat));
        CHECK_FALSE(s->extrapolated);
      }
    }
}

TEST_CASE("the edge of the nodes is a wall, and the nodes on it belong to the field") {
  const auto field = test::make_field(test::steps(-2, 0.5, 9), test::steps(10, 0.5, 9), plane);
  CHECK(field.sample(geo_point(2, 14), Depth{}, 0));
  CHECK(field.sample(geo_point(-2, 10), Depth{}, 0));
  CHECK(reason_of(field.sample(geo_point(2.001, 12), Depth{}, 0)) == NoCurrent::outside_area);
  CHECK(reason_of(field.sample(geo_point(0, 9.999), Depth{}, 0)) == NoCurrent::outside_area);
  CHECK(reason_of(field.sample(geo_point(0, -12), Depth{}, 0)) == NoCurrent::outside_area);
  const auto box = field.coverage();
  CHECK(box.south == Approx(-2 * kPi / 180));
  CHECK(box.east == Approx(14 * kPi / 180));
}

TEST_CASE("a field across the antimeridian answers on both sides of it") {
  const auto field = test::make_field(test::steps(0, 1, 3), test::steps(178, 1, 5), [](double, double lon) {
    return std::pair{lon - 180, 0.0};
  });
  CHECK(eastward(field.sample(geo_point(1, 179.5), Depth{}, 0)) == Approx(-0.5).margin(kFloat));
  CHECK(eastward(field.sample(geo_point(1, -179.5), Depth{}, 0)) == Approx(0.5).margin(kFloat));
  CHECK(reason_of(field.sample(geo_point(1, -177), Depth{}, 0)) == NoCurrent::outside_area);
}

TEST_CASE("a field around the globe has no edge in longitude") {
  for (const double first : {0.0, -180.0, -179.875}) {
    const auto field = test::make_field(test::steps(-1, 1, 3), test::steps(first, 0.25, 1440), [](double, double lon) {
      return std::pair{std::cos(lon * kPi / 180), 0.0};
    });
    for (double lon = -180; lon < 180; lon += 0.377) {
      const auto s = field.sample(geo_point(0.3, lon), Depth{}, 0);
      // Linear interpolation of a cosine over h = 0.25°: h²/8 = 2.4e-6.
      CHECK(eastward(s) == Approx(std::cos(lon * kPi / 180)).margin(2.4e-6 + kFloat));
    }
    CHECK(field.coverage().east - field.coverage().west == Approx(2 * kPi));
  }
}

TEST_CASE("wet corners with at least half the weight give their renormalised mean") {
  const auto field = chequered({{1, 1}}, {OutsideTime::hold, Interpolation::linear, 0, false});
  // At (1.25, 1.25) the dry corner has weight 0.75² = 0.5625: less than half is wet.
  CHECK(reason_of(field.sample(geo_point(1.25, 1.25), Depth{}, 0)) == NoCurrent::no_data);
  // At (1.5, 1.25) the corners weigh 0.375 (dry), 0.125 (12), 0.375 (21), 0.125 (22).
  CHECK(eastward(field.sample(geo_point(1.5, 1.25), Depth{}, 0)) ==
        Approx((0.125 * 12 + 0.375 * 21 + 0.125 * 22) / 0.625).epsilon(1e-6));
  // Exactly half: (1, 1.5) lies between the dry node and node 12.
  CHECK(eastward(field.sample(geo_point(1, 1.5), Depth{}, 0)) == Approx(12).epsilon(1e-6));
}

TEST_CASE("a dry corner of weight zero changes nothing") {
  const auto field = chequered({{1, 1}, {2, 1}});
  CHECK(eastward(field.sample(geo_point(1.5, 2), Depth{}, 0)) == Approx(17).epsilon(1e-6));
  CHECK_FALSE(field.sample(geo_point(1.5, 2), Depth{}, 0)->extrapolated);
}

TEST_CASE("beside the last wet node its value is borrowed up to one and a half cells, and marked") {
  std::vector<std::pair<int, int>> dry;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 3; ++column) dry.emplace_back(row, column);
  const auto field = chequered(dry);
  const auto borrowed = field.sample(geo_point(2, 1.6), Depth{}, 0);
  REQUIRE(borrowed);
  CHECK(borrowed->extrapolated);
  CHECK(borrowed->current.east.si() == 23);  // node (2, 3), 1.4 cells away
  CHECK(reason_of(field.sample(geo_point(2, 1.4), Depth{}, 0)) == NoCurrent::no_data);
  // At equal distance the southern node wins: (2.5, 2) is as far from (2, 3) as from (3, 3).
  CHECK(eastward(field.sample(geo_point(2.5, 2), Depth{}, 0)) == 23);

  const auto wider = chequered(dry, {OutsideTime::hold, Interpolation::linear, 3.0, false});
  CHECK(eastward(wider.sample(geo_point(2, 0.2), Depth{}, 0)) == 23);
}

TEST_CASE("without a coastline the mask is land and nothing is borrowed") {
  const auto field = chequered({{1, 1}, {1, 2}, {2, 1}, {2, 2}}, {OutsideTime::hold, Interpolation::linear, 1.5, true});
  CHECK(reason_of(field.sample(geo_point(1.5, 1.5), Depth{}, 0)) == NoCurrent::land);
  CHECK(reason_of(field.sample(geo_point(1.5, 2.4), Depth{}, 0)) == NoCurrent::land);
  CHECK(field.sample(geo_point(1.5, 2.6), Depth{}, 0));
}

TEST_CASE("borrowing reaches across the seam of a global field") {
  const auto field = test::make_field(test::steps(-1, 1, 3), test::steps(-180, 1, 360), [](double, double lon) {
    return lon >= 178 || lon < -179 ? std::pair{kDry, kDry} : std::pair{lon, 0.0};
  });
  // The dry columns are 178, 179 and −180; the nearest wet to −179.4 (u = 0.6) is −179, of weight 0.6: plain mean.
  CHECK_FALSE(field.sample(geo_point(0, -179.4), Depth{}, 0)->extrapolated);
  const auto east_side = field.sample(geo_point(0, -179.9), Depth{}, 0);
  REQUIRE(east_side);
  CHECK(east_side->extrapolated);
  CHECK(east_side->current.east.si() == -179);
  const auto across = field.sample(geo_point(0, 179.8), Depth{}, 0);  // 1.2 cells west of −179
  REQUIRE(across);
  CHECK(across->extrapolated);
  CHECK(across->current.east.si() == -179);
  CHECK(reason_of(field.sample(geo_point(0, 179.0 - 0.4), Depth{}, 0)) == NoCurrent::no_data);
}

TEST_CASE("in time the current is linear, and outside it the policy decides") {
  GridAxes axes{{1000, 2000}, {0.0}, {0, 1}, {0, 1}, true, false};
  const auto grid = test::make_grid(axes, [](double, double, double, double t) { return std::pair{t / 1000, 0.0}; });
  const auto at = [&](OutsideTime policy, double t, Interpolation how = Interpolation::linear) {
    return GriddedField{grid, {policy, how, 1.5, false}}.sample(geo_point(0.5, 0.5), Depth{}, t);
  };
  CHECK(eastward(at(OutsideTime::forbid, 1250)) == Approx(1.25).margin(kFloat));
  CHECK(reason_of(at(OutsideTime::forbid, 2001)) == NoCurrent::outside_time);
  CHECK(eastward(at(OutsideTime::hold, 5000)) == 2);
  CHECK(eastward(at(OutsideTime::hold, 0)) == 1);
  CHECK(eastward(at(OutsideTime::hold, 1499, Interpolation::nearest)) == 1);
  CHECK(eastward(at(OutsideTime::hold, 1501, Interpolation::nearest)) == 2);
  CHECK_FALSE((GriddedField{grid, {OutsideTime::forbid, Interpolation::linear, 1.5, false}}.coverage().holds_outside));
}

TEST_CASE("nearest takes the value of the nearest node") {
  const auto field = chequered({}, {OutsideTime::hold, Interpolation::nearest, 0, false});
  CHECK(eastward(field.sample(geo_point(1.4, 2.6), Depth{}, 0)) == 13);
  CHECK(eastward(field.sample(geo_point(1.6, 2.4), Depth{}, 0)) == 22);
}

TEST_CASE("cubic and Akima in time follow a parabola and a line, and bound what they may overshoot") {
  GridAxes axes{test::steps(0, 1, 8), {0.0}, {0, 1}, {0, 1}, true, false};
  const auto grid = test::make_grid(axes, [](double, double, double, double t) {
    return std::pair{t * t / 64, t / 8};
  });
  const GriddedField cubic{grid, {OutsideTime::hold, Interpolation::cubic, 1.5, false}};
  const GriddedField akima{grid, {OutsideTime::hold, Interpolation::akima, 1.5, false}};
  for (const double t : {2.5, 3.3, 4.75}) {
    CHECK(eastward(cubic.sample(geo_point(0.5, 0.5), Depth{}, t)) == Approx(t * t / 64).margin(kFloat));
    CHECK(akima.sample(geo_point(0.5, 0.5), Depth{}, t)->current.north.si() == Approx(t / 8).margin(kFloat));
  }
  CHECK(cubic.fastest().si() >= std::hypot(49.0 / 64, 7.0 / 8) * overshoot_bound(Interpolation::cubic, 1));
}

TEST_CASE("a time without a value at the place makes that the answer, unless it has no weight") {
  GridAxes axes{{0, 100}, {0.0}, {0, 1}, {0, 1}, true, false};
  const auto grid = test::make_grid(axes, [](double, double, double, double t) {
    return std::pair{t == 100 ? kDry : 1.0, 0.0};
  });
  const GriddedField field{grid, {}};
  CHECK(field.sample(geo_point(0.5, 0.5), Depth{}, 0));
  CHECK(reason_of(field.sample(geo_point(0.5, 0.5), Depth{}, 1)) == NoCurrent::no_data);
  const GriddedField cubic{grid, {OutsideTime::hold, Interpolation::cubic, 1.5, false}};
  CHECK(reason_of(cubic.sample(geo_point(0.5, 0.5), Depth{}, 1)) == NoCurrent::no_data);
}

namespace {
/// Levels at 5, 15, 30 m; east = depth. The sea floor rises eastwards: columns 0, 1 reach 30 m, 2 reaches 15 m, 3 reaches
/// 5 m, 4 is dry.
GriddedField slope(const GriddedOptions& options = {}) {
  GridAxes axes{{0.0}, {5, 15, 30}, test::steps(0, 1, 3), test::steps(0, 1, 5), false, true};
  return {test::make_grid(axes,
                          [](double, double lon, double z, double) {
                            const double floor = lon < 1.5 ? 30 : lon < 2.5 ? 15 : lon < 3.5 ? 5 : 0;
                            return z > floor ? std::pair{kDry, kDry} : std::pair{z, lon};
                          }),
          options};
}
}  // namespace

TEST_CASE("in depth the current is linear between levels and the first level's above it") {
  const auto field = slope();
  CHECK(eastward(field.sample(geo_point(1, 0.5), at_depth(0), 0)) == Approx(5).margin(kFloat * 10));
  CHECK(eastward(field.sample(geo_point(1, 0.5), at_depth(5), 0)) == Approx(5).margin(kFloat * 10));
  CHECK(eastward(field.sample(geo_point(1, 0.5), at_depth(11), 0)) == Approx(11).margin(kFloat * 10));
  CHECK(eastward(field.sample(geo_point(1, 0.5), at_depth(30), 0)) == Approx(30).margin(kFloat * 30));
}

TEST_CASE("below the deepest wet level it is below the bottom, over land it is not") {
  const auto field = slope();
  CHECK(reason_of(field.sample(geo_point(1, 0.5), at_depth(31), 0)) == NoCurrent::below_bottom);
  CHECK(reason_of(field.sample(geo_point(1, 2), at_depth(16), 0)) == NoCurrent::below_bottom);
  CHECK(reason_of(field.sample(geo_point(1, 3), at_depth(6), 0)) == NoCurrent::below_bottom);
  CHECK(
      reason_of(slope({OutsideTime::hold, Interpolation::linear, 1.5, true}).sample(geo_point(1, 4), at_depth(6), 0)) ==
      NoCurrent::land);
}

TEST_CASE("beside the coast the column of the nearest wet node is borrowed, down to its bottom") {
  const auto field = slope();
  const auto shallow = field.sample(geo_point(1, 4), at_depth(4), 0);
  REQUIRE(shallow);
  CHECK(shallow->extrapolated);
  CHECK(shallow->current.north.si() == 3);
  CHECK(reason_of(field.sample(geo_point(1, 4), at_depth(6), 0)) == NoCurrent::below_bottom);
}

TEST_CASE("the shallowest level is a two-dimensional field over the same numbers") {
  const auto top = slope().shallowest();
  CHECK(top.levels() == 1);
  CHECK(eastward(top.sample(geo_point(1, 0.5), at_depth(500), 0)) == Approx(5).margin(kFloat * 10));
  CHECK(top.fastest().si() == Approx(std::hypot(5, 3)).epsilon(3e-6));  // the fastest of that level alone
}

TEST_CASE("fastest bounds every sample and is reached at a node") {
  const auto field = chequered({{4, 4}});
  double found = 0;
  for (double lat = 0; lat <= 4; lat += 0.0625)
    for (double lon = 0; lon <= 4; lon += 0.0625)
      if (const auto s = field.sample(geo_point(lat, lon), Depth{}, 0))
        found = std::max(found, s->current.speed().si());
  CHECK(found <= field.fastest().si());
  CHECK(found >= field.fastest().si() * (1 - 3e-6));
}

TEST_CASE("a copy keeps the numbers alive") {
  std::optional<GriddedField> copy;
  {
    const auto field = chequered({});
    copy = field;
  }
  CHECK(eastward(copy->sample(geo_point(2, 2), Depth{}, 0)) == 22);
}

TEST_CASE("a sample over a filled node is marked extrapolated, at the times and levels that have it") {
  ocean::Grid grid = test::make_grid({{0, 3600, 7200}, {0, 100}, {0, 1, 2}, {0, 1, 2}, true, true},
                                     [](double, double, double, double) {
                                       return std::pair{0.1, 0.2};
                                     });
  grid.filled = {{4, 1}};  // first time, surface, the middle node
  const ocean::GriddedField field{grid, {}};
  const auto marked = [&](double lat, double lon, double depth, double t) {
    return field.sample(geo_point(lat, lon), Depth{Metres{depth}}, t)->extrapolated;
  };
  CHECK(marked(1, 1, 0, 0));
  CHECK(marked(0.5, 0.5, 0, 0));
  CHECK(marked(0.5, 0.5, 50, 1800));
  CHECK_FALSE(marked(0.5, 0, 0, 0));   // on the edge the middle node has no weight
  CHECK_FALSE(marked(1, 1, 100, 0));   // the level below is a value of its own
  CHECK_FALSE(marked(1, 1, 0, 5400));  // so are the later times
  // The fast path of two dimensions marks alike.
  ocean::Grid flat = test::make_grid({{0, 3600}, {0}, {0, 1}, {0, 1}, true, false}, [](double, double, double, double) {
    return std::pair{0.1, 0.2};
  });
  flat.filled = {{4, 1}};  // second time, south-west
  const GriddedField sheet{flat, {}};
  CHECK(sheet.sample(geo_point(0.5, 0.5), Depth{}, 1800)->extrapolated);
  CHECK_FALSE(sheet.sample(geo_point(1, 1), Depth{}, 1800)->extrapolated);
}
