#include "simulator/glider/seabed.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/local_metric.hpp"

namespace glidehelm::simulator {

std::optional<Metres> Seabed::depth(GeoPoint at, double t_s, Metres look_down) const {
  if (spec_.kind == SeabedSpec::Kind::none) return std::nullopt;
  if (spec_.kind == SeabedSpec::Kind::plane) {
    const auto from_origin =
        local_offset(spec_.origin.lat.radians(), spec_.origin.lon.radians(), at.lat.radians(), at.lon.radians());
    const double along = from_origin.east * spec_.deepens.east() + from_origin.north * spec_.deepens.north();
    const double r = std::hypot(from_origin.east, from_origin.north) / spec_.hump_radius.si();
    const double z = spec_.depth.si() + spec_.slope * along - spec_.hump_height.si() * std::exp(-0.5 * r * r);
    if (z > look_down.si()) return std::nullopt;
    return Metres{std::max(0.0, z)};
  }
  const auto is_floor = [&](double z) {
    const auto sample = truth_.sample(at, Depth{Metres{z}}, t_s);
    return !sample && sample.error() == ocean::NoCurrent::below_bottom;
  };
  double low = 0, high = look_down.si();
  if (!is_floor(high)) return std::nullopt;
  while (high - low > 0.1) {
    const double mid = 0.5 * (low + high);
    (is_floor(mid) ? high : low) = mid;
  }
  return Metres{high};
}

}  // namespace glidehelm::simulator
