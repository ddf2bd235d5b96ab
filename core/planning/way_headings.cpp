#include "core/planning/way_headings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/planning/flight.hpp"
#include "core/vehicle/constrained_motion.hpp"

namespace glidehelm::planning {

namespace {

constexpr std::array kShares{1.0, 0.6, 0.35, 0.2, 0.1};  // of the way of a stint, to the place that is aimed at
constexpr int kCorrections = 4;
constexpr double kOnWay = 10.0;  // metres

class Follower {
 public:
  Follower(std::span<const WayPoint> way, const Problem& problem, const vehicle::Waters& waters)
      : way_{way}, problem_{problem}, waters_{waters}, goal_{disc_of(problem)}, reached_s_{way.front().t_s} {}

  std::vector<Heading> headings() {
    std::vector<Heading> headings;
    auto at = vehicle::state_at(problem_.start.fix, problem_.start.fix_s, waters_);
    for (int k = 0; k < vehicle::kMostStints && problem_.schedule.surfacing_time(k).count() <= horizon(); ++k) {
      const auto drift =
          vehicle::move(waters_, waters_.ocean.surface, at, problem_.schedule.drift_before(k).count(), {}, &goal_);
      if (drift.lost || drift.arrival_s) break;
      come_ahead(drift.end);
      if (reached_s_ >= way_.back().t_s) break;
      const auto stint = choose(drift.end, k);
      if (!stint) break;
      headings.push_back(stint->heading);
      if (stint->motion.arrival_s) break;
      at = stint->motion.end;
    }
    return headings;
  }

 private:
  struct Stint {
    Heading heading;
    vehicle::Motion motion;
  };

  [[nodiscard]] double horizon() const { return problem_.horizon_s - problem_.start.fix_s; }

  /// Moves `reached_s_` to the time at which the way passes nearest to a position, within two cycles ahead.
  void come_ahead(const vehicle::State& at) {
    const double until = reached_s_ + 2 * cycle();
    double nearest = 1e18, best = reached_s_;
    for (std::size_t i = 1; i < way_.size() && way_[i - 1].t_s <= until; ++i) {
      const WayPoint &a = way_[i - 1], &b = way_[i];
      if (b.t_s <= reached_s_) continue;
      const auto leg = local_offset(a.lat, a.lon, b.lat, b.lon), here = local_offset(a.lat, a.lon, at.lat, at.lon);
      const double l2 = leg.length() * leg.length();
      const double share = l2 > 0 ? std::clamp((here.east * leg.east + here.north * leg.north) / l2, 0.0, 1.0) : 1.0;
      const double off = std::hypot(here.east - share * leg.east, here.north - share * leg.north);
      const double t = a.t_s + share * (b.t_s - a.t_s);
      if (off < nearest && t >= reached_s_) {
        nearest = off;
        best = t;
      }
    }
    reached_s_ = best;
  }
  [[nodiscard]] double cycle() const { return (problem_.schedule.stint + problem_.schedule.surface).count(); }

  [[nodiscard]] WayPoint place_at(double t_s) const {
    const auto next = std::find_if(way_.begin(), way_.end(), [t_s](const WayPoint& p) { return p.t_s >= t_s; });
    if (next == way_.begin()) return way_.front();
    if (next == way_.end()) return way_.back();
    const WayPoint &a = *(next - 1), &b = *next;
    const double share = (t_s - a.t_s) / (b.t_s - a.t_s);
    return {a.lat + share * (b.lat - a.lat), a.lon + share * (b.lon - a.lon), t_s};
  }

  [[nodiscard]] std::optional<Stint> choose(const vehicle::State& dive, int k) const {
    const double ahead = problem_.schedule.stint_length(k).count() + problem_.schedule.surface.count();
    for (const double share : kShares) {
      auto stint = towards(place_at(reached_s_ + share * ahead), dive, k);
      if (!stint.motion.lost) return stint;
    }
    return std::nullopt;
  }

  /// The heading that passes through a place: the error across it is what a turn can mend.
  [[nodiscard]] Stint towards(const WayPoint& place, const vehicle::State& dive, int k) const {
    const double seconds = problem_.schedule.stint_length(k).count(), speed = problem_.glider.horizontal_speed.si();
    const auto hold = [&](Heading h) {
      return vehicle::move(waters_, waters_.ocean.dive, dive, seconds,
                           vehicle::WaterVelocity::of(h, problem_.glider.horizontal_speed), &goal_);
    };
    const auto off = local_offset(dive.lat, dive.lon, place.lat, place.lon);
    const auto course = Course::of(off.east, off.north);
    const auto current = waters_.ocean.dive.sample(dive.at(), dive.t_s);
    const auto held =
        current ? vehicle::hold_course(course, problem_.glider.horizontal_speed, current->current) : std::nullopt;
    Stint best{held ? held->heading : Heading{course.from_north()}, {}};
    best.motion = hold(best.heading);
    double least = across(best.motion, dive, course);
    for (int i = 0; i < kCorrections && !best.motion.lost && !best.motion.arrival_s && std::abs(least) > kOnWay; ++i) {
      Stint next{best.heading + Radians{std::clamp(-least / (speed * seconds), -kPi / 6, kPi / 6)}, {}};
      next.motion = hold(next.heading);
      const double now = across(next.motion, dive, course);
      if (std::abs(now) >= std::abs(least) || next.motion.lost) break;
      best = next;
      least = now;
    }
    return best;
  }
  /// Metres to the right of the straight course from the dive at which a motion ends.
  static double across(const vehicle::Motion& motion, const vehicle::State& dive, Course course) {
    const auto off = local_offset(dive.lat, dive.lon, motion.end.lat, motion.end.lon);
    return off.east * course.north() - off.north * course.east();
  }

  std::span<const WayPoint> way_;
  const Problem& problem_;
  const vehicle::Waters& waters_;
  vehicle::Disc goal_;
  double reached_s_;  ///< time of the way that the glider has come to
};

}  // namespace

std::vector<Heading> headings_along(std::span<const WayPoint> way, const Problem& problem, const ocean::Ocean& ocean,
                                    const chart::Chart& chart, Metres margin) {
  if (way.size() < 2) return {};
  const vehicle::Waters waters{ocean, chart, margin};
  return Follower{way, problem, waters}.headings();
}

}  // namespace glidehelm::planning
