#pragma once

#include <optional>
#include <string>

#include "core/base/current.hpp"
#include "core/base/geo.hpp"
#include "core/chart/chart.hpp"
#include "core/ocean/field.hpp"
#include "simulator/glider/flight.hpp"
#include "simulator/glider/seabed.hpp"

namespace glidehelm::simulator {

/// The glider as it truly is; what it believes of itself is `Belief`.
struct Hull {
  MetresPerSecond speed{0.3};        ///< horizontal, through water
  Radians glide_angle{degrees(26)};  ///< of the path below the horizon: the vertical speed is speed·tan
  Metres dive_depth{200};            ///< lower turning depth of the yo
  Metres climb_to{20};               ///< upper turning depth of inner yos
  Radians heading_bias{};            ///< clockwise: the true heading is the wanted one plus this
  Current leeway;                    ///< added to the surface current while drifting (wind)
  std::optional<Body> body;   ///< force balance: speed and angle of each leg come from it, not from the two above
  double fouling_per_day{};   ///< share of the speed along the path that growth on the hull takes each day; angle kept
  Metres target_altitude{5};  ///< d_target_altitude: a dive turns at this height above the floor; negative: never
  Metres altimeter_range{100};  ///< farther away the floor is not heard
  SeabedSpec seabed;
};

/// Why a glider's way ended where it should not.
struct Accident {
  enum class What { aground, left_truth, truth_ended, sank } what{};
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

/// One leg of a yo at a depth: sizes. `horizontal`, `vertical` and `path` always belong together.
struct Leg {
  double horizontal{}, vertical{};  ///< m/s
  double path{};                    ///< rad, below or above the horizon
};

/// What a dive is told before it begins.
struct DiveOrders {
  std::optional<int> half_cycles;  ///< num_half_cycles_to_do: then it comes up; none: until the time is over
  bool altimeter{true};            ///< false: it hears no floor
};

/// True motion in the true ocean: midpoint steps of one navigation cycle with the metric at the current latitude.
///
/// A dive is a yo-yo: down to dive_depth, up to climb_to, and so on, with a last climb that reaches the surface exactly
/// when the dive is over; the current is asked at that depth (a two-dimensional truth ignores it). On the surface the
/// glider drifts with the truth's surface current plus leeway.
///
/// Two models: the point model has one speed and one angle; with a `Body` each leg flies the steady balance of forces at
/// its depth (flight.hpp), down and up differ, and a dive that floats turns up there. Growth on the hull takes
/// (1 − fouling)^days of the speed in both.
///
/// A floor turns the yo at the target altitude when the altimeter hears it. Otherwise the glider touches the floor, slides
/// up with it and turns; a floor that reaches the surface grounds it.
///
/// With a coastline the coastline alone is land, and water in which the truth has no value carries the glider with the
/// last current met; without one the truth's own land grounds it. Leaving the truth's area or time ends the run.
class Dynamics {
 public:
  /// Truth and chart must outlive this object.
  Dynamics(Hull hull, ocean::Ocean truth, const chart::Chart& chart);

  /// Puts the glider on the surface, with a clean hull.
  void place(GeoPoint at, double t_s);
  void begin_dive(const DiveOrders& orders = {});
  /// The last climb begins: no more turns until the surface.
  void come_up() { coming_up_ = true; }
  /// `dt` seconds under water with a wanted heading; `remaining` seconds of the dive are left before this step.
  std::optional<Accident> swim(Heading wanted, double dt, double remaining);
  /// Leeway from now on.
  void set_leeway(Current leeway) { hull_.leeway = leeway; }
  /// How a leg flies at a depth now; all zero where the buoyancy does not drive it.
  [[nodiscard]] Leg leg(bool down, Metres depth) const;
  /// How the next step flies when no turn comes first.
  [[nodiscard]] Leg leg() const { return leg(down_, Metres{depth_}); }
  /// From the depth in hand to the surface, seconds; infinite when it cannot climb.
  [[nodiscard]] double climb_seconds() const;
  /// The ordered half cycles are done and the glider is on its way up.
  [[nodiscard]] bool yo_is_over() const { return orders_.half_cycles && half_cycles_ >= *orders_.half_cycles; }
  [[nodiscard]] int half_cycles() const { return half_cycles_; }
  /// Lower inflections of this dive, and the sum of their depths: what the pump worked against.
  [[nodiscard]] int pumped() const { return pumped_; }
  [[nodiscard]] Metres pumped_depths() const { return Metres{pumped_depths_}; }
  /// Cycles of this dive in which it lay on the floor.
  [[nodiscard]] int touched() const { return touched_; }
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
  void turn_up();
  void meet_floor();

  Hull hull_;
  ocean::Ocean truth_;
  const chart::Chart* chart_;
  Seabed seabed_;
  Radians attack_dive_, attack_climb_;
  double lat_{}, lon_{}, t_s_{}, clean_s_{}, depth_{}, deepest_{};
  bool down_{}, coming_up_{};
  DiveOrders orders_;
  int half_cycles_{}, pumped_{}, touched_{};
  double pumped_depths_{};
  Current last_;
  double swum_s_{}, sum_east_{}, sum_north_{}, water_east_{}, water_north_{};
};

}  // namespace glidehelm::simulator
