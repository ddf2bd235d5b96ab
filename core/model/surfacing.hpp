#pragma once

#include <compare>
#include <map>
#include <optional>
#include <string>

#include "core/base/geo.hpp"
#include "core/base/time.hpp"

/// What the rooms say to each other: plain values without algorithms.
namespace glidehelm::model {

/// A velocity in the glider's rotated local frame (LMC: UTM grid turned by the magnetic variation): not a `Current`.
/// Only core/mission/learning turns it into one.
struct LocalVelocity {
  MetresPerSecond x, y;
  friend constexpr auto operator<=>(const LocalVelocity&, const LocalVelocity&) = default;
};

/// The dialog's `Waypoint:` line: what the glider steers to. Range and bearing are the glider's own, in its rotated
/// frame.
struct AimLine {
  GeoPoint at;
  Metres range;
  double bearing_deg{};
  friend constexpr auto operator<=>(const AimLine&, const AimLine&) = default;
};

/// Why the glider came up: `Because:TEXT [behavior NAME start_when = X]`. Never an exhaustive list.
struct SurfaceReason {
  std::string text, behavior;
  double start_when{};
  friend auto operator<=>(const SurfaceReason&, const SurfaceReason&) = default;
};

/// A surfacing that passed the rules of slocum.md 6.2 that need no memory (S1–S4, S7): one fresh, complete GPS fix of a
/// named glider, and what the same block said beside it. Duplicates and jumps are the pilot's to judge (S4–S6).
struct Surfacing {
  std::string glider;  ///< lower case
  Instant heard;       ///< our clock when the fix line was complete
  GeoPoint fix;
  Instant fix_taken;  ///< heard − age: our clock, not the glider's
  Seconds fix_age{};
  GliderTime curr_time;            ///< `Curr Time` of the block: identifies the fix together with its age
  std::string lat_ddmm, lon_ddmm;  ///< as printed: equal texts and times within 2 s are the same fix (S4)

  bool at_surface{};    ///< from an at-surface block of a running mission, not only from a connection block
  std::string mission;  ///< as printed, lower case; empty when not printed
  std::string segment;  ///< `MMMM.SSSS`; empty when not printed
  std::optional<SurfaceReason> because;
  std::optional<Seconds> until_diving;  ///< `Time until diving`, counted from `heard`
  std::optional<LocalVelocity> water;   ///< m_water_vx/vy
  bool water_is_final{};                ///< `Water Velocity Calculations COMPLETE` was printed in this block
  std::optional<AimLine> aim;
  std::optional<MetresPerSecond> believed_speed;  ///< m_avg_speed
  std::optional<int> current_correction;          ///< u_use_current_correction
  std::optional<Radians> magnetic_variation;      ///< m_gps_mag_var, positive west
  std::map<std::string, double> sensors;          ///< every sensor with a meaningful value, by name

  friend bool operator==(const Surfacing&, const Surfacing&) = default;
};

/// S4: two prints of one fix. The printed texts are equal and the times of the fix differ by less than 2 s on the
/// glider's clock (`Curr Time` has whole seconds, so the age makes the same fix come out up to a second apart).
/// Compared by difference, never by rounding into bins.
bool same_fix(const Surfacing& a, const Surfacing& b);

/// A fix that is not used: which rule of slocum.md refused it, and why in words a pilot reads.
struct Refusal {
  std::string rule;  ///< "S2", "S3", "S4", "S5", "S6", …
  std::string reason;
  std::string glider;  ///< as far as known
  Instant heard;
  std::string lat_ddmm, lon_ddmm;
  friend bool operator==(const Refusal&, const Refusal&) = default;
};

}  // namespace glidehelm::model
