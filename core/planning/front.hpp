#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/chart/chart.hpp"
#include "core/ocean/field.hpp"
#include "core/planning/wall_walk.hpp"
#include "core/planning/winding.hpp"
#include "core/vehicle/motion.hpp"

namespace glidehelm::planning {

/// The boundary of what a vehicle can have reached that is free to change its heading at every instant.
///
/// A closed clockwise polygon of markers, with a loop for each hole in it. Each follows Zermelo's extremal (Zermelo 1931; Bryson & Ho 1975, 2.7):
/// dx/dt = c(x, t) + U·n with n normal to the front. A step holds the heading that the marker will have at its middle, and
/// carries a second place, `kBeside` along the front: the line between the two ends gives the new normal, (Dφ)⁻ᵀn, so no
/// gradient of the field is asked for. Second order in the step. Drifting is the same with U = 0. Nothing depends on |c| < U.
///
/// Every marker is where the vehicle can be (one that is stuck at a wall may stay longer than a current would let it: early, never
/// late); the earliest arrival is not missed as long as the polygon covers the boundary. Hence three rules:
/// - `refine`: edges longer than `spacing`, or that turn much, get markers on the cubic that has the ends' normals
///   (fourth order in the spacing).
/// - `prune`: swallowtails grow without limit and are cut. A place about which the polygon winds is reached (the degree of
///   the map from slower vehicles' extremals to the plane); a marker is dropped when that holds all round it (winding.hpp). What is cut
///   off is inside for good: from inside the set no motion leads to its boundary. The pieces that are left are closed where they cross
///   each other (front_loops.hpp): edges across the reached set would, as it bends, sweep water nobody has reached, and what is dropped
///   there is lost.
/// - coasts (borders of the chart): a marker that meets one becomes two that walk along it, one to each side (wall_walk.hpp),
///   and each is the front's end there until it meets the next one on the same wall. So a front goes round corners and
///   through straits of any width, and is of second order there too. A walker leaves markers behind, which stay: the
///   polygon keeps the shape of the coast. Near coasts edges are shorter (`spacing_near`).
/// - other walls (land that only the field knows, water without data, shallows): a marker that would leave the water stays, and
///   the first in each half spacing of wall sends headings to all sides; those that run along the wall or round its end carry the
///   front on, late by a few spacings.
/// What is stuck stays also where a current would tear it off: too early, not too late.
///
/// Radians, metres, seconds, m/s. Deterministic. One step costs eight current evaluations per marker.
class Front {
 public:
  static constexpr double kBeside = 10.0;             ///< metres
  static constexpr std::size_t kMostMarkers = 60000;  ///< more are not refined; `complete` is false from then on

  /// All headings at one place. `spacing` in metres; `clearance` from land and borders is kept.
  Front(GeoPoint at, ocean::FieldRef dive, const chart::Chart& chart, double clearance, double spacing);

  /// Moves all markers by one step with `speed` through water (0 drifts). Returns the seconds after `t_s` at which the front
  /// first enters `goal`, if it does within this step. `retry`: markers at walls try to leave them.
  std::optional<double> advance(ocean::FieldRef field, double speed, double t_s, double dt, const vehicle::Disc& goal,
                                bool retry);
  void refine();
  /// To be called after each step: the pieces that are left are joined anew while their ends still lie beside each other. `t_s`: epoch
  /// seconds at which the end of the data is looked for.
  void prune(double t_s);
  /// Stops the markers (radians) for which `useless` holds: they stay where they are for good.
  void stop(const std::function<bool(double lat, double lon)>& useless);
  [[nodiscard]] const std::vector<Marker>& markers() const { return markers_; }
  [[nodiscard]] bool complete() const { return complete_; }
  [[nodiscard]] bool met_coast() const { return met_coast_; }  ///< or the border of an area
  /// Another wall of the chart, on which there is no walking: shallow water.
  [[nodiscard]] bool met_shallows() const { return met_shallows_; }
  /// A wall that the field itself has: its mask, or water without data. Its border (a convex box) and its end in time are none.
  [[nodiscard]] bool met_dry() const { return met_dry_; }
  [[nodiscard]] std::size_t evaluations() const { return evaluations_ + walk_.evaluations(); }

 private:
  static constexpr double kFinest = 0.15;  ///< of the spacing: edges beside coasts

  void move(ocean::FieldRef field, double speed, double t_s, double dt, std::span<Marker* const> moving);
  void graze(ocean::FieldRef field, double speed, double t_s, double dt);
  [[nodiscard]] bool water_between(const Marker& a, const Marker& b) const;
  void settle(Marker& m, const Marker& before, ocean::FieldRef field, double speed, double t_s, double dt,
              std::uint8_t lost);
  std::vector<bool> deep(double t_s, std::vector<bool> asked);
  void rest_inside(double t_s);
  void keep_walls(std::span<const Marker> run, bool cut, std::vector<Marker>& kept);
  [[nodiscard]] bool is_spot(std::span<const Marker> coast) const;
  bool blocked(std::int64_t row, std::int64_t column, double t_s);
  bool fan_out();
  void walk(ocean::FieldRef field, double speed, double t_s, double dt);
  std::optional<double> send_off(ocean::FieldRef field, double speed, double t_s, double dt, const vehicle::Disc& goal);
  void walk_one(std::size_t i, WallWalk::Way way, ocean::FieldRef field, double speed, double t_s, double dt);
  [[nodiscard]] bool has_passed(const Marker& walker, const Marker& m) const;
  void part_at_coasts(ocean::FieldRef field, double speed, double t_s, double dt);
  [[nodiscard]] double spacing_near(double lat, double lon) const;
  [[nodiscard]] std::int64_t wall_cell(const Marker& m) const;
  [[nodiscard]] bool spare(const Marker& last, const Marker& m, const Marker& next) const;
  void creep(const Marker& a, const Marker& b, std::vector<Marker>& out);
  void add_between(const Marker& a, const Marker& b, std::vector<Marker>& out);
  [[nodiscard]] bool clear_way(const Marker& from, double lat, double lon) const;
  [[nodiscard]] std::optional<double> entry(const vehicle::Disc& goal, double dt, double reach);

  ocean::FieldRef dive_;
  const chart::Chart& chart_;
  double clearance_, spacing_;
  WallWalk walk_;
  Squares lattice_;                                 ///< of half the spacing
  std::unordered_map<std::int64_t, bool> blocked_;  ///< middles of its cells; only asked, never walked through
  std::vector<Marker> markers_, before_;
  std::vector<Marker*> moving_;
  struct Sent {
    std::size_t from;  ///< the walker
    bool forward;
    std::vector<Marker> markers;
  };
  std::vector<Sent> sent_;                           ///< by walkers in this step, by their order
  std::unordered_set<std::int64_t> walls_, creeps_;  ///< cells that have sent; only asked, never walked through
  double room_{};  ///< metres that nothing can have come nearer than to the goal's disc
  bool met_coast_{}, met_shallows_{}, met_dry_{};
  unsigned steps_{};
  bool complete_{true};
  std::size_t evaluations_{};
};

}  // namespace glidehelm::planning
