#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/planning/lower_bound.hpp"
#include "tests/support/planning.hpp"
#include "tests/support/random_sea.hpp"

using namespace glidehelm;
using planning::Bound;

namespace {

constexpr double kDisc = 100;

struct Point {
  double x, y;  ///< metres about (0, 0) as a position
};
using Polygon = std::vector<Point>;  ///< convex, counter-clockwise

GeoPoint place(Point p) {
  const auto m = LocalMetric::at(0);
  return GeoPoint::from_kernel(p.y / m.meridian_radius, p.x / m.parallel_radius);
}
chart::Chart chart_of(const std::vector<Polygon>& islands) {
  chart::ChartSources sources;
  for (const auto& island : islands) {
    chart::Area area{"island", {}};
    for (const auto& p : island) area.vertices.push_back(place(p));
    sources.keep_out.push_back(std::move(area));
  }
  return chart::Chart{std::move(sources)};
}

/// Whether the straight way runs through the inside of a convex polygon: what its half-planes leave of the way is longer than nothing.
bool crosses(Point a, Point b, const Polygon& polygon) {
  double from = 0, to = 1;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double ex = q.x - p.x, ey = q.y - p.y, length = std::hypot(ex, ey);
    const auto inside = [&](Point r) { return (ex * (r.y - p.y) - ey * (r.x - p.x)) / length - 1e-6; };
    const double u = inside(a), v = inside(b);
    if (u <= 0 && v <= 0) return false;
    if (u < 0) from = std::max(from, u / (u - v));
    if (v < 0) to = std::min(to, u / (u - v));
  }
  return to > from;
}

/// The least time in a uniform current slower than the glider, to within `radius` of b: |d − c·t| = U·t + radius.
double straight_time(Point a, Point b, test::Uniform c, double radius) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  double low = 0, high = 1e8;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.5 * (low + high);
    (std::hypot(dx - c.east * t, dy - c.north * t) > test::kSpeed * t + radius ? low : high) = t;
  }
  return high;
}

/// The exact least time round convex islands: by symmetry in still water and because straight ways are the quickest in a uniform
/// current, the best way goes from corner to corner. Bellman and Ford over the graph of corners that see each other.
double least_time(Point from, Point to, const std::vector<Polygon>& islands, test::Uniform c) {
  std::vector<Point> nodes{from};
  for (const auto& island : islands) nodes.insert(nodes.end(), island.begin(), island.end());
  nodes.push_back(to);
  const std::size_t n = nodes.size();
  std::vector<double> time(n, 1e18);
  time[0] = 0;
  const auto sees = [&](std::size_t i, std::size_t j) {
    return std::none_of(islands.begin(), islands.end(),
                        [&](const Polygon& island) { return crosses(nodes[i], nodes[j], island); });
  };
  std::vector<std::vector<double>> cost(n, std::vector<double>(n, 1e18));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      if (i != j && sees(i, j)) cost[i][j] = straight_time(nodes[i], nodes[j], c, j + 1 == n ? kDisc : 0.0);
  for (std::size_t round = 0; round < n; ++round)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) time[j] = std::min(time[j], time[i] + cost[i][j]);
  return time[n - 1];
}

/// Convex islands of three to nine corners in a field of 30 by 40 km between start and goal, which may touch no other's circle.
std::vector<Polygon> random_islands(test::Dice& dice, std::size_t count) {
  struct Circle {
    Point at;
    double radius;
  };
  std::vector<Circle> circles;
  while (circles.size() < count) {
    const Circle c{{dice.between(-15e3, 15e3), dice.between(-20e3, 20e3)}, dice.between(1.5e3, 6e3)};
    if (std::all_of(circles.begin(), circles.end(), [&](const Circle& o) {
          return std::hypot(o.at.x - c.at.x, o.at.y - c.at.y) > o.radius + c.radius + 200;
        }))
      circles.push_back(c);
  }
  std::vector<Polygon> islands;
  for (const auto& c : circles) {
    const int corners = 3 + static_cast<int>(dice.between(0, 6.99));
    const double turn = dice.between(0, 2 * kPi);
    Polygon p;
    for (int i = 0; i < corners; ++i)
      p.push_back({c.at.x + c.radius * std::cos(turn + 2 * kPi * i / corners),
                   c.at.y + c.radius * std::sin(turn + 2 * kPi * i / corners)});
    islands.push_back(std::move(p));
  }
  return islands;
}
Polygon rectangle(double west, double south, double east, double north) {
  return {{west, south}, {east, south}, {east, north}, {west, north}};
}

planning::Problem submerged(Point from, Point to) {
  auto p = test::problem_between(place(from), place(to), kDisc);
  p.schedule.surface = p.schedule.time_to_dive = Seconds{0};
  p.coast_margin = Metres{0};
  return p;
}

/// The truth lies above the bound and, the bar being subtracted once, at most a second bar above that.
void check(Point from, Point to, const std::vector<Polygon>& islands, test::Uniform c, Metres spacing = Metres{},
           double most = 0.005) {
  const auto bound = planning::lower_bound(submerged(from, to), {c, c}, chart_of(islands), {}, {.spacing = spacing});
  REQUIRE(bound);
  REQUIRE(bound->kind == Bound::Kind::arrival);
  const double truth = least_time(from, to, islands, c);
  INFO("bound " << bound->travel_s << " s, error " << bound->error_s << " s, truth " << truth << " s");
  INFO("late by " << 100 * ((bound->travel_s + bound->error_s) / truth - 1) << " % with a bar of "
                  << 100 * bound->error_s / truth << " %");
  CHECK(bound->travel_s <= truth);
  CHECK(truth <= bound->travel_s + 2 * bound->error_s);
  CHECK(bound->error_s <= most * truth);
}

}  // namespace

TEST_CASE("the bound among islands is the exact way round their corners") {
  for (const std::uint64_t seed : {1U, 2U, 4U, 5U, 7U, 8U}) {
    test::Dice dice{seed};
    for (int k = 0; k < 16; ++k) dice.roll();
    const auto islands = random_islands(dice, 8);
    const double south = dice.between(-8e3, 8e3), north = dice.between(-8e3, 8e3);
    for (const auto& c : {test::Uniform{0, 0}, test::Uniform{0.1, 0.12}, test::Uniform{-0.12, 0.02}}) {
      INFO("seed " << seed << " current " << c.east << " " << c.north);
      check({-25e3, south}, {25e3, north}, islands, c);
    }
  }
}

TEST_CASE("the bound goes through straits far narrower than the spacing") {
  // A wall of 80 km with a gap, off the straight way; the markers are 400 m apart.
  for (const double width : {400.0, 100.0, 40.0}) {
    INFO("width " << width);
    const std::vector<Polygon> wall{rectangle(-1e3, -40e3, 1e3, 5.07e3), rectangle(-1e3, 5.07e3 + width, 1e3, 40e3)};
    // The run with twice the spacing comes later through the narrowest, which the bar shows.
    const double most = width > 50 ? 0.005 : 0.02;
    check({-15e3, 0}, {15e3, 1e3}, wall, {0, 0}, Metres{400}, most);
    check({-15e3, 0}, {15e3, 1e3}, wall, {-0.05, 0.1}, Metres{400}, most);
  }
}
