#include "protocol/latlon.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/base/text.hpp"

namespace glidehelm::protocol {

namespace {

/// The digits of a plain decimal number; minutes are in 1e-9.
struct Digits {
  bool negative{};
  std::int64_t whole{};
  std::int64_t billionths{};
  bool huge{};  ///< the whole part has more digits than any coordinate
};

bool read_digits(std::string_view text, Digits& out) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) {
    out.negative = text.front() == '-';
    text.remove_prefix(1);
  }
  std::size_t i = 0;
  for (; i < text.size() && is_digit(text[i]); ++i) {
    if (out.whole > 999'999'999)
      out.huge = true;
    else
      out.whole = out.whole * 10 + (text[i] - '0');
  }
  if (i == 0) return false;
  if (i == text.size()) return true;
  if (text[i] != '.' || ++i == text.size()) return false;
  for (std::int64_t weight = 100'000'000; i < text.size(); ++i, weight /= 10) {
    if (!is_digit(text[i])) return false;
    out.billionths += weight * (text[i] - '0');
  }
  return true;
}

}  // namespace

std::string NoCoordinate::message() const {
  const bool latitude = axis == Axis::latitude;
  const std::string what = std::string{latitude ? "latitude '" : "longitude '"} + found + "' ";
  switch (why) {
    case Why::not_a_number:
      return what + "is not a number of the form [-]DDMM.mmm";
    case Why::sentinel:
      return what + "means that the glider never had one";
    case Why::minutes:
      return what + "has 60 minutes or more";
    case Why::range:
      break;
  }
  return what + (latitude ? "is beyond 90 degrees" : "is beyond 180 degrees");
}

Expected<double, NoCoordinate> degrees_from_ddmm(std::string_view text, Axis axis) {
  const auto refused = [&](NoCoordinate::Why why) { return unexpected(NoCoordinate{why, axis, std::string{text}}); };
  Digits digits;
  if (!read_digits(text, digits)) return refused(NoCoordinate::Why::not_a_number);
  if (digits.huge || static_cast<double>(digits.whole) >= kSentinel) return refused(NoCoordinate::Why::sentinel);

  constexpr std::int64_t kBillion = 1'000'000'000;
  const std::int64_t minutes = digits.whole % 100 * kBillion + digits.billionths;
  if (minutes >= 60 * kBillion) return refused(NoCoordinate::Why::minutes);
  const std::int64_t most = axis == Axis::latitude ? 90 : 180;
  const std::int64_t whole_degrees = digits.whole / 100;
  if (whole_degrees > most || (whole_degrees == most && minutes > 0)) return refused(NoCoordinate::Why::range);
  const double value = static_cast<double>(whole_degrees) + static_cast<double>(minutes) / (60.0 * kBillion);
  return digits.negative ? -value : value;
}

Expected<Latitude, NoCoordinate> latitude_from_ddmm(std::string_view text) {
  const auto deg = degrees_from_ddmm(text, Axis::latitude);
  if (!deg) return unexpected(deg.error());
  return Latitude::from_degrees(*deg).value();
}

Expected<Longitude, NoCoordinate> longitude_from_ddmm(std::string_view text) {
  const auto deg = degrees_from_ddmm(text, Axis::longitude);
  if (!deg) return unexpected(deg.error());
  return Longitude::from_degrees(*deg).value();
}

std::int64_t minute_units(double degrees) { return std::llround(degrees * static_cast<double>(kUnitsPerDegree)); }

std::string ddmm_from_units(std::int64_t units) {
  const std::int64_t size = std::llabs(units);
  const std::int64_t whole = size / kUnitsPerDegree * 100 + size % kUnitsPerDegree / kUnitsPerMinute;
  char text[48];
  const int n = std::snprintf(text, sizeof text, "%s%lld.%04lld", units < 0 ? "-" : "", static_cast<long long>(whole),
                              static_cast<long long>(size % kUnitsPerMinute));
  return {text, static_cast<std::size_t>(n)};
}

std::string ddmm(Latitude lat) { return ddmm_from_units(minute_units(lat.degrees())); }
std::string ddmm(Longitude lon) {
  const auto units = minute_units(lon.degrees());
  return ddmm_from_units(units == 180 * kUnitsPerDegree ? -units : units);  // one meridian, one text
}

bool is_dialog_coordinate(std::string_view text) {
  if (!text.empty() && text.front() == '-') text.remove_prefix(1);
  if (text.size() < 5 || text[text.size() - 4] != '.') return false;
  if (text.front() == '0' && text.size() > 5) return false;  // printf pads with blanks
  for (std::size_t i = 0; i < text.size(); ++i)
    if (i != text.size() - 4 && !is_digit(text[i])) return false;
  return true;
}

}  // namespace glidehelm::protocol
