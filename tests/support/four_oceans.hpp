#pragma once

#include <string>

/// A small ensemble as text for `make_netcdf`.
namespace glidehelm::test {

/// Four members, each the same everywhere and always, from 2° south to 2° north and 0 to 8° east: eastward 0.02, 0.06, −0.06 and −0.6 m/s. The
/// third flows north as well with `third_north` m/s.
inline std::string four_oceans(const std::string& third_north = "0") {
  const auto four = [](const std::string& value) { return value + ", " + value + ", " + value + ", " + value; };
  return R"(netcdf e {
dimensions: member = 4 ; lat = 2 ; lon = 2 ;
variables: double lat(lat) ; lat:units = "degrees_north" ; double lon(lon) ; lon:units = "degrees_east" ;
  float u(member, lat, lon) ; u:units = "m/s" ; u:standard_name = "eastward_sea_water_velocity" ;
  float v(member, lat, lon) ; v:units = "m/s" ; v:standard_name = "northward_sea_water_velocity" ;
data: lat = -2, 2 ; lon = 0, 8 ;
  u = )" +
         four("0.02") + ", " + four("0.06") + ", " + four("-0.06") + ", " + four("-0.6") + " ;\n  v = " + four("0") +
         ", " + four("0") + ", " + four(third_north) + ", " + four("0") + " ;\n}";
}

}  // namespace glidehelm::test
