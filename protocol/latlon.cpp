#include "protocol/latlon.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/base/text.hpp"

namespace glidehelm::protocol {

namespace {
constexpr double kSentinel = 9e6;  // 69696969 is what firmware prints for "never set"
}

Expected<double, BadCoordinate> degrees_from_ddmm(std::string_view text, Axis axis) {
  const char* name = axis == Axis::latitude ? "latitude" : "longitude";
  const auto bad = [&](BadCoordinate::Why why, const std::string& what) {
    return unexpected(
        BadCoordinate{why, std::string{text}, std::string{name} + " " + std::string{text.substr(0, 40)} + ": " + what});
  };
  const auto value = number_from(text);
  if (!value) return bad(BadCoordinate::Why::not_a_number, "not a number of the form DDMM.mmmm");
  const double size = std::abs(*value);
  if (size >= kSentinel) return bad(BadCoordinate::Why::sentinel, "never set (a sentinel, not a position)");
  const double whole = std::floor(size / 100.0);
  const double minutes = size - 100.0 * whole;
  if (minutes >= 60.0)
    return bad(BadCoordinate::Why::minutes, "its minutes are 60 or more; allowed is DDMM.mmmm with minutes below 60");
  const double degrees = whole + minutes / 60.0;
  const double limit = axis == Axis::latitude ? 90.0 : 180.0;
  if (degrees > limit)
    return bad(BadCoordinate::Why::range, axis == Axis::latitude ? "beyond 90 degrees" : "beyond 180 degrees");
  return std::signbit(*value) ? -degrees : degrees;
}

Expected<GeoPoint, BadCoordinate> point_from_ddmm(std::string_view lat, std::string_view lon) {
  const auto lat_deg = degrees_from_ddmm(lat, Axis::latitude);
  if (!lat_deg) return unexpected(lat_deg.error());
  const auto lon_deg = degrees_from_ddmm(lon, Axis::longitude);
  if (!lon_deg) return unexpected(lon_deg.error());
  const auto point = GeoPoint::from_degrees(*lat_deg, *lon_deg);
  if (!point) return unexpected(BadCoordinate{BadCoordinate::Why::range, std::string{lat}, point.error().message()});
  return *point;
}

std::int64_t ten_thousandths_of_minute(double degrees) { return std::llround(degrees * 600'000.0); }

std::string ddmm_text(double degrees) {
  const auto units = ten_thousandths_of_minute(degrees);
  const auto size = std::llabs(units);
  const auto whole = size / 600'000, minutes = size % 600'000;
  char text[48];
  std::snprintf(text, sizeof text, "%s%02lld%02lld.%04lld", units < 0 ? "-" : "", whole, minutes / 10'000,
                minutes % 10'000);
  return text;
}

}  // namespace glidehelm::protocol
