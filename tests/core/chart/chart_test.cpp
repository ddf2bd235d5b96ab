#include "core/chart/chart.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <thread>

#include "core/chart/areas.hpp"
#include "tests/core/chart/shapes.hpp"
#include "tests/support/chart_art.hpp"

using namespace glidehelm;
using namespace glidehelm::chart;
using namespace glidehelm::test;

namespace {

Chart chart_of(const CoastArea& area, const std::vector<LonLat>& rings, std::vector<Area> keep_in = {},
               std::vector<Area> keep_out = {}) {
  return Chart{ChartSources{coast_of(area, rings), std::move(keep_in), std::move(keep_out)}};
}

double clearance_at(const Chart& chart, double lat, double lon) { return chart.clearance(rad(lat), rad(lon)); }
bool clear(const Chart& chart, double lat0, double lon0, double lat1, double lon1, double margin) {
  return chart.segment_is_clear(rad(lat0), rad(lon0), rad(lat1), rad(lon1), margin);
}

Area polygon(std::string name, const LonLat& corners) {
  Area area{std::move(name), {}};
  for (const auto& [lon, lat] : corners) area.vertices.push_back(geo_point(lat, lon));
  return area;
}

}  // namespace

TEST_CASE("an open ocean is clear everywhere") {
  const Chart sea;
  CHECK_FALSE(sea.has_coast());
  CHECK_FALSE(sea.is_land(geo_point(47, 8)));
  CHECK(sea.is_charted(geo_point(47, 8)));
  CHECK(clearance_at(sea, 10, 20) == Chart::kHorizon);
  CHECK(sea.clearance_at_least(rad(10), rad(20)) == Chart::kHorizon);
  CHECK(sea.distance_to_coast(geo_point(10, 20)).si() == Chart::kHorizon);
  CHECK(clear(sea, 10, 20, 10.4, 20, 2000));
  CHECK(clear(sea, 10, 20, 40, 80, Chart::kHorizon));
  CHECK_FALSE(clear(sea, 10, 20, 10.4, 20, Chart::kHorizon + 1));
  const Chart empty{ChartSources{}};
  CHECK(clearance_at(empty, 10, 20) == Chart::kHorizon);
  CHECK(empty.clearance_at_least(rad(10), rad(20)) == Chart::kHorizon);
}

TEST_CASE("a square island: land inside, exact distances outside, negative ones inside") {
  // 0.2° wide around 28°N 15°W; the nearest point of a side that runs along a meridian or of a corner is known, and
  // GeographicLib says how far it is.
  const auto area = area_of(-17, -13, 26, 30);
  const auto chart = chart_of(area, {box_of(-15.1, -14.9, 27.9, 28.1)});
  CHECK(chart.has_coast());
  CHECK(chart.is_land(geo_point(28, -15)));
  CHECK_FALSE(chart.is_land(geo_point(28.2, -15)));
  const auto corner = geo_point(28.1, -14.9);
  for (const auto& [lat, lon] :
       std::vector<std::pair<double, double>>{{28.1005, -14.8995}, {28.15, -14.85}, {28.4, -14.7}}) {
    const double exact = distance(geo_point(lat, lon), corner).si();
    INFO("at " << lat << ", " << lon << ": " << exact);
    CHECK(clearance_at(chart, lat, lon) == Approx(exact).margin(promised(exact)));
    CHECK(chart.distance_to_coast(geo_point(lat, lon)).si() == Approx(exact).margin(promised(exact)));
  }
  const double from_side = brute_distance(geo_point(28, -14.8), -14.9, 27.9, -14.9, 28.1);
  CHECK(clearance_at(chart, 28, -14.8) == Approx(from_side).margin(promised(from_side)));
  const double within = brute_distance(geo_point(28, -14.95), -14.9, 27.9, -14.9, 28.1);
  CHECK(clearance_at(chart, 28, -14.95) == Approx(-within).margin(promised(within)));
  CHECK(chart.distance_to_coast(geo_point(28, -14.95)).si() == Approx(-within).margin(promised(within)));
  // 1° is 111 km: beyond the horizon of both the island and the border of the chart
  CHECK(clearance_at(chart, 27, -14) == Chart::kHorizon);
}

TEST_CASE("a lake is water and its island is land") {
  const auto chart = chart_of(area_of(0, 4, 50, 54),
                              {box_of(1, 3, 51, 53), box_of(1.5, 2.5, 51.5, 52.5), box_of(1.9, 2.1, 51.9, 52.1)});
  CHECK(chart.is_land(geo_point(51.2, 2)));
  CHECK_FALSE(chart.is_land(geo_point(51.7, 2)));
  CHECK(chart.is_land(geo_point(52, 2)));
  CHECK_FALSE(chart.is_land(geo_point(50.5, 2)));
  const double in_lake = brute_distance(geo_point(51.8, 2), {box_of(1.9, 2.1, 51.9, 52.1)});
  CHECK(clearance_at(chart, 51.8, 2) == Approx(in_lake).margin(promised(in_lake)));
}

TEST_CASE("outside the coast file nothing is known and nothing is allowed") {
  const auto chart = chart_of(area_of(-17, -13, 26, 30), {box_of(-15.1, -14.9, 27.9, 28.1)});
  CHECK(chart.is_charted(geo_point(30, -13)));
  CHECK_FALSE(chart.is_charted(geo_point(30.01, -13)));
  CHECK_FALSE(chart.is_charted(geo_point(28, 165)));
  CHECK_FALSE(chart.is_land(geo_point(30.01, -13)));
  const double out = brute_distance(geo_point(28, -17.1), -17, 26, -17, 30);
  CHECK(clearance_at(chart, 28, -17.1) == Approx(-out).margin(promised(out)));
  CHECK(clearance_at(chart, 28, -16.9) == Approx(brute_distance(geo_point(28, -16.9), -17, 26, -17, 30)).margin(0.3));
  CHECK(clearance_at(chart, -28, 100) == -Chart::kHorizon);
  CHECK(chart.clearance_at_least(rad(28), rad(-17.1)) < 0);
  CHECK_FALSE(clear(chart, 28, -16.9, 28, -17.1, 0));
  CHECK_FALSE(clear(chart, 28, -17.2, 28, -17.1, 0));
  CHECK(clear(chart, 28, -16.9, 28.1, -16.9, 2000));
  // the land's own distance does not end at the border of the file
  const auto cape = chart_of(area_of(-17, -13, 26, 30), {box_of(-16.9, -16.5, 27.9, 28.1)});
  CHECK(cape.distance_to_coast(geo_point(28, -17.1)).si() > 0);
  CHECK(cape.distance_to_coast(geo_point(28, -17.1)).si() ==
        Approx(brute_distance(geo_point(28, -17.1), -16.9, 27.9, -16.9, 28.1)).margin(0.4));
}

TEST_CASE("a cut edge bounds the land but is no shore") {
  // land along the whole western border
  const auto area = area_of(10, 12, 40, 42);
  auto ring = ring_of(area, box_of(10, 10.2, 40, 42));
  // the edges along the south, north and west border
  ring.cut = {true, false, true, true};
  const Chart chart{ChartSources{Coast::make(area, "cut", {ring}).value(), {}, {}}};
  CHECK(chart.is_land(geo_point(41, 10.1)));
  const double shore = brute_distance(geo_point(40.01, 10.5), 10.2, 40, 10.2, 42);
  CHECK(chart.distance_to_coast(geo_point(40.01, 10.5)).si() == Approx(shore).margin(promised(shore)));
  // the border of the file is as near as it is, whoever cut it
  const double border = brute_distance(geo_point(40.01, 10.5), 10.4, 40, 10.6, 40);
  CHECK(clearance_at(chart, 40.01, 10.5) == Approx(border).margin(promised(border)));
  // deep in the land beside the cut edge: the shore is what is far away
  const double way_out = brute_distance(geo_point(41, 10.01), 10.2, 40, 10.2, 42);
  CHECK(chart.distance_to_coast(geo_point(41, 10.01)).si() == Approx(-way_out).margin(promised(way_out)));
}

TEST_CASE("random positions agree with brute force over all edges on the geodesic") {
  struct Sea {
    double lon, lat;
  };
  for (const auto& sea : {Sea{-15, 28}, Sea{179.9, -17}, Sea{20, 75}, Sea{-179.95, 79.5}, Sea{0.01, 0.0}}) {
    std::mt19937_64 random{static_cast<std::uint64_t>(1000 + sea.lat)};
    const double stretch = 1 / std::cos(rad(sea.lat));
    const double west = std::round((sea.lon - 0.9 * stretch) * 1e6) / 1e6;
    const double base = west < -180 ? 360 : 0;
    const double lon = sea.lon + base;
    const auto area = area_of(west + base, lon + 0.9 * stretch, sea.lat - 0.9, std::min(sea.lat + 0.9, 84.0));
    const std::vector<LonLat> rings{star(lon - 0.3 * stretch, sea.lat, 0.25, 24, random),
                                    star(lon + 0.35 * stretch, sea.lat + 0.2, 0.2, 60, random),
                                    star(lon, sea.lat - 0.45, 0.1, 7, random)};
    const auto chart = chart_of(area, rings);
    std::uniform_real_distribution<double> east{lon - 0.6 * stretch, lon + 0.6 * stretch},
        north{sea.lat - 0.6, sea.lat + 0.6};
    for (int k = 0; k < 60; ++k) {
      const double x = east(random), y = north(random);
      const auto p = geo_point(y, x > 180 ? x - 360 : x);
      const bool land = brute_inside(x, y, rings);
      double exact = brute_distance(p, rings);
      INFO("sea at " << sea.lat << ", " << sea.lon << ": " << p.lat.degrees() << ", " << p.lon.degrees() << ", "
                     << exact);
      CHECK(chart.is_land(p) == land);
      exact = std::min(exact, Chart::kHorizon);
      CHECK(chart.distance_to_coast(p).si() == Approx(land ? -exact : exact).margin(promised(exact)));
      const auto deg = [](std::int64_t coordinate) { return static_cast<double>(coordinate) / kCoastUnitsPerDegree; };
      const auto meridian = [&](double at) { return brute_distance(p, at, y - 0.3, at, y + 0.3); };
      const auto parallel = [&](double at) { return brute_distance(p, x - 0.3 * stretch, at, x + 0.3 * stretch, at); };
      const double border = std::min(
          {meridian(deg(area.west)), meridian(deg(area.east)), parallel(deg(area.south)), parallel(deg(area.north))});
      const double clearance = land ? -exact : std::min({exact, border, Chart::kHorizon});
      CHECK(chart.clearance(p).si() == Approx(clearance).margin(promised(exact)));
      // the raster never says more than the truth, and in water not much less
      const double bound = chart.clearance_at_least(p.lat.radians(), p.lon.radians());
      CHECK(bound <= clearance + promised(exact));
      if (clearance > 0) CHECK(bound >= clearance - std::max(0.25 * clearance, 250.0 * 1.5 * std::sqrt(2.0)) - 1);
    }
  }
}

TEST_CASE("clearance grows by no more than a metre per metre") {
  std::mt19937_64 random{5};
  const auto chart =
      chart_of(area_of(-17, -13, 26, 30), {star(-15, 28, 0.5, 40, random), star(-14.2, 28.3, 0.3, 40, random)},
               {polygon("in", box_of(-16, -14, 27, 29)), polygon("also in", box_of(-14.2, -13.5, 27.5, 28.5))},
               {polygon("out", {{-15.5, 28.4}, {-15.2, 28.6}, {-15.6, 28.7}})});
  std::uniform_real_distribution<double> lat{27, 29.2}, lon{-16.5, -13.2}, step{-0.01, 0.01};
  for (int k = 0; k < 5000; ++k) {
    const double a = lat(random), b = lon(random), c = a + step(random), d = b + step(random);
    const double between = distance(geo_point(a, b), geo_point(c, d)).si();
    // the promised errors of two distances below the horizon
    CHECK(std::abs(clearance_at(chart, a, b) - clearance_at(chart, c, d)) <= between + 2 * promised(Chart::kHorizon));
  }
}

TEST_CASE("a segment is clear when the sampled clearance along it is, random ways beside random shores") {
  std::mt19937_64 random{11};
  for (const double lat0 : {28.0, 75.0, -60.0}) {
    const double stretch = 1 / std::cos(rad(lat0));
    const auto chart = chart_of(
        area_of(-180 + 3, -180 + 3 + 4 * stretch, lat0 - 2, lat0 + 2),
        {star(-177 + 1.6 * stretch, lat0, 0.4, 80, random), star(-177 + 2.4 * stretch, lat0 + 0.2, 0.3, 80, random)});
    std::uniform_real_distribution<double> lat{lat0 - 0.6, lat0 + 0.6}, lon{-177 + 1.2 * stretch, -177 + 2.8 * stretch},
        reach{-0.15, 0.15}, margin{0, 4000};
    int yes = 0, no = 0;
    for (int k = 0; k < 300; ++k) {
      const double a = lat(random), b = lon(random), c = a + reach(random), d = b + stretch * reach(random);
      const double wanted = margin(random);
      // Samples 25 m apart: between two of them the clearance is at most 12.5 m less (one metre per metre), so nothing
      // is asked where the least sample is that near above the margin.
      const double length = distance(geo_point(a, b), geo_point(c, d)).si();
      const int samples = 2 + static_cast<int>(length / 25);
      double least = 1e9;
      for (int i = 0; i <= samples; ++i) {
        const double t = static_cast<double>(i) / samples;
        least = std::min(least, clearance_at(chart, a + t * (c - a), b + t * (d - b)));
      }
      if (least >= wanted - 1 && least <= wanted + 13.5) continue;
      INFO(a << ", " << b << " to " << c << ", " << d << " margin " << wanted << ", least " << least);
      const bool expected = least >= wanted;
      ++(expected ? yes : no);
      CHECK(clear(chart, a, b, c, d, wanted) == expected);
      CHECK(clear(chart, c, d, a, b, wanted) == expected);
      CHECK(chart.segment_is_clear(rad(a), rad(b), clearance_at(chart, a, b), rad(c), rad(d), clearance_at(chart, c, d),
                                   wanted) == expected);
      // a negative margin is judged point by point, up to 1 m
      if (std::abs(least + wanted) > 14) CHECK(clear(chart, a, b, c, d, -wanted) == (least >= -wanted));
    }
    CHECK(yes > 50);
    CHECK(no > 50);
  }
}

TEST_CASE("segments that hug a shore are told apart to a metre") {
  // a shore along 20°N: distances to it are differences of latitude, M(20°)·Δφ
  const auto chart = chart_of(area_of(30, 32, 19, 21), {box_of(30.2, 31.8, 20, 20.5)});
  const double metres = rad(1.0) * LocalMetric::at(rad(20)).meridian_radius;  // per degree
  const double lat = 20 - 1000 / metres;
  CHECK(clear(chart, lat, 30.5, lat, 31.0, 999));
  CHECK_FALSE(clear(chart, lat, 30.5, lat, 31.0, 1001));
  CHECK(clear(chart, lat, 31.0, lat, 30.5, 999));
  CHECK_FALSE(clear(chart, lat, 31.0, lat, 30.5, 1001));
  // only the middle comes near: an edge to a cape between two ends that are far off
  const auto cape = chart_of(area_of(30, 32, 19, 21), {{{30.9, 20.5}, {31, 20}, {31.1, 20.5}}});
  CHECK(clear(cape, lat, 30.75, lat, 31.25, 999));
  CHECK_FALSE(clear(cape, lat, 30.75, lat, 31.25, 1001));
  // through the tip, and just past it, with no margin at all
  CHECK_FALSE(clear(cape, 20.01, 30.8, 20.01, 31.2, 0));
  CHECK(clear(cape, 19.99999, 30.8, 19.99999, 31.2, 0));
}

TEST_CASE("a thin island between two far ends is never jumped over") {
  // 20 m wide, 300 m long: smaller than a raster cell
  const auto chart = chart_of(area_of(0, 1, 10, 11), {box_of(0.5, 0.5002, 10.5, 10.503)});
  CHECK_FALSE(clear(chart, 10.501, 0.3, 10.501, 0.7, 0));
  CHECK_FALSE(clear(chart, 10.501, 0.7, 10.501, 0.3, 0));
  CHECK(clear(chart, 10.51, 0.3, 10.51, 0.7, 500));
  CHECK_FALSE(clear(chart, 10.51, 0.3, 10.51, 0.7, 900));
}

TEST_CASE("clear with a margin means clear with every smaller one") {
  std::mt19937_64 random{17};
  const auto chart = chart_of(area_of(-17, -13, 26, 30), {star(-15, 28, 0.5, 60, random)}, {},
                              {polygon("out", box_of(-14.4, -14.2, 27.9, 28.1))});
  std::uniform_real_distribution<double> lat{27.2, 28.8}, lon{-15.8, -14.0}, reach{-0.2, 0.2};
  for (int k = 0; k < 300; ++k) {
    const double a = lat(random), b = lon(random), c = a + reach(random), d = b + reach(random);
    bool before = true;
    for (const double margin : {-3000.0, -500.0, 0.0, 1.0, 100.0, 1000.0, 2000.0, 5000.0, 20000.0}) {
      const bool now = clear(chart, a, b, c, d, margin);
      INFO(a << ", " << b << " to " << c << ", " << d << ", margin " << margin);
      CHECK((before || !now));
      before = now;
    }
  }
}

TEST_CASE("across the antimeridian positions and ways are like any others") {
  const auto chart = chart_of(area_of(178, 182, -19, -15), {box_of(179.8, 180.3, -17.2, -16.8)});
  CHECK(chart.is_land(geo_point(-17, 179.9)));
  CHECK(chart.is_land(geo_point(-17, -180)));
  CHECK(chart.is_land(geo_point(-17, -179.8)));
  CHECK_FALSE(chart.is_land(geo_point(-17, -179.6)));
  CHECK(chart.is_charted(geo_point(-17, -178)));
  CHECK_FALSE(chart.is_charted(geo_point(-17, -177.9)));
  const double exact = brute_distance(geo_point(-17, -179.6), 180.3, -17.2, 180.3, -16.8);
  CHECK(clearance_at(chart, -17, -179.6) == Approx(exact).margin(promised(exact)));
  CHECK(clearance_at(chart, -17, 180.4) == Approx(clearance_at(chart, -17, -179.6)).margin(1e-6));
  CHECK(chart.clearance_at_least(rad(-16.3), rad(180.1)) == chart.clearance_at_least(rad(-16.3), rad(-179.9)));
  CHECK(clear(chart, -16.5, 179.7, -16.5, -179.7, 5000));
  CHECK_FALSE(clear(chart, -17, 179.6, -17, -179.6, 0));
  CHECK_FALSE(clear(chart, -17, 179.6, -17, 180.4, 0));
}

TEST_CASE("keep-out areas are borders like a shore, on either side of which the distance is known") {
  const auto box = box_of(-15.1, -14.9, 27.9, 28.1);
  const Chart chart{ChartSources{nullptr, {}, {polygon("range", box)}}};
  CHECK_FALSE(chart.has_coast());
  CHECK(chart.is_charted(geo_point(28, -15)));
  CHECK_FALSE(chart.is_land(geo_point(28, -15)));
  CHECK(chart.distance_to_coast(geo_point(28, -15.2)).si() == Chart::kHorizon);
  // edges along meridians are geodesics; those along parallels bulge by 0.2²·… < 2 m here, so only sides are compared
  const double outside = brute_distance(geo_point(28, -14.8), -14.9, 27.9, -14.9, 28.1);
  CHECK(clearance_at(chart, 28, -14.8) == Approx(outside).margin(promised(outside)));
  const double inside = brute_distance(geo_point(28, -14.95), -14.9, 27.9, -14.9, 28.1);
  CHECK(clearance_at(chart, 28, -14.95) == Approx(-inside).margin(promised(inside)));
  CHECK(clearance_at(chart, -28, 100) == Chart::kHorizon);
  CHECK(chart.clearance_at_least(rad(-28), rad(100)) == Chart::kHorizon);
  CHECK(chart.clearance_at_least(rad(28), rad(-14.95)) < 0);
  CHECK_FALSE(clear(chart, 28, -15.3, 28, -14.7, 0));
  CHECK_FALSE(clear(chart, 28, -15, 28, -14.95, 0));
  CHECK(clear(chart, 28.2, -15.3, 28.2, -14.7, 10'000));
  CHECK_FALSE(clear(chart, 28.2, -15.3, 28.2, -14.7, 12'000));
  // a way that stays within 3 km of the way out of it
  CHECK(clear(chart, 28, -14.92, 28.05, -14.92, -3000));
  CHECK_FALSE(clear(chart, 28, -14.95, 28.0, -14.92, -3000));
}

TEST_CASE("keep-in areas: inside one of them is inside") {
  const Chart one{ChartSources{nullptr, {polygon("box", box_of(-16, -14, 27, 29))}, {}}};
  const double to_side = brute_distance(geo_point(28, -14.2), -14, 27, -14, 29);
  CHECK(clearance_at(one, 28, -14.2) == Approx(to_side).margin(promised(to_side)));
  CHECK(clearance_at(one, 28, -13.8) == Approx(-brute_distance(geo_point(28, -13.8), -14, 27, -14, 29)).margin(0.5));
  CHECK(clearance_at(one, -28, 100) == -Chart::kHorizon);
  CHECK(one.clearance_at_least(rad(-28), rad(100)) == -Chart::kHorizon);
  CHECK(clear(one, 28, -15, 28, -14.2, 2000));
  CHECK_FALSE(clear(one, 28, -14.2, 28, -13.8, 0));
  CHECK_FALSE(clear(one, 28, -13.9, 28, -13.8, 0));

  // two that overlap by 0.2°: the way from one into the other is clear with a margin below half of the overlap (9.8 km)
  const Chart two{ChartSources{
      nullptr, {polygon("west", box_of(-16, -14, 27, 29)), polygon("east", box_of(-14.2, -12, 27, 29))}, {}}};
  CHECK(clear(two, 28, -14.4, 28, -13.9, 9'000));
  CHECK_FALSE(clear(two, 28, -14.4, 28, -13.9, 11'000));
  CHECK(clear(two, 28, -14.4, 28, -13.9, 0));
  CHECK(clearance_at(two, 28, -14.1) == Approx(brute_distance(geo_point(28, -14.1), -14, 27, -14, 29)).epsilon(1e-4));
  // two with a gap: no way through
  const Chart apart{ChartSources{
      nullptr, {polygon("west", box_of(-16, -14, 27, 29)), polygon("east", box_of(-13.9999, -12, 27, 29))}, {}}};
  CHECK_FALSE(clear(apart, 28, -14.4, 28, -13.7, 0));
  CHECK(clear(apart, 28, -14.4, 28, -14.1, 2000));
}

TEST_CASE("the worst offence counts when there are several") {
  // on land, 0.05° from the shore, inside a keep-out area whose border is 0.02° away
  const auto chart = chart_of(area_of(-17, -13, 26, 30), {box_of(-15.1, -14.9, 27.9, 28.1)}, {},
                              {polygon("out", box_of(-14.97, -14.5, 27, 29))});
  const double shore = brute_distance(geo_point(28, -14.95), -14.9, 27.9, -14.9, 28.1);
  CHECK(clearance_at(chart, 28, -14.95) == Approx(-shore).margin(promised(shore)));
  // keep-in far away: the way back is longer than the way off the land
  const auto away = chart_of(area_of(-17, -13, 26, 30), {box_of(-15.1, -14.9, 27.9, 28.1)},
                             {polygon("in", box_of(-14.7, -14.5, 27, 29))});
  CHECK(clearance_at(away, 28, -14.95) ==
        Approx(-brute_distance(geo_point(28, -14.95), -14.7, 27, -14.7, 29)).margin(0.5));
  CHECK_FALSE(clear(away, 28, -14.95, 28, -14.94, 0));
}

TEST_CASE("positions that are not finite are nowhere") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto chart = chart_of(area_of(-17, -13, 26, 30), {box_of(-15.1, -14.9, 27.9, 28.1)},
                              {polygon("in", box_of(-16, -14, 27, 29))});
  const Chart sea, out{ChartSources{nullptr, {}, {polygon("out", box_of(-16, -14, 27, 29))}}}, empty{ChartSources{}};
  for (const auto* c : std::vector<const Chart*>{&chart, &sea, &out, &empty})
    for (const double bad : {nan, inf, -inf}) {
      CHECK(c->clearance(bad, 0.1) < 0);
      CHECK(c->clearance(0.1, bad) < 0);
      CHECK(c->clearance_at_least(bad, 0.1) < 0);
      CHECK(c->clearance_at_least(0.1, bad) < 0);
      CHECK_FALSE(c->segment_is_clear(bad, 0.1, 0.2, 0.2, 0));
      CHECK_FALSE(c->segment_is_clear(0.1, 0.1, 0.2, bad, 0));
      CHECK_FALSE(c->segment_is_clear(0.1, 0.1, 0.1, 0.1, nan));
    }
}

TEST_CASE("longitudes that run on are folded") {
  const auto chart = chart_of(area_of(-17, -13, 26, 30), {box_of(-15.1, -14.9, 27.9, 28.1)});
  for (const double turns : {-2.0, -1.0, 1.0, 3.0}) {
    CHECK(chart.clearance(rad(28), rad(-14.8 + 360 * turns)) == Approx(clearance_at(chart, 28, -14.8)).margin(1e-6));
    CHECK(chart.clearance_at_least(rad(28.4), rad(-14.5 + 360 * turns)) ==
          chart.clearance_at_least(rad(28.4), rad(-14.5)));
    CHECK_FALSE(clear(chart, 28, -14.8 + 360 * turns, 28, -15.2 + 360 * turns, 0));
  }
}

TEST_CASE("a coast that is all land or all water") {
  const auto area = area_of(10, 12, 40, 42);
  auto ring = ring_of(area, box_of(10, 12, 40, 42));
  ring.cut = {true, true, true, true};
  const Chart land{ChartSources{Coast::make(area, "land", {ring}).value(), {}, {}}};
  CHECK(land.is_land(geo_point(41, 11)));
  CHECK(land.distance_to_coast(geo_point(41, 11)).si() == -Chart::kHorizon);
  CHECK(clearance_at(land, 41, 11) == -Chart::kHorizon);
  CHECK_FALSE(clear(land, 41, 11, 41.1, 11, 0));
  const Chart water{ChartSources{Coast::make(area, "water", {}).value(), {}, {}}};
  CHECK_FALSE(water.is_land(geo_point(41, 11)));
  CHECK(water.distance_to_coast(geo_point(41, 11)).si() == Chart::kHorizon);
  CHECK(clear(water, 41, 11, 41.1, 11, 20'000));
}

TEST_CASE("several threads get the same answers from one chart") {
  std::mt19937_64 random{23};
  const auto chart = chart_of(area_of(-17, -13, 26, 30), {star(-15, 28, 0.5, 200, random)});
  const auto sum = [&] {
    double total = 0;
    for (int k = 0; k < 2000; ++k) total += clearance_at(chart, 27.2 + 0.0008 * k, -15.8 + 0.0007 * k);
    return total;
  };
  const double alone = sum();
  double first = 0, second = 0;
  std::thread one{[&] { first = sum(); }}, other{[&] { second = sum(); }};
  one.join();
  other.join();
  CHECK(first == alone);
  CHECK(second == alone);
}

TEST_CASE("a chart drawn in characters is what the drawing shows") {
  const ChartArt art{R"(
      ~~~~~~~~
      ~~~##~~~
      ~S~##~G~
      ~~~~~#~~
      ##~~~~~~)",
                     28.0, -16.0, 0.1};
  CHECK(art.at('S').lat.degrees() == Approx(28.25));
  CHECK(art.at('G').lon.degrees() == Approx(-15.35));
  CHECK(art.chart.is_land(geo_point(28.25, -15.65)));
  CHECK(art.chart.is_land(geo_point(28.35, -15.55)));
  CHECK(art.chart.is_land(geo_point(28.15, -15.45)));
  CHECK(art.chart.is_land(geo_point(28.05, -15.95)));
  CHECK_FALSE(art.chart.is_land(art.at('S')));
  CHECK_FALSE(art.chart.is_land(geo_point(28.15, -15.55)));
  const auto clear_between = [&](const GeoPoint& a, const GeoPoint& b) {
    return art.chart.segment_is_clear(a.lat.radians(), a.lon.radians(), b.lat.radians(), b.lon.radians(), 0);
  };
  CHECK_FALSE(clear_between(art.at('S'), art.at('G')));
  CHECK(clear_between(art.at('S'), geo_point(28.05, -15.55)));
  CHECK_THROWS_AS(art.at('X'), std::invalid_argument);
  CHECK_THROWS_AS((ChartArt{"~~\n~", 0, 0, 1}), std::invalid_argument);
  // the drawing's southern land goes on outside: no shore along the border
  CHECK(art.chart.distance_to_coast(geo_point(28.001, -15.9)).si() < -9'000);
}
