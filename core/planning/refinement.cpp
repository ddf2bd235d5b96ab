#include "core/planning/refinement.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/planning/held_flight.hpp"

namespace glidehelm::planning {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using LaneValues = std::array<double, ocean::Lanes::kMax>;

constexpr double kPlaceStep = 500.0;  // metres, largest step of differences
constexpr double kLongestTurn = 0.5;  // radians in one round
constexpr int kMostRounds = 100;
constexpr int kMostDampings = 6, kMostIdle = 3;
constexpr double kDampingUnit = 1e-5;  // 1/m, of curvature
constexpr double kWorthwhile = 0.5;    // metres of a round

/// A scalar with its first and second differences with respect to place (east, north, metres) and heading.
struct Expansion {
  double value{};
  Vector2d by_place = Vector2d::Zero();
  double by_turn{};
  Matrix2d by_places = Matrix2d::Zero();
  Vector2d by_place_turn = Vector2d::Zero();
  double by_turns{};
};

/// The lanes around a way: moves of place and heading, in steps, each with its opposite after it.
struct Around {
  int east, north, turn;
};
constexpr std::array<Around, 13> kAround{{{0, 0, 0},
                                          {1, 0, 0},
                                          {-1, 0, 0},
                                          {0, 1, 0},
                                          {0, -1, 0},
                                          {0, 0, 1},
                                          {0, 0, -1},
                                          {1, 1, 0},
                                          {-1, -1, 0},
                                          {1, 0, 1},
                                          {-1, 0, -1},
                                          {0, 1, 1},
                                          {0, -1, -1}}};

Expansion expand(const std::array<double, kAround.size()>& f, double place_step, double turn_step) {
  const auto first = [&](std::size_t k, double h) { return (f[k] - f[k + 1]) / (2 * h); };
  const auto second = [&](std::size_t k, double h) { return (f[k] - 2 * f[0] + f[k + 1]) / (h * h); };
  const auto mixed = [&](std::size_t both, std::size_t a, std::size_t b, double h) {
    return (f[both] + f[both + 1] - f[a] - f[a + 1] - f[b] - f[b + 1] + 2 * f[0]) / (2 * h);
  };
  Expansion e;
  e.value = f[0];
  e.by_place = {first(1, place_step), first(3, place_step)};
  e.by_turn = first(5, turn_step);
  const double en = mixed(7, 1, 3, place_step * place_step);
  e.by_places << second(1, place_step), en, en, second(3, place_step);
  e.by_turns = second(5, turn_step);
  e.by_place_turn = {mixed(9, 1, 5, place_step * turn_step), mixed(11, 3, 5, place_step * turn_step)};
  return e;
}

/// One stint of the way: where it begins and how its end answers to changes.
struct Link {
  double lat{}, lon{};
  Expansion east, north;  ///< of the end, metres from where the way ends
  Expansion toll;
};

/// What one turn does, and how it answers to a deviation from the way.
struct Gain {
  double turn{};
  Vector2d feedback = Vector2d::Zero();
};

/// A way as it was flown.
struct Way {
  std::vector<double> headings;
  double arrival_s{HeldLanes::kNever};
  double gain{-std::numeric_limits<double>::infinity()};  ///< metres over the way before
  [[nodiscard]] bool arrives() const { return arrival_s < HeldLanes::kNever; }
};

class Refinement {
 public:
  Refinement(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Metres margin,
             const Budget& budget)
      : problem_{problem}, budget_{budget}, flight_{problem, ocean, chart, margin} {
    lat0_ = problem.start.fix.lat.radians();
    lon0_ = problem.start.fix.lon.radians();
  }

  Refined run(std::span<const Heading> headings) {
    for (const auto h : headings) way_.headings.push_back(h.from_north().si());
    if (!way_.headings.empty())
      for (const double buffer : {4000.0, 1000.0, 250.0}) polish(buffer);
    return result();
  }

 private:
  /// Rounds with one buffer, until they no longer pay.
  void polish(double buffer) {
    flight_.set_buffer(Metres{buffer});
    // Differences must be finer than the slope of the toll.
    place_step_ = std::min(kPlaceStep, buffer / 3);
    turn_step_ = place_step_ / (problem_.glider.horizontal_speed.si() * problem_.schedule.stint.count());
    if (cut_ || !measure()) return;
    kept_margin_ = true;
    damping_ = 0;
    int dampings = 0, idle = 0;
    while (rounds_ < kMostRounds && statistics_.expansions < budget_.work && !cut_) {
      if (budget_.expired && budget_.expired()) {
        cut_ = true;
        return;
      }
      ++statistics_.expansions;
      if (!differentiate()) return;
      const double damped = std::max(1.0, damping_);
      look_back(free_, damping_, 0);
      look_back(held_, 0, damped);
      Way better = step_forward();
      if (!(better.gain > 0)) {
        if (++dampings > kMostDampings) break;
        damping_ = damping_ == 0 ? 1 : 4 * damping_;
        continue;
      }
      dampings = 0;
      damping_ = damping_ > 1 ? 0.25 * damping_ : 0;
      way_ = std::move(better);
      ++rounds_;
      if (!measure()) return;
      idle = way_.gain < kWorthwhile ? idle + 1 : 0;
      if (idle > 0 && (damping_ == 0 || idle > kMostIdle)) break;
    }
  }

  /// Flies the way at hand anew: its arrival, and the instant at which its distance counts. False when it cannot be flown.
  bool measure() {
    HeldLanes lanes;
    lanes.begin(1, lat0_, lon0_);
    LaneValues headings{};
    way_.arrival_s = HeldLanes::kNever;
    for (int k = 0; k < stints(); ++k) {
      headings[0] = way_.headings[static_cast<std::size_t>(k)];
      flight_.fly(lanes, k, headings, problem_.horizon_s, true);
      statistics_.cost_evaluations += 1;
      if (lanes.arrival_s[0] < HeldLanes::kNever) {
        way_.headings.resize(static_cast<std::size_t>(k) + 1);
        way_.arrival_s = lanes.arrival_s[0];
        break;
      }
      if (!lanes.flies(0)) return false;
    }
    until_s_ = way_.arrives() ? way_.arrival_s
                              : flight_.dive_s(stints() - 1) + problem_.schedule.stint_length(stints() - 1).count();
    if (until_s_ > problem_.horizon_s) return false;
    remaining_ = flight_.to_goal(lanes.at.lat[0], lanes.at.lon[0]);
    return true;
  }

  /// The links of the way up to the instant that counts.
  bool differentiate() {
    links_.assign(static_cast<std::size_t>(stints()), {});
    double lat = lat0_, lon = lon0_;
    for (int k = 0; k < stints(); ++k) {
      auto& link = links_[static_cast<std::size_t>(k)];
      link.lat = lat;
      link.lon = lon;
      HeldLanes lanes;
      lanes.begin(static_cast<int>(kAround.size()), lat, lon);
      LaneValues headings{};
      const auto metric = LocalMetric::at(lat);
      for (std::size_t i = 0; i < kAround.size(); ++i) {
        lanes.at.lat[i] += kAround[i].north * place_step_ / metric.meridian_radius;
        lanes.at.lon[i] += kAround[i].east * place_step_ / metric.parallel_radius;
        headings[i] = way_.headings[static_cast<std::size_t>(k)] + kAround[i].turn * turn_step_;
      }
      flight_.fly(lanes, k, headings, until_s_, false);
      statistics_.cost_evaluations += kAround.size();
      for (std::size_t i = 0; i < kAround.size(); ++i)
        if (!lanes.flies(i)) return false;  // at the edge of the field
      lat = lanes.at.lat[0];
      lon = lanes.at.lon[0];
      std::array<double, kAround.size()> east{}, north{}, toll{};
      for (std::size_t i = 0; i < kAround.size(); ++i) {
        const auto off = local_offset(lat, lon, lanes.at.lat[i], lanes.at.lon[i]);
        east[i] = off.east;
        north[i] = off.north;
        toll[i] = lanes.toll[i];
      }
      link.east = expand(east, place_step_, turn_step_);
      link.north = expand(north, place_step_, turn_step_);
      link.toll = expand(toll, place_step_, turn_step_);
    }
    end_lat_ = lat;
    end_lon_ = lon;
    return true;
  }
  /// Backwards: the distance that is left at the end as a quadratic in each link's beginning, and the turns that it asks for.
  /// Damped by a price on turning, or by one on leaving the way: then turns lead back to it (Tassa et al. 2012), and one
  /// stint's change does not carry all that follow away.
  void look_back(std::vector<Gain>& gains, double turning, double leaving) const {
    gains.assign(links_.size(), {});
    const auto& goal = flight_.goal().centre;
    const auto off = local_offset(goal.lat.radians(), goal.lon.radians(), end_lat_, end_lon_);
    const double far = std::max(1.0, off.length());
    Vector2d slope{off.east / far, off.north / far};
    Matrix2d curve = (Matrix2d::Identity() - slope * slope.transpose()) / far;
    for (std::size_t i = links_.size(); i-- > 0;) {
      const auto& link = links_[i];
      Matrix2d a;  // end by place
      a.row(0) = link.east.by_place.transpose();
      a.row(1) = link.north.by_place.transpose();
      const Vector2d b{link.east.by_turn, link.north.by_turn};
      const Vector2d q_x = a.transpose() * slope + link.toll.by_place;
      const double q_u = b.dot(slope) + link.toll.by_turn;
      const Matrix2d q_xx = a.transpose() * curve * a + slope[0] * link.east.by_places +
                            slope[1] * link.north.by_places + link.toll.by_places;
      const Vector2d q_xu = a.transpose() * curve * b + slope[0] * link.east.by_place_turn +
                            slope[1] * link.north.by_place_turn + link.toll.by_place_turn;
      const double q_uu =
          b.dot(curve * b) + slope[0] * link.east.by_turns + slope[1] * link.north.by_turns + link.toll.by_turns;
      const double scale = b.norm() * slope.norm();  // what straight water would give q_uu
      if (!(scale > 0)) {
        slope = q_x;
        curve = q_xx;
        continue;
      }
      const double price = leaving * kDampingUnit;
      const double firm = std::max(q_uu + price * b.squaredNorm(), 0.05 * scale) + turning * scale;
      auto& gain = gains[i];
      gain.turn = std::clamp(-q_u / firm, -kLongestTurn, kLongestTurn);
      gain.feedback = -(q_xu + price * (a.transpose() * b)) / firm;
      slope = q_x + gain.feedback * (q_uu * gain.turn + q_u) + q_xu * gain.turn;
      curve = q_xx + gain.feedback * gain.feedback.transpose() * q_uu + gain.feedback * q_xu.transpose() +
              q_xu * gain.feedback.transpose();
      limit(curve);
    }
  }
  /// A quadratic that bends more sharply than any eddy says nothing any more.
  static void limit(Matrix2d& curve) {
    constexpr double kSharpest = 1.0 / 500.0;  // per metre
    const double size = curve.norm();
    if (size > kSharpest) curve *= kSharpest / size;
  }

  /// Forwards on lanes: shares of both kinds of turns, and of the first without feedback; the last lane flies the way as it is.
  [[nodiscard]] Way step_forward() {
    static constexpr std::array<double, 6> kShares{1.0, 0.6, 0.3, 0.1, 0.03, 0.01};
    constexpr auto n = kShares.size(), kAsItIs = 3 * n;
    std::array<std::vector<double>, kAsItIs> flown;
    HeldLanes lanes;
    lanes.begin(static_cast<int>(kAsItIs) + 1, lat0_, lon0_);
    LaneValues headings{};
    for (std::size_t k = 0; k < links_.size(); ++k) {
      for (std::size_t i = 0; i < kAsItIs; ++i) {
        const auto& gain = i < 2 * n ? free_[k] : held_[k];
        const auto off = local_offset(links_[k].lat, links_[k].lon, lanes.at.lat[i], lanes.at.lon[i]);
        const double answer = i < n || i >= 2 * n ? gain.feedback.dot(Vector2d{off.east, off.north}) : 0.0;
        headings[i] = way_.headings[k] + kShares[i % n] * gain.turn + std::clamp(answer, -kLongestTurn, kLongestTurn);
        if (lanes.flies(i)) flown[i].push_back(headings[i]);
      }
      headings[kAsItIs] = way_.headings[k];
      flight_.fly(lanes, static_cast<int>(k), headings, until_s_, true);
      statistics_.cost_evaluations += kAsItIs + 1;
    }
    const double now = merit(lanes, kAsItIs);
    Way best;
    for (std::size_t i = 0; i < kAsItIs; ++i) {
      if (!lanes.flies(i) && lanes.at.lost[i] != HeldLanes::kArrived) continue;
      const double gain = now - merit(lanes, i);
      if (gain > best.gain) best = {flown[i], lanes.arrival_s[i], gain};
    }
    return best;
  }
  /// Toll, and the distance to the goal at the instant that counts; for a lane that came in before, less by what a glider in
  /// still water does in the time gained.
  [[nodiscard]] double merit(const HeldLanes& lanes, std::size_t i) const {
    if (lanes.arrival_s[i] < HeldLanes::kNever)
      return lanes.toll[i] + flight_.goal().radius.si() -
             problem_.glider.horizontal_speed.si() * std::max(0.0, until_s_ - lanes.arrival_s[i]);
    return lanes.toll[i] + flight_.to_goal(lanes.at.lat[i], lanes.at.lon[i]);
  }

  [[nodiscard]] Refined result() {
    flight_.set_buffer(Metres{0});
    Refined r;
    for (const double h : way_.headings) r.headings.emplace_back(Radians{h});
    r.arrival_s = way_.arrives() ? way_.arrival_s : std::nan("");
    r.remaining_m = remaining_;
    r.rounds = rounds_;
    statistics_.current_evaluations = flight_.evaluations();
    r.statistics = statistics_;
    r.kept_margin = kept_margin_;
    r.cut = cut_;
    return r;
  }
  [[nodiscard]] int stints() const { return static_cast<int>(way_.headings.size()); }

  const Problem& problem_;
  const Budget& budget_;
  HeldFlight flight_;
  double lat0_{}, lon0_{}, end_lat_{}, end_lon_{}, until_s_{}, remaining_{};
  Way way_;
  std::vector<Link> links_;
  std::vector<Gain> free_, held_;  ///< damped by a price on turning, and on leaving the way
  double place_step_{}, turn_step_{};
  double damping_{};
  int rounds_{};
  bool kept_margin_{};
  bool cut_{};
  Statistics statistics_;
};

}  // namespace

Refined refine(std::span<const Heading> headings, const Problem& problem, const ocean::Ocean& ocean,
               const chart::Chart& chart, Metres margin, const Budget& budget) {
  return Refinement{problem, ocean, chart, margin, budget}.run(headings);
}

std::vector<Heading> headings_of(const Plan& plan, const Problem& problem, const ocean::Ocean& ocean,
                                 const chart::Chart& chart) {
  HeldFlight flight{problem, ocean, chart, Metres{0}};
  std::vector<Heading> headings;
  HeldLanes lanes;
  lanes.begin(1, problem.start.fix.lat.radians(), problem.start.fix.lon.radians());
  for (std::size_t k = 0; k < plan.stints.size(); ++k) {
    const auto& stint = plan.stints[k];
    const double lat = stint.surface.lat.radians(), lon = stint.surface.lon.radians();
    double heading = stint.heading.from_north().si();
    HeldLanes tried;
    for (int i = 0; i < 4; ++i) {
      tried = lanes;
      LaneValues held{};
      held[0] = heading;
      flight.fly(tried, static_cast<int>(k), held, 1e18, false);
      if (stint.arrives || i == 3) break;
      const auto off = local_offset(tried.at.lat[0], tried.at.lon[0], lat, lon);
      const double way = problem.glider.horizontal_speed.si() * (stint.surface_s - stint.dive_s);
      heading +=
          std::clamp((off.east * std::cos(heading) - off.north * std::sin(heading)) / std::max(1.0, way), -0.3, 0.3);
    }
    headings.emplace_back(Radians{heading});
    lanes = tried;
  }
  return headings;
}

}  // namespace glidehelm::planning
