#include "simulator/cdl.hpp"

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>

using namespace glidehelm;
using simulator::CdlGrid;
using simulator::CoastalSpec;
using simulator::Variant;

namespace {

CoastalSpec small_sea() {
  CoastalSpec s;
  s.west_deg = 3;
  s.east_deg = 4;
  s.south_deg = 40;
  s.north_deg = 40.5;
  s.from = geo_point(40.1, 3.1);
  s.to = geo_point(40.4, 3.9);
  s.start_s = 1.7e9;
  return s;
}

int times_said(const std::string& text, const std::string& what) {
  int n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++n;
  return n;
}

}  // namespace

TEST_CASE("the CDL has the axes, names and units of CF, and one value per node and time") {
  const auto cdl = coastal_cdl(small_sea(), Variant::forecast, CdlGrid{0.25, 4, 2}, chart::Chart{});
  CHECK(cdl.rfind("netcdf coastal {", 0) == 0);
  CHECK(cdl.find("time = 3 ;\n\tlat = 3 ;\n\tlon = 5 ;") != std::string::npos);
  CHECK(cdl.find("time:units = \"hours since 2023-11-14T22:13:20Z\"") != std::string::npos);
  CHECK(cdl.find("water_u:standard_name = \"eastward_sea_water_velocity\"") != std::string::npos);
  CHECK(cdl.find("water_v:units = \"m s-1\"") != std::string::npos);
  CHECK(cdl.find(" time = 0.000000, 2.000000, 4.000000 ;") != std::string::npos);
  CHECK(cdl.find(" lon = 3.000000, 3.250000, 3.500000, 3.750000, 4.000000 ;") != std::string::npos);
  const auto values =
      cdl.substr(cdl.find(" water_u = ") + 11, cdl.find(" ;", cdl.find(" water_u = ")) - cdl.find(" water_u = ") - 11);
  CHECK(times_said(values, ",") == 3 * 3 * 5 - 1);
  CHECK(values.find('_') == std::string::npos);
}

TEST_CASE("a value of the CDL is the field at its node, to its last digit") {
  const auto spec = small_sea();
  const auto cdl = coastal_cdl(spec, Variant::truth, CdlGrid{0.25, 4, 2}, chart::Chart{});
  const simulator::CoastalField field{spec, Variant::truth};
  const auto at = cdl.find(" water_v = ");
  const double first = std::atof(cdl.c_str() + at + 11);
  CHECK(first == Approx(field.sample(geo_point(40.0 + 1e-9, 3.0 + 1e-9), Depth{}, spec.start_s)->current.north.si())
                     .margin(5.1e-5));
}

TEST_CASE("the same arguments give the same CDL") {
  CHECK(coastal_cdl(small_sea(), Variant::truth, CdlGrid{0.1, 6, 1}, chart::Chart{}) ==
        coastal_cdl(small_sea(), Variant::truth, CdlGrid{0.1, 6, 1}, chart::Chart{}));
}
