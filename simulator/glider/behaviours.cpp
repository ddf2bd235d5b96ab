#include "simulator/glider/behaviours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/local_metric.hpp"

namespace glidehelm::simulator {
namespace {

constexpr double kMaxWaterSpeed = 2.8;  // u_max_water_speed

Current clipped(double east, double north) {
  return {MetresPerSecond{std::clamp(east, -kMaxWaterSpeed, kMaxWaterSpeed)},
          MetresPerSecond{std::clamp(north, -kMaxWaterSpeed, kMaxWaterSpeed)}};
}

Offset offset(GeoPoint from, GeoPoint to) {
  return local_offset(from.lat.radians(), from.lon.radians(), to.lat.radians(), to.lon.radians());
}

}  // namespace

Glider::Glider(GliderSetup setup, ocean::Ocean truth, const chart::Chart& chart)
    : setup_{std::move(setup)},
      dynamics_{setup_.hull, truth, chart},
      navigator_{setup_.belief},
      random_{setup_.seed},
      gps_{setup_.gps, random_.stream(11)},
      wind_{setup_.wind, random_.stream(12)},
      luck_{random_.stream(13)},
      dived_s_{setup_.start_s},
      surfaced_s_{setup_.start_s},
      fix_s_{setup_.start_s},
      fixes_done_s_{setup_.start_s},
      water_s_{setup_.start_s},
      heard_s_{setup_.start_s},
      fix_{setup_.start},
      water_{setup_.prior_water},
      initial_water_{setup_.prior_water} {
  dynamics_.place(setup_.start, setup_.start_s);
  navigator_.read(setup_.list, setup_.start, setup_.start_s);
}

void Glider::watch(GeoPoint goal, Metres radius) {
  goal_ = goal;
  goal_radius_ = radius;
  arrived_s_.reset();
  closest_ = Metres{1e9};
  previous_distance_ = 1e9;
  look_at_goal();
}

/// The crossing of the radius is placed by linear interpolation between two looks, a cycle apart at most.
void Glider::look_at_goal() {
  if (!goal_ || arrived_s_) return;
  const auto p = dynamics_.position();
  const double bound =
      distance_lower_bound(p.lat.radians(), p.lon.radians(), goal_->lat.radians(), goal_->lon.radians());
  const double now = dynamics_.time_s();
  const bool could_matter = bound < closest_.si() || bound < goal_radius_.si();
  const double d = could_matter ? distance(p, *goal_).si() : bound;
  closest_ = std::min(closest_, Metres{could_matter ? d : closest_.si()});
  if (d < goal_radius_.si()) {
    const double fell = previous_distance_ - d;
    const double share = fell > 0 && previous_distance_ < 1e8 ? (previous_distance_ - goal_radius_.si()) / fell : 1.0;
    arrived_s_ = previous_distance_ < 1e8 ? previous_s_ + share * (now - previous_s_) : now;
  }
  previous_distance_ = d;
  previous_s_ = now;
}

std::optional<Accident> Glider::drift(double until_s) {
  const auto wind = wind_.leeway(dynamics_.time_s());
  const auto steady = setup_.hull.leeway;
  dynamics_.set_leeway({steady.east + wind.east, steady.north + wind.north});
  auto accident = dynamics_.drift(until_s);
  look_at_goal();
  return accident;
}

double Glider::stint_limit() {
  const double spread = setup_.stint_jitter == 0 ? 0.0 : random_.uniform(-setup_.stint_jitter, setup_.stint_jitter);
  if (setup_.surfacing.half_cycles) return std::numeric_limits<double>::infinity();
  return setup_.stint_s * (1.0 + spread);
}

/// The first behaviour that wants the surface now. The yo's own end and the stint's are seen by the caller.
std::optional<Because> Glider::reason_to_surface(int hits_before) {
  const auto& rules = setup_.surfacing;
  const double now = dynamics_.time_s();
  if (navigator_.quit() && rules.heading_idle != SurfaceRules::Idle::ignore && !idle_told_) {
    idle_told_ = true;
    return because::kHeadingIdle;
  }
  if (rules.at_waypoint && navigator_.hits() > hits_before) return because::kHitWaypoint;
  if (rules.no_comms_s && now - heard_s_ >= *rules.no_comms_s) {
    heard_s_ = now;
    return because::kNoComms;
  }
  if (rules.every_s && now - dived_s_ >= *rules.every_s) return because::kTimer;
  return std::nullopt;
}

void Glider::look_for_abort() {
  if (abort_) return;
  const auto& rules = setup_.aborts;
  const double now = dynamics_.time_s();
  if (rules.overdepth && dynamics_.depth() > *rules.overdepth) {
    abort_ = Abort{"MS_ABORT_OVERDEPTH", 0, {}, now};
  } else if (rules.max_wpt_distance && !navigator_.ended()) {
    const auto goal = navigator_.waypoint();
    const auto here = navigator_.reckoned();
    const double away = distance(here, goal).si();
    if (away > rules.max_wpt_distance->si())
      abort_ = Abort{"MS_ABORT_WPT_TOOFAR", 18, std::to_string(static_cast<long>(away)) + " m to the waypoint", now};
  }
}

/// slocum.md 4.1: depth rate over the tangent of the angle that the glider takes for its path's; too flat a pitch says
/// nothing.
std::optional<MetresPerSecond> Glider::speed_by_depth_rate() {
  constexpr double kFlattest = 11.3 * kPi / 180;
  const auto leg = dynamics_.leg();
  const double angle = leg.path + setup_.angle_error.si();
  if (!setup_.speed_by_depth_rate || leg.vertical <= 0 || angle < kFlattest || angle > 1.5) return std::nullopt;
  return MetresPerSecond{leg.vertical / std::tan(angle)};
}

void Glider::fly(DiveRecord& record) {
  const int hits_before = navigator_.hits();
  double left = stint_limit();
  dynamics_.begin_dive({setup_.surfacing.half_cycles, !strikes(setup_.altimeter_silent, segment_ + 1, luck_)});
  navigator_.dive(fresh_ ? gps_.fix(record.dive) : navigator_.reckoned(), dived_s_, water_.value_or(Current{}));
  because_ = because::kYoIsOver;
  bool coming_up = false;
  while (left > 1e-6 && !record.accident) {
    const double dt = std::min(setup_.cycle_s, left);
    const auto speed = speed_by_depth_rate();
    const auto heading = navigator_.cycle(dynamics_.time_s(), dt, speed);
    if (speed) {
      speed_sum_ += speed->si() * dt;
      speed_time_ += dt;
    }
    record.accident = dynamics_.swim(heading, dt, left);
    left -= dt;
    look_at_goal();
    look_for_abort();
    if (!coming_up) {
      const auto why = abort_ ? std::optional{because::kYoIsOver} : reason_to_surface(hits_before);
      if (why) because_ = *why;
      coming_up = why || dynamics_.yo_is_over();
      if (why) dynamics_.come_up();
    }
    if (coming_up) left = std::min(left, dynamics_.climb_seconds());
  }
  record.truth = dynamics_.dive_truth();
  record.deepest = dynamics_.deepest();
  record.hits = navigator_.hits() - hits_before;
  record.half_cycles = dynamics_.half_cycles();
  record.touched_floor = dynamics_.touched();
  if (speed_time_ > 0) navigator_.believe(MetresPerSecond{speed_sum_ / speed_time_});
  speed_sum_ = speed_time_ = 0;
}

DiveRecord Glider::dive(double at_s) {
  DiveRecord record;
  record.accident = drift(at_s);
  record.dive = dynamics_.position();
  record.dive_s = dived_s_ = dynamics_.time_s();
  measurable_ = !record.accident && !abort_;
  if (!record.accident && abort_) {
    ++fallback_calls_;
    because_ = because::kNoComms;
    record.accident = drift(dived_s_ + setup_.aborts.fallback_every_s);
  } else if (!record.accident) {
    fly(record);
  }
  surfaced_s_ = record.surface_s = dynamics_.time_s();
  record.surface = dynamics_.position();
  record.because = because_;
  if (measurable_) reckoned_s_ += surfaced_s_ - dived_s_;
  account_for_dive(record);
  ++segment_;
  return record;
}

void Glider::account_for_dive(DiveRecord& record) {
  const auto& spec = setup_.energy;
  const double surface_s = record.dive_s - fixes_done_s_ + setup_.times.last_fix;
  const double dive_w = measurable_ ? spec.dive_w : spec.surface_w;
  since_surfacing_.hotel_wh += (spec.surface_w * surface_s + dive_w * (record.surface_s - record.dive_s)) / 3600;
  if (measurable_) since_surfacing_.pump_wh += pump_wh(spec, dynamics_.pumped(), dynamics_.pumped_depths());
  record.energy = since_surfacing_;
  before_ += since_surfacing_;
  since_surfacing_ = {};
  if (const auto share = battery_left(); share && *share <= 0 && !abort_)
    abort_ = Abort{"MS_ABORT_UNDERVOLTS", 0, "battery empty", record.surface_s};
}

void Glider::called(double at_s, double seconds) {
  heard_s_ = at_s;
  since_surfacing_.call_wh += setup_.energy.call_w * seconds / 3600;
}

Energy Glider::energy() const {
  Energy all = before_;
  return all += since_surfacing_;
}

std::optional<double> Glider::battery_left() const {
  if (setup_.energy.battery_wh <= 0) return std::nullopt;
  return std::max(0.0, 1 - energy().total_wh() / setup_.energy.battery_wh);
}

void Glider::abort_by_behaviour_error(const BehaviourError& error, double now_s) {
  if (!abort_) abort_ = Abort{"MS_ABORT_BEH_ERROR", 6, error.message(), now_s};
}

std::optional<Accident> Glider::take_fixes() {
  const double t1 = surfaced_s_ + setup_.times.first_fix, t2 = surfaced_s_ + setup_.times.last_fix;
  const auto faults = gps_.next_surfacing();
  if (auto accident = drift(t1)) return accident;
  const auto first = gps_.fix(dynamics_.position());
  if (auto accident = drift(t2)) return accident;
  const auto second = gps_.fix(dynamics_.position());
  fixes_done_s_ = t2;
  // Without any valid fix yet the glider would have nothing to start from: the first surfacing of a run always has one.
  const bool had_one = fix_s_ > setup_.start_s;
  fresh_ = !had_one || !(faults.stale || faults.invalid);
  if (had_one && faults.invalid) invalid_fix_ = second;
  if (!fresh_) return std::nullopt;
  fix_ = second;
  fix_s_ = t2;
  const double dive_time = reckoned_s_;
  reckoned_s_ = 0;
  if (dive_time <= 0 || !measurable_) return std::nullopt;  // not dived in this run, or only drifted
  const auto used = navigator_.used();
  const auto error = offset(navigator_.reckoned(), first);
  initial_water_ = clipped(used.east.si() + error.east / dive_time, used.north.si() + error.north / dive_time);
  const auto moved = offset(first, fix_);
  const double back = t2 > t1 ? (t1 - surfaced_s_) / (t2 - t1) : 0.0;
  water_ = clipped(used.east.si() + (error.east - back * moved.east) / dive_time,
                   used.north.si() + (error.north - back * moved.north) / dive_time);
  water_s_ = t2;
  return std::nullopt;
}

Expected<Done, BehaviourError> Glider::read_list(std::string_view bytes, double now_s) {
  auto list = read_goto_list(bytes);
  idle_told_ = false;
  if (!list) return unexpected(list.error());
  navigator_.read(std::move(*list), fix_, now_s);
  return Done{};
}

void Glider::restart_list(double now_s) {
  idle_told_ = false;
  navigator_.read(setup_.list, fix_, now_s);
}

}  // namespace glidehelm::simulator
