#include "simulator/cdl.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <vector>

#include "core/base/utc.hpp"

namespace glidehelm::simulator {
namespace {

constexpr const char* kFill = "-32768.f";

std::vector<double> axis(double low, double high, double step) {
  std::vector<double> nodes;
  const int last = static_cast<int>(std::floor((high - low) / step + 1e-9));
  for (int i = 0; i <= last; ++i) nodes.push_back(low + i * step);
  return nodes;
}

void put_axis(std::string& out, const char* name, const std::vector<double>& nodes) {
  fmt::format_to(std::back_inserter(out), " {} = ", name);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    fmt::format_to(std::back_inserter(out), "{}{:.6f}", i == 0 ? "" : i % 10 == 0 ? ",\n  " : ", ", nodes[i]);
  out += " ;\n";
}

std::string header(const CoastalSpec& spec, Variant variant, std::size_t times, std::size_t lats, std::size_t lons) {
  return fmt::format(
      "netcdf coastal {{\n"
      "dimensions:\n"
      "\ttime = {} ;\n\tlat = {} ;\n\tlon = {} ;\n"
      "variables:\n"
      "\tdouble time(time) ;\n"
      "\t\ttime:standard_name = \"time\" ;\n"
      "\t\ttime:units = \"hours since {}\" ;\n"
      "\t\ttime:calendar = \"standard\" ;\n"
      "\tdouble lat(lat) ;\n"
      "\t\tlat:standard_name = \"latitude\" ;\n"
      "\t\tlat:units = \"degrees_north\" ;\n"
      "\tdouble lon(lon) ;\n"
      "\t\tlon:standard_name = \"longitude\" ;\n"
      "\t\tlon:units = \"degrees_east\" ;\n"
      "\tfloat water_u(time, lat, lon) ;\n"
      "\t\twater_u:standard_name = \"eastward_sea_water_velocity\" ;\n"
      "\t\twater_u:units = \"m s-1\" ;\n"
      "\t\twater_u:_FillValue = {} ;\n"
      "\tfloat water_v(time, lat, lon) ;\n"
      "\t\twater_v:standard_name = \"northward_sea_water_velocity\" ;\n"
      "\t\twater_v:units = \"m s-1\" ;\n"
      "\t\twater_v:_FillValue = {} ;\n"
      "\n// global attributes:\n"
      "\t\t:Conventions = \"CF-1.8\" ;\n"
      "\t\t:title = \"made-up coastal currents ({}), seed {}\" ;\n"
      "data:\n",
      times, lats, lons, utc_text(instant_at(spec.start_s)), kFill, kFill,
      variant == Variant::truth ? "truth" : "forecast", spec.seed);
}

}  // namespace

std::string coastal_cdl(const CoastalSpec& spec, Variant variant, const CdlGrid& grid, const chart::Chart& chart) {
  const CoastalField field{spec, variant};
  const auto lats = axis(spec.south_deg, spec.north_deg, grid.step_deg);
  const auto lons = axis(spec.west_deg, spec.east_deg, grid.step_deg);
  std::vector<double> hours;
  for (int h = 0; h <= grid.hours; h += grid.every_h) hours.push_back(h);

  std::vector<bool> land;
  land.reserve(lats.size() * lons.size());
  for (const double lat : lats)
    for (const double lon : lons)
      land.push_back(chart.is_land(GeoPoint::from_kernel(degrees(lat).si(), degrees(lon).si())));

  std::string out = header(spec, variant, hours.size(), lats.size(), lons.size());
  put_axis(out, "time", hours);
  put_axis(out, "lat", lats);
  put_axis(out, "lon", lons);
  for (const bool east : {true, false}) {
    out += east ? " water_u = " : " water_v = ";
    for (std::size_t t = 0; t < hours.size(); ++t)
      for (std::size_t j = 0; j < lats.size(); ++j) {
        if (t + j > 0) out += ",\n  ";
        for (std::size_t i = 0; i < lons.size(); ++i) {
          if (i > 0) out += ',';
          if (land[j * lons.size() + i]) {
            out += '_';
            continue;
          }
          // The outermost nodes lie on the edge of the area: rounding must not put them outside.
          const double lat = std::min(std::max(lats[j], spec.south_deg + 1e-9), spec.north_deg - 1e-9);
          const double lon = std::min(std::max(lons[i], spec.west_deg + 1e-9), spec.east_deg - 1e-9);
          const auto s = field.sample(GeoPoint::from_kernel(degrees(lat).si(), degrees(lon).si()), Depth{},
                                      spec.start_s + 3600.0 * hours[t]);
          if (!s)
            out += '_';
          else
            fmt::format_to(std::back_inserter(out), "{:.4f}", east ? s->current.east.si() : s->current.north.si());
        }
      }
    out += " ;\n";
  }
  return out + "}\n";
}

}  // namespace glidehelm::simulator
