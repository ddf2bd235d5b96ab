#include "core/mission/learning.hpp"

#include <cmath>

namespace glidehelm::mission {

namespace {
constexpr double kFastestBelieved = 2.8;  // u_max_water_speed: the firmware clips here
}

Radians utm_convergence(GeoPoint p) {
  const double zone = std::floor((p.lon.degrees() + 180.0) / 6.0);
  const double central = degrees(zone * 6.0 - 180.0 + 3.0).si();
  return Radians{std::atan(std::tan(p.lon.radians() - central) * std::sin(p.lat.radians()))};
}

FrameRotation frame_rotation(std::optional<Radians> configured, std::optional<Radians> magnetic_variation,
                             GeoPoint origin) {
  if (configured) return {*configured, FrameRotation::From::configured};
  if (magnetic_variation && std::isfinite(magnetic_variation->si()))
    return {utm_convergence(origin) - *magnetic_variation, FrameRotation::From::magnetic_variation};
  return {Radians{0.0}, FrameRotation::From::assumed_zero};
}

Current true_current(model::LocalVelocity local, Radians rotation) {
  const double c = std::cos(rotation.si()), s = std::sin(rotation.si());
  return {MetresPerSecond{local.x.si() * c + local.y.si() * s}, MetresPerSecond{-local.x.si() * s + local.y.si() * c}};
}

model::LocalVelocity local_velocity(Current current, Radians rotation) {
  const double c = std::cos(rotation.si()), s = std::sin(rotation.si());
  return {MetresPerSecond{current.east.si() * c - current.north.si() * s},
          MetresPerSecond{current.east.si() * s + current.north.si() * c}};
}

std::optional<Current> believed_current(const model::Surfacing& surfacing, Radians rotation) {
  if (!surfacing.water) return std::nullopt;
  const double speed = std::hypot(surfacing.water->x.si(), surfacing.water->y.si());
  if (!(speed <= kFastestBelieved)) return std::nullopt;
  return true_current(*surfacing.water, rotation);
}

}  // namespace glidehelm::mission
