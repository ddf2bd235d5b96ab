#pragma once

#include <optional>
#include <string>

#include "core/base/units.hpp"

namespace glidehelm::simulator {

/// Why a glider is on the surface, as its dialog says it: `Because:TEXT [behavior NAME start_when = N.N]`.
struct Because {
  std::string text, behavior;
  double start_when{};
  friend bool operator==(const Because&, const Because&) = default;
};

/// The surface behaviours of its mission (slocum.md 1.4 and 2.6). Texts not seen in any dialog ("heading not commanded")
/// follow the pattern of those that were. Names are the places in the simulated mission file.
namespace because {
inline const Because kYoIsOver{"pitch not commanded", "surface_4", 2.0};
inline const Because kHeadingIdle{"heading not commanded", "surface_3", 3.0};
inline const Because kHitWaypoint{"Hit a waypoint", "surface_5", 8.0};
inline const Because kTimer{"timeout expired", "surface_6", 9.0};
inline const Because kNoComms{"no comms for a while", "surface_2", 12.0};
}  // namespace because

/// When a glider comes up. Whatever says so first brings it up; the climb takes its time.
struct SurfaceRules {
  std::optional<int> half_cycles;  ///< the yo runs out (instead of the schedule's stint); an odd number ends at depth
  std::optional<double> every_s;   ///< since the dive: the climb begins then
  std::optional<double>
      no_comms_s;      ///< since the last call that came through, or since it last came up for this reason
  bool at_waypoint{};  ///< when one is hit
  enum class Idle {
    quit,                      ///< comes up when the list is through, and the mission ends (surface end_action 0)
    resume,                    ///< comes up once, and dives again with the last heading held
    ignore,                    ///< no such behaviour: the last heading is held
  } heading_idle{Idle::quit};  ///< when a list ends with end_action 0; with 6 goto_list waits and heading is not idle
  friend bool operator==(const SurfaceRules&, const SurfaceRules&) = default;
};

/// What ends a mission before its time, and what follows.
struct AbortRules {
  std::optional<Metres> max_wpt_distance;  ///< abend: reckoned distance to the waypoint (slocum.md 2.7)
  std::optional<Metres> overdepth;         ///< deeper than this
  int fallback_calls{0};  ///< after an abort: so many more calls from the surface in lastgasp.mi; 0: the run ends
  double fallback_every_s{3600};  ///< between two of them
  friend bool operator==(const AbortRules&, const AbortRules&) = default;
};

/// A mission's end by its own fault.
struct Abort {
  std::string cause;  ///< as the abort history names it
  int code{};         ///< 0: not known to us
  std::string details;
  double at_s{};
  [[nodiscard]] std::string message() const {
    return cause + (code > 0 ? "(" + std::to_string(code) + ")" : "") + (details.empty() ? "" : ": " + details);
  }
};

}  // namespace glidehelm::simulator
