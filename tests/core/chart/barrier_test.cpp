#include "core/chart/barrier.hpp"

#include <catch2/catch.hpp>

#include "tests/core/chart/shapes.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

namespace {

Outline random_outline(std::mt19937_64& random, int rings, int corners) {
  Outline outline;
  std::uniform_real_distribution<double> lon{-1, 1}, lat{44, 46};
  for (int r = 0; r < rings; ++r) {
    std::vector<Plane> plane;
    for (const auto& [x, y] : star(lon(random), lat(random), 0.1, corners, random)) plane.push_back({rad(x), rad(y)});
    outline.add_ring(plane);
  }
  return outline;
}

/// Every edge, no tree.
double brute(const Outline& outline, const Space& p) {
  double least = 1e18;
  for (std::size_t i = 0; i < outline.size(); ++i)
    if (outline.edge[i] == Edge::barrier)
      least = std::min(least, squared_distance(p, outline.space[i], outline.space[i + 1]));
  return std::sqrt(least);
}

}  // namespace

TEST_CASE("the tree finds the nearest edge that looking at every edge finds") {
  std::mt19937_64 random{9};
  for (const int rings : {1, 3, 40}) {
    const auto outline = random_outline(random, rings, 30);
    const Barrier barrier{outline};
    std::uniform_real_distribution<double> lon{-1.5, 1.5}, lat{43.5, 46.5};
    for (int k = 0; k < 500; ++k) {
      const auto p = Space::at(rad(lat(random)), rad(lon(random)));
      const double exact = brute(outline, p);
      CHECK(barrier.distance(outline, p, 1e9) == exact);
      CHECK(barrier.distance(outline, p, 20'000) == std::min(exact, 20'000.0));
      CHECK(barrier.distance(outline, p, 0) == 0);
    }
  }
}

TEST_CASE("a piece touches what looking at every edge says") {
  std::mt19937_64 random{10};
  const auto outline = random_outline(random, 40, 30);
  const Barrier barrier{outline};
  std::uniform_real_distribution<double> lon{-1.2, 1.2}, lat{43.8, 46.2}, step{-0.012, 0.012}, margins{0, 3000};
  int touching = 0;
  for (int k = 0; k < 3000; ++k) {
    const double x = rad(lon(random)), y = rad(lat(random)), u = x + rad(step(random)), v = y + rad(step(random));
    const Piece piece{{x, y}, {u, v}, Space::at(y, x), Space::at(v, u)};
    const double margin = k % 3 == 0 ? 0 : margins(random);
    bool expected = false;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      if (outline.edge[i] != Edge::barrier) continue;
      const auto &c = outline.space[i], &d = outline.space[i + 1];
      const double near2 =
          std::min({squared_distance(piece.from, c, d), squared_distance(piece.to, c, d),
                    squared_distance(c, piece.from, piece.to), squared_distance(d, piece.from, piece.to)});
      expected = expected || near2 < margin * margin || cross(piece.a, piece.b, outline.plane[i], outline.plane[i + 1]);
    }
    touching += expected;
    CHECK(barrier.touches(outline, piece, margin) == expected);
  }
  CHECK(touching > 100);
  CHECK(touching < 2900);
}

TEST_CASE("cut edges are no barrier") {
  Outline outline;
  outline.add_ring(std::vector<Plane>{{0, 0}, {0.01, 0}, {0.01, 0.01}, {0, 0.01}}, {true, true, false, true});
  const Barrier barrier{outline};
  // from the middle of the western side the only barrier, the northern one, is 0.005 rad away
  CHECK(barrier.distance(outline, Space::at(0.005, 0), 1e9) ==
        Approx(0.005 * LocalMetric::at(0.0075).meridian_radius).epsilon(1e-5));
  const Outline none;
  CHECK(Barrier{none}.distance(none, Space::at(0, 0), 7) == 7);
  CHECK_FALSE(Barrier{}.touches(none, Piece{{0, 0}, {1, 1}, Space::at(0, 0), Space::at(1, 1)}, 1e6));
}
