#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/ocean/analytic.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/planner.hpp"
#include "tests/support/fields.hpp"

/// Problems and analytic seas for tests of vehicle and planning.
namespace glidehelm::test {

inline constexpr double kT0 = 1.7e9;  ///< epoch second of every fix here
/// The schedule and the speed of `problem_between`.
inline constexpr double kStint = 8 * 3600.0, kSpeed = 0.3;

inline const double kEquator = LocalMetric::at(0).parallel_radius;  ///< metres
/// East and north metres about (0, 0) as a position. The metric changes by 2e-5 within 40 km of the equator.
inline GeoPoint on_equator(double x, double y) {
  const auto m = LocalMetric::at(0);
  return GeoPoint::from_kernel(y / m.meridian_radius, x / m.parallel_radius);
}

/// Point to point with stints of eight hours, U = Û = 0.3 m/s, on open water.
inline planning::Problem problem_between(GeoPoint from, GeoPoint to, double radius_m = 500) {
  planning::Problem p;
  p.start = {from, kT0};
  p.goal = planning::PointGoal{to, Metres{radius_m}};
  p.glider.name = "test";
  p.schedule.stint = p.schedule.first_stint = Seconds{kStint};
  p.coast_margin = Metres{0};
  p.headings = 24;
  p.horizon_s = kT0 + 3 * planning::still_water_time(p).count();
  return p;
}

/// On the equator, with surface intervals of no length: the mean motion is that of the dive.
inline planning::Problem always_under() {
  auto p = problem_between(geo_point(0, 0), geo_point(0, 1));
  p.schedule.surface = Seconds{0};
  return p;
}

/// A box of `degrees` on all sides.
inline ocean::Coverage box_around(GeoPoint p, double half_deg) {
  ocean::Coverage box;
  const double half = half_deg * kPi / 180, wide = half / std::cos(p.lat.radians());
  box.south = p.lat.radians() - half;
  box.north = p.lat.radians() + half;
  box.west = p.lon.radians() - wide;
  box.east = p.lon.radians() + wide;
  return box;
}

struct Sea {
  std::string name;
  ocean::AnalyticField field;
  planning::Problem problem;
};

/// Every kind of product.md 5 as a sea of its own, with a way of about four stints through it.
inline std::vector<Sea> analytic_seas() {
  struct Row {
    const char* kind;
    double scale_m, speed, bearing_deg;
    std::vector<std::pair<std::string, double>> params;
  };
  const std::vector<Row> rows{{"constant", 1, 1, 90, {{"u", 0.05}, {"v", -0.15}}},
                              {"source", 60e3, 0.2, 45, {}},
                              {"sink", 60e3, 0.2, 200, {}},
                              {"solid-body", 60e3, 0.2, 90, {{"omega", 1}}},
                              {"shear", 40e3, 0.15, 0, {{"rate", 1}}},
                              {"double-eddy", 30e3, 0.6, 90, {}},
                              {"stuart", 12e3, 0.15, 60, {}},
                              {"tiled", 12e3, 0.15, 120, {}},
                              {"tiled", 12e3, 0.15, 300, {{"dynamic", 1}}},
                              {"jet", 15e3, 0.2, 80, {}},
                              {"gaussians", 20e3, 0.9, 70, {}}};
  const auto origin = geo_point(28.0, -16.0);
  std::vector<Sea> seas;
  for (const auto& row : rows) {
    ocean::AnalyticSpec spec;
    spec.kind = row.kind;
    spec.origin = origin;
    spec.length_scale = Metres{row.scale_m};
    spec.speed_scale = MetresPerSecond{row.speed};
    spec.params = row.params;
    if (spec.kind == "gaussians")
      spec.gaussians = {{1.0, 0.5, 0.3, 0.5, 0.1, 0.4, 0, 0}, {-1.0, 1.5, -0.4, 0.4, 0, 0.5, 0.02, 0.01}};
    const auto field = ocean::AnalyticField::make(spec, instant_at(kT0), box_around(origin, 0.6));
    const auto to = destination(origin, Bearing{degrees(row.bearing_deg)}, Metres{31e3});
    std::string name = row.kind;
    if (!row.params.empty() && row.params[0].first == "dynamic") name += " (dynamic)";
    seas.push_back({name, *field, problem_between(origin, to)});
  }
  return seas;
}

}  // namespace glidehelm::test
