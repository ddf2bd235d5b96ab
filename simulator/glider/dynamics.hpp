#pragma once

#include <optional>
#include <string>

#include "core/base/current.hpp"
#include "core/base/geo.hpp"
#include "core/chart/chart.hpp"
#include "core/ocean/field.hpp"

namespace glidehelm::simulator {

/// The glider as it truly is; what it believes of itself is `Belief`.
struct Hull {
  MetresPerSecond speed{0.3};        ///< horizontal, through water
  Radians glide_angle{degrees(26)};  ///< of the path below the horizon: the vertical speed is speed·tan
  Metres dive_depth{200};            ///< lower turning depth of the yo
  Metres climb_to{20};               ///< upper turning depth of inner yos
  Radians heading_bias{};            ///< clockwise: the true heading is the wanted one plus this
  Current leeway;                    ///< added to the surface current while drifting (wind)
};

/// Why a glider's way ended where it should not.
struct Accident {
  enum class What { aground, left_truth, truth_ended } what{};
  GeoPoint at;
  double t_s{};  ///< epoch seconds
  [[nodiscard]] std::string message() const;
  friend bool operator==(const Accident&, const Accident&) = default;
};

/// Mean motion of one dive, as only the simulator knows it.
struct DiveTruth {
  Current water;    ///< time-weighted mean of the true current met
  Heading heading;  ///< direction of the mean velocity through water
};

/// True motion in the true ocean: midpoint steps of one navigation cycle with the metric at the current latitude.
///
/// A dive is a yo-yo: down to dive_depth, up to climb_to, and so on, with a last climb that reaches the surface exactly
/// when the dive is over; the current is asked at that depth (a two-dimensional truth ignores it). On the surface the
/// glider drifts with the truth's surface current plus leeway.
///
/// With a coastline the coastline alone is land, and water in which the truth has no value carries the glider with the
/// last current met; without one the truth's own land grounds it. Leaving the truth's area or time ends the run.
class Dynamics {
 public:
  /// Truth and chart must outlive this object.
  Dynamics(Hull hull, ocean::Ocean truth, const chart::Chart& chart) : hull_{hull}, truth_{truth}, chart_{&chart} {}

  /// Puts the glider on the surface.
  void place(GeoPoint at, double t_s);
  void begin_dive();
  /// `dt` seconds under water with a wanted heading; `remaining` seconds of the dive are left before this step.
  std::optional<Accident> swim(Heading wanted, double dt, double remaining);
  /// Drifts until epoch second `until_s`, in steps of at most a minute.
  std::optional<Accident> drift(double until_s);

  [[nodiscard]] GeoPoint position() const { return GeoPoint::from_kernel(lat_, lon_); }
  [[nodiscard]] double time_s() const { return t_s_; }
  [[nodiscard]] Metres depth() const { return Metres{depth_}; }
  [[nodiscard]] Metres deepest() const { return Metres{deepest_}; }
  [[nodiscard]] DiveTruth dive_truth() const;

 private:
  [[nodiscard]] std::optional<Accident> current_at(const ocean::FieldRef& field, double lat, double lon, double depth,
                                                   double t_s, Current& into);
  [[nodiscard]] std::optional<Accident> move(const ocean::FieldRef& field, double east, double north, double dt,
                                             double sink);
  void turn(double remaining, double dt);

  Hull hull_;
  ocean::Ocean truth_;
  const chart::Chart* chart_;
  double lat_{}, lon_{}, t_s_{}, depth_{}, deepest_{};
  bool down_{};
  Current last_;
  double swum_s_{}, sum_east_{}, sum_north_{}, water_east_{}, water_north_{};
};

}  // namespace glidehelm::simulator
