#include "core/planning/held_flight.hpp"

#include <algorithm>
#include <cmath>

#include "core/planning/flight.hpp"

namespace glidehelm::planning {

namespace {

constexpr double kTolerance = 2e-4;
constexpr double kLongestDrift = 1800;  // seconds of one step at the surface
constexpr double kNearly = 0.999;       // distances in the plane are good to 1e-4

}  // namespace

void HeldLanes::begin(int count, double lat, double lon) {
  const auto n = static_cast<std::size_t>(count);
  at.count = count;
  std::fill_n(at.lat.begin(), n, lat);
  std::fill_n(at.lon.begin(), n, lon);
  std::fill_n(at.lost.begin(), n, std::uint8_t{0});
  std::fill_n(arrival_s.begin(), n, kNever);
  std::fill_n(toll.begin(), n, 0.0);
  std::fill_n(to_goal.begin(), n, 0.0);
}

HeldFlight::HeldFlight(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Metres margin)
    : problem_{problem},
      ocean_{ocean},
      chart_{chart},
      goal_{disc_of(problem)},
      margin_{margin.si()},
      step_{vehicle::lane_step(ocean, problem.start.fix, goal_.centre, problem.start.fix_s,
                               problem.schedule.stint.count(), problem.glider.horizontal_speed, kTolerance)},
      fastest_{
          std::max(problem.glider.horizontal_speed.si() + ocean.dive.fastest().si(), ocean.surface.fastest().si())} {}

void HeldFlight::fly(HeldLanes& lanes, int k, const std::array<double, ocean::Lanes::kMax>& headings, double until_s,
                     bool strict) {
  const auto n = static_cast<std::size_t>(lanes.at.count);
  const double wait = problem_.schedule.drift_before(k).count(), dive = dive_s(k);
  std::fill_n(lanes.at.water_east.begin(), n, 0.0);
  std::fill_n(lanes.at.water_north.begin(), n, 0.0);
  leg(lanes, ocean_.surface, dive - wait, wait, until_s, kLongestDrift, strict);
  const double speed = problem_.glider.horizontal_speed.si();
  for (std::size_t i = 0; i < n; ++i) {
    lanes.at.water_east[i] = speed * std::sin(headings[i]);
    lanes.at.water_north[i] = speed * std::cos(headings[i]);
  }
  leg(lanes, ocean_.dive, dive, problem_.schedule.stint_length(k).count(), until_s, step_, strict);
}

void HeldFlight::leg(HeldLanes& lanes, ocean::FieldRef field, double from_s, double seconds, double until_s,
                     double longest_step, bool strict) {
  if (!(seconds > 0)) return;
  const auto n = static_cast<std::size_t>(lanes.at.count);
  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / longest_step - 1e-9)));
  for (int step = 0; step < steps; ++step) {
    // The last instant cuts a step short and moves none: two flights with other ends are the same until then.
    const double begin = from_s + seconds * step / steps, dt = std::min(seconds / steps, until_s - begin);
    if (!(dt > 0)) break;
    std::copy_n(lanes.at.lat.begin(), n, lat_before_.begin());
    std::copy_n(lanes.at.lon.begin(), n, lon_before_.begin());
    field.advance(lanes.at, begin, dt);
    evaluations_ += 4 * n;
    look_at_land(lanes, dt, strict);
    if (strict) look_for_goal(lanes, begin, dt);
  }
}

void HeldFlight::look_at_land(HeldLanes& lanes, double dt, bool strict) {
  const double asked = margin_ + buffer_;
  if (!(asked > 0)) return;
  for (std::size_t k = 0; k < static_cast<std::size_t>(lanes.at.count); ++k) {
    if (!lanes.flies(k)) continue;
    const double lat = lanes.at.lat[k], lon = lanes.at.lon[k];
    if (chart_.clearance_at_least(lat, lon) >= asked + fastest_ * dt) continue;
    const double paid = toll(lat_before_[k], lon_before_[k], lat, lon, strict);
    if (paid < 0)
      lanes.at.lost[k] = HeldLanes::kAground;
    else
      lanes.toll[k] += paid;
  }
}

double HeldFlight::toll(double lat0, double lon0, double lat1, double lon1, bool strict) const {
  // Places a fixed share of the way apart, so that toll is smooth in both ends. Clearance changes by at most a metre per
  // metre: where it is ample, places whose toll is nothing are passed over.
  const double length = local_offset(lat0, lon0, lat1, lon1).length(), asked = margin_ + buffer_;
  const int places = std::max(1, static_cast<int>(std::ceil(fastest_ * step_ / std::max(20.0, 0.25 * buffer_))));
  const double apart = length / places;
  double paid = 0;
  for (int i = 1; i <= places;) {
    const double share = static_cast<double>(i) / places;
    const double spare = chart_.clearance(lat0 + share * (lat1 - lat0), lon0 + share * (lon1 - lon0)) - asked;
    if (strict && spare < -buffer_) return -1;
    if (spare < 0 && buffer_ > 0) paid += 0.5 * (spare / buffer_) * (spare / buffer_) * apart;
    i += apart > 0 && spare > apart ? static_cast<int>(std::min(spare / apart, 1e6)) : 1;
  }
  return paid;
}

void HeldFlight::look_for_goal(HeldLanes& lanes, double from_s, double dt) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(lanes.at.count); ++k) {
    if (!lanes.flies(k)) continue;
    // A measured distance is spent at the fastest speed there is before another is measured.
    lanes.to_goal[k] -= fastest_ * dt;
    if (lanes.to_goal[k] > 0) continue;
    lanes.to_goal[k] = kNearly * to_goal(lanes.at.lat[k], lanes.at.lon[k]) - goal_.radius.si();
    const auto share = vehicle::entry_into(goal_, lat_before_[k], lon_before_[k], lanes.at.lat[k], lanes.at.lon[k]);
    if (!share) continue;
    lanes.arrival_s[k] = from_s + *share * dt;
    lanes.at.lost[k] = HeldLanes::kArrived;
  }
}

}  // namespace glidehelm::planning
