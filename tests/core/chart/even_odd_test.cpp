#include "core/chart/even_odd.hpp"

#include <catch2/catch.hpp>

#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

namespace {

Outline outline_of(const std::vector<LonLat>& rings) {
  Outline outline;
  for (const auto& ring : rings) {
    std::vector<Plane> plane;
    for (const auto& [lon, lat] : ring) plane.push_back({rad(lon), rad(lat)});
    outline.add_ring(plane);
  }
  return outline;
}

}  // namespace

TEST_CASE("random positions and rings agree with counting every crossing") {
  for (const int corners : {3, 10, 100, 3000}) {
    std::mt19937_64 random{static_cast<std::uint64_t>(corners)};
    const std::vector<LonLat> rings{star(1, 2, 1.5, corners, random), star(1.2, 2.1, 0.8, corners, random),
                                    star(2, 2, 1.2, corners, random)};
    const auto outline = outline_of(rings);
    const EvenOdd even_odd{outline};
    std::uniform_real_distribution<double> lon{-1, 3.5}, lat{0, 4};
    for (int k = 0; k < 2000; ++k) {
      const double x = lon(random), y = lat(random);
      INFO(corners << " corners, " << x << ", " << y);
      CHECK(even_odd.contains(outline, {rad(x), rad(y)}) == brute_inside(x, y, rings));
    }
  }
}

TEST_CASE("a ray through corners and along level edges counts each once") {
  // corners at the latitude of the ray: a tip that touches it, a step that crosses it, a level edge
  const LonLat ring{{0, 0}, {1, 1}, {2, 0}, {3, 1}, {4, 1}, {5, 2}, {4, 3}, {3, 1.5}, {2, 3}, {0, 3}};
  const auto outline = outline_of({ring});
  const EvenOdd even_odd{outline};
  for (const double y : {1.0, 1.5})
    for (const double x : {-0.5, 0.5, 1.5, 2.5, 2.9, 3.2, 4.6, 5.5}) {
      // what a position 1e-9° higher says, where no corner lies
      INFO(x << ", " << y);
      CHECK(even_odd.contains(outline, {rad(x), rad(y)}) == brute_inside(x, y + 1e-9, {ring}));
    }
}

TEST_CASE("tall edges do not multiply the bands") {
  LonLat comb;
  for (int k = 0; k < 2000; ++k) comb.emplace_back(0.001 * k, k % 2 == 0 ? 0.0 : 0.01);
  comb.emplace_back(2.0, -0.01);
  comb.emplace_back(0.0, -0.01);
  const auto outline = outline_of({comb});
  const EvenOdd even_odd{outline};
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> lon{-0.1, 2.1}, lat{-0.011, 0.011};
  for (int k = 0; k < 2000; ++k) {
    const double x = lon(random), y = lat(random);
    CHECK(even_odd.contains(outline, {rad(x), rad(y)}) == brute_inside(x, y, {comb}));
  }
}

TEST_CASE("nothing is inside of nothing") {
  const Outline none;
  CHECK_FALSE(EvenOdd{none}.contains(none, {0, 0}));
  CHECK_FALSE(EvenOdd{}.contains(none, {0, 0}));
  const auto flat = outline_of({{{0, 0}, {1, 0}, {2, 0}}});
  CHECK_FALSE(EvenOdd{flat}.contains(flat, {rad(0.5), 0}));
}
