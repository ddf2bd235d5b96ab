#include "simulator/glider/frame.hpp"

#include <cmath>

namespace glidehelm::simulator {
namespace {

/// Longitude from the central meridian of the position's own 6° zone.
double from_central_meridian(GeoPoint p) {
  const double deg = p.lon.degrees();
  const double central = std::floor((deg + 180.0) / 6.0) * 6.0 - 177.0;
  return degrees(deg - central).si();
}

}  // namespace

Radians grid_convergence(GeoPoint p) {
  return Radians{std::atan(std::tan(from_central_meridian(p)) * std::sin(p.lat.radians()))};
}

double grid_scale(GeoPoint p) {
  const double across = from_central_meridian(p) * std::cos(p.lat.radians());
  return 0.9996 * (1.0 + 0.5 * across * across);
}

LocalFrame LocalFrame::from_variation(Radians west, GeoPoint mission_start) {
  return {wrapped(grid_convergence(mission_start) - west)};
}

Radians LocalFrame::magnetic_variation(GeoPoint mission_start) const {
  return wrapped(grid_convergence(mission_start) - rotation);
}

LocalFrame::Xy LocalFrame::local(Current current) const {
  const double s = std::sin(rotation.si()), c = std::cos(rotation.si());
  return {current.east.si() * c - current.north.si() * s, current.east.si() * s + current.north.si() * c};
}

double LocalFrame::local_bearing_deg(Bearing bearing) const { return (bearing + -rotation).degrees(); }

}  // namespace glidehelm::simulator
