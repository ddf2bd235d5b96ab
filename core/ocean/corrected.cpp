#include "core/ocean/corrected.hpp"

#include <cmath>

namespace glidehelm::ocean {

bool LocalCorrection::plausible() const {
  return std::isfinite(at_s) && added.speed().si() <= kStrongest && spread.si() >= 0 && std::isfinite(spread.si()) &&
         length.si() >= 100 && length.si() <= 1e7 && time.count() >= 60 && time.count() <= 1e8;
}

CorrectedField::CorrectedField(FieldRef field, const LocalCorrection& correction)
    : field_{field},
      correction_{correction},
      metric_{LocalMetric::at(correction.at.lat.radians())},
      lat_{correction.at.lat.radians()},
      lon_{correction.at.lon.radians()} {}

double CorrectedField::weight(double lat, double lon, double t_s) const {
  const double east = std::remainder(lon - lon_, 2 * kPi) * metric_.parallel_radius,
               north = (lat - lat_) * metric_.meridian_radius;
  const double length = correction_.length.si();
  const double away = 0.5 * (east * east + north * north) / (length * length);
  return std::exp(-away - std::abs(t_s - correction_.at_s) / correction_.time.count());
}

Expected<Sample, NoCurrent> CorrectedField::sample(GeoPoint p, Depth z, double t_s) const {
  auto sample = field_.sample(p, z, t_s);
  if (!sample) return sample;
  const double w = weight(p.lat.radians(), p.lon.radians(), t_s);
  sample->current.east = sample->current.east + w * correction_.added.east;
  sample->current.north = sample->current.north + w * correction_.added.north;
  return sample;
}

void CorrectedField::advance(Lanes& lanes, double t_s, double dt) const {
  std::array<double, Lanes::kMax> east{}, north{}, before{};
  const double added_east = correction_.added.east.si(), added_north = correction_.added.north.si();
  for (int i = 0; i < lanes.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    east[k] = lanes.water_east[k];
    north[k] = lanes.water_north[k];
    before[k] = weight(lanes.lat[k], lanes.lon[k], t_s);
    lanes.water_east[k] += before[k] * added_east;
    lanes.water_north[k] += before[k] * added_north;
  }
  field_.advance(lanes, t_s, dt);
  for (int i = 0; i < lanes.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    lanes.water_east[k] = east[k];
    lanes.water_north[k] = north[k];
    if (lanes.lost[k] != 0) continue;
    const double half = 0.5 * dt * (weight(lanes.lat[k], lanes.lon[k], t_s + dt) - before[k]);
    const auto metric = LocalMetric::at(lanes.lat[k]);
    lanes.lat[k] += half * added_north / metric.meridian_radius;
    lanes.lon[k] += half * added_east / metric.parallel_radius;
  }
}

}  // namespace glidehelm::ocean
