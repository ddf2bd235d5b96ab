#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/ocean/grid_format.hpp"
#include "daemon/ingest/component.hpp"
#include "daemon/ingest/grid_file.hpp"
#include "daemon/ingest/part.hpp"
#include "daemon/ingest/units.hpp"
#include "daemon/ingest/water_mean.hpp"

/// Temperature and salinity beside the currents: one column of them is what a glider is weighed in (docs/decisions/028).
namespace glidehelm::ingest {

/// The two variables, and what their numbers mean.
struct WaterVariables {
  Found temperature, salinity;
  /// Potential, or conservative, which is taken for potential: up to 30 °C the two (TEOS-10) differ by at most 0.11 °C at salinities of 33
  /// to 37, which is 0.04 kg/m³, and by 0.7 °C, 0.2 kg/m³, at 20.
  bool potential{};
  bool absolute{};  ///< salinity: absolute, g/kg; else practical
  std::string why;  ///< "standard_name …", "name …"
};
/// Finds them in any of the files. Temperature: standard_name sea_water_temperature, sea_water_potential_temperature or
/// sea_water_conservative_temperature, else the names temp, thetao, votemper, water_temp, temperature, theta, toce; salinity:
/// sea_water_practical_salinity, sea_water_salinity or sea_water_absolute_salinity, else salt, so, vosaline, salinity, soce, psal;
/// whatever the case. Of several the one with the most dimensions, since surface fields have fewer, then the first of these. A temperature by name is
/// potential, as models keep it, but for water_temp and temperature, when its long_name does not say so. Nothing without both.
std::optional<WaterVariables> recognise_water(const ModelFiles& files);

/// How the stored numbers become °C (salinities as they are counted: practical, or g/kg). Units by UDUNITS and what is often met besides
/// (C, deg C, Celsius; psu, PSS-78, 1, 1e-3, ppt); without a unit °C and the same numbers.
Result<Component> temperature_component(const Variable& variable, const Units& units);
Result<Component> salinity_component(const Variable& variable, const Units& units);

/// Which of so many times are read: at most eight, evenly spread, the first and the last among them. Temperature changes slowly, and a
/// forecast of two hundred times is not read twice for it.
std::vector<std::size_t> times_to_read(std::size_t times);

/// The column of a mean as it stands in a grid: temperature in situ, practical salinity. None of a single depth, whose water says nothing
/// of what lies below, or with impossible values.
ocean::GridWater water_of(const WaterMean& mean, const std::vector<double>& depths_m, const WaterVariables& variables,
                          std::size_t times_read, std::size_t times);
/// More levels than this are none of a sea: their sums would fill the memory.
inline constexpr std::size_t kWaterLevelsAtMost = 1000;
/// No column, and why.
ocean::GridWater no_water(const WaterVariables& variables, const std::string& why);

/// The water of a file on latitudes, longitudes and depths: over the nodes of the area that has been asked for, each counting
/// alike; where they are the nodes of `currents`, over those with a current. Empty without words when the file has none. Never a
/// reason to refuse the currents: what is wrong stands in the words.
ocean::GridWater read_water(const NetcdfFile& file, const Units& units, const ReadOptions& options,
                            const ocean::Grid& currents);

}  // namespace glidehelm::ingest
