#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/current.hpp"
#include "core/base/units.hpp"
#include "core/planning/draws.hpp"

/// Which headings a search tries at a surfacing.
namespace glidehelm::planning {

/// `uniform`: M headings, 2π/M apart, the first of them the direction to the goal (Thesis 4.4.2). `adaptive`: AdaptiveHeadings.
enum class HeadingSampling : std::uint8_t { uniform, adaptive };

/// Candidate courses of AdaptiveHeadings, 5° apart, counted clockwise from the direction to the goal.
inline constexpr int kCourses = 72;
/// A weight for each candidate course; the sum is 1, or all are 0.
using CourseWeights = std::array<double, kCourses>;

/// f_ψd of Thesis 4.16: a Gaussian around the direction to the goal with σ² = 0.1745 rad² (σ ≈ 24°; erratum: the printed
/// "10°" is no variance), wrapped around the circle.
CourseWeights goal_weights();
/// f_ψc of Thesis 4.13: speed over ground on each course, which starts at `first` (radians from north); 0 where the course
/// is infeasible. All are 0 when the cone of feasible courses (4.15 and its erratum) holds no candidate: it is then narrower than 5°,
/// and the current more than 22 times as strong as the vehicle.
CourseWeights speed_weights(double first, double speed_m_per_s, const Current& current);

/// Systematic resampling (Thesis 4.17, Madow): `chosen[m]` is the first index whose running sum of `weights` reaches (r + m)/M, for
/// m = 0 … M − 1 with M = chosen.size() and r in [0, 1). Index i comes ⌊M·w⌋ or ⌈M·w⌉ times. O(weights + M). Weights add
/// up to 1.
void resample(std::span<const double> weights, double r, std::span<int> chosen);

/// Duplicates replaced as in Thesis 4.18–4.19: one of them stays, the others become uniform draws between the midpoints to the
/// neighbouring values. `angles`: ascending, within one turn; the circle closes. Afterwards ascending, but for a turn, and all
/// different.
void repair_duplicates(std::span<double> angles, Draws& draws);

/// Adaptive bearing sampling, ABS (Thesis 4.4.3): courses are drawn where the current helps and where the goal lies, so that fewer
/// of them do.
///
/// Idea: f = ½ f_ψc + ½ f_ψd over the candidate courses; M of them by systematic resampling; duplicates repaired; each turned
/// into the heading that holds the course in the current at the dive (4.12). Where none does, the course serves as heading.
///
/// Departures: *candidates* are counted from the direction to the goal, so f_ψd is a constant table. *The goal*: the sample
/// nearest to its direction is moved there; otherwise a goal radius that fills less than the spacing is missed again and
/// again. (The uniform headings begin with that direction, too.) Should no candidate course be feasible, f = f_ψd.
///
/// Complexity: 72 square roots and M arc sines per draw. Same seed and stream, same headings.
class AdaptiveHeadings {
 public:
  AdaptiveHeadings(MetresPerSecond speed, std::uint64_t seed);
  /// Fills `headings` (radians from north, at most kCourses of them). `to_goal`: direction to the goal, radians from north;
  /// `stream` numbers the draws.
  void draw(double to_goal, const Current& current, std::uint64_t stream, std::span<double> headings) const;

 private:
  double speed_;
  std::uint64_t seed_;
  CourseWeights goal_;
};

}  // namespace glidehelm::planning
