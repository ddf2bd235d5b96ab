#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/ocean/field.hpp"

namespace glidehelm::simulator {

/// What a NetCDF file says of a variable, or of itself: a text, or one float.
struct ClassicAttribute {
  std::string name, text;
  std::optional<float> number{};  ///< instead of the text
};

/// A variable of a NetCDF file; `data` holds its values as the file does, appended with put_floats and put_doubles.
struct ClassicVariable {
  enum class Type : std::uint32_t { float32 = 5, float64 = 6 };
  std::string name;
  std::vector<std::uint32_t> dimensions;  ///< indices into the file's list
  std::vector<ClassicAttribute> attributes;
  Type type{Type::float64};
  std::string data;
};

/// Appends a value as the file has it (big-endian, all bits kept).
void put_float(std::string& out, float value);
void put_double(std::string& out, double value);

/// The bytes of a NetCDF file in classic format with 64-bit offsets (version 2), written from the published grammar of the
/// format, without a library: the programs that write link none. Precondition: each variable has as many values as its
/// dimensions say, and fewer than 4 GiB of them. Same arguments, same bytes.
std::string classic_file(const std::vector<std::pair<std::string, std::size_t>>& dimensions,
                         const std::vector<ClassicAttribute>& global, const std::vector<ClassicVariable>& variables);

/// The grid on which a forecast file samples a field.
struct ForecastGrid {
  double west_deg{}, east_deg{}, south_deg{}, north_deg{};
  double step_deg{0.05};
  std::vector<double> times_s;   ///< epoch seconds
  std::vector<double> depths_m;  ///< empty: a file without depths, sampled at the surface
  friend bool operator==(const ForecastGrid&, const ForecastGrid&) = default;
};

/// A forecast as the bytes of a NetCDF file (`classic_file`), after the CF conventions: float variables water_u and water_v
/// over (time, [depth,] lat, lon) with standard names, units and _FillValue, coordinates with units, and
/// `forecast_reference_time` for the cycle. Nodes where the field has no value hold the fill value. Same arguments, same
/// bytes.
std::string forecast_file(const ocean::FieldRef& field, const ForecastGrid& grid, double reference_s);

}  // namespace glidehelm::simulator
