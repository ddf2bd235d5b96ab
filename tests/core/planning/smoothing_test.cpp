#include "core/planning/smoothing.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstddef>

#include "tests/support/random_sea.hpp"

using namespace glidehelm;
using planning::smooth;
using planning::StraightTime;
using planning::WayPoint;

namespace {

/// Plane distance over a speed of one: lengths are times.
std::optional<double> still(const WayPoint& a, const WayPoint& b, double) {
  return std::hypot(b.lat - a.lat, b.lon - a.lon);
}
std::vector<WayPoint> stairs(int steps) {
  std::vector<WayPoint> way;
  for (int i = 0; i <= steps; ++i) way.push_back({static_cast<double>(i / 2), static_cast<double>((i + 1) / 2), 0, 0});
  return way;
}
double arrival(const std::vector<WayPoint>& way, const StraightTime& seconds) {
  double t = way.front().t_s;
  for (std::size_t i = 1; i < way.size(); ++i) t += seconds(way[i - 1], way[i], t).value_or(1e9);
  return t;
}

}  // namespace

TEST_CASE("stairs in still water become the straight line between their ends") {
  const auto smoothed = smooth(stairs(8), still);
  REQUIRE(smoothed.size() == 2);
  CHECK(smoothed.front().lon == 0);
  CHECK(smoothed.back().lat == 4);
  CHECK(smoothed.back().t_s == Approx(std::hypot(4.0, 4.0)));
}

TEST_CASE("a corner that keeps a way off an obstacle stays, the others go") {
  // A block reaches to y = 2 at x = 4: lines that cross x = 4 below it cannot be flown. The way climbs in stairs to (4, 2) and down again.
  const StraightTime seconds = [](const WayPoint& a, const WayPoint& b, double t) -> std::optional<double> {
    if (a.lon <= 4 && b.lon >= 4 && a.lon < b.lon) {
      const double y = a.lat + (4 - a.lon) / (b.lon - a.lon) * (b.lat - a.lat);
      if (y < 2 - 1e-9) return std::nullopt;
    }
    return still(a, b, t);
  };
  const std::vector<WayPoint> way{{0, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 0, 0}, {2, 3, 0, 0}, {2, 4, 0, 0},
                                  {2, 5, 0, 0}, {1, 6, 0, 0}, {1, 7, 0, 0}, {0, 8, 0, 0}};
  const auto smoothed = smooth(way, seconds);
  REQUIRE(smoothed.size() == 3);
  CHECK(smoothed[1].lat == 2);
  CHECK(smoothed[1].lon == 4);
  CHECK(smoothed.back().t_s == Approx(2 * std::hypot(2.0, 4.0)));
}

TEST_CASE("a short cut that comes too early for the rest of the way is not taken: test V") {
  // A tide closes the last leg until t = 3: who leaves for it earlier waits for the end of the tide and pays two beside. Stairs come to it at 3
  // and take one; past the corner one comes at 2.24 and takes 0.76 + 2 + 1.
  const StraightTime seconds = [](const WayPoint& a, const WayPoint& b, double t) -> std::optional<double> {
    const auto leg = still(a, b, t);
    return b.lon > 2.5 && t < 3 ? 3 - t + 2 + *leg : *leg;
  };
  const std::vector<WayPoint> way{{0, 0, 0, 0}, {1, 0, 0, 0}, {1, 2, 0, 0}, {1, 3, 0, 0}};
  const auto smoothed = smooth(way, seconds);
  CHECK(smoothed.size() == 4);
  CHECK(smoothed.back().t_s == Approx(4));
}

TEST_CASE("rounds go on until no waypoint can be left out: what a first round had to keep a later one drops") {
  int whole = 0;  // times that the line from end to end is asked for
  const StraightTime seconds = [&](const WayPoint& a, const WayPoint& b, double t) -> std::optional<double> {
    if (a.lon == 0 && b.lon == 6) ++whole;
    if (a.lon == 0 && b.lon == 2) return 2.5;  // slower than its halves, which take one each
    return still(a, b, t);
  };
  const std::vector<WayPoint> way{{0, 0, 0, 0}, {0, 1, 0, 0}, {0, 2, 0, 0}, {0, 4, 0, 0}, {0, 6, 0, 0}};
  // First round: 0 → 2 is refused, so 1 stays, and 1 → 6 is straight. Second round: 0 → 6 past 1.
  const auto smoothed = smooth(way, seconds);
  CHECK(smoothed.size() == 2);
  CHECK(whole == 1);
  CHECK(smoothed.back().t_s == Approx(6));
}

TEST_CASE("no way ever arrives later when it is smoothed, and its times are those of its legs") {
  // Random ways in a random time of legs: length, a slope across the plane and a tide.
  test::Dice dice{20261126};
  for (int i = 0; i < 300; ++i) {
    const double slope = dice.between(-0.4, 0.4), tide = dice.between(0, 0.4), period = dice.between(1, 10);
    const StraightTime seconds = [=](const WayPoint& a, const WayPoint& b, double t) -> std::optional<double> {
      const double length = std::hypot(b.lat - a.lat, b.lon - a.lon);
      if (length > 6) return std::nullopt;
      return length * (1 + slope * std::sin(a.lat + b.lat) + tide * std::sin(2 * kPi * t / period));
    };
    std::vector<WayPoint> way{{0, 0, dice.between(0, 10), 0}};
    for (int k = 0; k < 12; ++k) {
      way.push_back(way.back());
      way.back().lon += dice.between(0, 2);
      way.back().lat += dice.between(-1, 1);
    }
    const auto smoothed = smooth(way, seconds);
    INFO("way " << i << " of seed 20261126");
    CHECK(smoothed.size() <= way.size());
    CHECK(smoothed.front().lon == way.front().lon);
    CHECK(smoothed.back().lon == way.back().lon);
    CHECK(smoothed.back().t_s <= arrival(way, seconds) + 1e-12);
    CHECK(smoothed.back().t_s == Approx(arrival(smoothed, seconds)).epsilon(1e-12));
  }
}

TEST_CASE("ways of less than three places, and those that cannot be flown, come back as they are") {
  CHECK(smooth({}, still).empty());
  CHECK(smooth({{0, 0, 5, 0}}, still).size() == 1);
  CHECK(smooth({{0, 0, 5, 0}, {0, 1, 6, 0}}, still).size() == 2);
  const StraightTime never = [](const WayPoint&, const WayPoint&, double) { return std::nullopt; };
  CHECK(smooth(stairs(4), never).size() == 5);
}
