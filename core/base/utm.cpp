#include "core/base/utm.hpp"

#include <GeographicLib/TransverseMercator.hpp>
#include <cmath>
#include <string>

#include "core/base/text.hpp"

namespace glidehelm {

std::optional<UtmZone> utm_zone_from(std::string_view text) {
  const std::string word = lower(trimmed(text));
  UtmZone zone;
  std::string_view digits;
  if (word.rfind("epsg:326", 0) == 0 || word.rfind("epsg:327", 0) == 0) {
    zone.north = word[7] == '6';
    digits = std::string_view{word}.substr(8);
    if (digits.size() != 2) return std::nullopt;
  } else if (word.rfind("utm", 0) == 0 && word.size() > 4 && (word.back() == 'n' || word.back() == 's')) {
    zone.north = word.back() == 'n';
    digits = std::string_view{word}.substr(3, word.size() - 4);
  }
  if (digits.empty() || digits.size() > 2) return std::nullopt;
  for (const char c : digits) {
    if (c < '0' || c > '9') return std::nullopt;
    zone.number = 10 * zone.number + (c - '0');
  }
  if (zone.number < 1 || zone.number > 60) return std::nullopt;
  return zone;
}

std::optional<GeoPoint> from_utm(const UtmZone& zone, double easting, double northing) {
  const double x = easting - 500'000.0, y = northing - (zone.north ? 0.0 : 10'000'000.0);
  if (!(std::abs(x) < 3.9e6 && std::abs(y) < 1.0e7)) return std::nullopt;
  double lat = 0, lon = 0;
  GeographicLib::TransverseMercator::UTM().Reverse(6.0 * zone.number - 183.0, x, y, lat, lon);
  auto point = GeoPoint::from_degrees(lat, lon);
  if (!point) return std::nullopt;
  return *point;
}

}  // namespace glidehelm
