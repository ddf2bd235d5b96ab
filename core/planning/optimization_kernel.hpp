#pragma once

#include <array>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "core/planning/flight_end.hpp"

namespace glidehelm::planning {

/// The kernels that Thesis 4.6.3 compares, by what stands for them in NLopt (docs/decisions/027).
///  - `simplex`: Nelder–Mead (fminsearch); `subplex`: Sbplx, Nelder–Mead on a sequence of subspaces, for many stints. No derivatives.
///  - `least_squares`: SLSQP on headings and residuals r together: least r·r where r = goal − f(B) (lsqnonlin, 4.25). The constraint is
///    made linear at each step, which makes it a Gauss–Newton step.
///  - `quasi_newton`: L-BFGS (fminunc).
///  - `sqp`: SLSQP, sequential quadratic programming, on the squared distance (fmincon), which the Thesis found best.
enum class Kernel { simplex, subplex, least_squares, quasi_newton, sqp };
inline constexpr std::array<Kernel, 5> kKernels{Kernel::simplex, Kernel::subplex, Kernel::least_squares,
                                                Kernel::quasi_newton, Kernel::sqp};
std::string_view word(Kernel kernel);

/// What a kernel minimises, and where it begins.
struct KernelTask {
  Kernel kernel{Kernel::sqp};
  double unit_m{1};         ///< metres that count as one: about the way of a stint
  double near_enough_m{};   ///< it may stop this near to the goal's centre
  std::size_t evaluations;  ///< most of them
  /// The end of the flight on some headings, with slopes or without; false: no more may be asked.
  std::function<bool(std::span<const double> headings, bool with_slopes, FlightEnd& end)> fly;
};

/// The best headings that a kernel has found from `guess`: least distance plus toll.
///
/// Minimised is the squared distance to the goal (Thesis 4.23). Land: the kernels that take constraints (`least_squares`, `sqp`) keep the
/// toll below 10 m; to the distance of the others it is added. Headings stay within half a turn of the guess. Stops by counts
/// and by tolerances, never by a clock; no kernel draws random numbers.
std::vector<double> run_kernel(const KernelTask& task, std::span<const double> guess);

}  // namespace glidehelm::planning
