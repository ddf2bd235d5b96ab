#include "daemon/ingest/geostrophic.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "core/base/local_metric.hpp"
#include "tests/daemon/ingest/run.hpp"
#include "tests/support/data.hpp"
#include "tests/support/fields.hpp"

using namespace glidehelm;
using namespace glidehelm::ingest;

namespace {

/// A grid of heights by a function of latitude and longitude (degrees).
template <class F>
ocean::Grid heights(std::vector<double> lats, std::vector<double> lons, const F& height) {
  return test::make_grid({{0.0}, {0.0}, std::move(lats), std::move(lons), false, false},
                         [&](double lat, double lon, double, double) {
                           const double h = height(lat, lon);
                           return std::pair{h, h};
                         });
}
float east(const ocean::Grid& g, std::size_t j, std::size_t i) {
  return g.values[2 * (j * g.axes.lons_deg.size() + i)];
}
float north(const ocean::Grid& g, std::size_t j, std::size_t i) {
  return g.values[2 * (j * g.axes.lons_deg.size() + i) + 1];
}

}  // namespace

TEST_CASE("gravity and the Coriolis parameter are those of WGS84") {
  // Normal gravity at the equator, at 45° and at the pole as WGS84 defines and tabulates it.
  CHECK(normal_gravity(0) == Approx(9.7803253359).epsilon(1e-12));
  CHECK(normal_gravity(45 * kDegree) == Approx(9.8061977).epsilon(1e-7));
  CHECK(normal_gravity(90 * kDegree) == Approx(9.8321849).epsilon(1e-7));
  CHECK(coriolis(30 * kDegree) == Approx(7.292115e-5).epsilon(1e-12));
  CHECK(coriolis(-30 * kDegree) == -coriolis(30 * kDegree));
}

TEST_CASE("an even slope gives the current of the balance, to the left hand low in the north") {
  // Heights that rise to the east by 1e-6 of the longitude's own length at each latitude: v = g·1e-6/f, u ≈ 0 where the
  // height does not change with latitude. The tolerance is that of the floats: 1e-7 of heights up to 0.5 m over cells of
  // about 20 km, times g/f = 1e5: 5e-8·0.5/2e4·1e5 = 1.3e-7 m/s.
  const auto slope_to_east = [](double lat) {
    return heights(test::steps(lat, 0.25, 4), test::steps(10, 0.25, 6), [&](double, double lon) {
      return 1e-6 * LocalMetric::at(lat * kDegree).parallel_radius * (lon - 10) * kDegree;
    });
  };
  auto grid = slope_to_east(40);
  CHECK(geostrophic_currents(grid, 5) == 0);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(north(grid, 0, i) == Approx(1e-6 * normal_gravity(40 * kDegree) / coriolis(40 * kDegree)).margin(3e-7));
    CHECK(east(grid, 0, i) == Approx(0).margin(1e-6));
  }
  auto south = slope_to_east(-40);
  geostrophic_currents(south, 5);
  CHECK(north(south, 0, 2) == Approx(-1e-6 * normal_gravity(40 * kDegree) / coriolis(40 * kDegree)).margin(3e-7));

  // High in the south: eastward in the north, u = g·1e-6/f.
  auto zonal = heights(test::steps(40, 0.25, 5), test::steps(10, 0.25, 4), [](double lat, double) {
    return -1e-6 * LocalMetric::at(40.5 * kDegree).meridian_radius * (lat - 40.5) * kDegree;
  });
  geostrophic_currents(zonal, 5);
  CHECK(east(zonal, 2, 1) == Approx(1e-6 * normal_gravity(40.5 * kDegree) / coriolis(40.5 * kDegree)).margin(3e-7));
}

TEST_CASE("a parabola comes out exactly on an uneven axis, and a cubic to second order on an even one") {
  const auto speed_at_zero = [](std::vector<double> lons, int power) {
    auto grid = heights(test::steps(45, 0.5, 3), std::move(lons),
                        [&](double, double lon) { return 0.02 * lon + 0.01 * std::pow(lon, power); });
    geostrophic_currents(grid, 5);
    std::size_t middle = 0;
    while (grid.axes.lons_deg[middle] != 0) ++middle;
    return static_cast<double>(north(grid, 1, middle));
  };
  const auto metric = LocalMetric::at(45.5 * kDegree);
  const double exact =
      normal_gravity(45.5 * kDegree) / coriolis(45.5 * kDegree) * 0.02 / kDegree / metric.parallel_radius;
  // Floats: 1e-7·0.05 m over 0.3° ≈ 23 km, times 1e5.
  CHECK(speed_at_zero({-1, -0.1, 0, 0.2, 1}, 2) == Approx(exact).margin(1e-6));
  const double coarse = speed_at_zero({-1, -0.5, 0, 0.5, 1}, 3) - exact,
               fine = speed_at_zero({-1, -0.25, 0, 0.25, 1}, 3) - exact;
  CHECK(coarse / fine == Approx(4).epsilon(1e-3));
}

TEST_CASE("at a coast the difference is one-sided, and a lone node has no current") {
  auto grid = heights(test::steps(30, 1, 4), test::steps(0, 1, 5), [](double lat, double lon) {
    if (lon == 2 || (lat == 33 && lon == 3)) return test::kDry;
    return 0.01 * lon;
  });
  geostrophic_currents(grid, 5);
  const auto speed = [&](double lat) {
    return normal_gravity(lat * kDegree) / coriolis(lat * kDegree) * 0.01 / kDegree /
           LocalMetric::at(lat * kDegree).parallel_radius;
  };
  CHECK(north(grid, 0, 1) == Approx(speed(30)).margin(1e-6));
  CHECK(north(grid, 1, 3) == Approx(speed(31)).margin(1e-6));
  CHECK(std::isnan(north(grid, 0, 2)));
  CHECK(std::isnan(north(grid, 3, 4)));  // its only neighbours are to the north and south
  CHECK(std::isnan(east(grid, 3, 4)));
}

TEST_CASE("a grid around the globe has no coast at its seam, and the equator's band has no current") {
  // Not periodic in the file's columns: h = sin λ runs smoothly through the seam.
  auto grid = heights(test::steps(-10, 5, 5), test::steps(-180, 10, 36),
                      [](double, double lon) { return std::sin(lon * kDegree); });
  CHECK(geostrophic_currents(grid, 5) == 36);  // the row at 0; the rows at ±5 are outside |φ| < 5
  for (std::size_t i = 0; i < 36; ++i) CHECK(std::isnan(north(grid, 2, i)));
  for (const std::size_t j : {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{4}}) {
    const double lat = grid.axes.lats_deg[j] * kDegree;
    // The centred difference of a sine is its derivative times sin(Δ)/Δ.
    const double expected = normal_gravity(lat) / coriolis(lat) * std::cos(-180 * kDegree) * std::sin(10 * kDegree) /
                            (10 * kDegree) / LocalMetric::at(lat).parallel_radius;
    CHECK(north(grid, j, 0) == Approx(expected).epsilon(1e-5));
  }
}

TEST_CASE("heights in a file become currents where it has no velocity, and its facts say so") {
  const test::ScratchFolder folder;
  const std::string cdl = R"(netcdf h { dimensions: time = 2 ; lat = 3 ; lon = 3 ;
variables: double time(time) ; time:units = "days since 2024-01-01" ; float lat(lat) ; lat:units = "degrees_north" ;
  float lon(lon) ; lon:units = "degrees_east" ; float sla(time, lat, lon) ; sla:units = "cm" ;
  float mdt(lat, lon) ; mdt:units = "m" ;
data: time = 0, 1 ; lat = 40, 40.25, 40.5 ; lon = 5, 5.25, 5.5 ;
  sla = 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 2, 4, 0, 2, 4, 0, 2, 4 ;
  mdt = 0.5, 0.51, 0.52, 0.5, 0.51, 0.52, 0.5, 0.51, 0.52 ; })";
  const auto result = test::run_ingest(folder, test::make_netcdf(folder, "h.nc", cdl));
  REQUIRE(result.view);
  // 1 cm of sla and 1 cm of mdt a column; 2 cm and 1 cm at the second time.
  const double lat = 40.25 * kDegree;
  const double centimetre =
      normal_gravity(lat) / coriolis(lat) * 0.01 / (0.25 * kDegree) / LocalMetric::at(lat).parallel_radius;
  // Floats: 6e-8 of 0.5 m over 42 km, times g/f = 1e5.
  CHECK(result.at(0, 0, 1, 1, 1) == Approx(2 * centimetre).margin(1e-6));
  CHECK(result.at(1, 0, 1, 1, 1) == Approx(3 * centimetre).margin(1e-6));
  CHECK(result.at(0, 0, 1, 1, 0) == Approx(0).margin(1e-6));
  CHECK(result.view->facts.recognised_by == "computed from heights: sla + mdt, by name");
  CHECK(result.view->facts.east_variable == "sla");
  CHECK(result.view->facts.warnings ==
        std::vector<std::string>{"h.nc: computed from heights: without tide and wind drift"});

  const auto never = test::run_ingest(folder, (folder / "h.nc") + " --heights never");
  CHECK(never.ran.err.find("no east and north velocity is recognised") != std::string::npos);
  const auto lone = test::run_ingest(
      folder,
      test::make_netcdf(folder, "a.nc", R"(netcdf a { dimensions: lat = 2 ; lon = 2 ; variables: float lat(lat) ;
  float lon(lon) ; float sla(lat, lon) ; sla:units = "m" ; data: lat = 40, 41 ; lon = 5, 6 ; sla = 0, 1, 2, 3 ; })"));
  CHECK(lone.ran.err.find("sla(lat, lon) is the height above the mean sea surface: its slope lacks the mean current") !=
        std::string::npos);
}

TEST_CASE("real data: currents from the DUACS heights agree with the producer's") {
  GLIDEHELM_NEEDS_DATA(data);
  const test::ScratchFolder folder;
  const auto file = data + "/currents/duacs/nrt_global_allsat_phy_l4_20190223_20190226.nc";
  const auto theirs = test::run_ingest(folder, file);
  const auto ours = test::run_ingest(folder, "--heights always " + file);
  REQUIRE(theirs.view);
  REQUIRE(ours.view);
  CHECK(ours.view->facts.recognised_by == "computed from heights: adt, standard_name sea_surface_height_above_geoid");
  CHECK(ours.view->axes == theirs.view->axes);
  const auto& axes = ours.view->axes;
  const std::size_t columns = axes.lons_deg.size();
  struct Sums {
    double n{}, x{}, y{}, xx{}, yy{}, xy{}, dd{};
  } sums[2];
  std::size_t near_equator = 0;
  for (std::size_t node = 0; node < axes.nodes(); ++node) {
    const double lat = axes.lats_deg[node / columns];
    const float* mine = ours.view->values + 2 * node;
    const float* other = theirs.view->values + 2 * node;
    if (std::abs(lat) < 5) {
      near_equator += std::isnan(mine[0]) ? 0 : 1;
      continue;
    }
    if (std::isnan(mine[0]) || std::isnan(other[0])) continue;
    for (std::size_t side = 0; side < 2; ++side) {
      const double x = mine[side], y = other[side];
      auto& s = sums[side];
      s.n += 1, s.x += x, s.y += y, s.xx += x * x, s.yy += y * y, s.xy += x * y, s.dd += (x - y) * (x - y);
    }
  }
  CHECK(near_equator == 0);
  for (const auto& s : sums) {
    const double r = (s.n * s.xy - s.x * s.y) / std::sqrt((s.n * s.xx - s.x * s.x) * (s.n * s.yy - s.y * s.y));
    const double rms = std::sqrt(s.dd / s.n), size = std::sqrt(s.yy / s.n);
    WARN((&s == sums ? "east" : "north") << ": nodes " << s.n << ", r " << r << ", rms of the difference " << rms
                                         << " m/s, rms of theirs " << size << " m/s, slope " << s.xy / s.yy);
    CHECK(s.n > 500'000);
    // The producer's own stencil spans nine nodes, ours three: of a wave of wave number k ours keeps 1 − (kΔ)²/6. At the
    // eddies' k = 1/50 km and Δ = 25 km that is 4 %, at k = 1/30 km 12 %: amplitudes of 0.88 to 1, so a difference of at
    // most an eighth of the speeds, and r = √(1 − 1/64) = 0.992 if that part were independent.
    CHECK(r > 0.99);
    CHECK(rms < size / 8);
  }
}
