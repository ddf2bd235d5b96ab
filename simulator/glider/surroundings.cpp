#include "simulator/glider/surroundings.hpp"

#include <cmath>

#include "core/base/local_metric.hpp"

namespace glidehelm::simulator {

GpsFaults Gps::next_surfacing() {
  ++surfacings_;
  faults_.stale = strikes(setup_.stale, surfacings_, luck_);
  faults_.invalid = strikes(setup_.invalid, surfacings_, luck_);
  faults_.far = strikes(setup_.far, surfacings_, luck_);
  far_toward_ = Bearing{Radians{2 * kPi * luck_.uniform()}};
  return faults_;
}

GeoPoint Gps::fix(GeoPoint truth) {
  if (faults_.far) truth = destination(truth, far_toward_, setup_.far_off);
  if (setup_.noise.si() == 0) return truth;
  const auto metric = LocalMetric::at(truth.lat.radians());
  const double north = setup_.noise.si() * noise_.normal(), east = setup_.noise.si() * noise_.normal();
  return GeoPoint::from_kernel(truth.lat.radians() + north / metric.meridian_radius,
                               truth.lon.radians() + east / metric.parallel_radius);
}

Current Wind::leeway(double t_s) {
  if (setup_.gusts.si() > 0) {
    const double kept = last_s_ ? std::exp(-(t_s - *last_s_) / setup_.lasting_s) : 0.0;
    const double fresh = setup_.gusts.si() * std::sqrt(1 - kept * kept);
    east_ = kept * east_ + fresh * random_.normal();
    north_ = kept * north_ + fresh * random_.normal();
    last_s_ = t_s;
  }
  return {MetresPerSecond{setup_.leeway * (east_ - setup_.speed.si() * setup_.from.east())},
          MetresPerSecond{setup_.leeway * (north_ - setup_.speed.si() * setup_.from.north())}};
}

}  // namespace glidehelm::simulator
