#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/ingest/curvilinear.hpp"

/// Models' files written as CDL, with fields by formula.
namespace glidehelm::test {

/// Points `step` degrees apart around (lat, lon), turned by `turn` degrees counter-clockwise in the plane of degrees.
inline ingest::Mesh turned_mesh(std::size_t rows, std::size_t columns, double lat, double lon, double turn,
                                double step) {
  ingest::Mesh mesh{rows, columns, {}, {}};
  const double c = std::cos(turn * 3.14159265358979323846 / 180), s = std::sin(turn * 3.14159265358979323846 / 180);
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const double x = step * (static_cast<double>(i) - 0.5 * static_cast<double>(columns - 1));
      const double y = step * (static_cast<double>(j) - 0.5 * static_cast<double>(rows - 1));
      mesh.lat.push_back(lat + x * s + y * c);
      double at = lon + x * c - y * s;
      if (at >= 180) at -= 360;
      mesh.lon.push_back(at);
    }
  return mesh;
}

/// "name = 1, 2, 3 ;"
inline std::string cdl_data(const std::string& name, const std::vector<double>& values) {
  std::string text = "  " + name + " = ";
  char buffer[40];
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::isnan(values[k]))
      std::snprintf(buffer, sizeof buffer, "NaN");
    else
      std::snprintf(buffer, sizeof buffer, "%.10g", values[k]);
    text += (k > 0 ? ", " : "") + std::string{buffer};
  }
  return text + " ;\n";
}

/// Values over index space; rows outermost.
using ByIndex = std::function<double(double j, double i)>;
inline std::vector<double> over(std::size_t rows, std::size_t columns, double first_j, double first_i,
                                const ByIndex& f) {
  std::vector<double> values;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i)
      values.push_back(f(first_j + static_cast<double>(j), first_i + static_cast<double>(i)));
  return values;
}

/// A ROMS file of one time, by formulas over the index space of its centres: u lies at (j, i + ½), v at (j + ½, i).
struct RomsFile {
  std::size_t rows{6}, columns{7}, levels{};   ///< levels 0: a surface field
  ByIndex lat, lon, angle, mask, depth, zeta;  ///< angle, mask, depth, zeta: left out when empty
  std::string angle_unit{"radians"};
  std::function<double(std::size_t k, double j, double i)> u, v;
  std::string variables, data;  ///< more of each

  [[nodiscard]] std::string cdl() const {
    std::string dims = "netcdf m {\ndimensions: ocean_time = 1 ; eta_rho = " + std::to_string(rows) +
                       " ; xi_rho = " + std::to_string(columns) + " ; eta_u = " + std::to_string(rows) +
                       " ; xi_u = " + std::to_string(columns - 1) + " ; eta_v = " + std::to_string(rows - 1) +
                       " ; xi_v = " + std::to_string(columns) + " ;";
    if (levels > 0) dims += " s_rho = " + std::to_string(levels) + " ;";
    std::string names =
        "\nvariables:\n  double ocean_time(ocean_time) ; ocean_time:units = \"hours since 2024-01-01\" ;\n";
    std::string values = "data:\n  ocean_time = 0 ;\n";
    const auto plane = [&](const char* name, const ByIndex& f, const std::string& attributes) {
      if (!f) return;
      names += std::string{"  double "} + name + "(eta_rho, xi_rho) ; " + attributes + "\n";
      values += cdl_data(name, over(rows, columns, 0, 0, f));
    };
    plane("lat_rho", lat, "lat_rho:units = \"degree_north\" ;");
    plane("lon_rho", lon, "lon_rho:units = \"degree_east\" ;");
    plane("angle", angle, "angle:units = \"" + angle_unit + "\" ;");
    plane("mask_rho", mask, "");
    plane("h", depth, "h:units = \"meter\" ;");
    if (zeta) {
      names += "  double zeta(ocean_time, eta_rho, xi_rho) ; zeta:units = \"meter\" ;\n";
      values += cdl_data("zeta", over(rows, columns, 0, 0, zeta));
    }
    const std::string level = levels > 0 ? "s_rho, " : "";
    names += "  double u(ocean_time, " + level + "eta_u, xi_u) ; u:units = \"m/s\" ;\n  double v(ocean_time, " + level +
             "eta_v, xi_v) ; v:units = \"m/s\" ;\n";
    std::vector<double> us, vs;
    for (std::size_t k = 0; k < std::max<std::size_t>(levels, 1); ++k) {
      const auto a = over(rows, columns - 1, 0, 0.5, [&](double j, double i) { return u(k, j, i); });
      const auto b = over(rows - 1, columns, 0.5, 0, [&](double j, double i) { return v(k, j, i); });
      us.insert(us.end(), a.begin(), a.end());
      vs.insert(vs.end(), b.begin(), b.end());
    }
    values += cdl_data("u", us) + cdl_data("v", vs);
    return dims + names + variables + values + data + "}\n";
  }
};

/// The straight mesh of turned_mesh in index space, and the direction of its rows.
struct Turned {
  double lat0{40}, lon0{-30}, turn_deg{25}, step_deg{0.1}, rows{6}, columns{7};
  [[nodiscard]] double x(double i) const { return step_deg * (i - 0.5 * (columns - 1)); }
  [[nodiscard]] double y(double j) const { return step_deg * (j - 0.5 * (rows - 1)); }
  [[nodiscard]] double c() const { return std::cos(turn_deg * 3.14159265358979323846 / 180); }
  [[nodiscard]] double s() const { return std::sin(turn_deg * 3.14159265358979323846 / 180); }
  [[nodiscard]] double squeeze() const { return std::cos(lat0 * 3.14159265358979323846 / 180); }
  [[nodiscard]] double lat(double j, double i) const { return lat0 + x(i) * s() + y(j) * c(); }
  [[nodiscard]] double lon(double j, double i) const { return lon0 + (x(i) * c() - y(j) * s()) / squeeze(); }
  /// The index place (row, column) of a position.
  [[nodiscard]] std::pair<double, double> place(double lat_deg, double lon_deg) const {
    const double dx = (lon_deg - lon0) * squeeze(), dy = lat_deg - lat0;
    return {(-dx * s() + dy * c()) / step_deg + 0.5 * (rows - 1),
            (dx * c() + dy * s()) / step_deg + 0.5 * (columns - 1)};
  }
  /// Direction of the rows on the sphere, radians.
  [[nodiscard]] double theta(double j, double i) const {
    return std::atan2(s(), c() * std::cos(lat(j, i) * 3.14159265358979323846 / 180) / squeeze());
  }
  /// A file of this mesh with a flow given as east and north at index places.
  [[nodiscard]] RomsFile file(const ByIndex& east, const ByIndex& north) const {
    RomsFile f;
    f.rows = static_cast<std::size_t>(rows);
    f.columns = static_cast<std::size_t>(columns);
    const Turned mesh = *this;
    f.lat = [mesh](double j, double i) { return mesh.lat(j, i); };
    f.lon = [mesh](double j, double i) { return mesh.lon(j, i); };
    f.angle = [mesh](double j, double i) { return mesh.theta(j, i); };
    f.u = [=](std::size_t, double j, double i) {
      return east(j, i) * std::cos(mesh.theta(j, i)) + north(j, i) * std::sin(mesh.theta(j, i));
    };
    f.v = [=](std::size_t, double j, double i) {
      return -east(j, i) * std::sin(mesh.theta(j, i)) + north(j, i) * std::cos(mesh.theta(j, i));
    };
    return f;
  }
};

}  // namespace glidehelm::test
