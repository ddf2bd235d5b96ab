#pragma once

#include <string>

#include "core/base/expected.hpp"
#include "core/model/surfacing.hpp"
#include "protocol/surface_block.hpp"

namespace glidehelm::protocol {

/// What a fix is measured against.
struct Limits {
  std::string glider;             ///< the configured name, compared without case; empty: any
  Seconds max_age{1200};          ///< of the fix
  Seconds max_water_age{86'400};  ///< one segment: an older m_water_vx/vy is of another dive
  friend bool operator==(const Limits&, const Limits&) = default;
};

/// Turns what the glider said into a surfacing, by the rules of slocum.md 6.2 that need no memory, or says which rule
/// refuses it and why, in words for a pilot:
///
///   S2  no vehicle name, or another glider's
///   S8  printed at a GliderDos or GliderLAB prompt: a position report, not a surfacing of a mission
///   R7  the `GPS Location` line was damaged
///   S3  never had a fix (69696969); no `Curr Time` in the block; an age beyond the limit, below −5 s or 1e+308;
///       letters other than N and E (S and W only before an unsigned number, which they negate); 60 minutes or
///       more; out of range; 0°/0°
///
/// They are tried in this order. Duplicates (S4), jumps (S5) and unchanged fixes (S6) need memory and are the pilot's.
///
/// Of the rest of the block only what is meaningful is taken over (slocum.md 1.2, S7): the water velocity when both
/// components are younger than a segment and not beyond 2.8 m/s (u_max_water_speed), of a dialog without m_water_vx/vy the
/// m_final_water of a completed calculation, else m_initial_water; `m_avg_speed` between 0.01 and 3
/// m/s; `m_gps_mag_var` and every other sensor only when it was ever updated, except the constants `u_…` and the
/// commands `c_…`, whose value holds without an age (`c_wpt_lat` and `c_wpt_lon` are 0 then and left out).
Expected<model::Surfacing, model::Refusal> accept_fix(const SurfaceBlock& block, const Limits& limits);
/// Everything of a surfacing but the fix itself: mission, reason, window, water, waypoint and sensors, also of a block
/// whose fix is refused.
model::Surfacing facts_beside_fix(const SurfaceBlock& block, const Limits& limits);
/// `accept_fix` with the usual limits.
Expected<model::Surfacing, model::Refusal> accept_fix(const SurfaceBlock& block, const std::string& glider);

}  // namespace glidehelm::protocol
