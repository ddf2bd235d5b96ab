#pragma once

#include <optional>

#include "core/planning/planner.hpp"
#include "core/vehicle/steering.hpp"

namespace glidehelm::planning {

/// What became of a plan under the glider's own law.
struct RefinedFlight {
  std::optional<vehicle::FlownList> flown;  ///< the earliest flight that was found; none: none is earlier than the plan
  Statistics statistics;
  bool cut{};  ///< the clock ended it
};

/// Improves the headings of a plan that reaches the goal as it is flown: by lists, one at each surfacing (vehicle::fly_helm).
///
/// refine() polishes held headings, and the law leaves them for the last minutes of each stint. Where neighbouring ways part, a flight drifts off
/// what was polished and is kept to it by force. So here the way that is improved is the flight itself: links are measured around its own
/// surfacings with held headings (they differ from the law's by about a hundredth), and each step that they ask for is flown by the law, with the
/// feedback on where the glider really dives. A step counts only when that flight arrives earlier, so the answer is never worse. Refined flights keep
/// half a per cent of a stint's way beyond the coastal margin, for the verifier's own integrator; a plan that is nearer to land is left alone.
///
/// A step is flown only where its quadratics promise a gain worth having and no more than a tenth of the travel time. A round is thirteen lanes for
/// each stint and up to three dozen flights, few away from land; `Budget::work` counts rounds. Deterministic.
RefinedFlight refine_flown(const Plan& plan, const Problem& problem, const ocean::Ocean& ocean,
                           const chart::Chart& chart, const Budget& budget);

}  // namespace glidehelm::planning
