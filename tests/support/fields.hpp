#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "core/ocean/gridded.hpp"

/// Small fields for tests of any room.
namespace glidehelm::test {

inline Current current(double east, double north) { return {MetresPerSecond{east}, MetresPerSecond{north}}; }

/// The same current everywhere and always; still water by default.
struct Uniform {
  double east{}, north{};
  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint, Depth, double) const {
    return ocean::Sample{{MetresPerSecond{east}, MetresPerSecond{north}}, false};
  }
  [[nodiscard]] ocean::Coverage coverage() const { return {}; }
  [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{std::hypot(east, north)}; }
};
inline Uniform still_water() { return {}; }

/// Any function of position (radians) and epoch second as a field; `bound` is what fastest() says.
struct FromFunction {
  std::function<std::pair<double, double>(double lat, double lon, double t_s)> current;
  double bound{};
  ocean::Coverage box{};
  [[nodiscard]] Expected<ocean::Sample, ocean::NoCurrent> sample(GeoPoint p, Depth, double t_s) const {
    if (!box.contains(p)) return unexpected(ocean::NoCurrent::outside_area);
    const auto [east, north] = current(p.lat.radians(), p.lon.radians(), t_s);
    return ocean::Sample{{MetresPerSecond{east}, MetresPerSecond{north}}, false};
  }
  [[nodiscard]] ocean::Coverage coverage() const { return box; }
  [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{bound}; }
};

inline constexpr double kDry = std::numeric_limits<double>::quiet_NaN();

/// `count` values from `first` in steps of `step`.
inline std::vector<double> steps(double first, double step, std::size_t count) {
  std::vector<double> axis(count);
  for (std::size_t k = 0; k < count; ++k) axis[k] = first + step * static_cast<double>(k);
  return axis;
}

/// A grid filled by a function of (latitude °, longitude °, depth m, epoch s) → (east, north); kDry makes a dry node.
template <class F>
ocean::Grid make_grid(ocean::GridAxes axes, const F& current) {
  ocean::Grid grid;
  grid.axes = std::move(axes);
  grid.facts.cycle = "made by a test";
  grid.values.reserve(2 * grid.axes.nodes());
  for (const double t : grid.axes.times_s)
    for (const double z : grid.axes.depths_m)
      for (const double lat : grid.axes.lats_deg)
        for (const double lon : grid.axes.lons_deg) {
          const std::pair<double, double> value = current(lat, lon, z, t);
          const bool dry = std::isnan(value.first) || std::isnan(value.second);
          grid.values.push_back(static_cast<float>(dry ? kDry : value.first));
          grid.values.push_back(static_cast<float>(dry ? kDry : value.second));
        }
  return grid;
}

/// Axes without time and depth.
inline ocean::GridAxes flat_axes(std::vector<double> lats_deg, std::vector<double> lons_deg) {
  return {{0.0}, {0.0}, std::move(lats_deg), std::move(lons_deg), false, false};
}

/// A two-dimensional GriddedField without time from a function of (latitude °, longitude °) → (east, north).
template <class F>
ocean::GriddedField make_field(std::vector<double> lats_deg, std::vector<double> lons_deg, const F& current,
                               const ocean::GriddedOptions& options = {}) {
  return {make_grid(flat_axes(std::move(lats_deg), std::move(lons_deg)),
                    [&](double lat, double lon, double, double) { return current(lat, lon); }),
          options};
}

}  // namespace glidehelm::test
