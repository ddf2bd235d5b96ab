#include "core/planning/wall_walk.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/fields.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;
using planning::Marker;
using planning::WallWalk;

namespace {

constexpr double kFast = 0.4;

chart::Chart island(const std::vector<GeoPoint>& corners) {
  chart::ChartSources sources;
  sources.keep_out.push_back({"island", corners});
  return chart::Chart{std::move(sources)};
}
/// A point's bearing from the origin, radians clockwise from north.
double bearing_of(const Marker& m) {
  const auto metric = LocalMetric::at(0);
  return std::atan2(m.lon * metric.parallel_radius, m.lat * metric.meridian_radius);
}
Marker at(GeoPoint p) { return {p.lat.radians(), p.lon.radians()}; }

}  // namespace

TEST_CASE("a walk round an island takes the time of its grown outline") {
  // A square of 8 km, grown by 3 km: sides and quarter circles. From the middle of the north side to that of the west side: land to
  // the left, 4 km + a quarter of a circle of 3 km + 4 km. kOff widens the circle by 2 m; strides bend by at most 0.2 rad, whose chord is
  // short by 0.2 %^2/24 of the arc.
  const auto chart = island({test::on_equator(-4e3, -4e3), test::on_equator(4e3, -4e3), test::on_equator(4e3, 4e3),
                             test::on_equator(-4e3, 4e3)});
  WallWalk walk{chart, 3e3};
  const test::Uniform still{0, 0};
  for (const auto way : {WallWalk::Way::forward, WallWalk::Way::back}) {
    auto m = at(test::on_equator(0, 7e3));
    REQUIRE(walk.settle(m));
    std::vector<Marker> sent;
    const double length = 8e3 + 0.5 * kPi * (3e3 + WallWalk::kOff);
    CHECK(walk.walk(m, way, nullptr, still, kFast, 0, length / kFast, sent) == WallWalk::End::under_way);
    const double sign = way == WallWalk::Way::forward ? -1 : 1;  // north to west, north to east
    CHECK(std::abs(std::remainder(bearing_of(m) - sign * 0.5 * kPi, 2 * kPi)) * 7e3 < 0.002 * length);
    CHECK(chart.clearance(m.lat, m.lon) == Approx(3e3 + WallWalk::kOff).margin(1.0));
    CHECK(m.north == Approx(-1).margin(1e-3));  // south at the end, whichever way round
    CHECK(sent.size() == 7);                    // one for each 0.2 rad of a right angle
  }
}

TEST_CASE("a walk adds the current along the wall and crabs against the current across it") {
  // A straight wall along the north: with 0.2 m/s along and 0.3 m/s onto the land the speed over ground is 0.2 + √(U² − 0.3²).
  const auto chart = island({test::on_equator(0, -60e3), test::on_equator(20e3, -60e3), test::on_equator(20e3, 60e3),
                             test::on_equator(0, 60e3)});
  WallWalk walk{chart, 1e3};
  const test::Uniform onto{0.3, 0.2};
  auto m = at(test::on_equator(-1e3, 0));
  REQUIRE(walk.settle(m));
  std::vector<Marker> sent;
  walk.walk(m, WallWalk::Way::back, nullptr, onto, kFast, 0, 20e3, sent);  // land to the right: north
  const double speed = 0.2 + std::sqrt(kFast * kFast - 0.09);
  CHECK(m.lat * LocalMetric::at(0).meridian_radius == Approx(speed * 20e3).epsilon(1e-3));
  CHECK(m.east == Approx(-0.3 / kFast).margin(1e-3));
  // A current that takes it off the wall faster than it can steer back lets it stay.
  const test::Uniform off{-0.5, 0.2};
  const auto before = m;
  walk.walk(m, WallWalk::Way::back, nullptr, off, kFast, 0, 1e3, sent);
  CHECK(std::abs(m.lat - before.lat) * 6.4e6 < 1);
  CHECK(sent.empty());
}

TEST_CASE("a corner that a walker is carried back over sends nothing a second time") {
  const auto chart = island({test::on_equator(-4e3, -4e3), test::on_equator(4e3, -4e3), test::on_equator(4e3, 4e3),
                             test::on_equator(-4e3, 4e3)});
  WallWalk walk{chart, 3e3};
  const test::Uniform still{0, 0};
  auto m = at(test::on_equator(0, 7e3));
  REQUIRE(walk.settle(m));
  std::vector<Marker> sent;
  const auto go = [&](const test::Uniform& current, double seconds) {
    sent.clear();
    CHECK(walk.walk(m, WallWalk::Way::forward, nullptr, current, kFast, 0, seconds, sent) == WallWalk::End::under_way);
  };
  const double arc = 0.5 * kPi * (3e3 + WallWalk::kOff);
  go(still, (4e3 + arc + 2e3) / kFast);  // round the north-western corner and 2 km down the west side
  CHECK(sent.size() == 7);
  CHECK(m.behind == 0);
  // On the west side 0.6 m/s onto the wall let nothing be steered along it, and 0.3 m/s carry it back; on the arc and on the north side,
  // where 0.3 m/s off the wall leave √(0.4² − 0.3²) along it, it is carried back too.
  go({0.6, 0.3}, 30e3);
  CHECK(sent.empty());
  CHECK(m.lat * LocalMetric::at(0).meridian_radius == Approx(7e3 + WallWalk::kOff).margin(1.0));
  CHECK(m.behind > arc + 2e3);
  // To the place where it was turned back: the chords of its strides are up to 0.2 %^2/24 shorter than arcs, and the corner is 2 km away.
  go(still, m.behind / kFast);
  CHECK(sent.empty());
  go(still, (4e3 + arc + 2e3) / kFast);  // the next corner is new ground
  CHECK(sent.size() == 7);
}

TEST_CASE("a walker that the current holds in the corner of two walls stays there") {
  // Land in the south and in the west. In the south 0.5 m/s carry it west, in the west 0.5 m/s carry it back south: both more than it
  // can steer against.
  chart::ChartSources sources;
  sources.keep_out.push_back({"south",
                              {test::on_equator(-20e3, -20e3), test::on_equator(20e3, -20e3), test::on_equator(20e3, 0),
                               test::on_equator(-20e3, 0)}});
  sources.keep_out.push_back({"west",
                              {test::on_equator(-20e3, -20e3), test::on_equator(0, -20e3), test::on_equator(0, 20e3),
                               test::on_equator(-20e3, 20e3)}});
  const chart::Chart chart{std::move(sources)};
  WallWalk walk{chart, 1e3};
  const test::Uniform into{-0.5, -0.5};
  auto m = at(test::on_equator(4e3, 1e3));
  REQUIRE(walk.settle(m));
  std::vector<Marker> sent;
  CHECK(walk.walk(m, WallWalk::Way::forward, nullptr, into, kFast, 0, 36e3, sent) == WallWalk::End::under_way);
  // Two metres off walls grown by 1 km, and the two shortest strides within which it is held.
  const double metres = LocalMetric::at(0).meridian_radius;
  CHECK(m.lat * metres == Approx(1e3 + WallWalk::kOff).margin(2 * WallWalk::kShortestStride));
  CHECK(m.lon * LocalMetric::at(0).parallel_radius ==
        Approx(1e3 + WallWalk::kOff).margin(2 * WallWalk::kShortestStride));
  CHECK(sent.empty());  // the way from one wall to the other and back is no bend
  // To and fro for all the 28 000 s that are left would be 3500 shortest strides, of two samples each.
  CHECK(walk.evaluations() < 350);
}

TEST_CASE("two that walk towards each other on one wall meet") {
  const auto chart = island({test::on_equator(0, -60e3), test::on_equator(20e3, -60e3), test::on_equator(20e3, 60e3),
                             test::on_equator(0, 60e3)});
  WallWalk walk{chart, 1e3};
  auto m = at(test::on_equator(-1e3, 0)), other = at(test::on_equator(-1e3, 3e3));
  REQUIRE(walk.settle(m));
  REQUIRE(walk.settle(other));
  std::vector<Marker> sent;
  const test::Uniform still{0, 0};
  CHECK(walk.walk(m, WallWalk::Way::back, &other, still, kFast, 0, 30e3, sent) == WallWalk::End::met);
  CHECK(local_offset(m.lat, m.lon, other.lat, other.lon).length() < WallWalk::kMeet);
}
