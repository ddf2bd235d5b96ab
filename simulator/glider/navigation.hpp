#pragma once

#include <optional>

#include "core/base/current.hpp"
#include "core/base/geo.hpp"
#include "core/base/time.hpp"
#include "simulator/glider/list_reader.hpp"

namespace glidehelm::simulator {

/// What a glider believes of itself.
struct Belief {
  MetresPerSecond speed{0.3};  ///< Û, horizontal through water (m_avg_speed)
  int correction{1};           ///< u_use_current_correction: 0 reckons without currents, 1 with the last measured one
};

/// The glider's own law (product.md 6; slocum.md 4.1, 4.4): every cycle dead reckoning from the dive point, then aim.
///
///   hit:   dead-reckoned distance < list_when_wpt_dist → next waypoint, as often as needed within one cycle
///   aim:   heading = bearing − asin(cross/Û), cross = believed current to the right of the bearing
///   reckon: position += (Û·heading + believed current)·dt
///
/// When the cross current reaches Û the arcsine has no value and what the firmware does is unknown (slocum.md 6.5);
/// here the sine is clamped to ±1: the glider points square to the bearing, against the cross current.
/// After the last waypoint of a list that ends (−2 or N legs) the last heading is held; with end_action 0 `quit()`
/// tells that the mission is over.
///
/// list_stop_when 15 hits where the reckoned distance is *greater* than list_when_wpt_dist, 5 never: the first waypoint is
/// steered to for ever.
///
/// Works in true directions: the rotated local frame appears only where the dialog prints (frame.hpp). That is exact
/// because the frame turns bearing, current and heading alike.
class Navigator {
 public:
  explicit Navigator(Belief belief) : belief_{belief} {}

  /// A list is read (start of the mission, or Ctrl-F): steering starts at its initial_wpt, seen from `here`.
  void read(GotoList list, GeoPoint here, double now_s);
  /// Dead reckoning starts here; `measured` is the last depth-averaged current, used with correction 1 only.
  void dive(GeoPoint at, double now_s, Current measured);
  /// One cycle of `dt` seconds from epoch second `now_s`: hits, aims, reckons. Returns the heading to hold for `dt`.
  /// `speed_now` is what it reckons with when it measures its speed; the aim always takes the believed one.
  Heading cycle(double now_s, double dt, std::optional<MetresPerSecond> speed_now = std::nullopt);
  /// Û from now on (m_avg_speed).
  void believe(MetresPerSecond speed) { belief_.speed = speed; }

  [[nodiscard]] GeoPoint reckoned() const { return GeoPoint::from_kernel(lat_, lon_); }
  /// The current that dead reckoning uses in this dive: zero with correction 0.
  [[nodiscard]] Current used() const { return used_; }
  [[nodiscard]] const GotoList& list() const { return list_; }
  [[nodiscard]] int target() const { return target_; }
  [[nodiscard]] GeoPoint waypoint() const { return list_.waypoints[static_cast<std::size_t>(target_)]; }
  [[nodiscard]] double waypoint_since_s() const { return since_s_; }
  [[nodiscard]] std::optional<GeoPoint> last_achieved() const { return achieved_; }
  [[nodiscard]] double last_achieved_s() const { return achieved_s_; }
  [[nodiscard]] int hits() const { return hits_; }
  [[nodiscard]] bool ended() const { return ended_; }
  [[nodiscard]] bool quit() const { return ended_ && list_.end_action == 0; }
  [[nodiscard]] Belief belief() const { return belief_; }

 private:
  [[nodiscard]] int first_target(GeoPoint here) const;
  [[nodiscard]] bool is_hit(GeoPoint goal) const;
  void hit_all(double now_s);

  Belief belief_;
  GotoList list_;
  Current used_;
  int target_{}, legs_left_{-1}, hits_{};
  bool ended_{};
  double lat_{}, lon_{}, since_s_{}, achieved_s_{};
  std::optional<GeoPoint> achieved_;
  Heading heading_;
};

/// The aim law by itself: the heading towards `bearing` for a believed current and speed.
Heading aim(Bearing bearing, Current believed, MetresPerSecond speed);

}  // namespace glidehelm::simulator
