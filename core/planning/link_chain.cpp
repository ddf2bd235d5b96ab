#include "core/planning/link_chain.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"

namespace glidehelm::planning {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kDampingUnit = 1e-5;  // 1/m, of curvature

/// The lanes around a way: moves of place and heading, in steps, each with its opposite after it.
struct Around {
  int east, north, turn;
};
constexpr std::array<Around, kLinkLanes> kAround{{{0, 0, 0},
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

Expansion expand(const std::array<double, kLinkLanes>& f, Steps steps) {
  const auto first = [&](std::size_t k, double h) { return (f[k] - f[k + 1]) / (2 * h); };
  const auto second = [&](std::size_t k, double h) { return (f[k] - 2 * f[0] + f[k + 1]) / (h * h); };
  const auto mixed = [&](std::size_t both, std::size_t a, std::size_t b, double h) {
    return (f[both] + f[both + 1] - f[a] - f[a + 1] - f[b] - f[b + 1] + 2 * f[0]) / (2 * h);
  };
  Expansion e;
  e.value = f[0];
  e.by_place = {first(1, steps.place), first(3, steps.place)};
  e.by_turn = first(5, steps.turn);
  const double en = mixed(7, 1, 3, steps.place * steps.place);
  e.by_places << second(1, steps.place), en, en, second(3, steps.place);
  e.by_turns = second(5, steps.turn);
  e.by_place_turn = {mixed(9, 1, 5, steps.place * steps.turn), mixed(11, 3, 5, steps.place * steps.turn)};
  return e;
}

/// A quadratic that bends more sharply than any eddy says nothing any more.
void limit(Matrix2d& curve) {
  constexpr double kSharpest = 1.0 / 500.0;  // per metre
  const double size = curve.norm();
  if (size > kSharpest) curve *= kSharpest / size;
}

}  // namespace

std::optional<MeasuredLink> measure_link(HeldFlight& flight, int k, double lat, double lon, double heading,
                                         double until_s, Steps steps) {
  HeldLanes lanes;
  lanes.begin(static_cast<int>(kLinkLanes), lat, lon);
  std::array<double, ocean::Lanes::kMax> headings{};
  const auto metric = LocalMetric::at(lat);
  for (std::size_t i = 0; i < kLinkLanes; ++i) {
    lanes.at.lat[i] += kAround[i].north * steps.place / metric.meridian_radius;
    lanes.at.lon[i] += kAround[i].east * steps.place / metric.parallel_radius;
    headings[i] = heading + kAround[i].turn * steps.turn;
  }
  flight.fly(lanes, k, headings, until_s, false);
  for (std::size_t i = 0; i < kLinkLanes; ++i)
    if (!lanes.flies(i)) return std::nullopt;  // at the edge of the field
  MeasuredLink m{{lat, lon, {}, {}, {}}, lanes.at.lat[0], lanes.at.lon[0]};
  std::array<double, kLinkLanes> east{}, north{}, toll{};
  for (std::size_t i = 0; i < kLinkLanes; ++i) {
    const auto off = local_offset(m.end_lat, m.end_lon, lanes.at.lat[i], lanes.at.lon[i]);
    east[i] = off.east;
    north[i] = off.north;
    toll[i] = lanes.toll[i];
  }
  m.link.east = expand(east, steps);
  m.link.north = expand(north, steps);
  m.link.toll = expand(toll, steps);
  return m;
}

ChainStep step_along(const std::vector<ChainLink>& links, Vector2d to_end, Damping damping) {
  ChainStep step{std::vector<Gain>(links.size()), 0};
  const double far = std::max(1.0, to_end.norm());
  Vector2d slope = to_end / far;
  Matrix2d curve = (Matrix2d::Identity() - slope * slope.transpose()) / far;
  for (std::size_t i = links.size(); i-- > 0;) {
    const auto& link = links[i];
    Matrix2d a;  // end by place
    a.row(0) = link.east.by_place.transpose();
    a.row(1) = link.north.by_place.transpose();
    const Vector2d b{link.east.by_turn, link.north.by_turn};
    const Vector2d q_x = a.transpose() * slope + link.toll.by_place;
    const double q_u = b.dot(slope) + link.toll.by_turn;
    const Matrix2d q_xx = a.transpose() * curve * a + slope[0] * link.east.by_places + slope[1] * link.north.by_places +
                          link.toll.by_places;
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
    const double price = damping.leaving * kDampingUnit;
    const double firm = std::max(q_uu + price * b.squaredNorm(), 0.05 * scale) + damping.turning * scale;
    auto& gain = step.gains[i];
    gain.turn = std::clamp(-q_u / firm, -kLongestTurn, kLongestTurn);
    gain.feedback = -(q_xu + price * (a.transpose() * b)) / firm;
    step.promises -= gain.turn * (q_u + 0.5 * q_uu * gain.turn);
    slope = q_x + gain.feedback * (q_uu * gain.turn + q_u) + q_xu * gain.turn;
    curve = q_xx + gain.feedback * gain.feedback.transpose() * q_uu + gain.feedback * q_xu.transpose() +
            q_xu * gain.feedback.transpose();
    limit(curve);
  }
  return step;
}

}  // namespace glidehelm::planning
