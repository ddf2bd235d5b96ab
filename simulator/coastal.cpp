#include "simulator/coastal.hpp"

#include <cmath>

#include "simulator/random.hpp"

namespace glidehelm::simulator {
namespace {

constexpr double kM2Period = 12.4206012 * 3600.0;
constexpr double kTideRadian = 120e3;  // metres along the way to a radian of phase

// Streams of the generator: what one part draws never moves another part.
enum Purpose : std::uint64_t { kJets = 1, kEddies, kTide, kTruthJets, kTruthEddies, kNoise };

double sign_of(double u) { return u < 0.5 ? -1.0 : 1.0; }

}  // namespace

CoastalField::CoastalField(const CoastalSpec& spec, Variant variant)
    : lat0_{degrees(0.5 * (spec.south_deg + spec.north_deg)).si()},
      lon0_{degrees(0.5 * (spec.west_deg + spec.east_deg)).si()},
      start_s_{spec.start_s},
      metric_{LocalMetric::at(lat0_)} {
  coverage_.south = degrees(spec.south_deg).si();
  coverage_.north = degrees(spec.north_deg).si();
  coverage_.west = degrees(spec.west_deg).si();
  coverage_.east = degrees(spec.east_deg).si();
  width_m_ = (coverage_.east - coverage_.west) * metric_.parallel_radius;
  height_m_ = (coverage_.north - coverage_.south) * metric_.meridian_radius;
  fading_m_ = spec.fading_m;
  const auto from = plane(spec.from), to = plane(spec.to);
  const double length = std::hypot(to.east - from.east, to.north - from.north);
  from_x_ = from.east;
  from_y_ = from.north;
  if (length > 0) {
    way_x_ = (to.east - from.east) / length;
    way_y_ = (to.north - from.north) / length;
  }
  draw_jets(spec, variant);
  draw_eddies(spec, variant);
  Random tide = Random{spec.seed}.stream(kTide);
  tide_phase_ = tide.uniform(0, 2 * kPi) + (variant == Variant::truth ? degrees(spec.tide_lag_deg).si() : 0.0);
  tide_major_ = spec.tide;
  tide_minor_ = spec.tide * spec.tide_ratio * sign_of(tide.uniform());
  double fastest = std::hypot(tide_major_, tide_minor_);
  for (const auto& jet : jets_) fastest += std::fabs(jet.speed);
  for (const auto& e : eddies_) fastest += std::fabs(e.strength) / e.sigma * std::exp(-0.5);
  fastest_ = MetresPerSecond{fastest};
}

void CoastalField::draw_jets(const CoastalSpec& spec, Variant variant) {
  Random random = Random{spec.seed}.stream(kJets), change = Random{spec.seed}.stream(kTruthJets);
  const double side = sign_of(random.uniform());
  jets_ = {{0.0, spec.jet_width_km * 1e3, -spec.jet},
           {side * spec.jet_offset_km * 1e3, spec.jet_width_km * 1e3, spec.counter_jet}};
  if (variant == Variant::forecast) return;
  for (auto& jet : jets_) {
    jet.speed *= 1.0 + spec.jet_change * change.uniform(-1, 1);
    jet.centre += spec.jet_change * change.uniform(-1, 1) * jet.width;
  }
}

void CoastalField::draw_eddies(const CoastalSpec& spec, Variant variant) {
  const double area_deg2 = (spec.east_deg - spec.west_deg) * (spec.north_deg - spec.south_deg);
  const int count = static_cast<int>(std::lround(spec.eddies * area_deg2 / 6.25));
  Random random = Random{spec.seed}.stream(kEddies), shift = Random{spec.seed}.stream(kTruthEddies);
  const auto add = [&](Random& r, double min_km, double max_km, double speed, double drift) {
    const double sigma = 0.5e3 * r.uniform(min_km, max_km);
    const double x = r.uniform(-0.5, 0.5) * width_m_, y = r.uniform(-0.5, 0.5) * height_m_;
    const double fastest = speed * r.uniform(0.5, 1.0) * sign_of(r.uniform());
    eddies_.push_back({x, y, sigma, fastest * sigma * std::exp(0.5), -drift});
  };
  for (int i = 0; i < count; ++i) add(random, spec.eddy_min_km, spec.eddy_max_km, spec.eddy, spec.eddy_drift);
  if (variant == Variant::forecast) return;
  for (auto& e : eddies_) {
    const double direction = shift.uniform(0, 2 * kPi);
    e.x += 1e3 * spec.shift_km * std::sin(direction);
    e.y += 1e3 * spec.shift_km * std::cos(direction);
  }
  if (spec.noise <= 0) return;
  Random noise = Random{spec.seed}.stream(kNoise);
  const int small = static_cast<int>(std::lround(24 * area_deg2 / 6.25));
  for (int i = 0; i < small; ++i) add(noise, 6, 12, spec.noise, spec.eddy_drift);
}

Offset CoastalField::plane(GeoPoint p) const {
  double dlon = p.lon.radians() - lon0_;
  if (dlon > kPi || dlon < -kPi) dlon = std::remainder(dlon, 2 * kPi);
  return {dlon * metric_.parallel_radius, (p.lat.radians() - lat0_) * metric_.meridian_radius};
}

double CoastalField::stream_function(double x, double y, double t_s) const {
  double psi = 0;
  for (const auto& e : eddies_) {
    const double dx = x - e.x - e.drift_x * (t_s - start_s_), dy = y - e.y;
    psi += e.strength * std::exp(-(dx * dx + dy * dy) / (2 * e.sigma * e.sigma));
  }
  // d grows to the left of the way (n = (−w_y, w_x)), and a flow s(d) along w has Ψ'(d) = −s(d): with u = −∂ψ/∂y,
  // v = ∂ψ/∂x this gives (u, v) = s·(w_x, w_y). The primitive of exp(−d²/w²) is √π/2·w·erf(d/w).
  const double d = -(x - from_x_) * way_y_ + (y - from_y_) * way_x_;
  for (const auto& jet : jets_)
    psi -= jet.speed * jet.width * 0.5 * std::sqrt(kPi) * std::erf((d - jet.centre) / jet.width);
  return psi;
}

Offset CoastalField::flow(double x, double y, double t_s) const {
  double u = 0, v = 0;
  for (const auto& e : eddies_) {
    const double dx = x - e.x - e.drift_x * (t_s - start_s_), dy = y - e.y;
    const double s2 = e.sigma * e.sigma, r2 = dx * dx + dy * dy;
    if (r2 > 50 * s2) continue;  // e^-25 of the strength
    const double g = e.strength * std::exp(-r2 / (2 * s2)) / s2;
    u += g * dy;
    v -= g * dx;
  }
  const double d = -(x - from_x_) * way_y_ + (y - from_y_) * way_x_;
  for (const auto& jet : jets_) {
    const double q = (d - jet.centre) / jet.width;
    const double s = jet.speed * std::exp(-q * q);
    u += s * way_x_;
    v += s * way_y_;
  }
  return {u, v};
}

Expected<ocean::Sample, ocean::NoCurrent> CoastalField::sample(GeoPoint p, Depth z, double t_s) const {
  if (!coverage_.contains(p)) return unexpected(ocean::NoCurrent::outside_area);
  const auto at = plane(p);
  auto c = flow(at.east, at.north, t_s);
  if (fading_m_ > 0) {
    const double share = std::exp(-z.below_surface.si() / fading_m_);
    c.east *= share;
    c.north *= share;
  }
  const double along = (at.east - from_x_) * way_x_ + (at.north - from_y_) * way_y_;
  const double phase = 2 * kPi * (t_s - start_s_) / kM2Period + tide_phase_ - along / kTideRadian;
  const double major = tide_major_ * std::cos(phase), minor = tide_minor_ * std::sin(phase);
  c.east += major * way_x_ - minor * way_y_;
  c.north += major * way_y_ + minor * way_x_;
  return ocean::Sample{{MetresPerSecond{c.east}, MetresPerSecond{c.north}}, false};
}

}  // namespace glidehelm::simulator
