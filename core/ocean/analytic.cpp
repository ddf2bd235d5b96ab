#include "core/ocean/analytic.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::ocean {

namespace analytic {

namespace {
double squared(double x) { return x * x; }
double sech2(double q) { return 1.0 / squared(std::cosh(q)); }
}  // namespace

Uv Constant::at(double, double, double) const { return {u, v}; }
double Constant::bound(double, double) const { return std::hypot(u, v); }

Uv Source::at(double x, double y, double) const { return {sign * x, sign * y}; }
double Source::bound(double x, double y) const { return std::hypot(x, y); }

Uv SolidBody::at(double x, double y, double) const { return {-omega * y, omega * x}; }
double SolidBody::bound(double x, double y) const { return std::abs(omega) * std::hypot(x, y); }

Uv Shear::at(double, double y, double) const { return {rate * y, 0}; }
double Shear::bound(double, double y) const { return std::abs(rate * y); }

double DoubleEddy::stream(double x, double y, double t) const {
  const double s = epsilon * std::sin(omega * t);
  return a * std::sin(kPi * (s * x * x + (1 - 2 * s) * x)) * std::sin(kPi * y);
}
Uv DoubleEddy::at(double x, double y, double t) const {
  const double s = epsilon * std::sin(omega * t);
  const double f = x * (s * x + 1 - 2 * s), f_x = 2 * s * x + 1 - 2 * s;
  return {-kPi * a * std::sin(kPi * f) * std::cos(kPi * y), kPi * a * std::cos(kPi * f) * std::sin(kPi * y) * f_x};
}
double DoubleEddy::bound(double x, double) const { return kPi * std::abs(a) * (1 + 2 * std::abs(epsilon) * (x + 1)); }

double Stuart::stream(double x, double y, double t) const {
  return -y - 0.5 * std::log(std::cosh(2 * y) - 0.25 * std::cos(2 * (x - t)));
}
Uv Stuart::at(double x, double y, double t) const {
  // Divided by cosh 2y, so that it stays finite far from the street.
  const double over_cosh = 1.0 / std::cosh(std::min(std::abs(2 * y), 700.0));
  const double a = 1 - 0.25 * std::cos(2 * (x - t)) * over_cosh;
  return {1 + std::tanh(2 * y) / a, -std::sin(2 * (x - t)) * over_cosh / (4 * a)};
}
double Stuart::bound(double, double) const { return std::hypot(1 + 4 / std::sqrt(15.0), 1.0 / 3.0); }

double Tiled::stream(double x, double y, double t) const { return -std::cos(y + (dynamic ? t : 0)) - std::cos(x); }
Uv Tiled::at(double x, double y, double t) const { return {-std::sin(y + (dynamic ? t : 0)), std::sin(x)}; }
double Tiled::bound(double, double) const { return std::sqrt(2.0); }

double Jet::stream(double x, double y, double t) const {
  const double b = b0 + epsilon * std::cos(omega * t + theta), phase = k * (x - c * t);
  const double slope = k * b * std::sin(phase);
  return 1 - std::tanh((y - b * std::cos(phase)) / std::sqrt(1 + slope * slope));
}
Uv Jet::at(double x, double y, double t) const {
  const double b = b0 + epsilon * std::cos(omega * t + theta), phase = k * (x - c * t);
  const double curve = -b * std::cos(phase), slope = k * b * std::sin(phase), bend = -k * k * curve;  // A, A_x, A_xx
  const double d = std::sqrt(1 + slope * slope), q = (y + curve) / d;
  const double common = std::abs(q) > 350 ? 0 : sech2(q) / d;
  return {common, -common * (slope - q * slope * bend / d)};
}
double Jet::bound(double, double) const { return 1 + 0.4480 * k * k * (std::abs(b0) + std::abs(epsilon)); }

namespace {
struct Slope {
  double density, x, y;  ///< N and Σ⁻¹·d
};
Slope slope_of(const Gaussians::Hill& hill, double x, double y, double t) {
  const double dx = x - hill.x - hill.vx * t, dy = y - hill.y - hill.vy * t;
  const double det = hill.sxx * hill.syy - hill.sxy * hill.sxy;
  const double gx = (hill.syy * dx - hill.sxy * dy) / det, gy = (hill.sxx * dy - hill.sxy * dx) / det;
  return {std::exp(-0.5 * (dx * gx + dy * gy)) / (2 * kPi * std::sqrt(det)), gx, gy};
}
}  // namespace

double Gaussians::stream(double x, double y, double t) const {
  double sum = 0;
  for (const auto& hill : hills) sum += hill.w * slope_of(hill, x, y, t).density;
  return sum;
}
Uv Gaussians::at(double x, double y, double t) const {
  Uv sum;
  for (const auto& hill : hills) {
    const auto slope = slope_of(hill, x, y, t);
    if (slope.density == 0) continue;  // far away: the slope may overflow while the density is gone
    sum.u += hill.w * slope.density * slope.y;
    sum.v -= hill.w * slope.density * slope.x;
  }
  return sum;
}
double Gaussians::bound(double, double) const {
  double sum = 0;
  for (const auto& hill : hills) {
    const double det = hill.sxx * hill.syy - hill.sxy * hill.sxy;
    const double half = 0.5 * (hill.sxx + hill.syy);
    const double largest = half + std::sqrt(squared(0.5 * (hill.sxx - hill.syy)) + squared(hill.sxy));
    const double smallest = det / largest;  // not half − √…, which cancels for long ellipses
    sum += std::abs(hill.w) / (2 * kPi * std::sqrt(det)) * std::exp(-0.5) / std::sqrt(smallest);
  }
  return sum;
}

}  // namespace analytic

namespace {

using analytic::Kind;

/// The named parameters of a specification, each taken once.
class Params {
 public:
  explicit Params(const AnalyticSpec& spec) : spec_{spec} {}
  double take(const char* name, double otherwise) {
    known_.emplace_back(name);
    for (const auto& [key, value] : spec_.params)
      if (key == name) return value;
    return otherwise;
  }
  [[nodiscard]] std::optional<AnalyticError> fault() const {
    for (const auto& [key, value] : spec_.params) {
      if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        std::string allowed;
        for (const auto& name : known_) allowed += (allowed.empty() ? "" : ", ") + name;
        return AnalyticError{spec_.kind + " has no parameter " + key +
                             "; allowed: " + (allowed.empty() ? "none" : allowed)};
      }
      if (!std::isfinite(value))
        return AnalyticError{"parameter " + key + " of " + spec_.kind + " is not a finite number"};
    }
    return std::nullopt;
  }

 private:
  const AnalyticSpec& spec_;
  std::vector<std::string> known_;
};

std::optional<AnalyticError> read_hills(const AnalyticSpec& spec, analytic::Gaussians& gaussians) {
  for (std::size_t i = 0; i < spec.gaussians.size(); ++i) {
    const auto& row = spec.gaussians[i];
    const auto where = "gaussians row " + std::to_string(i + 1);
    if (row.size() != 8)
      return AnalyticError{where + " has " + std::to_string(row.size()) +
                           " numbers, allowed is 8: w, x, y, sxx, sxy, syy, vx, vy"};
    for (const double value : row)
      if (!std::isfinite(value)) return AnalyticError{where + " has a number that is not finite"};
    const analytic::Gaussians::Hill hill{row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7]};
    if (!(hill.sxx > 0 && hill.syy > 0 && hill.sxx * hill.syy > hill.sxy * hill.sxy))
      return AnalyticError{where + " has a covariance that is not positive definite"};
    gaussians.hills.push_back(hill);
  }
  if (gaussians.hills.empty()) return AnalyticError{"gaussians needs at least one row in list"};
  return std::nullopt;
}

std::optional<AnalyticError> read_kind(const AnalyticSpec& spec, Kind& kind) {
  Params params{spec};
  const auto& name = spec.kind;
  if (name == "constant") {
    kind = analytic::Constant{params.take("u", 0), params.take("v", 0)};
  } else if (name == "source" || name == "sink") {
    kind = analytic::Source{name == "source" ? 1.0 : -1.0};
  } else if (name == "solid-body") {
    kind = analytic::SolidBody{params.take("omega", 1)};
  } else if (name == "shear") {
    kind = analytic::Shear{params.take("rate", 1)};
  } else if (name == "double-eddy") {
    kind = analytic::DoubleEddy{params.take("A", 0.1), params.take("epsilon", 0.25), params.take("omega", 2 * kPi)};
  } else if (name == "stuart") {
    kind = analytic::Stuart{};
  } else if (name == "tiled") {
    kind = analytic::Tiled{params.take("dynamic", 0) != 0};
  } else if (name == "jet") {
    kind = analytic::Jet{params.take("B0", 1.2),        params.take("epsilon", 0.3), params.take("omega", 0.4),
                         params.take("theta", kPi / 2), params.take("k", 0.84),      params.take("c", 0.12)};
  } else if (name == "gaussians") {
    kind = analytic::Gaussians{};
    if (auto fault = read_hills(spec, std::get<analytic::Gaussians>(kind))) return fault;
  } else {
    return AnalyticError{"unknown analytic kind " + name +
                         "; allowed: constant, source, sink, solid-body, shear, double-eddy, stuart, tiled, jet, "
                         "gaussians"};
  }
  return params.fault();
}

bool positive(double x) { return std::isfinite(x) && x > 0; }

}  // namespace

Expected<AnalyticField, AnalyticError> AnalyticField::make(const AnalyticSpec& spec, Instant start,
                                                           const Coverage& coverage) {
  AnalyticField field;
  if (auto fault = read_kind(spec, field.kind_)) return unexpected(std::move(*fault));
  const double length = spec.length_scale.si(), speed = spec.speed_scale.si();
  if (!positive(length)) return unexpected(AnalyticError{"length_scale_m must be positive"});
  if (!positive(speed)) return unexpected(AnalyticError{"speed_scale_m_per_s must be positive"});
  const double time = spec.time_scale ? spec.time_scale->count() : length / speed;
  if (!positive(time)) return unexpected(AnalyticError{"time_scale_s must be positive"});

  field.spec_ = spec;
  field.lat0_ = spec.origin.lat.radians();
  field.lon0_ = spec.origin.lon.radians();
  const auto metric = LocalMetric::at(field.lat0_);
  field.per_lat_ = metric.meridian_radius / length;
  field.per_lon_ = metric.parallel_radius / length;
  field.speed_ = spec.south ? -speed : speed;
  field.per_second_ = 1.0 / time;
  field.t0_s_ = epoch_seconds(spec.t0.value_or(start));
  return field.within(coverage);
}

AnalyticField AnalyticField::within(const Coverage& coverage) const {
  AnalyticField field = *this;
  field.coverage_ = coverage;
  const double y = std::max(std::abs(coverage.south - lat0_), std::abs(coverage.north - lat0_)) * per_lat_;
  // The farthest meridian from the origin is an edge of the box, unless the opposite meridian lies inside.
  double opposite = lon0_ + kPi;
  while (opposite < coverage.west) opposite += 2 * kPi;
  while (opposite - 2 * kPi >= coverage.west) opposite -= 2 * kPi;
  const double edges = std::max(std::abs(std::remainder(coverage.west - lon0_, 2 * kPi)),
                                std::abs(std::remainder(coverage.east - lon0_, 2 * kPi)));
  const double x = (opposite <= coverage.east ? kPi : edges) * per_lon_;
  // 1e-12 covers the rounding of the evaluation against that of the bound.
  field.fastest_ =
      std::abs(speed_) * (1 + 1e-12) * std::visit([&](const auto& kind) { return kind.bound(x, y); }, kind_);
  return field;
}

analytic::Uv AnalyticField::plane(GeoPoint p) const {
  return {std::remainder(p.lon.radians() - lon0_, 2 * kPi) * per_lon_, (p.lat.radians() - lat0_) * per_lat_};
}

Expected<Sample, NoCurrent> AnalyticField::sample(GeoPoint p, Depth, double t_s) const {
  if (!coverage_.contains(p)) return unexpected(NoCurrent::outside_area);
  if (!coverage_.holds_outside && !(t_s >= coverage_.first_s && t_s <= coverage_.last_s))
    return unexpected(NoCurrent::outside_time);
  const auto at = plane(p);
  const double t = (t_s - t0_s_) * per_second_;
  const auto uv = std::visit([&](const auto& kind) { return kind.at(at.u, at.v, t); }, kind_);
  return Sample{{MetresPerSecond{speed_ * uv.u}, MetresPerSecond{speed_ * uv.v}}, false};
}

Expected<Sample, NoCurrent> FieldSum::sample(GeoPoint p, Depth z, double t_s) const {
  double east = 0, north = 0;
  bool extrapolated = false;
  for (const auto& part : parts_) {
    const auto s = part.sample(p, z, t_s);
    if (!s) return s;
    east += s->current.east.si();
    north += s->current.north.si();
    extrapolated = extrapolated || s->extrapolated;
  }
  return Sample{{MetresPerSecond{east}, MetresPerSecond{north}}, extrapolated};
}

Coverage FieldSum::coverage() const {
  if (parts_.empty()) return {};
  Coverage all = parts_.front().coverage();
  for (std::size_t i = 1; i < parts_.size(); ++i) {
    const Coverage box = parts_[i].coverage();
    all.south = std::max(all.south, box.south);
    all.north = std::min(all.north, box.north);
    all.first_s = std::max(all.first_s, box.first_s);
    all.last_s = std::min(all.last_s, box.last_s);
    all.holds_outside = all.holds_outside && box.holds_outside;
    if (box.east - box.west >= 2 * kPi) continue;
    if (all.east - all.west >= 2 * kPi) {
      all.west = box.west;
      all.east = box.east;
      continue;
    }
    // Bring the second box into the first one's turn of the globe: the nearest of its copies by the middle.
    const double shift = 2 * kPi * std::round((0.5 * (all.west + all.east) - 0.5 * (box.west + box.east)) / (2 * kPi));
    all.west = std::max(all.west, box.west + shift);
    all.east = std::min(all.east, box.east + shift);
  }
  return all;
}

MetresPerSecond FieldSum::fastest() const {
  MetresPerSecond sum;
  for (const auto& part : parts_) sum += part.fastest();
  return sum;
}

}  // namespace glidehelm::ocean
