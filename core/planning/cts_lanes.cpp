#include "core/planning/cts_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "core/planning/flight.hpp"

namespace glidehelm::planning {

namespace {

constexpr std::uint8_t kAground = 200, kArrived = 201;  // beside ocean::NoCurrent
constexpr auto kForecastEnd = static_cast<std::uint8_t>(ocean::NoCurrent::outside_time);
constexpr double kLetGo = 1.0;  // metres, as vehicle::gained_margin

}  // namespace

CtsLanes::CtsLanes(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, double margin,
                   const Envelope& reach)
    : problem_{problem},
      ocean_{ocean},
      chart_{chart},
      goal_{disc_of(problem)},
      margin_{margin},
      reach_{reach},
      step_{vehicle::lane_step(ocean, problem.start.fix, goal_.centre, problem.start.fix_s,
                               problem.schedule.stint.count(), problem.glider.horizontal_speed)} {}

void CtsLanes::begin(const Place& place) {
  put(0, place, 0, 0, 0);
  lanes_.count = 1;
}

void CtsLanes::put(std::size_t k, const Place& place, double east, double north, std::uint16_t heading) {
  lanes_.lat[k] = place.lat;
  lanes_.lon[k] = place.lon;
  lanes_.water_east[k] = east;
  lanes_.water_north[k] = north;
  lanes_.lost[k] = 0;
  margins_[k] = place.margin;
  rooms_[k] = place.room;
  which_[k] = heading;
}

void CtsLanes::move(std::size_t from, std::size_t to) {
  put(to, at(from), lanes_.water_east[from], lanes_.water_north[from], which_[from]);
}

void CtsLanes::drop_lost() {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(lanes_.count); ++k)
    if (!lost(k)) move(k, kept++);
  lanes_.count = static_cast<int>(kept);
}

std::optional<CtsLanes::Entry> CtsLanes::drift(int stint, bool goal_near) {
  std::optional<Entry> first;
  const double seconds = problem_.schedule.drift_before(stint).count();
  const double t0 = problem_.schedule.dive_time(stint).count() - seconds;
  if (seconds <= 0) return first;
  std::copy_n(lanes_.water_east.begin(), lanes_.count, east_kept_.begin());
  std::copy_n(lanes_.water_north.begin(), lanes_.count, north_kept_.begin());
  std::fill_n(lanes_.water_east.begin(), lanes_.count, 0.0);
  std::fill_n(lanes_.water_north.begin(), lanes_.count, 0.0);
  remember_places();
  ocean_.surface.advance(lanes_, problem_.start.fix_s + t0, seconds);
  statistics_.current_evaluations += 4 * static_cast<std::uint64_t>(lanes_.count);
  std::copy_n(east_kept_.begin(), lanes_.count, lanes_.water_east.begin());
  std::copy_n(north_kept_.begin(), lanes_.count, lanes_.water_north.begin());
  check_land(reach_.drift * seconds);
  if (goal_near) check_goal(t0, seconds, first);
  note_lost();
  return first;
}

std::optional<CtsLanes::Entry> CtsLanes::fly(int stint, bool goal_near) {
  std::optional<Entry> first;
  const double seconds = problem_.schedule.stint_length(stint).count(), t0 = problem_.schedule.dive_time(stint).count();
  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / step_ - 1e-9)));
  const double dt = seconds / steps;
  const bool land_near = !spend_room(reach_.dive * seconds);
  for (int step = 0; step < steps; ++step) {
    if (land_near || goal_near) remember_places();
    ocean_.dive.advance(lanes_, problem_.start.fix_s + t0 + step * dt, dt);
    if (land_near) check_land(reach_.dive * dt);
    if (goal_near) check_goal(t0 + step * dt, dt, first);
  }
  const auto flown = static_cast<std::uint64_t>(lanes_.count);
  statistics_.current_evaluations += 4 * flown * static_cast<std::uint64_t>(steps);
  statistics_.cost_evaluations += flown;
  note_lost();
  return first;
}

void CtsLanes::remember_places() {
  std::copy_n(lanes_.lat.begin(), lanes_.count, lat_before_.begin());
  std::copy_n(lanes_.lon.begin(), lanes_.count, lon_before_.begin());
}

double CtsLanes::margin_at(double lat, double lon) const {
  const bool far = chart_.clearance_at_least(lat, lon) >= margin_;
  return (far ? margin_ : std::min(margin_, chart_.clearance(lat, lon))) - kLetGo;
}

/// True when every lane has room for a way of so many metres; it is spent at once.
bool CtsLanes::spend_room(double way) {
  const auto n = static_cast<std::size_t>(lanes_.count);
  for (std::size_t k = 0; k < n; ++k)
    if (rooms_[k] - way < margins_[k]) return false;
  for (std::size_t k = 0; k < n; ++k) rooms_[k] -= way;
  return true;
}

/// After a step on which no lane came farther than `way`. A lane spends its room first.
void CtsLanes::check_land(double way) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(lanes_.count); ++k) {
    rooms_[k] -= way;
    if (rooms_[k] < margins_[k] && !lost(k)) check_land_closely(k);
  }
}
void CtsLanes::check_land_closely(std::size_t k) {
  const double lat0 = lat_before_[k], lon0 = lon_before_[k], lat1 = lanes_.lat[k], lon1 = lanes_.lon[k];
  rooms_[k] = chart_.clearance_at_least(lat1, lon1);
  const double way = local_offset(lat0, lon0, lat1, lon1).length();
  if (rooms_[k] - way >= margins_[k]) return;
  if (!chart_.segment_is_clear(lat0, lon0, lat1, lon1, margins_[k])) lanes_.lost[k] = kAground;
  if (margins_[k] < margin_) margins_[k] = std::max(margins_[k], margin_at(lat1, lon1));
}

void CtsLanes::check_goal(double t0, double dt, std::optional<Entry>& first) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(lanes_.count); ++k) {
    if (lost(k)) continue;
    const auto share = vehicle::entry_into(goal_, lat_before_[k], lon_before_[k], lanes_.lat[k], lanes_.lon[k]);
    if (!share) continue;
    const double t = t0 + *share * dt;
    if (!first || t < first->t) first = Entry{t, which_[k]};
    lanes_.lost[k] = kArrived;
  }
}

void CtsLanes::note_lost() {
  for (std::size_t k = 0; k < static_cast<std::size_t>(lanes_.count); ++k) {
    const auto lost = lanes_.lost[k];
    stopped_.margin = stopped_.margin || lost == kAground;
    stopped_.forecast_end = stopped_.forecast_end || lost == kForecastEnd;
    stopped_.no_water = stopped_.no_water || (lost != 0 && lost < kAground && lost != kForecastEnd);
  }
}

}  // namespace glidehelm::planning
