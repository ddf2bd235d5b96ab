#include "core/planning/optimal_course.hpp"

#include "core/vehicle/constrained_motion.hpp"

namespace glidehelm::planning {

namespace {

/// A current and its derivatives per metre of east (x) and north (y).
struct Stream {
  double u, v, u_x, u_y, v_x, v_y;
};

/// Velocity over ground and turn of the heading to the right, per second.
struct Rate {
  double east, north, turn;
};

/// Zermelo's formula in compass angles: θ = π/2 − ψ, so cos θ = sin ψ, sin θ = cos ψ and ψ̇ = −θ̇ (Eichhorn eq. 2 with 10).
Rate rate(const Stream& s, double speed, Heading psi) {
  const double east = psi.east(), north = psi.north();
  const double theta_rate = -s.u_y * east * east + (s.u_x - s.v_y) * east * north + s.v_x * north * north;
  return {speed * east + s.u, speed * north + s.v, -theta_rate};
}

class Sampler {
 public:
  Sampler(const MeanMotion& motion, double apart, std::uint64_t& evaluations)
      : motion_{motion}, half_{0.5 * apart}, evaluations_{evaluations} {}

  [[nodiscard]] Expected<Current, NoPassage> current(double lat, double lon, double t_s) {
    ++evaluations_;
    return motion_.current(lat, lon, t_s);
  }
  /// The mean of four samples around a place is its current, to the second order like their differences.
  [[nodiscard]] std::optional<Stream> stream(double lat, double lon, double t_s) {
    const auto metric = LocalMetric::at(lat);
    const double dlat = half_ / metric.meridian_radius, dlon = half_ / metric.parallel_radius;
    const auto east = current(lat, lon + dlon, t_s), west = current(lat, lon - dlon, t_s),
               north = current(lat + dlat, lon, t_s), south = current(lat - dlat, lon, t_s);
    if (!east || !west || !north || !south) return std::nullopt;
    const auto mean = [&](auto part) { return 0.25 * (part(*east) + part(*west) + part(*north) + part(*south)); };
    const auto slope = [&](const Current& a, const Current& b, auto part) { return (part(a) - part(b)) / (2 * half_); };
    const auto u = [](const Current& c) { return c.east.si(); };
    const auto v = [](const Current& c) { return c.north.si(); };
    return Stream{mean(u),
                  mean(v),
                  slope(*east, *west, u),
                  slope(*north, *south, u),
                  slope(*east, *west, v),
                  slope(*north, *south, v)};
  }

 private:
  const MeanMotion& motion_;
  double half_;
  std::uint64_t& evaluations_;
};

}  // namespace

std::optional<Course> optimal_course(const MeanMotion& motion, const WayPoint& from, const WayPoint& to,
                                     std::uint64_t& evaluations) {
  const auto edge = local_offset(from.lat, from.lon, to.lat, to.lon);
  const double lat = 0.5 * (from.lat + to.lat), lon = 0.5 * (from.lon + to.lon), t_s = 0.5 * (from.t_s + to.t_s);
  const double dt = to.t_s - from.t_s, speed = motion.speed();
  Sampler sampler{motion, 0.5 * edge.length(), evaluations};
  const auto begin = sampler.stream(lat, lon, t_s);
  if (!begin) return std::nullopt;
  const auto held = vehicle::hold_course(Course::of(edge.east, edge.north), MetresPerSecond{speed},
                                         {MetresPerSecond{begin->u}, MetresPerSecond{begin->v}});
  if (!held) return std::nullopt;

  const auto metric = LocalMetric::at(lat);
  const auto moved = [&](const Rate& r, double seconds) {
    return std::pair{lat + seconds * r.north / metric.meridian_radius, lon + seconds * r.east / metric.parallel_radius};
  };
  const auto first = rate(*begin, speed, held->heading);
  const auto [lat_half, lon_half] = moved(first, 0.5 * dt);
  const auto half = sampler.stream(lat_half, lon_half, t_s + 0.5 * dt);
  if (!half) return std::nullopt;
  const auto second = rate(*half, speed, held->heading + Radians{0.5 * dt * first.turn});
  const auto [lat_end, lon_end] = moved(second, dt);
  const auto end = sampler.current(lat_end, lon_end, t_s + dt);
  if (!end) return std::nullopt;
  const Heading psi = held->heading + Radians{dt * second.turn};
  return Course::of(speed * psi.east() + end->east.si(), speed * psi.north() + end->north.si());
}

}  // namespace glidehelm::planning
