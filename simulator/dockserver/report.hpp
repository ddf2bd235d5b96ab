#pragma once

#include "simulator/dockserver/dialog_writer.hpp"
#include "simulator/glider/behaviours.hpp"

namespace glidehelm::simulator {

/// What a glider on the surface says of itself at epoch second `now_s`, with `dives_in_s` seconds left in its keystroke
/// window. Positions and fix are the last ones taken (during a call there is no new fix, slocum.md 4.6); the currents
/// and the waypoint bearing are in its rotated frame. Battery and vacuum drain linearly with mission time: plausible
/// numbers that nothing depends on.
Report report_of(const Glider& glider, double now_s, double dives_in_s);

}  // namespace glidehelm::simulator
