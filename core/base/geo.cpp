#include "core/base/geo.hpp"

#include <GeographicLib/Geodesic.hpp>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace glidehelm {

std::string OutOfRange::message() const {
  char text[160];
  const bool is_latitude = what == "latitude";
  std::snprintf(text, sizeof text, "%s %.6g is out of range: allowed is %s degrees", what.c_str(), found_deg,
                is_latitude ? "-90 to 90" : "-180 to 360");
  return text;
}

Expected<Latitude, OutOfRange> Latitude::from_degrees(double deg) {
  if (!(deg >= -90.0 && deg <= 90.0)) return unexpected(OutOfRange{"latitude", deg});
  return Latitude{glidehelm::degrees(deg).si()};
}

Latitude Latitude::from_kernel(double radians) {
  return Latitude{radians > kPi / 2 ? kPi / 2 : radians < -kPi / 2 ? -kPi / 2 : radians};
}

Expected<Longitude, OutOfRange> Longitude::from_degrees(double deg) {
  if (!(deg >= -360.0 && deg <= 360.0)) return unexpected(OutOfRange{"longitude", deg});
  return from_kernel(glidehelm::degrees(deg).si());
}

Longitude Longitude::from_kernel(double radians) {
  if (radians >= -kPi && radians < kPi) return Longitude{radians};
  double folded = std::remainder(radians, 2 * kPi);
  if (folded >= kPi) folded -= 2 * kPi;
  if (folded < -kPi) folded += 2 * kPi;
  return Longitude{folded};
}

Expected<GeoPoint, OutOfRange> GeoPoint::from_degrees(double lat_deg, double lon_deg) {
  const auto lat = Latitude::from_degrees(lat_deg);
  if (!lat) return unexpected(lat.error());
  const auto lon = Longitude::from_degrees(lon_deg);
  if (!lon) return unexpected(lon.error());
  return GeoPoint{*lat, *lon};
}

GeoPoint GeoPoint::from_kernel(double lat_rad, double lon_rad) {
  return {Latitude::from_kernel(lat_rad), Longitude::from_kernel(lon_rad)};
}

GeoPoint geo_point(double lat_deg, double lon_deg) {
  const auto point = GeoPoint::from_degrees(lat_deg, lon_deg);
  if (!point) throw std::invalid_argument(point.error().message());
  return *point;
}

Geodesic geodesic(const GeoPoint& from, const GeoPoint& to) {
  double length{}, azimuth{}, azimuth_back{};
  GeographicLib::Geodesic::WGS84().Inverse(from.lat.degrees(), from.lon.degrees(), to.lat.degrees(), to.lon.degrees(),
                                           length, azimuth, azimuth_back);
  if (length == 0.0) return {Metres{0.0}, Bearing{}};
  return {Metres{length}, Bearing{degrees(azimuth)}};
}

Metres distance(const GeoPoint& from, const GeoPoint& to) { return geodesic(from, to).length; }

GeoPoint destination(const GeoPoint& from, Bearing departing, Metres length) {
  double lat{}, lon{};
  GeographicLib::Geodesic::WGS84().Direct(from.lat.degrees(), from.lon.degrees(), departing.degrees(), length.si(), lat,
                                          lon);
  return GeoPoint::from_kernel(degrees(lat).si(), degrees(lon).si());
}

}  // namespace glidehelm
