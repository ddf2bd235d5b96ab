#include "core/ocean/seawater.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::ocean {

double sea_water_density(double salinity, double temperature_c, double pressure_pa) {
  // Coefficients and their order as in UNESCO (1981), Tenth report of the joint panel on oceanographic tables and standards: the
  // density of pure water, the density at one atmosphere, and the secant bulk modulus.
  const double t = temperature_c, s = salinity, root = s * std::sqrt(s), p = pressure_pa / 1e5;
  const double water =
      999.842594 + t * (6.793952e-2 + t * (-9.095290e-3 + t * (1.001685e-4 + t * (-1.120083e-6 + t * 6.536332e-9))));
  const double at_surface = water +
                            s * (8.24493e-1 + t * (-4.0899e-3 + t * (7.6438e-5 + t * (-8.2467e-7 + t * 5.3875e-9)))) +
                            root * (-5.72466e-3 + t * (1.0227e-4 - t * 1.6546e-6)) + s * s * 4.8314e-4;
  const double stiffness = 19652.21 + t * (148.4206 + t * (-2.327105 + t * (1.360477e-2 - t * 5.155288e-5))) +
                           s * (54.6746 + t * (-0.603459 + t * (1.09987e-2 - t * 6.1670e-5))) +
                           root * (7.944e-2 + t * (1.6483e-2 - t * 5.3009e-4));
  const double by_pressure = 3.239908 + t * (1.43713e-3 + t * (1.16092e-4 - t * 5.77905e-7)) +
                             s * (2.2838e-3 - t * (1.0981e-5 + t * 1.6078e-6)) + root * 1.91075e-4;
  const double by_square =
      8.50935e-5 + t * (-6.12293e-6 + t * 5.2787e-8) + s * (-9.9348e-7 + t * (2.0816e-8 + t * 9.1697e-10));
  return at_surface / (1 - p / (stiffness + p * (by_pressure + p * by_square)));
}

double adiabatic_lapse_rate(double salinity, double temperature_c, double pressure_pa) {
  const double t = temperature_c, s = salinity - 35, p = pressure_pa / 1e4;  // the polynomial counts in decibars
  const double at_surface =
      3.5803e-5 + t * (8.5258e-6 + t * (-6.836e-8 + t * 6.6228e-10)) + s * (1.8932e-6 - t * 4.2393e-8);
  const double by_pressure =
      1.8741e-8 + t * (-6.7795e-10 + t * (8.733e-12 - t * 5.4481e-14)) + s * (-1.1351e-10 + t * 2.7759e-12);
  const double by_square = -4.6206e-13 + t * (1.8676e-14 - t * 2.1687e-16);
  return (at_surface + p * (by_pressure + p * by_square)) / 1e4;
}

double in_situ_temperature(double salinity, double theta_c, double pressure_pa) {
  const double p = pressure_pa;
  const auto rate = [&](double t, double at) { return adiabatic_lapse_rate(salinity, t, at); };
  const double a = rate(theta_c, 0), b = rate(theta_c + 0.5 * p * a, 0.5 * p), c = rate(theta_c + 0.5 * p * b, 0.5 * p),
               d = rate(theta_c + p * c, p);
  return theta_c + p / 6 * (a + 2 * b + 2 * c + d);
}

double pressure_at(Metres depth) {
  constexpr double kDensity = 1027, kCompressed = 4.4e-10;
  const double even = kDensity * kGravity * depth.si();
  return even * (1 + 0.5 * kCompressed * even);
}

bool plausible(const WaterLayer& water) {
  return water.temperature_c >= -3 && water.temperature_c <= 45 && water.salinity >= 0 && water.salinity <= 45;
}

WaterColumn WaterColumn::climatological() {
  std::vector<WaterLayer> layers;
  for (const double z :
       {0.0, 25.0, 50.0, 75.0, 100.0, 150.0, 200.0, 300.0, 400.0, 600.0, 800.0, 1000.0, 1500.0, 2000.0})
    layers.push_back({Metres{z}, 4 + 12 * std::exp(-z / 300), 35});
  return WaterColumn{std::move(layers)};
}

WaterLayer WaterColumn::at(Metres depth) const {
  const auto below = std::upper_bound(layers_.begin(), layers_.end(), depth,
                                      [](Metres z, const WaterLayer& layer) { return z < layer.depth; });
  auto found = below == layers_.begin() ? layers_.front() : below == layers_.end() ? layers_.back() : WaterLayer{};
  if (below != layers_.begin() && below != layers_.end()) {
    const auto& above = *(below - 1);
    const double f = (depth - above.depth) / (below->depth - above.depth);
    found.temperature_c = above.temperature_c + f * (below->temperature_c - above.temperature_c);
    found.salinity = above.salinity + f * (below->salinity - above.salinity);
  }
  found.depth = depth;
  return found;
}

double WaterColumn::density(Metres depth) const {
  const auto water = at(depth);
  return sea_water_density(water.salinity, water.temperature_c, pressure_at(depth));
}

}  // namespace glidehelm::ocean
