#pragma once

#include <array>

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// What became of each lane of a held flight.
struct HeldLanes {
  ocean::Lanes at;                                   ///< where the lanes are; `lost` also holds kAground and kArrived
  std::array<double, ocean::Lanes::kMax> arrival_s;  ///< epoch second of the entry into the goal's disc; kNever
  std::array<double, ocean::Lanes::kMax> toll;       ///< metres: what nearness to land has cost so far
  std::array<double, ocean::Lanes::kMax> to_goal;    ///< metres to the goal's disc, at least

  static constexpr std::uint8_t kAground = 200, kArrived = 201;  // beside ocean::NoCurrent
  static constexpr double kNever = 1e18;
  /// Lanes 0 … count − 1 all at one place, with nothing told of them.
  void begin(int count, double lat, double lon);
  [[nodiscard]] bool flies(std::size_t k) const { return at.lost[k] == 0; }
};

/// Flies held headings on lanes with fixed steps: the dynamics that refinement improves a plan under. Smooth in headings and
/// places wherever the field is, and the same for all lanes, so that differences between lanes are derivatives.
///
/// The step is vehicle::lane_step with a tolerance of 2e-4 of the way. Land is looked at along every step: a lane that comes
/// within `margin` is aground, one that comes within `margin` + `buffer` pays toll for every metre that it goes there: half a metre at
/// the margin, falling to nothing at the outer edge with the square of the distance from it.
class HeldFlight {
 public:
  HeldFlight(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Metres margin);

  /// Drifts before stint `k` and dives in it on each lane's own heading (`headings`, one for each lane), but not beyond
  /// `until_s` (epoch seconds). With `strict` a lane that enters the goal's disc, or runs aground, stays where its step
  /// ended; without, it flies on, and toll goes on growing inside the margin: so that differences stay smooth.
  void fly(HeldLanes& lanes, int k, const std::array<double, ocean::Lanes::kMax>& headings, double until_s,
           bool strict);

  /// How far beyond the margin toll is paid; 0 (the default): nowhere.
  void set_buffer(Metres buffer) { buffer_ = buffer.si(); }
  /// Distance to the goal's centre.
  [[nodiscard]] double to_goal(double lat, double lon) const { return vehicle::distance_near(lat, lon, goal_); }
  /// Epoch second of the dive of stint `k`.
  [[nodiscard]] double dive_s(int k) const { return problem_.start.fix_s + problem_.schedule.dive_time(k).count(); }
  [[nodiscard]] const vehicle::Disc& goal() const { return goal_; }
  [[nodiscard]] std::uint64_t evaluations() const { return evaluations_; }

 private:
  void leg(HeldLanes& lanes, ocean::FieldRef field, double from_s, double seconds, double until_s, double longest_step,
           bool strict);
  void look_at_land(HeldLanes& lanes, double dt, bool strict);
  /// Toll of the straight way between two near places; negative when it comes within the margin.
  [[nodiscard]] double toll(double lat0, double lon0, double lat1, double lon1, bool strict) const;
  void look_for_goal(HeldLanes& lanes, double from_s, double dt);

  const Problem& problem_;
  ocean::Ocean ocean_;
  const chart::Chart& chart_;
  vehicle::Disc goal_;
  double margin_, buffer_{}, step_, fastest_;  ///< `fastest_`: over ground, m/s
  std::array<double, ocean::Lanes::kMax> lat_before_{}, lon_before_{};
  std::uint64_t evaluations_{};
};

}  // namespace glidehelm::planning
