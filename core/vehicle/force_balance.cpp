#include "core/vehicle/force_balance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace glidehelm::vehicle {

namespace {

constexpr double kDepthStep = 2.0;  // metres

/// Displaced volume per volume at the surface (2.31 without the pump).
double swollen(const Hull& hull, const WaterLayer& water, double pressure_pa) {
  return 1 - hull.compressibility_per_pa * pressure_pa +
         hull.expansion_per_c * (water.temperature_c - hull.reference_c);
}

double displaced(const Hull& hull, const WaterColumn& water, Metres depth) {
  return hull.volume_m3 * swollen(hull, water.at(depth), ocean::pressure_at(depth));
}

double mass_of(const Hull& hull, const WaterColumn& water) {
  if (hull.mass_kg) return *hull.mass_kg;
  return water.density(hull.neutral_at) * displaced(hull, water, hull.neutral_at);
}

std::string number(const char* form, double value) {
  char text[64];
  std::snprintf(text, sizeof text, form, value);
  return text;
}

}  // namespace

double wing_lift_slope(double aspect_ratio, Radians sweep) {
  const double tangent = std::tan(sweep.si()), a2 = aspect_ratio * aspect_ratio;
  return 2 * kPi * aspect_ratio / (2 + std::sqrt(a2 * (1 + tangent * tangent) + 4));
}

double wing_induced_drag(double lift_slope, double aspect_ratio, double span_efficiency) {
  return lift_slope * lift_slope / (kPi * aspect_ratio * span_efficiency);
}

std::optional<Radians> angle_of_attack(const Hull& hull, Radians pitch) {
  // f(α) = a·α·tan(θ + α) − C_D0 − C_D1·α² is negative at 0. Its first root is the flight; whether there is one before the path is
  // vertical is seen on a scan, which also brackets it for the bisection.
  const auto f = [&](double alpha) {
    return hull.lift_per_rad * alpha * std::tan(pitch.si() + alpha) - hull.drag -
           hull.induced_drag_per_rad2 * alpha * alpha;
  };
  const double largest = std::min(kPi / 2 - pitch.si(), kLargestAttack.si());
  if (!(largest > 0)) return std::nullopt;
  constexpr int kScan = 400;
  double low = 0;
  for (int k = 1; k <= kScan; ++k) {
    double high = largest * k / kScan;
    if (k == kScan) high = std::nextafter(high, 0.0);
    if (f(high) < 0) {
      low = high;
      continue;
    }
    while (high - low > 1e-13) {
      const double middle = 0.5 * (low + high);
      (f(middle) < 0 ? low : high) = middle;
    }
    return Radians{0.5 * (low + high)};
  }
  return std::nullopt;
}

Radians pitch_of(const Hull& hull, Radians angle_of_attack) {
  const double alpha = angle_of_attack.si();
  const double drag = hull.drag + hull.induced_drag_per_rad2 * alpha * alpha;
  return Radians{std::atan2(drag, alpha * hull.lift_per_rad) - alpha};
}

double net_buoyancy(const Hull& hull, const WaterColumn& water, Metres depth, double pumped_m3) {
  return kGravity * (water.density(depth) * (displaced(hull, water, depth) + pumped_m3) - mass_of(hull, water));
}

double neutral_volume(const Hull& hull, const WaterColumn& water, Metres depth) {
  return mass_of(hull, water) / water.density(depth) - displaced(hull, water, depth);
}

std::optional<Glide> steady_glide(const Hull& hull, Radians pitch, double net_buoyancy_n, double density) {
  const auto attack = angle_of_attack(hull, pitch);
  if (!attack) return std::nullopt;
  const double alpha = attack->si(), gamma = pitch.si() + alpha;
  const double drag = hull.drag + hull.induced_drag_per_rad2 * alpha * alpha;
  const double u = std::sqrt(2 * std::sin(gamma) * std::abs(net_buoyancy_n) / (density * hull.area_m2 * drag));
  return Glide{MetresPerSecond{u}, MetresPerSecond{u * std::cos(gamma)},
               MetresPerSecond{std::copysign(u * std::sin(gamma), net_buoyancy_n)}, Radians{gamma}, *attack};
}

MetresPerSecond float_speed(const Hull& hull, double net_buoyancy_n, double density) {
  const double speed = std::sqrt(2 * std::abs(net_buoyancy_n) / (density * hull.area_m2 * hull.drag));
  return MetresPerSecond{std::copysign(speed, net_buoyancy_n)};
}

Expected<YoMeans, std::string> yo_means(const Hull& hull, const Trim& trim, const WaterColumn& water, Metres upper,
                                        Metres lower) {
  const double height = (lower - upper).si();
  const int steps = std::max(1, static_cast<int>(std::ceil(height / kDepthStep)));
  const double dz = height / steps;
  double way = 0, down = 0, up = 0;
  for (int k = 0; k < steps; ++k) {
    const Metres z{upper.si() + (k + 0.5) * dz};
    for (const bool sinking : {true, false}) {
      const double net = net_buoyancy(hull, water, z, sinking ? trim.pumped_down_m3 : trim.pumped_up_m3);
      if (sinking ? net >= 0 : net <= 0)
        return unexpected(std::string{"the glider does not "} + (sinking ? "sink" : "climb") + " at " +
                          number("%.0f", z.si()) + " m: it is " + number("%.0f", std::abs(net) / kGravity * 1000) +
                          " g too " + (sinking ? "light" : "heavy"));
      const auto glide = steady_glide(hull, sinking ? trim.pitch_down : trim.pitch_up, net, water.density(z));
      if (!glide)
        return unexpected("a pitch of " + number("%.1f", in_degrees(sinking ? trim.pitch_down : trim.pitch_up)) +
                          " degrees is too flat for the wings to carry the glider forward");
      const double time = dz / std::abs(glide->vertical.si());
      way += glide->horizontal.si() * time;
      (sinking ? down : up) += time;
    }
  }
  return YoMeans{MetresPerSecond{way / (down + up)}, Radians{std::atan2(2 * height, way)}, Seconds{down}, Seconds{up}};
}

std::vector<std::vector<PolarPoint>> glide_polar(const Hull& hull, const WaterColumn& water, Metres depth,
                                                 const std::vector<double>& pumped_m3) {
  std::vector<std::vector<PolarPoint>> curves;
  const double density = water.density(depth);
  for (const double pumped : pumped_m3) {
    auto& curve = curves.emplace_back();
    const double net = net_buoyancy(hull, water, depth, pumped);
    for (int pitch = 1; pitch < 90; ++pitch)
      if (const auto glide = steady_glide(hull, degrees(pitch), net, density))
        curve.push_back({pumped, degrees(pitch), glide->angle_of_attack, glide->horizontal, glide->vertical});
  }
  return curves;
}

}  // namespace glidehelm::vehicle
