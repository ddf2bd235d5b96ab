#include "simulator/netcdf_classic.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include "core/base/utc.hpp"

namespace glidehelm::simulator {
namespace {

constexpr std::uint32_t kDimension = 10, kVariable = 11, kAttribute = 12;
constexpr std::uint32_t kChar = 2;
constexpr float kFill = -32768.0F;

void put32(std::string& out, std::uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((v >> static_cast<unsigned>(shift)) & 0xFFU);
}
void put64(std::string& out, std::uint64_t v) {
  put32(out, static_cast<std::uint32_t>(v >> 32U));
  put32(out, static_cast<std::uint32_t>(v));
}
void pad(std::string& out) {
  while (out.size() % 4 != 0) out += '\0';
}
void put_text(std::string& out, const std::string& text) {
  put32(out, static_cast<std::uint32_t>(text.size()));
  out += text;
  pad(out);
}

void put_attributes(std::string& out, const std::vector<ClassicAttribute>& attributes) {
  put32(out, attributes.empty() ? 0 : kAttribute);
  put32(out, static_cast<std::uint32_t>(attributes.size()));
  for (const auto& a : attributes) {
    put_text(out, a.name);
    put32(out, a.number ? static_cast<std::uint32_t>(ClassicVariable::Type::float32) : kChar);
    if (a.number) {
      put32(out, 1);
      put_float(out, *a.number);
    } else {
      put_text(out, a.text);
    }
  }
}

std::vector<double> axis(double low, double high, double step) {
  std::vector<double> nodes;
  const int last = static_cast<int>(std::floor((high - low) / step + 1e-9));
  for (int i = 0; i <= last; ++i) nodes.push_back(low + i * step);
  return nodes;
}

std::string doubles(const std::vector<double>& values, double less = 0, double by = 1) {
  std::string out;
  for (const double v : values) put_double(out, (v - less) / by);
  return out;
}

}  // namespace

void put_float(std::string& out, float value) { put32(out, std::bit_cast<std::uint32_t>(value)); }
void put_double(std::string& out, double value) { put64(out, std::bit_cast<std::uint64_t>(value)); }

std::string classic_file(const std::vector<std::pair<std::string, std::size_t>>& dimensions,
                         const std::vector<ClassicAttribute>& global, const std::vector<ClassicVariable>& variables) {
  // Where the data begin depends on the header's length, which does not depend on where they begin.
  const auto header = [&](std::uint64_t begin) {
    std::string out{"CDF\x02"};
    put32(out, 0);
    put32(out, kDimension);
    put32(out, static_cast<std::uint32_t>(dimensions.size()));
    for (const auto& [name, length] : dimensions) {
      put_text(out, name);
      put32(out, static_cast<std::uint32_t>(length));
    }
    put_attributes(out, global);
    put32(out, kVariable);
    put32(out, static_cast<std::uint32_t>(variables.size()));
    for (const auto& v : variables) {
      put_text(out, v.name);
      put32(out, static_cast<std::uint32_t>(v.dimensions.size()));
      for (const auto d : v.dimensions) put32(out, d);
      put_attributes(out, v.attributes);
      put32(out, static_cast<std::uint32_t>(v.type));
      put32(out, static_cast<std::uint32_t>(v.data.size()));
      put64(out, begin);
      begin += v.data.size();
    }
    return out;
  };
  std::string out = header(header(0).size());
  std::size_t size = out.size();
  for (const auto& v : variables) size += v.data.size();
  out.reserve(size);
  for (const auto& v : variables) out += v.data;
  return out;
}

std::string forecast_file(const ocean::FieldRef& field, const ForecastGrid& grid, double reference_s) {
  const auto lats = axis(grid.south_deg, grid.north_deg, grid.step_deg);
  const auto lons = axis(grid.west_deg, grid.east_deg, grid.step_deg);
  const bool deep = !grid.depths_m.empty();
  const auto depths = deep ? grid.depths_m : std::vector<double>{0.0};
  std::string u, v;
  for (const double t : grid.times_s)
    for (const double z : depths)
      for (const double lat : lats)
        for (const double lon : lons) {
          // The outermost nodes lie on the edge of the area: rounding must not put them outside.
          const double inner_lat = std::fmin(std::fmax(lat, grid.south_deg + 1e-9), grid.north_deg - 1e-9);
          const double inner_lon = std::fmin(std::fmax(lon, grid.west_deg + 1e-9), grid.east_deg - 1e-9);
          const auto s = field.sample(GeoPoint::from_kernel(degrees(inner_lat).si(), degrees(inner_lon).si()),
                                      Depth{Metres{z}}, t);
          put_float(u, s ? static_cast<float>(s->current.east.si()) : kFill);
          put_float(v, s ? static_cast<float>(s->current.north.si()) : kFill);
        }
  std::vector<std::pair<std::string, std::size_t>> dimensions{{"time", grid.times_s.size()}};
  if (deep) dimensions.emplace_back("depth", depths.size());
  const auto lat_d = static_cast<std::uint32_t>(dimensions.size());
  dimensions.emplace_back("lat", lats.size());
  dimensions.emplace_back("lon", lons.size());
  std::vector<std::uint32_t> all{0};
  if (deep) all.push_back(1);
  all.push_back(lat_d);
  all.push_back(lat_d + 1);
  const std::string since = "hours since " + utc_text(instant_at(reference_s));
  constexpr auto kFloat = ClassicVariable::Type::float32, kDouble = ClassicVariable::Type::float64;
  std::vector<ClassicVariable> variables{{"time",
                                          {0},
                                          {{"standard_name", "time"}, {"units", since}, {"calendar", "standard"}},
                                          kDouble,
                                          doubles(grid.times_s, reference_s, 3600)},
                                         {"forecast_reference_time",
                                          {},
                                          {{"standard_name", "forecast_reference_time"}, {"units", since}},
                                          kDouble,
                                          doubles({0.0})}};
  if (deep)
    variables.push_back(
        {"depth", {1}, {{"standard_name", "depth"}, {"units", "m"}, {"positive", "down"}}, kDouble, doubles(depths)});
  variables.push_back(
      {"lat", {lat_d}, {{"standard_name", "latitude"}, {"units", "degrees_north"}}, kDouble, doubles(lats)});
  variables.push_back(
      {"lon", {lat_d + 1}, {{"standard_name", "longitude"}, {"units", "degrees_east"}}, kDouble, doubles(lons)});
  variables.push_back(
      {"water_u",
       all,
       {{"standard_name", "eastward_sea_water_velocity"}, {"units", "m s-1"}, {"_FillValue", "", kFill}},
       kFloat,
       std::move(u)});
  variables.push_back(
      {"water_v",
       all,
       {{"standard_name", "northward_sea_water_velocity"}, {"units", "m s-1"}, {"_FillValue", "", kFill}},
       kFloat,
       std::move(v)});
  return classic_file(dimensions, {{"Conventions", "CF-1.8"}, {"title", "made-up currents"}}, variables);
}

}  // namespace glidehelm::simulator
