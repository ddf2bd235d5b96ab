#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/geo.hpp"

namespace glidehelm::simulator {

/// A goto list as the glider holds it. A b_arg that the file leaves out takes the masterdata default, never the value
/// of an earlier file (slocum.md 2.2).
struct GotoList {
  std::vector<GeoPoint> waypoints;
  Metres radius{10};  ///< list_when_wpt_dist: dead-reckoned distance below which a waypoint is hit
  int legs{-1};       ///< num_legs_to_run: −1 loop for ever, −2 the list once, N exactly N legs
  int initial{-2};    ///< initial_wpt: −2 closest, −1 one after the last achieved, 0…N−1 index
  int start_when{0};  ///< 0 at once; 1, 2 and 4 wait for an idle that never comes under a yo: the list is not flown
  int stop_when{7};   ///< list_stop_when; only 7 (within distance) ever hits a waypoint here
  int end_action{0};  ///< 0 quit (ends the mission), 6 wait for Ctrl-F
  int declared{0};    ///< num_waypoints as written; the listed ones are flown
  friend bool operator==(const GotoList&, const GotoList&) = default;
};

/// The behaviour went into its error state: on a real glider this ends the mission (MS_ABORT_BEH_ERROR, slocum.md 2.7).
struct BehaviourError {
  int line{};
  std::string reason;
  [[nodiscard]] std::string message() const { return "line " + std::to_string(line) + ": " + reason; }
  friend bool operator==(const BehaviourError&, const BehaviourError&) = default;
};

/// Reads a `goto_lNN.ma` by slocum.md 2.1 and 2.2, as strictly as the firmware is said to be: an unknown or repeated
/// b_arg, a value outside its masterdata range, no waypoint or more than eight, a position that is none: each is a
/// behaviour error. The unit in brackets is decoration. A wrong `num_waypoints` flies (masterdata: ignored in files).
/// The primary_ b_args of firmware 8 and later are read and not flown: the last waypoint is no station here.
/// This reader shares nothing with protocol/ nor with the verifier's, so that one's mistake shows at the other.
Expected<GotoList, BehaviourError> read_goto_list(std::string_view bytes);

}  // namespace glidehelm::simulator
