#include "core/planning/sector_grid.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/planning/lattice.hpp"

using namespace glidehelm;
using planning::SectorGrid;

TEST_CASE("grids of 1 and 2 and 3 sectors have Eichhorn's 8 and 16 and 32 directions, none twice") {
  // Fig. 1. The widest gap between neighbouring directions is atan(1/sectors), beside the axes: twice that is the cone.
  for (const auto& [sectors, directions] : {std::pair{1, 8U}, {2, 16U}, {3, 32U}}) {
    const SectorGrid grid{sectors, {}};
    const planning::Lattice lattice{{0, 0}, {0, 0.01}, 100e3, 5e3, grid.lattice(), {}};
    std::vector<double> angles;
    for (const auto& step : lattice.steps(lattice.start_row())) {
      CHECK(std::max(std::abs(step.rows), std::abs(step.columns)) <= sectors);
      angles.push_back(std::atan2(step.rows, step.columns));
    }
    std::sort(angles.begin(), angles.end());
    REQUIRE(angles.size() == directions);
    double widest = angles.front() + 2 * kPi - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) {
      CHECK(angles[i] - angles[i - 1] > 0.05);
      widest = std::max(widest, angles[i] - angles[i - 1]);
    }
    CHECK(grid.cone().si() == Approx(2 * widest));
  }
}
