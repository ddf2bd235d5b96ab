#include "core/planning/lattice_water.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "tests/support/planning.hpp"

using namespace glidehelm;
using planning::LatticeWater;
using planning::TriangleLattice;

namespace {

constexpr double kTriangleSide = 5000;
constexpr double kCircumradius = kTriangleSide * 0.57735026918962576;  // side/√3
constexpr double kTide = 0.12, kTidalHours = 12;                       // m/s, and a period of whole hours

/// Around (0, 0), 30 km to all sides. A parallel within it is 1e-5 shorter than the equator.
TriangleLattice lattice_at_origin() { return {0, 0, kTriangleSide, 30e3, 30e3, 30e3, 30e3}; }

/// Metres east and north of (0, 0) as the equator measures them, so that every triangle is equilateral to rounding.
struct Plane {
  double x{}, y{};
};
Plane plane_of(TriangleLattice::Place p) {
  const auto m = LocalMetric::at(0);
  return {p.lon * m.parallel_radius, p.lat * m.meridian_radius};
}

/// From 60 km south-west to 60 km north-east, for a day.
planning::Problem day_across() {
  auto p = test::problem_between(test::on_equator(-40e3, -45e3), test::on_equator(40e3, 45e3));
  p.horizon_s = test::kT0 + 24 * 3600;
  return p;
}

LatticeWater water_in(const test::FromFunction& field, const planning::Problem& problem = day_across(),
                      const chart::Chart& chart = {}) {
  return planning::water_of(lattice_at_origin(), problem, {field, field}, chart);
}
test::FromFunction steady(double east, double north) {
  return {[=](double, double, double) { return std::pair{east, north}; }, std::hypot(east, north), {}};
}
/// East and west, and in between for a moment still: at its fastest on whole hours.
double tide_at(double t_s) { return kTide * std::sin(2 * kPi * (t_s - test::kT0) / (3600 * kTidalHours)); }
/// How far such a tide is thought to go when it is seen every hour. It is seen at its fastest; its largest second difference, 2a(1 − cos 30°), is
/// there too, an eighth of which stands for what may lie between two instants.
double tidal_reach() { return kTide * (1 + (1 - std::cos(2 * kPi / kTidalHours)) / 4); }

/// A square island of 24 km around (0, 0), and how far a place is from its shore: negative on land. Its sides are geodesics: within 24 km they
/// leave the parallel by 0.02 m.
constexpr double kHalfIsland = 12e3;
chart::Chart square_island() {
  chart::ChartSources sources;
  const auto corner = [](double x, double y) { return test::on_equator(x * kHalfIsland, y * kHalfIsland); };
  sources.keep_out.push_back({"island", {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}});
  return chart::Chart{std::move(sources)};
}
double from_shore(Plane p) {
  const double east = std::abs(p.x) - kHalfIsland, north = std::abs(p.y) - kHalfIsland;
  return east > 0 && north > 0 ? std::hypot(east, north) : std::max(east, north);
}
constexpr double kClearanceError = 2;  // metres: the metre that is let go, and the chart's own 0.2 m

}  // namespace

TEST_CASE("a triangle inside an island is closed and one at its shore is open") {
  const auto lattice = lattice_at_origin();
  const auto still = steady(0, 0);
  for (const double margin : {0.0, 3000.0}) {
    auto p = day_across();
    p.coast_margin = Metres{margin};
    const auto water = water_in(still, p, square_island());
    int closed = 0, at_shore = 0;
    for (std::size_t i = 0; i < lattice.triangles(); ++i) {
      const auto t = lattice.triangle(i);
      const double middle = from_shore(plane_of(lattice.middle(t)));
      double farthest = middle;
      for (const auto corner : {t.left, t.right, t.apex})
        farthest = std::max(farthest, from_shore(plane_of(lattice.at(corner))));
      INFO("margin " << margin << ", middle " << middle << " m from the shore, its farthest corner " << farthest);
      // Where some place keeps the margin a way may lead. A triangle lies within its circumradius of the middle, so beyond that none does.
      if (farthest > margin + kClearanceError) CHECK(water.triangles[i].open);
      if (middle < margin - kCircumradius * (1 + 1e-4) - kClearanceError) CHECK_FALSE(water.triangles[i].open);
      closed += water.triangles[i].open ? 0 : 1;
      at_shore += water.triangles[i].open && middle < margin ? 1 : 0;
    }
    CHECK(closed > 10);
    CHECK(at_shore > 10);
  }
}

TEST_CASE("triangles inside the margin are open when the start or the goal lies as near to land") {
  // 13 km north of the middle of the island is 1 km off its shore.
  const auto near_shore = test::on_equator(0, kHalfIsland + 1000);
  auto p = day_across();
  p.coast_margin = Metres{6000};
  const auto count = [&](const planning::Problem& of) {
    const auto water = water_in(steady(0, 0), of, square_island());
    return std::count_if(water.triangles.begin(), water.triangles.end(), [](const auto& t) { return t.open; });
  };
  const auto far_ends = count(p);
  auto from_shore_out = p, to_shore = p, by_a_small_margin = p;
  from_shore_out.start.fix = near_shore;
  // A disc of 500 m whose centre is 1.5 km off: a way may end 1 km off.
  to_shore.goal = planning::PointGoal{test::on_equator(0, kHalfIsland + 1500), Metres{500}};
  by_a_small_margin.coast_margin = Metres{1000};
  CHECK(count(from_shore_out) > far_ends);
  CHECK(count(from_shore_out) == count(by_a_small_margin));
  CHECK(count(to_shore) == count(by_a_small_margin));
}

TEST_CASE("water is lent to dry triangles beside wet ones and to no others") {
  // Wet as far as a quarter of a side east of the seed: of the nodes, which lie half a side apart, those at 0 and west of it.
  auto field = steady(0.1, -0.05);
  field.box.east = test::on_equator(0.25 * kTriangleSide, 0).lon.radians();
  const auto lattice = lattice_at_origin();
  const auto water = water_in(field);
  int lent = 0;
  for (std::size_t i = 0; i < lattice.triangles(); ++i) {
    const auto t = lattice.triangle(i);
    const auto& here = water.triangles[i];
    const double west = plane_of(lattice.at(t.left)).x;  // no corner lies west of the left one
    INFO("from " << west << " m on");
    // Its left corner is one of a wet triangle when a neighbour of that corner, a side away at most, is wet.
    CHECK(here.open == (west < 1.25 * kTriangleSide));
    if (!here.open) continue;
    lent += west > 0.25 * kTriangleSide ? 1 : 0;
    CHECK(here.east == Approx(0.1));
    CHECK(here.north == Approx(-0.05));
    CHECK(here.speed == Approx(test::kSpeed));
  }
  CHECK(lent > 10);
}

TEST_CASE("the mean of a parabolic jet along a side and its speed cover the flow on the axis") {
  // u = u₀ − k·d², d from the axis, with a side of length s on it: corners u₀, u₀, u₀ − ¾ks², middle (d = s·√¾/3) u₀ − ks²/12. The mean of the four is
  // u₀ − (10/48)ks²; corners and middle differ by ks²/6. To cover u₀ takes 10/48 : 1/6 = 1.25 of that difference; 1.3 leave ks²·(1.3/6 − 10/48).
  const double peak = 0.5, k = 0.2 / (kTriangleSide * kTriangleSide), ks2 = 0.2;
  const auto lattice = lattice_at_origin();
  for (const double degrees : {0.0, 60.0, 120.0}) {
    const double along_x = std::cos(degrees * kPi / 180), along_y = std::sin(degrees * kPi / 180);
    const auto off_axis = [&](Plane p) { return along_x * p.y - along_y * p.x; };
    const test::FromFunction jet{[&](double lat, double lon, double) {
                                   const double d = off_axis(plane_of({lat, lon})), flow = peak - k * d * d;
                                   return std::pair{flow * along_x, flow * along_y};
                                 },
                                 2,
                                 {}};
    const auto water = water_in(jet);
    int beside = 0;
    for (std::size_t i = 0; i < lattice.triangles(); ++i) {
      const auto t = lattice.triangle(i);
      int on_axis = 0;
      for (const auto corner : {t.left, t.right, t.apex})
        on_axis += std::abs(off_axis(plane_of(lattice.at(corner)))) < 1e-3 ? 1 : 0;
      if (on_axis != 2) continue;
      ++beside;
      const auto& here = water.triangles[i];
      const double mean = here.east * along_x + here.north * along_y, reach = here.speed - test::kSpeed;
      CHECK(mean == Approx(peak - 10.0 / 48 * ks2).epsilon(1e-9));
      CHECK(mean + reach == Approx(peak + (1.3 / 6 - 10.0 / 48) * ks2).epsilon(1e-9));
    }
    CHECK(beside > 10);
  }
}

TEST_CASE("a flow that is linear is its value in the middle and no faster") {
  const test::FromFunction shear{[](double lat, double lon, double) {
                                   const auto p = plane_of({lat, lon});
                                   return std::pair{0.1 + 4e-6 * p.y, -2e-6 * p.x + 1e-6 * p.y};
                                 },
                                 1,
                                 {}};
  const auto lattice = lattice_at_origin();
  const auto water = water_in(shear);
  for (std::size_t i = 0; i < lattice.triangles(); ++i) {
    const auto p = plane_of(lattice.middle(lattice.triangle(i)));
    CHECK(water.triangles[i].east == Approx(0.1 + 4e-6 * p.y).margin(1e-12));
    CHECK(water.triangles[i].north == Approx(-2e-6 * p.x + 1e-6 * p.y).margin(1e-12));
    CHECK(water.triangles[i].speed == Approx(test::kSpeed).margin(1e-12));
  }
}

TEST_CASE("a tide counts with the middle of its swing and half of it as speed") {
  // 25 instants in 24 hours are one every hour.
  const test::FromFunction tide{[](double, double, double t) {
                                  return std::pair{0.2 + tide_at(t), -0.1};
                                },
                                kTide + 0.3,
                                {}};
  for (const auto& here : water_in(tide).triangles) {
    CHECK(here.east == Approx(0.2));
    CHECK(here.north == Approx(-0.1));
    CHECK(here.speed == Approx(test::kSpeed + tidal_reach()));
  }
  // One that turns: what holds both components holds the circle.
  const test::FromFunction turning{[](double, double, double t) {
                                     return std::pair{tide_at(t), tide_at(t + 900 * kTidalHours)};
                                   },
                                   kTide,
                                   {}};
  for (const auto& here : water_in(turning).triangles) {
    CHECK(std::hypot(here.east, here.north) < 1e-9);
    CHECK(here.speed == Approx(test::kSpeed + std::sqrt(2.0) * tidal_reach()));
  }
}

TEST_CASE("a forecast that ends long before the horizon is still seen every hour") {
  // Fifteen hours of a tide, held at its fastest until the horizon: instants over all that time would be seventeen hours apart.
  const double end_s = test::kT0 + 1.25 * 3600 * kTidalHours;
  test::FromFunction tide{[=](double, double, double t) {
                            return std::pair{tide_at(std::min(t, end_s)), 0.0};
                          },
                          kTide,
                          {}};
  tide.box.first_s = test::kT0;
  tide.box.last_s = end_s;
  auto p = day_across();
  p.horizon_s = test::kT0 + 400 * 3600;
  for (const auto& here : water_in(tide, p).triangles) CHECK(here.speed == Approx(test::kSpeed + tidal_reach()));
}

TEST_CASE("a field that stays the same is asked four times a place and one that changes at all instants") {
  const auto lattice = lattice_at_origin();
  const auto places = lattice.nodes() + lattice.triangles();
  const auto still = steady(0.1, 0), other = steady(0.1, 0);
  CHECK(water_in(still).current_evaluations == 4 * places);
  // A surface that is another field is asked as well.
  CHECK(planning::water_of(lattice, day_across(), {still, other}, {}).current_evaluations == 8 * places);
  const test::FromFunction tide{[](double, double, double t) { return std::pair{tide_at(t), 0.0}; }, kTide, {}};
  CHECK(water_in(tide).current_evaluations == (4 + planning::kMostInstants) * places);
}

TEST_CASE("a drift has the currents of the surface and those below where the surface has none") {
  const auto below = steady(0.05, 0.1);
  test::FromFunction surface{[](double, double, double t) { return std::pair{-0.2 + tide_at(t), 0.3}; }, 0.5, {}};
  surface.box.east = test::on_equator(0.25 * kTriangleSide, 0).lon.radians();
  const auto lattice = lattice_at_origin();
  const auto water = planning::water_of(lattice, day_across(), {below, surface}, {});
  for (std::size_t i = 0; i < lattice.triangles(); ++i) {
    const auto& here = water.triangles[i];
    CHECK(here.east == Approx(0.05));
    CHECK(here.speed == Approx(test::kSpeed));
    const bool has_surface = plane_of(lattice.at(lattice.triangle(i).left)).x < 1.25 * kTriangleSide;
    CHECK(here.drift_east == Approx(has_surface ? -0.2 : 0.05));
    CHECK(here.drift_north == Approx(has_surface ? 0.3 : 0.1));
    CHECK(here.drift_spread == Approx(has_surface ? tidal_reach() : 0.0).margin(1e-12));
  }
}
