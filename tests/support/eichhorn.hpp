#pragma once

#include <cmath>

#include "core/ocean/analytic.hpp"
#include "core/planning/planner.hpp"
#include "tests/support/planning.hpp"

/// The case of Eichhorn's Table 4: his meandering jet (eq. 7 to 9) with U = 0.5, a 3-sector grid of 0.4, no dive schedule.
///
/// Lengths in units of 20 km, speeds of 1 m/s, on the equator, where a degree is nearly the same north and east. **Ours**, because the paper
/// prints neither: the goal at (10, 0), the area [0, 12] × [−5, 5], and all starts.
namespace glidehelm::test {

class EichhornJet {
 public:
  static constexpr double kUnit = 20e3;                 ///< metres
  static constexpr double kSpeed = 0.5;                 ///< m/s
  static constexpr double kGrid = 0.4, kGoal_x = 10.0;  ///< units
  static constexpr double kTime = kUnit;                ///< seconds of a unit of time

  static GeoPoint at(double x, double y) {
    const auto metric = LocalMetric::at(0);
    return GeoPoint::from_kernel(y * kUnit / metric.meridian_radius, x * kUnit / metric.parallel_radius);
  }

  /// The jet: nodes lie inside the area, but derivatives are taken across its edge, where the formula goes on.
  struct Field {
    ocean::AnalyticField jet = made();
    [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth z, double t_s) const {
      return jet.sample(p, z, t_s);
    }
    [[nodiscard]] ocean::Coverage coverage() const {
      const auto low = at(-1e-6, -5 - 1e-6), high = at(12 + 1e-6, 5 + 1e-6);
      ocean::Coverage area;
      area.south = low.lat.radians();
      area.north = high.lat.radians();
      area.west = low.lon.radians();
      area.east = high.lon.radians();
      return area;
    }
    /// Eichhorn's v_current.max: the largest over area and mission time, sampled every 0.1 in place and 1 in time, and a hundredth.
    [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{fastest_}; }

   private:
    static ocean::AnalyticField made() {
      ocean::AnalyticSpec spec;
      spec.kind = "jet";
      spec.origin = at(0, 0);
      spec.length_scale = Metres{kUnit};
      return *ocean::AnalyticField::make(spec, instant_at(kT0), ocean::Coverage{});
    }
    static double sampled() {
      const ocean::analytic::Jet jet;
      double most = 0;
      for (double t = 0; t <= 30; t += 1)
        for (double x = 0; x <= 12; x += 0.1)
          for (double y = -5; y <= 5; y += 0.1) {
            const auto c = jet.at(x, y, t);
            most = std::max(most, std::hypot(c.u, c.v));
          }
      return 1.01 * most;
    }
    double fastest_ = sampled();
  };

  Field field;
  [[nodiscard]] ocean::Ocean ocean() const { return {field, field}; }

  static planning::Problem problem(double x, double y) {
    auto p = problem_between(at(x, y), at(kGoal_x, 0), 0.005 * kUnit);
    p.glider.horizontal_speed = p.glider.believed_speed = MetresPerSecond{kSpeed};
    p.schedule.surface = p.schedule.time_to_dive = Seconds{0};
    p.sector_grid = {3, Metres{kGrid * kUnit}};
    p.horizon_s = kT0 + 100 * kTime;
    return p;
  }
};

}  // namespace glidehelm::test
