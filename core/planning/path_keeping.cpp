#include "core/planning/path_keeping.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/planning/flight.hpp"

namespace glidehelm::planning {

namespace {

constexpr double kOnPath = 20.0;        // metres
constexpr double kOffPath = 500.0;      // metres
constexpr double kMostTurn = kPi / 12;  // 15°
constexpr int kCorrections = 3;

/// The path that headings mean when they are held, and the helm that keeps to it.
class PathKeeper {
 public:
  PathKeeper(std::span<const Heading> headings, const Problem& problem, const vehicle::Waters& waters,
             const Replan& replan)
      : headings_{headings.begin(), headings.end()},
        problem_{problem},
        waters_{waters},
        goal_{disc_of(problem)},
        replan_{replan} {
    const auto fix = vehicle::state_at(problem.start.fix, problem.start.fix_s, waters);
    lay_out(drift(fix, 0), 0);
  }

  /// The law asks more than once for a stint: the same question has the same answer.
  [[nodiscard]] std::optional<Heading> heading(int k, GeoPoint dive, double dive_s) {
    if (asked_ && asked_->k == k && asked_->dive == dive && asked_->dive_s == dive_s) return asked_->answer;
    const auto n = static_cast<std::size_t>(k);
    const auto from = vehicle::state_at(dive, dive_s, waters_);
    if (replan_ && k > 0 && (n >= headings_.size() || off_path(n, from))) {
      const auto begin = std::min(n, headings_.size());
      const auto rest = replan_(k, dive, dive_s, std::span{headings_}.subspan(begin));
      headings_.resize(begin);
      headings_.insert(headings_.end(), rest.begin(), rest.end());
      lay_out(from, n);
    }
    std::optional<Heading> answer;
    if (n < headings_.size()) answer = n < surfacings_.size() ? towards_surfacing(k, from) : towards_goal(k, from);
    asked_ = Asked{k, dive, dive_s, answer};
    return answer;
  }

 private:
  struct Asked {
    int k;
    GeoPoint dive;
    double dive_s;
    std::optional<Heading> answer;
  };
  [[nodiscard]] vehicle::State drift(const vehicle::State& from, int k) const {
    return vehicle::move(waters_, waters_.ocean.surface, from, problem_.schedule.drift_before(k).count(), {}, nullptr)
        .end;
  }
  /// Where the headings from stint `n` on lead when they are held from a dive, as far as they do without an arrival.
  void lay_out(vehicle::State dive, std::size_t n) {
    dives_.resize(n);
    surfacings_.resize(std::min(n, surfacings_.size()));
    for (; n < headings_.size(); ++n) {
      dives_.push_back(dive);
      const int k = static_cast<int>(n);
      const auto stint = hold(dive, k, headings_[n]);
      if (stint.lost || stint.arrival_s) break;
      surfacings_.push_back(stint.end);
      dive = drift(stint.end, k + 1);
    }
  }
  [[nodiscard]] bool off_path(std::size_t n, const vehicle::State& from) const {
    if (n >= dives_.size()) return true;
    return local_offset(from.lat, from.lon, dives_[n].lat, dives_[n].lon).length() > kOffPath;
  }
  [[nodiscard]] vehicle::Motion hold(const vehicle::State& from, int k, Heading heading) const {
    return vehicle::move(waters_, waters_.ocean.dive, from, problem_.schedule.stint_length(k).count(),
                         vehicle::WaterVelocity::of(heading, problem_.glider.horizontal_speed), &goal_);
  }

  /// The turn to the right that moves a position reached after `seconds` on a heading towards a place beside it.
  [[nodiscard]] double turn_for(const vehicle::State& reached, double lat, double lon, Heading heading,
                                double seconds) const {
    const auto off = local_offset(reached.lat, reached.lon, lat, lon);
    const double to_the_right = off.east * heading.north() - off.north * heading.east();
    return to_the_right / std::max(1.0, problem_.glider.horizontal_speed.si() * seconds);
  }
  [[nodiscard]] Heading turned(Heading wanted, Heading now, double turn) const {
    const double all = std::clamp((now - wanted).si() + turn, -kMostTurn, kMostTurn);
    return wanted + Radians{all};
  }

  [[nodiscard]] Heading towards_surfacing(int k, const vehicle::State& from) const {
    const auto& place = surfacings_[static_cast<std::size_t>(k)];
    const Heading wanted = headings_[static_cast<std::size_t>(k)];
    Heading now = wanted, best = wanted;
    double nearest = 1e18;
    for (int i = 0; i <= kCorrections; ++i) {
      const auto m = hold(from, k, now);
      // A corrected heading must not run aground; the wanted one is the search's to answer for.
      if (m.lost) break;
      const double off = local_offset(m.end.lat, m.end.lon, place.lat, place.lon).length();
      if (off < nearest) {
        nearest = off;
        best = now;
      }
      const double turn = turn_for(m.end, place.lat, place.lon, now, m.end.t_s - from.t_s);
      if (off <= kOnPath || std::abs(turn) < kSmallTurn) break;
      now = turned(wanted, now, turn);
    }
    return best;
  }

  /// The last stint: the first correction whose track meets the goal, else the one that comes nearest.
  [[nodiscard]] Heading towards_goal(int k, const vehicle::State& from) const {
    const Heading wanted = headings_[static_cast<std::size_t>(k)];
    Heading now = wanted, best = wanted;
    double nearest = 1e18;
    for (int i = 0; i <= kCorrections; ++i) {
      const auto m = hold(from, k, now);
      if (m.arrival_s) return now;
      if (m.closest < nearest) {
        nearest = m.closest;
        best = now;
      }
      const auto& near = m.closest_at;
      const double turn =
          turn_for(near, goal_.centre.lat.radians(), goal_.centre.lon.radians(), now, near.t_s - from.t_s);
      if (std::abs(turn) < kSmallTurn) break;
      now = turned(wanted, now, turn);
    }
    return best;
  }

  static constexpr double kSmallTurn = 1e-4;  // radians: a metre beside a stint's end

  std::vector<Heading> headings_;
  const Problem& problem_;
  const vehicle::Waters& waters_;
  vehicle::Disc goal_;
  const Replan& replan_;
  std::vector<vehicle::State> dives_, surfacings_;  ///< of the held headings, as far as they lead without an arrival
  std::optional<Asked> asked_;
};

}  // namespace

vehicle::FlownList fly_path(std::span<const Heading> headings, const Problem& problem, const ocean::Ocean& ocean,
                            const chart::Chart& chart, double until_s, const Replan& replan) {
  const auto waters = waters_of(problem, ocean, chart);
  auto flight = flight_of(problem);
  flight.horizon_s = std::min(flight.horizon_s, until_s);
  PathKeeper keeper{headings, problem, waters, replan};
  return vehicle::fly_helm([&](int k, GeoPoint dive, double dive_s) { return keeper.heading(k, dive, dive_s); }, flight,
                           waters);
}

}  // namespace glidehelm::planning
