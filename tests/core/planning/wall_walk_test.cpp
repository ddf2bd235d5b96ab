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
