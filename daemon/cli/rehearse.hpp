#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "daemon/cli/plan.hpp"

namespace glidehelm::cli {

/// `glidehelm rehearse MISSION.yaml [--truth FILE…] [--seeds N] [--from LAT,LON] [--at TIME] [--method NAME] [--delays H…] [--noise M_PER_S]
/// [--shift KM] [--late H] [--html FILE] [--json]`.
struct RehearseOptions {
  PlanOptions plan;                ///< mission, method, from, at
  std::vector<std::string> truth;  ///< forecast files that play the ocean; empty: the forecast, perturbed
  int seeds{10};
  std::vector<double> delays_h{0.0};  ///< departures that much later
  double noise_m_per_s{0.05};         ///< root mean square speed of eddies that the forecast does not have
  double shift_km{5};                 ///< the truth lies this much elsewhere, in a drawn direction
  double late_h{1};                   ///< the truth happens up to this much earlier or later (drawn)
  std::string html;                   ///< one page that opens offline; empty: none
  bool json{};
  enum class Progress {
    none,
    lines,                     ///< one at every tenth of the flights: for a file or a pipe
    bar,                       ///< drawn over itself: for a terminal
  } progress{Progress::none};  ///< on the error stream
};

/// Flies the real pilot, planner and verifier against the simulator, in one process and no time: for every seed and departure once
/// with the mission's method and once with `direct`, in an ocean that differs from the forecast, with a glider that differs
/// from its description (true speed ±3 %, heading bias ±2°, stints ±3 %, drawn from the seed). Beside each flight stands the
/// plan of somebody who knew that ocean (`regret_to_hindcast` is flown over planned time less one).
///
/// JSON as in product.md 9. `windows_missed` counts surface intervals in which no new list reached the glider; `closest_coast_m` is
/// the smallest distance to the shore on the straight lines from dive to surfacing to dive, within 50 m, and 60 km (as far as
/// a chart looks) when it is farther away. `energy_wh` is the simulator's, from the start to the end of the flight.
/// Nothing is flown when the page could not be written, or when a departure lies outside the forecast.
/// Returns 0 when every flight of the mission's method arrived, 1 when not or when there is nothing to fly, 2 misuse.
int run_rehearse(const RehearseOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
