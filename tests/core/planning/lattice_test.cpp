#include "core/planning/lattice.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/local_metric.hpp"

using namespace glidehelm;
using planning::GridKind;
using planning::Lattice;
using planning::LatticeChoice;

namespace {

Lattice lattice(const LatticeChoice& choice, const ocean::Coverage& coverage = {}) {
  return {{0.5, -0.3}, {0.505, -0.29}, 150e3, 3000, choice, coverage};
}

/// From a node in the middle, in metres.
Offset offset(const Lattice& l, int row, int column, const planning::LatticeStep& step) {
  return local_offset(l.lat(row), l.lon(row, column), l.lat(row + step.rows),
                      l.lon(row + step.rows, column + step.columns));
}

/// Directions of the steps in whole tenths of a degree.
std::set<long> directions(const Lattice& l) {
  std::set<long> all;
  for (const auto& step : l.steps(l.start_row())) {
    const auto off = offset(l, l.start_row(), l.start_column(), step);
    all.insert(std::lround(std::fmod(std::atan2(off.east, off.north) * 1800 / kPi + 3600, 3600)));
  }
  return all;
}

}  // namespace

TEST_CASE("neighbourhoods have the sizes of Garau, and a radius adds only new directions") {
  struct Row {
    LatticeChoice choice;
    std::size_t steps, directions;
  };
  // The directions within n rings of a square lattice: 8, 16, 32 (pairs without common divisor); of triangles 6, 12, 24.
  for (const auto& row : {Row{{8, 1, GridKind::regular}, 8, 8},
                          {{16, 1, GridKind::regular}, 16, 16},
                          {{24, 1, GridKind::regular}, 24, 16},
                          {{8, 2, GridKind::regular}, 16, 16},
                          {{8, 3, GridKind::regular}, 32, 32},
                          {{16, 2, GridKind::regular}, 48, 48},
                          {{8, 1, GridKind::triangular}, 6, 6},
                          {{16, 1, GridKind::triangular}, 12, 12},
                          {{24, 1, GridKind::triangular}, 18, 12},
                          {{8, 3, GridKind::triangular}, 24, 24}}) {
    INFO(row.choice.neighbours << ", radius " << row.choice.radius);
    const auto l = lattice(row.choice);
    CHECK(l.steps(l.start_row()).size() == row.steps);
    CHECK(directions(l).size() == row.directions);
  }
}

TEST_CASE("the start is a node, and every neighbour has its own way back") {
  for (const auto grid : {GridKind::regular, GridKind::irregular, GridKind::triangular})
    for (const int neighbours : {8, 16, 24}) {
      const auto l = lattice({neighbours, 2, grid});
      const int r0 = l.start_row(), c0 = l.start_column();
      CHECK(l.lat(r0) == 0.5);
      CHECK(l.lon(r0, c0) == -0.3);
      for (const int row : {r0, r0 + 1})
        for (const auto& step : l.steps(row)) {
          const auto back = l.steps(row + step.rows);
          CHECK(std::count(back.begin(), back.end(), planning::LatticeStep{-step.rows, -step.columns}) == 1);
          CHECK(offset(l, row, c0, step).length() <= 1.01 * l.longest_step());
        }
    }
}

TEST_CASE("the six neighbours on triangles are as far away as the spacing") {
  // Square at the latitude midway, half a degree from the rows here at most: cos changes by 0.5 % per degree at 29°.
  const auto l = lattice({8, 1, GridKind::triangular});
  for (const int row : {l.start_row(), l.start_row() + 1})
    for (const auto& step : l.steps(row))
      CHECK(offset(l, row, l.start_column(), step).length() == Approx(3000).epsilon(0.005));
}

TEST_CASE("an irregular lattice is finer beside start and goal than elsewhere") {
  const auto l = lattice({8, 1, GridKind::irregular});
  const auto height = [&](int row) { return (l.lat(row + 1) - l.lat(row)) * LocalMetric::at(0.5).meridian_radius; };
  CHECK(height(l.start_row()) == Approx(1500).epsilon(0.01));
  CHECK(height(0) == Approx(6000).epsilon(0.01));
  for (int row = 0; row + 1 < l.rows(); ++row) {
    CHECK(height(row) >= 1500 * 0.99);
    CHECK(height(row) <= 6000 * 1.01);
  }
}

TEST_CASE("the box ends with the field, across the antimeridian too, and never grows without bound") {
  ocean::Coverage box;
  box.south = 0.49;
  box.north = 0.52;
  box.west = -0.31 + 2 * kPi;  // the same longitudes, a turn further
  box.east = -0.28 + 2 * kPi;
  const auto l = lattice({16, 1, GridKind::regular}, box);
  CHECK(l.lat(0) >= 0.49);
  CHECK(l.lat(l.rows() - 1) <= 0.52);
  CHECK(l.lon(0, 0) >= -0.31 - 1e-12);
  CHECK(l.lon(0, l.columns() - 1) <= -0.28 + 1e-12);
  for (const auto grid : {GridKind::regular, GridKind::irregular, GridKind::triangular}) {
    const Lattice huge{{0, 0}, {0.1, 0.1}, 8e6, 10, {16, 1, grid}, {}};
    CHECK(huge.nodes() <= static_cast<std::size_t>(Lattice::kMostNodes));
    CHECK(huge.spacing() > 10);
  }
}
