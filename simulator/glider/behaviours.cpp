#include "simulator/glider/behaviours.hpp"

#include <algorithm>
#include <cmath>

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
      dived_s_{setup_.start_s},
      surfaced_s_{setup_.start_s},
      fix_s_{setup_.start_s},
      water_s_{setup_.start_s},
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
  auto accident = dynamics_.drift(until_s);
  look_at_goal();
  return accident;
}

DiveRecord Glider::dive(double at_s) {
  DiveRecord record;
  record.accident = drift(at_s);
  record.dive = dynamics_.position();
  record.dive_s = dived_s_ = dynamics_.time_s();
  if (!record.accident) {
    const int hits_before = navigator_.hits();
    const double spread = setup_.stint_jitter == 0 ? 0.0 : random_.uniform(-setup_.stint_jitter, setup_.stint_jitter);
    double left = setup_.stint_s * (1.0 + spread);
    dynamics_.begin_dive();
    navigator_.dive(record.dive, dived_s_, water_.value_or(Current{}));
    while (left > 1e-6 && !record.accident && !navigator_.quit()) {
      const double dt = std::min(setup_.cycle_s, left);
      const auto heading = navigator_.cycle(dynamics_.time_s(), dt);
      record.accident = dynamics_.swim(heading, dt, left);
      left -= dt;
      look_at_goal();
    }
    record.truth = dynamics_.dive_truth();
    record.deepest = dynamics_.deepest();
    record.hits = navigator_.hits() - hits_before;
  }
  surfaced_s_ = record.surface_s = dynamics_.time_s();
  record.surface = dynamics_.position();
  ++segment_;
  return record;
}

std::optional<Accident> Glider::take_fixes() {
  const double t1 = surfaced_s_ + setup_.times.first_fix, t2 = surfaced_s_ + setup_.times.last_fix;
  if (auto accident = drift(t1)) return accident;
  const auto first = dynamics_.position();
  if (auto accident = drift(t2)) return accident;
  fix_ = dynamics_.position();
  fix_s_ = t2;
  const double dive_time = surfaced_s_ - dived_s_;
  if (dive_time <= 0) return std::nullopt;  // not dived yet in this run: nothing is measured
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
  if (!list) return unexpected(list.error());
  navigator_.read(std::move(*list), fix_, now_s);
  return Done{};
}

void Glider::restart_list(double now_s) { navigator_.read(setup_.list, fix_, now_s); }

}  // namespace glidehelm::simulator
