#pragma once

#include <memory>
#include <vector>

#include "core/ocean/field.hpp"
#include "core/ocean/grid_axis.hpp"
#include "core/ocean/grid_format.hpp"
#include "core/ocean/metric_table.hpp"
#include "core/ocean/time_axis.hpp"

namespace glidehelm::ocean {

/// How a gridded field answers.
struct GriddedOptions {
  OutsideTime outside_time{OutsideTime::hold};
  Interpolation interpolation{Interpolation::linear};
  double coastal_fill_cells{1.5};  ///< how far beyond the last wet node a value is borrowed, in cells; 0 = never
  bool mask_is_land{false};        ///< no coastline given: a dry node is land, and nothing is borrowed
  friend bool operator==(const GriddedOptions&, const GriddedOptions&) = default;
};

/// Currents on a rectilinear latitude–longitude grid, in two dimensions or with depth levels, at one or many times.
/// A value: cheap to copy (the numbers are shared), immutable, const calls from any thread.
///
/// Sampling (product.md 6, "Land and no data are different"):
///  - Between four nodes: the bilinear mean over the wet ones, weights renormalised, if they hold at least half the
///    weight.
///  - Otherwise the value of the nearest wet node within `coastal_fill_cells` (distance in cells of each axis; of equally
///    near nodes the southern, then the western), marked extrapolated; else `no_data`. When the mask is land: `land`.
///  - A mean over a node that the grid itself has filled from its neighbours is marked extrapolated too.
///  - Outside the nodes: `outside_area`; the domain's edge is a wall. A grid around the globe has no edge in longitude.
///  - In depth: see Interpolation; above the first level the first; where a level has no water under water that the
///    shallowest level has, `below_bottom`, also below the last level. A smooth curve ends at the last wet level, too.
///    A field without depths ignores the depth.
///  - In time: see TimeAxis and Interpolation. A time at which the place has no value makes the answer that reason.
///
/// `advance` is the kernel of product.md 10: all lanes in lockstep, four evaluations each, one bracket of time per
/// stage, two 16-byte loads per evaluation and time; a NaN in the result sends a lane to the careful path above. It
/// agrees with `advance_by_samples` to rounding (metric table: 5e-7 relative).
class GriddedField {
 public:
  /// A view over a grid. `keep_alive` owns the bytes, or is empty when the caller keeps them longer than the field and
  /// its copies. One pass over the values finds the fastest.
  GriddedField(const GridView& view, const GriddedOptions& options, std::shared_ptr<const void> keep_alive = {});
  /// Owns its numbers.
  GriddedField(Grid grid, const GriddedOptions& options);

  /// The shallowest level of this field as a two-dimensional field over the same numbers.
  [[nodiscard]] GriddedField shallowest() const;

  [[nodiscard]] Expected<Sample, NoCurrent> sample(GeoPoint p, Depth z, double t_s) const;
  void advance(Lanes& lanes, double t_s, double dt) const;
  [[nodiscard]] Coverage coverage() const;
  [[nodiscard]] MetresPerSecond fastest() const { return MetresPerSecond{fastest_}; }

  [[nodiscard]] const GridAxis& latitudes() const { return lats_; }
  [[nodiscard]] const GridAxis& longitudes() const { return lons_; }
  /// The last column neighbours the first.
  [[nodiscard]] bool around_globe() const { return around_globe_; }
  /// By node [latitude][longitude]: a value at the shallowest level at every time. One pass over that level.
  [[nodiscard]] std::vector<bool> always_wet() const;
  [[nodiscard]] std::size_t levels() const { return depths_.size(); }
  [[nodiscard]] const GriddedOptions& options() const { return options_; }

 private:
  friend struct GriddedKernel;
  /// A position in fractional cells. `u`, `v` are the true ones; `fx`, `fy` are rounded for `nearest`.
  struct Place {
    std::size_t j{}, i{}, east{};  ///< row, column and the column east of it (0 across the seam of a global grid)
    double u{}, v{};
    float fx{}, fy{};
  };
  /// What one slice (one time, one level) has at a place.
  struct Spot {
    float east{}, north{};
    bool wet{}, borrowed{};
    std::size_t node{};  ///< the node it was borrowed from
  };
  using Answer = Expected<Sample, NoCurrent>;

  void find_fastest();
  [[nodiscard]] const float* slice(std::size_t time, std::size_t level) const {
    return values_ + time * time_stride_ + level * level_stride_;
  }
  [[nodiscard]] bool locate(double lat, double lon, Place& place) const;
  /// True when a corner with weight was filled.
  [[nodiscard]] bool over_filled(const float* slice, const Place& place) const;
  [[nodiscard]] Spot wet_mean(const float* slice, const Place& place) const;
  [[nodiscard]] Spot borrow(const float* slice, const Place& place) const;
  /// At `fraction` between nodes k and k + 1 of an axis (depths, times), through up to six answers around it.
  template <class At>
  [[nodiscard]] Answer smooth(const std::vector<double>& axis, std::size_t k, double fraction, const At& at) const;
  [[nodiscard]] Answer at_time(const Place& place, double depth, std::size_t time) const;
  [[nodiscard]] Answer between_levels(const Place& place, std::size_t level, double fraction, std::size_t time) const;
  [[nodiscard]] Answer in_time(const Place& place, double depth, const TimeBracket& bracket) const;
  [[nodiscard]] Answer at(double lat, double lon, double depth, double t_s) const;

  std::shared_ptr<const void> keep_alive_;
  const float* values_{};
  std::size_t time_stride_{}, level_stride_{}, row_stride_{};  ///< in floats
  TimeAxis times_;
  std::vector<double> depths_;  ///< one entry: two-dimensional
  GridAxis lats_, lons_;
  bool around_globe_{};  ///< the last column neighbours the first
  GriddedOptions options_;
  std::shared_ptr<const MetricTable> metric_;
  std::shared_ptr<const std::vector<bool>> filled_;  ///< by node; empty when no node is
  double fastest_{};
};

}  // namespace glidehelm::ocean
