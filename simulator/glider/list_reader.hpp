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
  int stop_when{7};   ///< list_stop_when: 7 a waypoint is hit within `radius`, 15 beyond it, 5 never
  int end_action{0};  ///< 0 quit (ends the mission), 6 wait for Ctrl-F
  int declared{0};    ///< num_waypoints as written; the listed ones are flown
  friend bool operator==(const GotoList&, const GotoList&) = default;
};

/// The behaviour went into its error state: on a real glider this ends the mission (MS_ABORT_BEH_ERROR, slocum.md 2.7).
struct BehaviourError {
  int line{}, column{};  ///< from 1; column 0: the whole file
  std::string reason;
  [[nodiscard]] std::string message() const {
    return "line " + std::to_string(line) + (column > 0 ? ", column " + std::to_string(column) : "") + ": " + reason;
  }
  friend bool operator==(const BehaviourError&, const BehaviourError&) = default;
};

/// Reads a `goto_lNN.ma` by slocum.md 2.1 and 2.2, as strictly as the firmware is said to be: an unknown or repeated
/// b_arg, a value outside its masterdata range, no waypoint or more than eight, a position that is none: each is a
/// behaviour error. The unit in brackets is decoration. A wrong `num_waypoints` flies (masterdata: ignored in files).
///
/// Some values are allowed on a glider and told by no source beyond their name: when a list starts that waits for an idle
/// stack, pitch or depth controller (start_when 1, 2, 4), when one of these ends a leg (list_stop_when 1, 2), and what the
/// station of firmware 8 and later does (primary_ b_args other than their defaults). They are refused as not simulated,
/// for a list flown by a guess would be trusted.
/// This reader shares nothing with protocol/ nor with the verifier's, so that one's mistake shows at the other.
Expected<GotoList, BehaviourError> read_goto_list(std::string_view bytes);

}  // namespace glidehelm::simulator
