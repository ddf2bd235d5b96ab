#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/expected.hpp"
#include "core/base/geo.hpp"

/// Slocum text to types and back, from bytes to bytes. Not here: sockets, files, clocks, planning.
namespace glidehelm::protocol {

/// Coordinates are written as sign · (100·degrees + minutes); four decimals of a minute are 0.19 m of latitude. All
/// writing goes through whole units of 1e-4 minute, so that 59.99996′ carries into the next degree and the sign
/// survives at 0 degrees (slocum.md 2.5).
inline constexpr std::int64_t kUnitsPerMinute = 10'000;
inline constexpr std::int64_t kUnitsPerDegree = 60 * kUnitsPerMinute;

/// From this size on a number is no coordinate: 69696969 means "never set" (slocum.md 1.2).
inline constexpr double kSentinel = 9e6;

enum class Axis { latitude, longitude };

/// A text that is not a coordinate, with what was found.
struct NoCoordinate {
  enum class Why {
    not_a_number,  ///< not [+-]digits[.digits]
    sentinel,      ///< ≥ 9e6: the glider has never had this value
    minutes,       ///< 60 minutes or more
    range,         ///< |latitude| > 90° or |longitude| > 180°
  } why{};
  Axis axis{};
  std::string found;
  [[nodiscard]] std::string message() const;
  friend bool operator==(const NoCoordinate&, const NoCoordinate&) = default;
};

/// `[+-]DDMM.mmmm` as signed degrees: any number of digits before the point (`801` is 8°01′, `054.00` 0°54′, `228.117`
/// 2°28.117′) and after it; the first nine decimals of a minute count. Exact in integers up to the final division.
Expected<double, NoCoordinate> degrees_from_ddmm(std::string_view text, Axis axis);
Expected<Latitude, NoCoordinate> latitude_from_ddmm(std::string_view text);
Expected<Longitude, NoCoordinate> longitude_from_ddmm(std::string_view text);

/// Nearest whole number of 1e-4 minutes; halves away from zero. Precondition: finite, |degrees| ≤ 360.
std::int64_t minute_units(double degrees);

/// `%.4f` of sign · (100·degrees + minutes): `-11741.8000`, `-30.5000` for 0°30.5′ S. Zero has no sign.
std::string ddmm(Latitude lat);
/// As above; the antimeridian is written `-18000.0000`, also when rounding reaches it from the east.
std::string ddmm(Longitude lon);
/// The text of a number of 1e-4 minutes.
std::string ddmm_from_units(std::int64_t units);

/// The dialog's `%9.3f`: exactly three decimals, no '+', no exponent, no leading zero. Says nothing about range.
bool is_dialog_coordinate(std::string_view text);

}  // namespace glidehelm::protocol
