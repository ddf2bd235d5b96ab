#include "simulator/glider/flight.hpp"

#include <cmath>
#include <cstdio>

namespace glidehelm::simulator {
namespace {

constexpr double kGravity = 9.81;

double density_at(const Body& b, double depth) { return b.surface_density + b.density_per_m * depth; }

}  // namespace

double wing_lift_slope(const Body& b) {
  const double tangent = std::tan(b.sweep.si());
  return 2 * kPi * b.aspect_ratio / (2 + std::sqrt(b.aspect_ratio * b.aspect_ratio * (1 + tangent * tangent) + 4));
}

double lift_slope(const Body& b) { return b.hull_lift + wing_lift_slope(b); }

double induced_drag(const Body& b) {
  const double a_w = wing_lift_slope(b);
  return b.hull_induced_drag + a_w * a_w / (kPi * b.aspect_ratio * b.span_efficiency);
}

Radians angle_of_attack(const Body& b, Radians pitch) {
  const double a = lift_slope(b), c1 = induced_drag(b), theta = pitch.si();
  const auto excess = [&](double alpha) {
    return (b.parasite_drag + c1 * alpha * alpha) * std::cos(theta + alpha) - a * alpha * std::sin(theta + alpha);
  };
  const double most = kPi / 2 - theta;
  // The first sign change, so that it is the smallest root: the others belong to stalled flight.
  constexpr int kScan = 256;
  double low = 0, high = most;
  for (int i = 1; i <= kScan; ++i) {
    const double alpha = most * i / kScan;
    if (excess(alpha) <= 0) {
      high = alpha;
      break;
    }
    low = alpha;
  }
  for (int i = 0; i < 60 && high - low > 1e-13; ++i) {
    const double mid = 0.5 * (low + high);
    (excess(mid) > 0 ? low : high) = mid;
  }
  return Radians{0.5 * (low + high)};
}

double net_buoyancy(const Body& b, bool down, Metres depth) {
  const double pressure = density_at(b, 0.5 * depth.si()) * kGravity * depth.si();
  const double volume =
      b.volume_m3 * (1 - b.compressibility_per_pa * pressure) + (down ? b.pump_dive_m3 : b.pump_climb_m3);
  const double mass = b.ballast_density * b.volume_m3;
  return kGravity * (density_at(b, depth.si()) * volume - mass);
}

std::string NoFlight::message() const {
  char text[96];
  std::snprintf(text, sizeof text, "%s at %.0f m (%+.2f N)", down ? "floats while diving" : "sinks while climbing",
                depth.si(), newtons);
  return text;
}

Expected<Flight, NoFlight> steady_flight(const Body& b, bool down, Metres depth, Radians attack) {
  const double force = net_buoyancy(b, down, depth);
  if (down ? force >= 0 : force <= 0) return unexpected(NoFlight{down, depth, force});
  const double path = (down ? b.pitch_dive : b.pitch_climb).si() + attack.si();
  const double drag = b.parasite_drag + induced_drag(b) * attack.si() * attack.si();
  const double u =
      std::sqrt(2 * std::sin(path) * std::fabs(force) / (density_at(b, depth.si()) * b.wing_area_m2 * drag));
  return Flight{attack, Radians{path}, MetresPerSecond{u}, MetresPerSecond{u * std::cos(path)},
                MetresPerSecond{u * std::sin(path)}};
}

Expected<Flight, NoFlight> steady_flight(const Body& b, bool down, Metres depth) {
  return steady_flight(b, down, depth, angle_of_attack(b, down ? b.pitch_dive : b.pitch_climb));
}

std::optional<NoFlight> cannot_reach(const Body& b, Metres to) {
  constexpr int kLooks = 64;  // the buoyancy is a smooth curve of depth, a few newtons over all of it
  for (int i = 0; i <= kLooks; ++i) {
    const Metres z{to.si() * i / kLooks};
    for (const bool down : {true, false}) {
      const double force = net_buoyancy(b, down, z);
      if (down ? force >= 0 : force <= 0) return NoFlight{down, z, force};
    }
  }
  return std::nullopt;
}

}  // namespace glidehelm::simulator
