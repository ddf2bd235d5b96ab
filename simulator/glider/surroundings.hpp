#pragma once

#include <optional>

#include "core/base/current.hpp"
#include "core/base/geo.hpp"
#include "simulator/fault_plan.hpp"

namespace glidehelm::simulator {

/// A satellite receiver and what may be wrong with its fixes. Faults strike per surfacing (counted from 1).
struct GpsSetup {
  Metres noise{0};    ///< standard deviation of each component of each fix
  FaultPlan stale;    ///< no fix in this surfacing: the dialog prints the one of an earlier surfacing, with its age
  FaultPlan invalid;  ///< a fix that the receiver flags: printed as `GPS Invalid`, and no valid one comes
  FaultPlan far;      ///< a fix that looks valid and is `far_off` away, in a drawn direction
  Metres far_off{30'000};
  friend bool operator==(const GpsSetup&, const GpsSetup&) = default;
};

/// What one surfacing's receiver does.
struct GpsFaults {
  bool stale{}, invalid{}, far{};
  friend bool operator==(const GpsFaults&, const GpsFaults&) = default;
};

/// Draws noise and faults from its own stream: same seed, same fixes.
class Gps {
 public:
  Gps(GpsSetup setup, Random random) : setup_{std::move(setup)}, noise_{random.stream(1)}, luck_{random.stream(2)} {}

  /// Faults of the next surfacing; call once for each.
  GpsFaults next_surfacing();
  /// What it reads at a true position.
  GeoPoint fix(GeoPoint truth);

 private:
  GpsSetup setup_;
  Random noise_, luck_;
  int surfacings_{};
  GpsFaults faults_;
  Bearing far_toward_;
};

/// Wind over the sea, in which a glider on the surface drifts: a mean and gusts with an e-folding time, each component a
/// first-order Gauss–Markov process sampled exactly at the times that are asked for.
struct WindSetup {
  MetresPerSecond speed{0};
  Bearing from{};            ///< as sailors name it: the drift goes the other way
  MetresPerSecond gusts{0};  ///< standard deviation of each component
  double lasting_s{6 * 3600.0};
  double leeway{0.02};  ///< share of the wind with which the glider drifts
  friend bool operator==(const WindSetup&, const WindSetup&) = default;
};

class Wind {
 public:
  Wind(WindSetup setup, Random random) : setup_{setup}, random_{random} {}
  /// The drift it causes at epoch second `t_s`; times must not go back.
  Current leeway(double t_s);

 private:
  WindSetup setup_;
  Random random_;
  std::optional<double> last_s_;
  double east_{}, north_{};
};

}  // namespace glidehelm::simulator
