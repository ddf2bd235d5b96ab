#pragma once

#include <span>
#include <vector>

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// A plan's headings after they were polished.
struct Refined {
  std::vector<Heading> headings;
  double arrival_s{};    ///< by the lanes' integration; NaN when the goal is not reached
  double remaining_m{};  ///< distance to the goal's centre at the end when it is not
  int rounds{};          ///< improvements that were made
  Statistics statistics;
  bool
      kept_margin{};  ///< false: the way itself comes nearer to land than `margin`, or leaves the field; nothing was done
  bool cut{};         ///< the clock ended it
};

/// Improves the headings of a plan until none of them can be turned to advantage: the nearest plan of constant-heading
/// stints that no small change makes faster.
///
/// The flight is a chain of maps x_{k+1} = Φ_k(x_k, ψ_k), one for each drift and stint, under the true dynamics of the problem
/// (held_flight.hpp). What is improved is the distance to the goal at the instant at which the plan at hand arrives there: to
/// bring it down is to arrive earlier, and each round begins at the new instant. When the goal is not reached the instant is
/// that of the last surfacing, and the distance then is what counts (Thesis 3.1.2, minimal remaining distance).
///
/// A round is one step of differential dynamic programming (Jacobson and Mayne 1970; Newton's method for chains): backwards
/// along the way, with first and second differences of Φ_k by lanes around it, a quadratic model of what is left of the
/// distance as a function of x_k, and from it the best turn and its feedback on a deviation from the way; then
/// forwards, on several lanes at once, that step, shares of it, and the same without feedback. The best lane is the next way.
/// When none is better, the turns are damped; after `kMostDampings` in a row the way is done. Where curvature is wrong
/// (behind a focus) the damped step is still a descent.
///
/// Land: a way that keeps `margin` is improved only to ways that do. It is kept off the margin by a toll over a buffer that
/// shrinks in three rounds of polishing (see HeldFlight), so that a way along a coast can be followed. Where the first way itself comes nearer
/// than `margin` nothing is done.
///
/// It finds the best way of the valley that it begins in, not another one round the next eddy: that is for its callers, who
/// begin in several. Cost: about thirteen lanes for each stint and round; 650 km with 80 stints take some ten to thirty rounds.
/// Deterministic. `Budget::work` counts rounds.
Refined refine(std::span<const Heading> headings, const Problem& problem, const ocean::Ocean& ocean,
               const chart::Chart& chart, Metres margin, const Budget& budget);

/// The headings with which lanes, too, come up where a plan comes up: those of a plan were chosen for the glider's own law.
std::vector<Heading> headings_of(const Plan& plan, const Problem& problem, const ocean::Ocean& ocean,
                                 const chart::Chart& chart);

}  // namespace glidehelm::planning
