#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/planning/planner.hpp"

/// The certificate: how early any vehicle could arrive.
namespace glidehelm::planning {

/// Where the front was at an instant: closed lines, the outline of what can have been reached and one round each hole in it.
struct Isochrone {
  double t_s{};  ///< epoch seconds, a surfacing
  std::vector<std::vector<GeoPoint>> lines;
};

/// What can be said about the earliest arrival of a vehicle with the problem's speed and dive schedule, in the same currents
/// and the same water, that may change heading at every instant.
struct Bound {
  enum class Kind {
    arrival,      ///< none arrives earlier than `travel_s`
    unreachable,  ///< none arrives before the horizon, not even with the speed raised by `kSpeedBar`
    cut           ///< stopped before there was an answer
  };
  Kind kind{Kind::cut};
  double travel_s{};   ///< seconds from the fix, error already subtracted; of `unreachable` and `cut` NaN
  double error_s{};    ///< what was subtracted
  std::string reason;  ///< in words, unless it is an arrival
  std::vector<Isochrone> isochrones;
  Statistics statistics;       ///< `expansions`: steps of markers
  std::size_t most_markers{};  ///< that a front had after a step
};

struct BoundSettings {
  Metres spacing{};  ///< of the markers; 0 = 1/130 of the way, between 100 m and 5 km
  Seconds step{};    ///< longest step; 0 = one spacing through still water, at most 1 h
  /// Epoch seconds: an arrival that is known; only earlier ones are looked for closely. A front that comes later has lost a way: no answer.
  double earlier_than_s{1e18};
  int surfacings_per_isochrone{};  ///< 0: none are kept
  /// Calls `body(k)` for every k < count, in any order and at once if it likes, and returns when all have; none: one after the
  /// other. The answer is the same; `Budget::expired` must bear to be asked from several threads.
  std::function<void(std::size_t count, const std::function<void(std::size_t k)>& body)> at_once;
};

/// Share of the speed by which `unreachable` is proven beyond: the error that the bound is held to.
inline constexpr double kSpeedBar = 0.005;

/// The earliest arrival by the front of what can be reached (front.hpp, docs/decisions/022).
///
/// Computed three times, with steps and spacings of 1, 1.5 and 2. Every marker is where a vehicle can be, so a front that has lost a way is
/// late, never early: the earliest of the three counts. The method is of second order: where all three go the same way, the finest is
/// late by e and the next by 2.25 e. Twice the difference of the two earliest, 2.5 e then, and `kLeastError` of the time are the
/// error bar, and `travel_s` has it subtracted. Where the front met coasts or borders of areas, which it walks round
/// (wall_walk.hpp), its shortest edge there, 0.15 of the spacing, is subtracted as well. Behind other walls it is late by a few
/// spacings: where it met shallows, or the field's own land or water without data, the time of six spacings comes on top, but no more than
/// the detour that these walls cost (another run, without chart and with the dry places flooded, tells), and one spacing for places that are flooded. Passages between coasts down to
/// some 20 m are gone through whatever the spacing; one between other walls may be lost when it is narrower than a spacing. Where
/// the goal stays unreached by all three the front is moved again with the speed raised by `kSpeedBar`, and only when that does not reach
/// it either it is `unreachable`.
///
/// A known arrival stops the markers that cannot reach the goal within 2 % after it; a front that comes later (round corners) is moved
/// again with 10 %.
///
/// `budget.work` counts steps of markers, in each run and over all of them; beyond it, and with `expired`, the answer is `cut`. The
/// failures are those of `check_ends`. For 650 km 10^5 to 10^6 steps of markers, 0.5 µs each in open water, 1 to 2 µs among islands.
Expected<Bound, PlanFailure> lower_bound(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart,
                                         const Budget& budget, const BoundSettings& settings = {});
inline constexpr double kLeastError = 5e-4;

/// The earliest arrival of one run, not certified: seconds from the fix, NaN when the goal is not reached. For tests of the
/// order.
double front_arrival(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Metres spacing,
                     Seconds step);

}  // namespace glidehelm::planning
