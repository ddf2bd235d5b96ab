#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/planning.hpp"

namespace glidehelm::test {

/// Every sequence of constant-heading stints on `headings` absolute headings, of which the first is the goal's direction
/// from the start: the earliest entry into the goal's disc. Own midpoint integrator; branches that cannot beat the best one
/// known by their distance alone are not followed, which leaves the answer what it is.
class Exhaustive {
 public:
  /// `known`: seconds; only what is earlier is looked for.
  Exhaustive(const planning::Problem& problem, ocean::FieldRef field, int headings, int most_stints, double known)
      : problem_{problem}, field_{field}, goal_{planning::disc_of(problem)}, most_{most_stints}, best_{known} {
    const double first = geodesic(problem.start.fix, goal_.centre).departing.from_north().si();
    for (int i = 0; i < headings; ++i) headings_.push_back(first + 2 * kPi * i / headings);
    fastest_ = problem.glider.horizontal_speed.si() + field.fastest().si();
  }
  /// Seconds from the fix; `known` when no sequence arrives earlier.
  double travel_time() {
    visit({problem_.start.fix.lat.radians(), problem_.start.fix.lon.radians(), 0.0}, 0);
    return best_;
  }
  [[nodiscard]] long stints_flown() const { return stints_; }

 private:
  struct Place {
    double lat, lon, t;
  };
  static constexpr double kStep = 1200.0;

  [[nodiscard]] double metres_to_goal(const Place& p) const {
    return local_offset(p.lat, p.lon, goal_.centre.lat.radians(), goal_.centre.lon.radians()).length();
  }
  /// False when the field ends. Stops at the goal and notes the time.
  bool move(Place& p, double seconds, double east, double north) {
    const double until = p.t + seconds;
    while (until - p.t > 1e-6) {
      const double dt = std::min(kStep, until - p.t);
      double lat = p.lat, lon = p.lon, v_east = 0, v_north = 0;
      for (const double ahead : {0.0, 0.5 * dt}) {
        const auto c = field_.sample(GeoPoint::from_kernel(lat, lon), kT0 + p.t + ahead);
        if (!c) return false;
        v_east = east + c->current.east.si();
        v_north = north + c->current.north.si();
        const auto m = LocalMetric::at(lat);
        lat = p.lat + 0.5 * dt * v_north / m.meridian_radius;
        lon = p.lon + 0.5 * dt * v_east / m.parallel_radius;
      }
      const auto m = LocalMetric::at(lat);
      const Place next{p.lat + dt * v_north / m.meridian_radius, p.lon + dt * v_east / m.parallel_radius, p.t + dt};
      const double before = metres_to_goal(p), after = metres_to_goal(next), radius = goal_.radius.si();
      if (before > radius && after <= radius) {
        best_ = std::min(best_, p.t + dt * (before - radius) / (before - after));
        return false;
      }
      p = next;
    }
    return true;
  }
  void visit(Place p, int stint) {
    if (!move(p, problem_.schedule.drift_before(stint).count(), 0, 0)) return;
    const double u = problem_.glider.horizontal_speed.si();
    const double seconds = problem_.schedule.stint_length(stint).count();
    std::vector<Place> ends;
    for (const double h : headings_) {
      Place q = p;
      ++stints_;
      if (move(q, seconds, u * std::sin(h), u * std::cos(h))) ends.push_back(q);
    }
    if (stint + 1 == most_) return;
    std::sort(ends.begin(), ends.end(),
              [&](const Place& a, const Place& b) { return metres_to_goal(a) < metres_to_goal(b); });
    for (const auto& q : ends)
      if (q.t + (metres_to_goal(q) * 0.999 - goal_.radius.si()) / fastest_ < best_) visit(q, stint + 1);
  }

  const planning::Problem& problem_;
  ocean::FieldRef field_;
  vehicle::Disc goal_;
  int most_;
  double best_;
  std::vector<double> headings_;
  double fastest_{};
  long stints_{};
};

}  // namespace glidehelm::test
