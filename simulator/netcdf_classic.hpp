#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/ocean/field.hpp"

namespace glidehelm::simulator {

/// The grid on which a forecast file samples a field.
struct ForecastGrid {
  double west_deg{}, east_deg{}, south_deg{}, north_deg{};
  double step_deg{0.05};
  std::vector<double> times_s;   ///< epoch seconds
  std::vector<double> depths_m;  ///< empty: a file without depths, sampled at the surface
  friend bool operator==(const ForecastGrid&, const ForecastGrid&) = default;
};

/// A forecast as the bytes of a NetCDF file (classic format with 64-bit offsets, version 2), after the CF conventions: float
/// variables water_u and water_v over (time, [depth,] lat, lon) with standard names, units and _FillValue, coordinates with
/// units, and `forecast_reference_time` for the cycle. Written from the published grammar of the format, without a library:
/// the programs of this room link none. Nodes where the field has no value hold the fill value. Same arguments, same bytes.
std::string forecast_file(const ocean::FieldRef& field, const ForecastGrid& grid, double reference_s);

}  // namespace glidehelm::simulator
