#include "core/planning/cost_to_go.hpp"

#include <cmath>

#include "core/base/local_metric.hpp"
#include "core/planning/envelope.hpp"
#include "core/planning/flight.hpp"
#include "core/vehicle/goal_distance.hpp"

namespace glidehelm::planning {

namespace {

constexpr int kLeastSides = 24, kMostSides = 60;  // on the way; between them, sides as long as a stint
constexpr double kMostLatitude = 85 * kPi / 180;
constexpr double kRoom = 0.35, kFarRoom = 1.5;  // times the way
constexpr double kFarSide = 3;                  // times the side

double way_of(const Problem& problem) {
  const auto goal = disc_of(problem);
  return std::max(distance(problem.start.fix, goal.centre).si(), 2 * goal.radius.si());
}
double side_of(const Problem& problem) {
  const double stint = (problem.glider.horizontal_speed * problem.schedule.stint).si();
  const double way = way_of(problem);
  return std::clamp(stint, way / kMostSides, way / kLeastSides);
}

/// Start and goal with `ways` times the way to all sides, or what there is of the field.
TriangleLattice lattice_around(const Problem& problem, const ocean::Coverage& coverage, double sides, double ways) {
  const auto goal = disc_of(problem);
  const double side = sides * side_of(problem), room = ways * way_of(problem) + 4 * side;
  const double lat = goal.centre.lat.radians(), lon = goal.centre.lon.radians();
  const auto to_start = local_offset(lat, lon, problem.start.fix.lat.radians(), problem.start.fix.lon.radians());
  const auto metric = LocalMetric::at(lat);
  // Not beyond where a parallel is of use as an axis. Three sides beyond the field all is dry, so that the rim is of no use to anybody.
  const double lowest = std::max(-kMostLatitude, coverage.south), highest = std::min(kMostLatitude, coverage.north);
  const bool all_round = coverage.east - coverage.west >= 2 * kPi;
  const double from_middle = std::remainder(lon - 0.5 * (coverage.west + coverage.east), 2 * kPi);
  const double eastward = all_round ? 0.0 : from_middle;  // in the field
  const double half = all_round ? kPi : 0.5 * (coverage.east - coverage.west);
  const auto reach = [&](double wanted, double limit, double radius) {
    return std::min(std::max(0.0, wanted) + room, std::max(0.0, limit) * radius + 3 * side);
  };
  return {lat,
          lon,
          side,
          reach(-to_start.north, lat - lowest, metric.meridian_radius),
          reach(to_start.north, highest - lat, metric.meridian_radius),
          reach(-to_start.east, half + eastward, metric.parallel_radius),
          reach(to_start.east, half - eastward, metric.parallel_radius)};
}

/// Beyond all lattices: seconds over the distance at the fastest speed over ground. Between two nodes of a rim a distance is less than linear: by
/// side²/8d at most.
class ByDistance {
 public:
  ByDistance(const Problem& problem, const ocean::Ocean& ocean)
      : goal_{disc_of(problem)},
        radius_{disc_of(problem).radius.si()},
        fastest_{reach_of(problem, ocean).dive},
        side_{kFarSide * side_of(problem)} {}
  double operator()(double lat, double lon) const {
    const double d = goal_.least(lat, lon);
    return d > 0 ? (d - radius_ - side_ * side_ / (8 * d)) / fastest_ : 0.0;
  }

 private:
  vehicle::GoalDistance goal_;
  double radius_, fastest_, side_;
};

}  // namespace

CostToGo::CostToGo(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart)
    : far_{lattice_around(problem, ocean.dive.coverage(), kFarSide, kFarRoom), problem, ocean, chart,
           ByDistance{problem, ocean}},
      near_{lattice_around(problem, ocean.dive.coverage(), 1, kRoom), problem, ocean, chart,
            [this](double lat, double lon) { return far_.at(lat, lon).value_or(0); }} {
  const auto reach = reach_of(problem, ocean);
  drift_rate_ = std::max({near_.drift_rate(), far_.drift_rate(), reach.drift / reach.dive});
}

}  // namespace glidehelm::planning
