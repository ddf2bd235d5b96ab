#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/current.hpp"
#include "core/base/expected.hpp"
#include "core/base/geo.hpp"
#include "core/base/local_metric.hpp"
#include "core/base/time.hpp"

/// Currents: where, how deep and when the water moves how. Samples, never files.
namespace glidehelm::ocean {

/// Why there is no current at a place and time.
enum class NoCurrent : std::uint8_t { land = 1, no_data, below_bottom, outside_area, outside_time };
/// "land", "no_data", "below_bottom", "outside_area", "outside_time": the words of `glidehelm field sample --json`.
std::string_view word(NoCurrent reason);

/// A current and whether it was borrowed from the nearest wet node (product.md 6, "coastal fill"; its uncertainty is
/// then doubled).
struct Sample {
  Current current;
  bool extrapolated{};
  friend bool operator==(const Sample&, const Sample&) = default;
};

/// Box and interval in which a field may answer. Radians; `east` ≥ `west` and may run beyond π: a box across the
/// antimeridian is [170°, 190°]. A global field has east − west ≥ 2π.
struct Coverage {
  double south{-kPi / 2}, north{kPi / 2}, west{-kPi}, east{kPi};
  double first_s{-1e18}, last_s{1e18};  ///< epoch seconds between which data exist
  bool holds_outside{true};             ///< answers beyond [first, last] too (hold or cycle), else outside_time
  [[nodiscard]] bool contains(GeoPoint p) const {
    const double lat = p.lat.radians();
    if (lat < south || lat > north) return false;
    const double lon = p.lon.radians();
    if (lon >= west && lon <= east) return true;
    // In one step, not turn by turn: a lane that left the globe would keep such a loop for ever. What a turn loses in the rounding does not put
    // an edge outside. Neither NaN nor an infinite longitude is inside.
    const double middle = 0.5 * (west + east), rounding = 1e-12;
    return std::abs(std::remainder(lon - middle, 2 * kPi)) <= 0.5 * (east - west) + rounding;
  }
  friend bool operator==(const Coverage&, const Coverage&) = default;
};

/// The positions of all headings of one expansion, as a structure of arrays: an integrator moves them in lockstep, so
/// that one lane's cache miss hides behind the others' arithmetic. Longitudes run on across the antimeridian.
struct Lanes {
  static constexpr int kMax = 72;
  int count{};
  alignas(64) std::array<double, kMax> lat, lon;                 ///< radians
  alignas(64) std::array<double, kMax> water_east, water_north;  ///< velocity through water, m/s; 0 drifts
  alignas(64) std::array<std::uint8_t, kMax> lost;  ///< 0 under way, else the NoCurrent that stopped the lane
};

/// A velocity field: `sample` for edges and `coverage`. Deterministic, const, callable from several threads at once.
template <class F>
concept VelocityField = requires(const F& f, GeoPoint p, Depth z, double t_s) {
  { f.sample(p, z, t_s) } -> std::same_as<Expected<Sample, NoCurrent>>;
  { f.coverage() } -> std::same_as<Coverage>;
  { f.fastest() } -> std::same_as<MetresPerSecond>;
};

/// Non-owning view of any VelocityField. `sample` is for edges; `advance` moves all lanes with one indirect call per
/// step, whatever the field, so that the expansion loop holds no virtual call.
class FieldRef {
 public:
  template <VelocityField F>
  FieldRef(const F& field) : object_{&field}, table_{&kTable<F>} {}  // NOLINT(google-explicit-constructor): a view

  /// Current at position, depth and epoch second. Two-dimensional fields ignore the depth.
  [[nodiscard]] Expected<Sample, NoCurrent> sample(GeoPoint p, Depth z, double t_s) const {
    return table_->sample(object_, p, z, t_s);
  }
  [[nodiscard]] Expected<Sample, NoCurrent> sample(GeoPoint p, double t_s) const { return sample(p, Depth{}, t_s); }

  /// One classical Runge–Kutta step of `dt` seconds from epoch second `t_s` for every lane that is under way:
  /// dx/dt = water velocity + current(x, t), with the metric of LocalMetric at each stage. A lane whose stage has no
  /// current is marked lost and stays where the step began. Four current evaluations per lane.
  void advance(Lanes& lanes, double t_s, double dt) const { table_->advance(object_, lanes, t_s, dt); }

  [[nodiscard]] Coverage coverage() const { return table_->coverage(object_); }
  /// True when both look at the same object.
  [[nodiscard]] bool is(const FieldRef& other) const { return object_ == other.object_ && table_ == other.table_; }
  /// An upper bound of the speed of any current that `sample` can return: what makes heuristics admissible.
  [[nodiscard]] MetresPerSecond fastest() const { return table_->fastest(object_); }

 private:
  struct Table {
    Expected<Sample, NoCurrent> (*sample)(const void*, GeoPoint, Depth, double);
    void (*advance)(const void*, Lanes&, double, double);
    Coverage (*coverage)(const void*);
    MetresPerSecond (*fastest)(const void*);
  };
  template <class F>
  static const Table kTable;

  const void* object_;
  const Table* table_;
};

/// What the water does, as a planner sees it. One forecast is one Ocean; an ensemble is a span of them.
struct Ocean {
  FieldRef dive;     ///< depth-averaged over the dive profile: moves a diving glider (2-D)
  FieldRef surface;  ///< the shallowest current: moves a drifting glider (2-D)
};

/// The step of `FieldRef::advance` for a field that brings no kernel of its own: one sample() per stage and lane.
template <VelocityField F>
void advance_by_samples(const F& field, Lanes& lanes, double t_s, double dt) {
  for (int i = 0; i < lanes.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (lanes.lost[k] != 0) continue;
    const double lat0 = lanes.lat[k], lon0 = lanes.lon[k];
    double sum_lat = 0, sum_lon = 0, step_lat = 0, step_lon = 0;
    for (int stage = 0; stage < 4; ++stage) {
      const double fraction = stage == 0 ? 0.0 : stage == 3 ? 1.0 : 0.5;
      const double lat = lat0 + fraction * dt * step_lat, lon = lon0 + fraction * dt * step_lon;
      const auto s = field.sample(GeoPoint::from_kernel(lat, lon), Depth{}, t_s + fraction * dt);
      if (!s) {
        lanes.lost[k] = static_cast<std::uint8_t>(s.error());
        break;
      }
      const auto metric = LocalMetric::at(lat);
      step_lat = (lanes.water_north[k] + s->current.north.si()) / metric.meridian_radius;
      step_lon = (lanes.water_east[k] + s->current.east.si()) / metric.parallel_radius;
      const double weight = stage == 1 || stage == 2 ? 2.0 : 1.0;
      sum_lat += weight * step_lat;
      sum_lon += weight * step_lon;
    }
    if (lanes.lost[k] != 0) continue;
    lanes.lat[k] = lat0 + dt / 6.0 * sum_lat;
    lanes.lon[k] = lon0 + dt / 6.0 * sum_lon;
  }
}

template <class F>
const FieldRef::Table FieldRef::kTable = {
    [](const void* f, GeoPoint p, Depth z, double t) { return static_cast<const F*>(f)->sample(p, z, t); },
    [](const void* f, Lanes& lanes, double t, double dt) {
      if constexpr (requires(const F& field) { field.advance(lanes, t, dt); })
        static_cast<const F*>(f)->advance(lanes, t, dt);
      else
        advance_by_samples(*static_cast<const F*>(f), lanes, t, dt);
    },
    [](const void* f) { return static_cast<const F*>(f)->coverage(); },
    [](const void* f) { return static_cast<const F*>(f)->fastest(); }};

}  // namespace glidehelm::ocean
