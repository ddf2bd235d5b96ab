#pragma once

#include "core/chart/chart.hpp"
#include "core/ocean/field.hpp"

namespace glidehelm::test {

/// A current by formula, for tests: no edges in space or time unless `limits` says so.
struct FormulaField {
  Current (*formula)(double lat_deg, double lon_deg, double depth_m, double t_s){};
  ocean::Coverage limits{};
  MetresPerSecond limit_speed{3.0};
  Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth z, double t_s) const {
    if (!limits.contains(p)) return unexpected(ocean::NoCurrent::outside_area);
    if (t_s < limits.first_s || t_s > limits.last_s) return unexpected(ocean::NoCurrent::outside_time);
    return ocean::Sample{formula(p.lat.degrees(), p.lon.degrees(), z.below_surface.si(), t_s), false};
  }
  ocean::Coverage coverage() const { return limits; }
  MetresPerSecond fastest() const { return limit_speed; }
};

inline const chart::Chart kOpen;  ///< no land, no keep-out areas
inline const GeoPoint kHome = geo_point(40.0, 5.0);

inline Current water(double east, double north) { return {MetresPerSecond{east}, MetresPerSecond{north}}; }
inline const FormulaField kStill{[](double, double, double, double) { return water(0, 0); }};
inline const FormulaField kUniform{[](double, double, double, double) { return water(0.12, -0.10); }};

}  // namespace glidehelm::test
