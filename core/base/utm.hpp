#pragma once

#include <optional>
#include <string_view>

#include "core/base/geo.hpp"

namespace glidehelm {

/// A zone of the Universal Transverse Mercator projection on WGS84 (NAD83 and ETRS89 differ from it by less than 2 m).
struct UtmZone {
  int number{};  ///< 1 to 60
  bool north{true};
  friend bool operator==(const UtmZone&, const UtmZone&) = default;
};

/// "utm33n", "UTM33S", "EPSG:32633" (north), "EPSG:32733" (south); nothing when it is none of these.
std::optional<UtmZone> utm_zone_from(std::string_view text);

/// Position of an easting and northing in metres (with the false easting of 500 km and, in the south, the false northing of
/// 10 000 km). Nothing where the projection has no position. GeographicLib; better than a micrometre within 3900 km of the
/// central meridian.
std::optional<GeoPoint> from_utm(const UtmZone& zone, double easting, double northing);

}  // namespace glidehelm
