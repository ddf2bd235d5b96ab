#pragma once

#include <vector>

#include "core/base/geo.hpp"

namespace glidehelm::model {

enum class WaypointRole { aim, goal };

struct Waypoint {
  GeoPoint at;
  WaypointRole role{WaypointRole::aim};
  friend constexpr auto operator<=>(const Waypoint&, const Waypoint&) = default;
};

/// What the glider does after the last waypoint (product.md 6).
enum class AtEnd {
  loop,  ///< num_legs_to_run −1: it turns back to the first; the closing leg is flown and judged
  wait,  ///< num_legs_to_run −2 with end_action 6: goto_list waits for Ctrl-F
};

/// A goto list as we mean it: initial_wpt 0, list_stop_when 7, one radius for all points, start_when 0.
struct WaypointList {
  std::vector<Waypoint> points;
  Metres radius;  ///< list_when_wpt_dist: dead-reckoned distance below which a waypoint is hit
  AtEnd at_end{AtEnd::loop};
  friend bool operator==(const WaypointList&, const WaypointList&) = default;
};

}  // namespace glidehelm::model
