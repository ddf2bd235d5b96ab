#include "core/vehicle/drift.hpp"

#include <catch2/catch.hpp>

#include "tests/support/chart_art.hpp"
#include "tests/support/planning.hpp"

using namespace glidehelm;
using namespace glidehelm::vehicle;

namespace {

constexpr double kDay = 86'400.0;

DriftSettings for_seconds(double duration, double every = 6 * 3600.0) {
  return {test::kT0, Seconds{duration}, Seconds{every}};
}

/// Any function of position and depth as a field; it may have no current.
struct Layered {
  std::function<Expected<Current, ocean::NoCurrent>(GeoPoint, double depth, double t_s)> current;
  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth z, double t_s) const {
    const auto found = current(p, z.below_surface.si(), t_s);
    if (!found) return unexpected(found.error());
    return ocean::Sample{*found, false};
  }
  [[nodiscard]] ocean::Coverage coverage() const { return {}; }
  [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{1}; }
};

/// 0.2 m/s eastward, until `none` says why there is no current.
Layered eastward_until(std::function<std::optional<ocean::NoCurrent>(GeoPoint, double depth, double t_s)> none) {
  return {[none = std::move(none)](GeoPoint p, double depth, double t_s) -> Expected<Current, ocean::NoCurrent> {
    if (const auto why = none(p, depth, t_s)) return unexpected(*why);
    return test::current(0.2, 0);
  }};
}

/// Along 0 E; the longitude of the end in metres along the equator.
double metres_east(const DriftPoint& p) { return p.at.lon.radians() * test::kEquator; }

}  // namespace

TEST_CASE("a drifter in a uniform current goes along the parallel and the meridian as far as the current does") {
  const chart::Chart open;
  const double way = 0.2 * 10 * kDay;
  // A Runge–Kutta step is exact where the metric stays, and along a meridian M(φ) is smooth over 240 m: rounding is left,
  // of latitudes (1e-9 m) and of epoch seconds (2.4e-7 s) in some thousand steps.
  for (const double lat : {0.0, 41.0, -72.0}) {
    const auto from = geo_point(lat, 179.5);
    const test::Uniform east{0.2, 0}, north{0, 0.2};
    const auto along = drift(Drifter{}, east, open, from, for_seconds(10 * kDay));
    CHECK(along.end == DriftEnd::time);
    REQUIRE(along.points.size() == 41);  // every six hours, both ends
    const auto there = GeoPoint::from_kernel(
        from.lat.radians(), from.lon.radians() + way / LocalMetric::at(from.lat.radians()).parallel_radius);
    CHECK(distance(along.points.back().at, there).si() < 0.01);
    CHECK(along.points[1].t_s == test::kT0 + 6 * 3600);
    const auto up = drift(Drifter{Metres{15}}, north, open, from, for_seconds(10 * kDay));
    CHECK(distance(up.points.back().at, destination(from, Bearing{}, Metres{way})).si() < 0.01);
    CHECK(up.points.back().depth == Metres{15});
    CHECK(up.points.back().current == test::current(0, 0.2));
  }
}

TEST_CASE(
    "a drifter in solid-body rotation is back after a period, and sixteen times nearer with half the steps' length") {
  // In the plane of longitude and latitude the water turns around (28 N, 0 E) in six hours: exact on the ellipsoid.
  const double omega = 2 * kPi / (6 * 3600.0), lat0 = 28 * kPi / 180, x = 5e-4;  // 2.8 km, 0.8 m/s
  const test::FromFunction eddy{
      [&](double lat, double lon, double) {
        const auto m = LocalMetric::at(lat);
        return std::pair{-omega * (lat - lat0) * m.parallel_radius, omega * lon * m.meridian_radius};
      },
      1.0};
  const chart::Chart open;
  const auto from = GeoPoint::from_kernel(lat0, x);
  const auto missed = [&](double every) {
    const auto track = drift(Drifter{}, eddy, open, from, for_seconds(6 * 3600.0, every));
    CHECK(track.end == DriftEnd::time);
    const auto half = track.points[track.points.size() / 2];  // on the other side after half the time
    CHECK(distance(half.at, GeoPoint::from_kernel(lat0, -x)).si() < 0.1);
    return distance(track.points.back().at, from).si();
  };
  // Points every 600 s make steps of 300 s: 72 of r·(ωh)^5/120 each are 0.010 m; whole and halves differ by r·(600 ω)^5/120 =
  // 4 mm, so none is halved. Steps of half the length leave 1/16, to the next order: (ωh)² = 0.8 %.
  const double coarse = missed(600), fine = missed(300);
  CHECK(coarse < 0.015);
  CHECK(coarse / fine == Approx(16).epsilon(0.05));
}

TEST_CASE("a float in two layers is carried by each for as long as it is in it") {
  // Above 500 m the water goes east, below it north.
  const Layered layers{[](GeoPoint, double depth, double) -> Expected<Current, ocean::NoCurrent> {
    return depth < 500 ? test::current(0.3, 0) : test::current(0, 0.1);
  }};
  ProfilingFloat f;  // parks at 1000 m, profiles from 2000 m, 0.1 m/s
  f.cycle = Seconds{216'000};
  f.surface = Seconds{3600};
  const chart::Chart open;
  const auto track = drift(f, layers, open, geo_point(0, 0), for_seconds(216'000, 1e7));
  CHECK(track.end == DriftEnd::time);
  struct Change {
    DriftPhase phase;
    double depth, after;
  };
  // Down 10 000 s to the parking depth; parked until 40 000 s of sinking and rising and the hour at the surface are left.
  const std::vector<Change> expected{
      {DriftPhase::sinking, 0, 0},         {DriftPhase::parked, 1000, 10'000}, {DriftPhase::deepening, 1000, 182'400},
      {DriftPhase::rising, 2000, 192'400}, {DriftPhase::surfaced, 0, 212'400}, {DriftPhase::sinking, 0, 216'000}};
  REQUIRE(track.points.size() == expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    INFO(k);
    CHECK(track.points[k].phase == expected[k].phase);
    CHECK(track.points[k].depth.si() == Approx(expected[k].depth).margin(1e-6));
    CHECK(track.points[k].t_s - test::kT0 == Approx(expected[k].after).margin(1e-3));
  }
  const auto way = local_offset(0, 0, track.points.back().at.lat.radians(), track.points.back().at.lon.radians());
  // East for 5000 s down, 5000 s up and the hour at the surface; north for the rest. The jump lies within one step of 10 s at
  // most on the way down and one on the way up: (0.3 + 0.1)·10 m each. 20 km from the equator the metric is off by 1e-5.
  CHECK(way.east == Approx(0.3 * 13'600).margin(8));
  CHECK(way.north == Approx(0.1 * (216'000 - 13'600)).margin(8));

  const auto twice = drift(f, layers, open, geo_point(0, 0), for_seconds(432'000, 1e7));
  CHECK(twice.points.size() == 11);  // the second cycle follows the first
  const auto both = local_offset(0, 0, twice.points.back().at.lat.radians(), twice.points.back().at.lon.radians());
  CHECK(both.east == Approx(0.3 * 27'200).margin(16));
}

TEST_CASE("a float in water that is too shallow parks as deep as there is a current and a drifter ends there") {
  const double shelf = 0.05 * kPi / 180;  // longitude from which the water is 300 m deep, 600 m before
  const auto sea = eastward_until([&](GeoPoint p, double depth, double) {
    return depth > (p.lon.radians() > shelf ? 300 : 600) ? std::optional{ocean::NoCurrent::below_bottom} : std::nullopt;
  });
  const chart::Chart open;
  const auto carried = drift(ProfilingFloat{}, sea, open, geo_point(0, 0), for_seconds(3 * kDay));
  CHECK(carried.end == DriftEnd::time);
  CHECK(metres_east(carried.points.back()) == Approx(0.2 * 3 * kDay).margin(0.1));
  CHECK(carried.points.back().due == Metres{1000});
  CHECK(carried.points.back().depth.si() == Approx(300).margin(0.5));  // to half a metre, see yo.hpp
  CHECK(carried.points[2].depth.si() == Approx(600).margin(0.5));      // parked, before the shelf

  const auto stopped = drift(Drifter{Metres{400}}, sea, open, geo_point(0, 0), for_seconds(3 * kDay));
  CHECK(stopped.end == DriftEnd::bottom);
  // The last step that was tried is 10 s long: 2 m at most before the edge.
  CHECK(metres_east(stopped.points.back()) <= shelf * test::kEquator);
  CHECK(metres_east(stopped.points.back()) == Approx(shelf * test::kEquator).margin(2.1));
  const auto never = drift(Drifter{Metres{700}}, sea, open, geo_point(0, 0), for_seconds(kDay));
  CHECK(never.end == DriftEnd::bottom);
  CHECK(never.points.empty());
}

TEST_CASE("a drift ends where water, data, area or forecast do and says which") {
  const chart::Chart open;
  const double edge = 0.05 * kPi / 180;
  for (const auto& [none, end] :
       {std::pair{ocean::NoCurrent::land, DriftEnd::aground}, std::pair{ocean::NoCurrent::no_data, DriftEnd::no_data},
        std::pair{ocean::NoCurrent::outside_area, DriftEnd::left_area}}) {
    INFO(word(end));
    const auto sea = eastward_until([&, why = none](GeoPoint p, double, double) {
      return p.lon.radians() > edge ? std::optional{why} : std::nullopt;
    });
    const auto track = drift(Drifter{}, sea, open, geo_point(0, 0), for_seconds(2 * kDay));
    CHECK(track.end == end);
    CHECK(metres_east(track.points.back()) <= edge * test::kEquator);
    CHECK(metres_east(track.points.back()) == Approx(edge * test::kEquator).margin(2.1));  // 10 s, as above
    const auto nowhere = drift(Drifter{}, sea, open, geo_point(0, 1), for_seconds(kDay));
    CHECK(nowhere.end == end);
    CHECK(nowhere.points.empty());
  }
  const auto ending = eastward_until([](GeoPoint, double, double t_s) {
    return t_s > test::kT0 + 50'000 ? std::optional{ocean::NoCurrent::outside_time} : std::nullopt;
  });
  const auto ended = drift(Drifter{}, ending, open, geo_point(0, 0), for_seconds(2 * kDay));
  CHECK(ended.end == DriftEnd::forecast);
  CHECK(ended.points.back().t_s - test::kT0 == Approx(50'000).margin(10));

  auto settings = for_seconds(2 * kDay);
  settings.forecast_last_s = test::kT0 + 50'000;
  const test::Uniform held{0.2, 0};
  const auto told = drift(Drifter{}, held, open, geo_point(0, 0), settings);
  CHECK(told.end == DriftEnd::forecast);
  CHECK(told.points.back().t_s == settings.forecast_last_s);
}

TEST_CASE("a drifter strands on the shore of the chart, and leaving the chart is not stranding") {
  const test::ChartArt art{R"(
      ~~~~~~
      ~S~#L~
      ~~~~~~
      ~W~~~~
      ~~~~~~)",
                           28.0, -16.0, 0.1};
  const test::Uniform east{0.2, 0};
  const auto track = drift(Drifter{}, east, art.chart, art.at('S'), for_seconds(10 * kDay));
  CHECK(track.end == DriftEnd::aground);
  // 10 s at 0.2 m/s, and what a distance of the chart may be off (0.2 m and 1e-5 of it).
  CHECK(art.chart.distance_to_coast(track.points.back().at).si() == Approx(0).margin(2.3));
  const auto out = drift(Drifter{}, east, art.chart, art.at('W'), for_seconds(10 * kDay));
  CHECK(out.end == DriftEnd::left_chart);
  CHECK(out.points.back().at.lon.degrees() == Approx(-15.4).margin(3e-5));  // 2.1 m of longitude
  const auto ashore = drift(Drifter{}, east, art.chart, geo_point(28.35, -15.65), for_seconds(kDay));
  CHECK(ashore.end == DriftEnd::aground);
  CHECK(ashore.points.empty());
}

TEST_CASE("a float whose numbers cannot be is told why") {
  CHECK(why_no_float({}).empty());
  ProfilingFloat f;
  f.profile = Metres{900};
  CHECK(why_no_float(f).find("deeper") != std::string::npos);
  f = {};
  f.cycle = Seconds{2 * 2000 / 0.1 + 1800};  // down, up and half an hour: to the second
  CHECK(why_no_float(f).empty());
  f.cycle -= Seconds{1};
  CHECK(why_no_float(f).find("take 697 min") != std::string::npos);
}
