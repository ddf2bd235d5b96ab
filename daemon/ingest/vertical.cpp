#include "daemon/ingest/vertical.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "core/base/text.hpp"

namespace glidehelm::ingest {

namespace {

/// Song and Haidvogel 1994.
double stretching_1(double theta_s, double theta_b, double s) {
  if (theta_s == 0) return s;
  return (1 - theta_b) * std::sinh(theta_s * s) / std::sinh(theta_s) +
         theta_b * (0.5 * std::tanh(theta_s * (s + 0.5)) / std::tanh(0.5 * theta_s) - 0.5);
}

double surface_curve(double theta_s, double s) {
  return theta_s > 0 ? (1 - std::cosh(theta_s * s)) / (std::cosh(theta_s) - 1) : -s * s;
}

/// Shchepetkin 2005, with the exponents α = β = 1 of ROMS.
double stretching_2(double theta_s, double theta_b, double s) {
  if (theta_s == 0) return s;
  const double surface = surface_curve(theta_s, s);
  if (theta_b == 0) return surface;
  const double bottom = std::sinh(theta_b * (s + 1)) / std::sinh(theta_b) - 1;
  const double weight = (s + 1) * (1 + (1 - (s + 1)));
  return weight * surface + (1 - weight) * bottom;
}

/// Geyer, for high resolution at the floor of shallow seas.
double stretching_3(double theta_s, double theta_b, double s) {
  constexpr double kScale = 3;
  const double norm = std::log(std::cosh(kScale));
  const double surface = -std::log(std::cosh(kScale * std::pow(std::abs(s), theta_s))) / norm;
  const double bottom = std::log(std::cosh(kScale * std::pow(s + 1, theta_b))) / norm - 1;
  const double weight = 0.5 * (1 - std::tanh(kScale * (s + 0.5)));
  return weight * bottom + (1 - weight) * surface;
}

/// Shchepetkin 2010: twice stretched.
double stretching_4(double theta_s, double theta_b, double s) {
  const double surface = surface_curve(theta_s, s);
  return theta_b > 0 ? std::expm1(theta_b * surface) / -std::expm1(-theta_b) : surface;
}

std::string number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

}  // namespace

Result<StretchingChoice> stretching_choice_from(const std::string& text) {
  const std::string allowed =
      "; allowed is vtransform=1|2,vstretching=1…5,theta_s=0…20,theta_b=0…4,hc=METRES, each of the five once";
  std::map<std::string, double> given;
  for (std::size_t at = 0; at <= text.size();) {
    auto end = text.find(',', at);
    if (end == std::string::npos) end = text.size();
    const std::string item = text.substr(at, end - at);
    at = end + 1;
    const auto equals = item.find('=');
    const auto value = equals == std::string::npos ? std::nullopt : number_from(item.substr(equals + 1));
    if (!value) return fault("\"" + item + "\" is no parameter" + allowed);
    const std::string name = lower(trimmed(item.substr(0, equals)));
    if (!given.emplace(name, *value).second) return fault(name + " twice" + allowed);
  }
  const auto within = [&](const char* name, double low, double high) {
    const auto found = given.find(name);
    return found != given.end() && found->second >= low && found->second <= high;
  };
  const bool fits = given.size() == 5 && within("vtransform", 1, 2) && within("vstretching", 1, 5) &&
                    within("theta_s", 0, 20) && within("theta_b", 0, 4) && within("hc", 0, 10000);
  if (!fits) return fault("\"" + text + "\"" + allowed);
  StretchingChoice choice{static_cast<int>(given["vtransform"]), static_cast<int>(given["vstretching"]),
                          given["theta_s"], given["theta_b"], given["hc"]};
  if (choice.vtransform != given["vtransform"] || choice.vstretching != given["vstretching"])
    return fault("\"" + text + "\"" + allowed);
  return choice;
}

std::vector<double> s_of_layers(std::size_t layers, int vstretching) {
  std::vector<double> s(layers);
  const auto n = static_cast<double>(layers);
  for (std::size_t k = 0; k < layers; ++k) {
    const double r = static_cast<double>(k) + 0.5;
    s[k] = vstretching == 5 && layers > 1
               ? -(r * r - 2 * r * n + r + n * n - n) / (n * n - n) - 0.01 * (r * r - r * n) / (1 - n)
               : r / n - 1;
  }
  return s;
}

double stretching_curve(const StretchingChoice& choice, double s) {
  switch (choice.vstretching) {
    case 1:
      return stretching_1(choice.theta_s, choice.theta_b, s);
    case 2:
      return stretching_2(choice.theta_s, choice.theta_b, s);
    case 3:
      return stretching_3(choice.theta_s, choice.theta_b, s);
    default:
      return stretching_4(choice.theta_s, choice.theta_b, s);
  }
}

double TerrainLevels::depth(std::size_t k, double h_m, double zeta_m) const {
  switch (law) {
    case LevelLaw::sigma:
      return -(h_m + zeta_m) * s[k];
    case LevelLaw::s_coordinate:
      return -(hc_m * s[k] + (h_m - hc_m) * c[k] + zeta_m * s[k]);
    case LevelLaw::transform_1: {
      const double zo = hc_m * s[k] + (h_m - hc_m) * c[k];
      return -(zo + zeta_m * zo / h_m);
    }
    case LevelLaw::transform_2:
      return -(h_m + zeta_m) * (hc_m * s[k] + h_m * c[k]) / (hc_m + h_m);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

Result<Done> check_levels(const TerrainLevels& levels) {
  const auto monotone = [](const std::vector<double>& v) {
    for (std::size_t k = 2; k < v.size(); ++k)
      if ((v[k] - v[k - 1]) * (v[1] - v[0]) <= 0) return false;
    return v.size() < 2 || v[1] != v[0];
  };
  for (const auto& [list, name] : {std::pair{&levels.s, "s"}, std::pair{&levels.c, "C(s)"}}) {
    for (const double value : *list)
      if (!(value >= -1 - 1e-6 && value <= 1e-6))
        return fault(std::string{"terrain-following level "} + name + " = " + number(value) + ", allowed is -1 to 0");
    if (!monotone(*list)) return fault(std::string{"terrain-following levels "} + name + " neither ascend nor descend");
  }
  if (levels.s.empty() || (levels.law != LevelLaw::sigma && levels.c.size() != levels.s.size()))
    return fault("terrain-following levels: " + std::to_string(levels.s.size()) + " of s against " +
                 std::to_string(levels.c.size()) + " of C(s)");
  if (!(levels.hc_m >= 0 && levels.hc_m <= 12000))
    return fault("critical depth hc = " + number(levels.hc_m) + " m, allowed is 0 to 12000");
  return Done{};
}

std::vector<double> fixed_depths(double deepest_m) {
  constexpr struct {
    double to, step;
  } kLadder[] = {{10, 2}, {50, 5}, {100, 10}, {200, 20}, {300, 25}, {600, 50}, {1200, 100}, {2000, 200}, {12000, 500}};
  std::vector<double> depths{0};
  for (const auto& rung : kLadder)
    while (depths.back() < rung.to && depths.back() + rung.step <= deepest_m)
      depths.push_back(depths.back() + rung.step);
  return depths;
}

void Column::set(std::span<const double> depths_m, double bottom_m) {
  depths_ = depths_m;
  bottom_m_ = bottom_m;
  descending_ = depths_m.size() > 1 && depths_m.front() > depths_m.back();
}

double Column::at(double depth_m, std::span<const double> values) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!(depth_m <= bottom_m_)) return kNone;
  double above_depth = 0, above = kNone;
  for (std::size_t n = 0; n < depths_.size(); ++n) {
    const std::size_t k = descending_ ? depths_.size() - 1 - n : n;  // from the surface down
    if (std::isnan(values[k])) continue;
    if (depths_[k] >= depth_m) {
      if (std::isnan(above)) return values[k];
      const double f = (depth_m - above_depth) / (depths_[k] - above_depth);
      return above + f * (values[k] - above);
    }
    above_depth = depths_[k];
    above = values[k];
  }
  return above;
}

}  // namespace glidehelm::ingest
