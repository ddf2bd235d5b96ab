#pragma once

#include <functional>
#include <string>

#include "core/mission/event.hpp"
#include "core/planning/lower_bound.hpp"
#include "daemon/ocean_source.hpp"

namespace glidehelm::daemon {

/// Expansions after which a stage of the ladder stops (product.md 4.4: by work, not by the clock).
inline constexpr std::uint64_t kStageWork = 2'000'000;

/// Answers one planning request: planner → headings → list → bytes and promise. Pure but for `expired`; runs on the planning worker, in the
/// command line and in tests.
///
/// `found` is called with every candidate, better ones later. Returns why there was none, or nothing. `work` limits the expansions
/// of each stage.
std::string answer(const mission::PlanningRequest& request, const OceanSource& ocean, const chart::Chart& chart,
                   const std::function<bool()>& expired, const std::function<void(mission::Candidate)>& found,
                   std::uint64_t work = kStageWork);

/// The file of one plan with what it promises: `answer` uses it for every plan it finds.
mission::Candidate candidate_for(const planning::Plan& plan, const mission::PlanningRequest& request,
                                 const planning::Problem& problem, const OceanSource& ocean, const chart::Chart& chart);

/// Steps of markers after which the certificate is given up: some ten seconds.
inline constexpr std::uint64_t kCertificateWork = 20'000'000;

/// The certificate of a request, on the same currents as its plan. `known_arrival_s`: epoch seconds of a plan that arrives, NaN
/// without one. `expired` cuts it; it is asked from several threads, but only from one at a time. The reason of `unreachable` names the policy it assumes for times that the forecast does not have.
Expected<planning::Bound, planning::PlanFailure> certificate(const mission::PlanningRequest& request,
                                                             const OceanSource& ocean, const chart::Chart& chart,
                                                             double known_arrival_s,
                                                             const std::function<bool()>& expired);

/// The horizon of a request (epoch seconds): as wanted, else automatic; at least two stints.
double horizon_of(const mission::PlanningRequest& request);

}  // namespace glidehelm::daemon
