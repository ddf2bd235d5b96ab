#include "core/planning/extremal.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/local_metric.hpp"

namespace glidehelm::planning {

namespace {

using State = ExtremalFlow::State;

constexpr double kDifference = 200.0;  // metres to each side
constexpr int kHeadings = 72;
constexpr int kSteps = 200;  // of an extremal, for the time that still water takes
constexpr int kParts = 48;   // of collocation
constexpr int kMostIterations = 40;
constexpr double kConverged = 1e-9;  // of lengths over the way, and radians

State plus(const State& s, double dt, const State& rate) {
  return {s.lat + dt * rate.lat, s.lon + dt * rate.lon, s.psi + dt * rate.psi};
}

/// One extremal, as far as it matters.
struct Shot {
  double arrival_s{std::numeric_limits<double>::infinity()};  ///< epoch second at which the disc is entered
  double nearest_m{std::numeric_limits<double>::infinity()};
  double side{};  ///< of the centre where it is nearest: positive to the right of the way
  std::vector<WayPoint> way;
};

class Shooting {
 public:
  Shooting(const ExtremalFlow& flow, const WayPoint& from, const vehicle::Disc& goal, double until_s)
      : flow_{flow}, from_{from}, goal_{goal}, until_s_{until_s} {
    length_ = distance(GeoPoint::from_kernel(from.lat, from.lon), goal.centre).si();
    step_ = std::clamp(length_ / flow.motion().speed() / kSteps, 10.0, 3600.0);
  }

  Shot shot(double psi) const {
    Shot shot;
    State at{from_.lat, from_.lon, psi};
    double t = from_.t_s;
    shot.way = {{at.lat, at.lon, t}};
    std::size_t nearest = 1;
    const double lat = goal_.centre.lat.radians(), lon = goal_.centre.lon.radians();
    while (t < until_s_) {
      const auto next = flow_.step(at, t, step_);
      if (!next) break;
      const auto share = vehicle::entry_into(goal_, at.lat, at.lon, next->lat, next->lon);
      const auto way_on = local_offset(at.lat, at.lon, next->lat, next->lon);
      const auto to_goal = local_offset(next->lat, next->lon, lat, lon);
      const double away = vehicle::distance_near(next->lat, next->lon, goal_);
      at = *next;
      t += step_;
      shot.way.push_back({at.lat, at.lon, t});
      if (share) shot.arrival_s = std::min(shot.arrival_s, t - (1 - *share) * step_);
      if (away < shot.nearest_m) {
        shot.nearest_m = away;
        shot.side = (to_goal.east * way_on.north - to_goal.north * way_on.east) / std::max(1.0, way_on.length());
        nearest = shot.way.size();
      } else if (away > 2 * shot.nearest_m + 0.5 * length_) {
        break;
      }
    }
    shot.way.resize(nearest);
    return shot;
  }

 private:
  const ExtremalFlow& flow_;
  WayPoint from_;
  vehicle::Disc goal_;
  double until_s_, length_{}, step_{};
};

bool better(const Shot& a, const Shot& b) {
  return a.arrival_s != b.arrival_s ? a.arrival_s < b.arrival_s : a.nearest_m < b.nearest_m;
}

}  // namespace

std::optional<State> ExtremalFlow::rates(const State& s, double t_s) const {
  const double sin = std::sin(s.psi), cos = std::cos(s.psi), speed = motion_.speed();
  const auto metric = LocalMetric::at(s.lat);
  const double dlat = kDifference / metric.meridian_radius, dlon = kDifference / metric.parallel_radius;
  // Momentum of length 1 along the heading: p = (M cos ψ, P sin ψ), H = p·(dφ/dt, dλ/dt).
  const double p_lat = metric.meridian_radius * cos, p_lon = metric.parallel_radius * sin;
  double h[5], rate_lat = 0, rate_lon = 0;
  const double lats[5] = {s.lat, s.lat + dlat, s.lat - dlat, s.lat, s.lat};
  const double lons[5] = {s.lon, s.lon, s.lon, s.lon + dlon, s.lon - dlon};
  for (int k = 0; k < 5; ++k) {
    const auto c = motion_.current(lats[k], lons[k], t_s);
    ++evaluations_;
    if (!c) return std::nullopt;
    const auto m = LocalMetric::at(lats[k]);
    const double north = (c->north.si() + speed * cos) / m.meridian_radius;
    const double east = (c->east.si() + speed * sin) / m.parallel_radius;
    h[k] = p_lat * north + p_lon * east;
    if (k == 0) {
      rate_lat = north;
      rate_lon = east;
    }
  }
  const double dp_lat = -(h[1] - h[2]) / (2 * dlat), dp_lon = -(h[3] - h[4]) / (2 * dlon);
  // ψ = atan2(p_λ/P, p_φ/M), and the radii change on the way.
  const auto n = LocalMetric::at(s.lat + dlat), d = LocalMetric::at(s.lat - dlat);
  const double dm = (n.meridian_radius - d.meridian_radius) / (2 * dlat) * rate_lat;
  const double dp = (n.parallel_radius - d.parallel_radius) / (2 * dlat) * rate_lat;
  const double q_north = (dp_lat - cos * dm) / metric.meridian_radius;
  const double q_east = (dp_lon - sin * dp) / metric.parallel_radius;
  return State{rate_lat, rate_lon, cos * q_east - sin * q_north};
}

std::optional<State> ExtremalFlow::step(const State& s, double t_s, double dt) const {
  const auto a = rates(s, t_s);
  if (!a) return std::nullopt;
  const auto b = rates(plus(s, 0.5 * dt, *a), t_s + 0.5 * dt);
  if (!b) return std::nullopt;
  const auto c = rates(plus(s, 0.5 * dt, *b), t_s + 0.5 * dt);
  if (!c) return std::nullopt;
  const auto d = rates(plus(s, dt, *c), t_s + dt);
  if (!d) return std::nullopt;
  const auto mean = [](double p, double q, double r, double t) { return (p + 2 * q + 2 * r + t) / 6; };
  return plus(s, dt,
              {mean(a->lat, b->lat, c->lat, d->lat), mean(a->lon, b->lon, c->lon, d->lon),
               mean(a->psi, b->psi, c->psi, d->psi)});
}

Extremal shoot(const ExtremalFlow& flow, const WayPoint& from, const vehicle::Disc& goal, double until_s,
               const std::function<bool(std::uint64_t)>& may_go_on) {
  const Shooting shooting{flow, from, goal, until_s};
  Extremal found;
  Shot best;
  const auto stopped = [&] { return !may_go_on(found.shots); };
  const auto fire = [&](double psi) {
    ++found.shots;
    auto shot = shooting.shot(psi);
    if (better(shot, best)) best = shot;
    return shot;
  };
  const auto finish = [&](bool complete) {
    found.arrives = std::isfinite(best.arrival_s);
    found.arrival_s = best.arrival_s;
    found.way = best.way;
    found.nearest_m = best.nearest_m;
    found.complete = complete;
    found.evaluations = flow.evaluations();
    return found;
  };
  const auto line = geodesic(GeoPoint::from_kernel(from.lat, from.lon), goal.centre);
  const double bearing = line.departing.from_north().si(), length = line.length.si();
  const auto heading = [&](int i) { return bearing + 2 * kPi * i / kHeadings; };
  std::vector<Shot> shots;
  for (int i = 0; i < kHeadings; ++i) {
    if (stopped()) return finish(false);
    shots.push_back(fire(heading(i)));
  }
  for (int i = 0; i < kHeadings; ++i) {
    const Shot &a = shots[static_cast<std::size_t>(i)], &b = shots[static_cast<std::size_t>((i + 1) % kHeadings)];
    if (a.side * b.side > 0 || std::min(a.nearest_m, b.nearest_m) > 0.9 * length) continue;
    double low = heading(i), high = heading(i + 1);
    for (int k = 0; k < 30; ++k) {  // to 1e-10 rad
      if (stopped()) return finish(false);
      const double middle = 0.5 * (low + high);
      const auto shot = fire(middle);
      (shot.side * a.side > 0 ? low : high) = middle;
    }
    // The disc's edge is met first a little beside the way to its centre: golden section.
    const double ahead = 0.5 * (low + high), golden = 0.5 * (std::sqrt(5.0) - 1);
    low = ahead - kPi / kHeadings;
    high = ahead + kPi / kHeadings;
    for (int k = 0; k < 24; ++k) {
      if (stopped()) return finish(false);
      const double p = high - golden * (high - low), q = low + golden * (high - low);
      const auto at_p = fire(p), at_q = fire(q);
      const bool first = !better(at_q, at_p);
      (first ? high : low) = first ? q : p;
    }
  }
  return finish(true);
}

std::optional<Extremal> collocate(const ExtremalFlow& flow, const WayPoint& from, const vehicle::Disc& goal,
                                  double until_s) {
  // In units of the way and the time that still water takes; the unknowns are places and headings at the parts' ends, and τ.
  const auto metric = LocalMetric::at(from.lat);
  const double goal_lat = goal.centre.lat.radians();
  const double goal_lon = from.lon + std::remainder(goal.centre.lon.radians() - from.lon, 2 * kPi);
  const auto line = geodesic(GeoPoint::from_kernel(from.lat, from.lon), goal.centre);
  const double length = line.length.si(), time = length / flow.motion().speed();
  const double per_lat = length / metric.meridian_radius, per_lon = length / metric.parallel_radius;
  constexpr int kUnknowns = 3 * (kParts + 1) + 1;
  using Vector = Eigen::VectorXd;
  const auto state = [&](const Vector& y, int i) {
    return State{from.lat + per_lat * y[3 * i], from.lon + per_lon * y[3 * i + 1], y[3 * i + 2]};
  };
  const auto slope = [&](const State& s, double t) -> std::optional<Eigen::Vector3d> {
    const auto r = flow.rates(s, from.t_s + t);
    if (!r) return std::nullopt;
    return Eigen::Vector3d{time * r->lat / per_lat, time * r->lon / per_lon, time * r->psi};
  };
  // Of part i: its ends' difference less Simpson's integral of the slope.
  const auto part = [&](const Vector& y, int i) -> std::optional<Eigen::Vector3d> {
    const double tau = y[kUnknowns - 1], h = tau / kParts;
    const Eigen::Vector3d a = y.segment<3>(3 * i), b = y.segment<3>(3 * i + 3);
    const auto fa = slope(state(y, i), time * h * i), fb = slope(state(y, i + 1), time * h * (i + 1));
    if (!fa || !fb) return std::nullopt;
    const Eigen::Vector3d m = 0.5 * (a + b) + h / 8 * (*fa - *fb);
    const State middle{from.lat + per_lat * m[0], from.lon + per_lon * m[1], m[2]};
    const auto fm = slope(middle, time * h * (i + 0.5));
    if (!fm) return std::nullopt;
    return Eigen::Vector3d{b - a - h / 6 * (*fa + 4 * *fm + *fb)};
  };
  const auto ends = [&](const Vector& y) {
    const State end = state(y, kParts);
    const auto m = LocalMetric::at(0.5 * (end.lat + goal_lat));
    const double radius = goal.radius.si() / length;
    return Eigen::Vector4d{y[0], y[1], (goal_lat - end.lat) * m.meridian_radius / length - radius * std::cos(end.psi),
                           (goal_lon - end.lon) * m.parallel_radius / length - radius * std::sin(end.psi)};
  };
  const auto residual = [&](const Vector& y) -> std::optional<Vector> {
    Vector r(kUnknowns);
    for (int i = 0; i < kParts; ++i) {
      const auto p = part(y, i);
      if (!p) return std::nullopt;
      r.segment<3>(3 * i) = *p;
    }
    r.tail<4>() = ends(y);
    return r;
  };

  Vector y(kUnknowns);
  const double psi = line.departing.from_north().si();
  for (int i = 0; i <= kParts; ++i) {
    const double u = static_cast<double>(i) / kParts;
    y.segment<3>(3 * i) << u * (goal_lat - from.lat) / per_lat, u * (goal_lon - from.lon) / per_lon, psi;
  }
  y[kUnknowns - 1] = 1;
  auto r = residual(y);
  for (int iteration = 0; r && r->lpNorm<Eigen::Infinity>() > kConverged; ++iteration) {
    if (iteration == kMostIterations) return std::nullopt;
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(kUnknowns, kUnknowns);
    for (int k = 0; k < kUnknowns; ++k) {
      constexpr double kTurn = 1e-6;
      Vector z = y;
      z[k] += kTurn;
      const int node = k / 3;
      const bool all = k == kUnknowns - 1;
      for (int i = all ? 0 : std::max(0, node - 1); i <= (all ? kParts - 1 : std::min(kParts - 1, node)); ++i) {
        const auto p = part(z, i);
        if (!p) return std::nullopt;
        jacobian.block<3, 1>(3 * i, k) = (*p - r->segment<3>(3 * i)) / kTurn;
      }
      jacobian.block<4, 1>(kUnknowns - 4, k) = (ends(z) - Eigen::Vector4d{r->tail<4>()}) / kTurn;
    }
    const Vector way = jacobian.partialPivLu().solve(*r);
    if (!way.allFinite()) return std::nullopt;
    // A heading turns by at most half a radian at a time, and a step is halved until it brings the residual down.
    double share = std::min(1.0, 0.5 / std::max(1e-12, way.lpNorm<Eigen::Infinity>()));
    bool down = false;
    for (int k = 0; k < 12 && !down; ++k, share *= 0.5) {
      const Vector z = y - share * way;
      auto s = residual(z);
      down = s && z[kUnknowns - 1] > 0 && s->norm() < r->norm();
      if (!down) continue;
      y = z;
      r = std::move(s);
    }
    if (!down) return std::nullopt;
  }
  if (!r) return std::nullopt;
  Extremal found;
  for (int i = 0; i <= kParts; ++i) {
    const auto s = state(y, i);
    found.way.push_back({s.lat, s.lon, from.t_s + time * y[kUnknowns - 1] * i / kParts});
  }
  found.arrival_s = found.way.back().t_s;
  found.arrives = found.arrival_s <= until_s;
  found.nearest_m = goal.radius.si();
  found.complete = true;
  found.evaluations = flow.evaluations();
  return found;
}

}  // namespace glidehelm::planning
