#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/chart/chart.hpp"
#include "core/planning/cts_astar.hpp"
#include "core/planning/envelope.hpp"
#include "core/vehicle/motion.hpp"

namespace glidehelm::planning {

/// The headings of one expansion of CTS-A*, flown in lockstep: drifts and dives, land and goal on the way (cts_astar.hpp).
///
/// Clearance is kept per lane and spent by the distance flown, so the chart is only asked near land. Radians, metres, seconds from
/// the fix. No allocation.
class CtsLanes {
 public:
  /// `margin`: clearance that is kept, unless a start lies within it. `reach`: speeds that no lane can exceed.
  CtsLanes(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, double margin,
           const Envelope& reach);

  struct Place {
    double lat{}, lon{};
    double margin{};  ///< clearance that it keeps
    double room{};    ///< lower bound of the clearance that it has
  };
  /// One lane at rest.
  void begin(const Place& place);
  /// Makes lane k one that starts at a place with a velocity through water; `heading` is its number in the expansion.
  void put(std::size_t k, const Place& place, double east, double north, std::uint16_t heading);
  void resize(int count) { lanes_.count = count; }
  [[nodiscard]] int count() const { return lanes_.count; }
  [[nodiscard]] Place at(std::size_t k) const { return {lanes_.lat[k], lanes_.lon[k], margins_[k], rooms_[k]}; }
  [[nodiscard]] std::uint16_t heading(std::size_t k) const { return which_[k]; }
  [[nodiscard]] bool lost(std::size_t k) const { return lanes_.lost[k] != 0; }
  /// Lane `from` becomes lane `to` ≤ `from`.
  void move(std::size_t from, std::size_t to);
  void drop_lost();

  /// The first crossing of the goal's radius.
  struct Entry {
    double t{};
    std::uint16_t heading{};
  };
  /// The surface interval before `stint`, for all lanes. The goal is only looked for when it is near.
  std::optional<Entry> drift(int stint, bool goal_near);
  /// One stint on every lane: land and goal are looked at after every integration step.
  std::optional<Entry> fly(int stint, bool goal_near);

  /// The clearance that is kept from a place on: less than the margin where the place itself has less. A metre is let go.
  [[nodiscard]] double margin_at(double lat, double lon) const;
  [[nodiscard]] const Statistics& statistics() const { return statistics_; }
  void count_evaluation() { ++statistics_.current_evaluations; }
  [[nodiscard]] CtsSearch::Stopped stopped() const { return stopped_; }
  [[nodiscard]] double step() const { return step_; }

 private:
  using PerLane = std::array<double, ocean::Lanes::kMax>;

  void remember_places();
  bool spend_room(double way);
  void check_land(double way);
  void check_land_closely(std::size_t k);
  void check_goal(double t0, double dt, std::optional<Entry>& first);
  void note_lost();

  const Problem& problem_;
  const ocean::Ocean& ocean_;
  const chart::Chart& chart_;
  vehicle::Disc goal_;
  double margin_;
  Envelope reach_;
  double step_;
  ocean::Lanes lanes_{};
  PerLane lat_before_{}, lon_before_{};
  PerLane east_kept_{}, north_kept_{};
  PerLane margins_{}, rooms_{};
  std::array<std::uint16_t, ocean::Lanes::kMax> which_{};
  Statistics statistics_;
  CtsSearch::Stopped stopped_;
};

}  // namespace glidehelm::planning
