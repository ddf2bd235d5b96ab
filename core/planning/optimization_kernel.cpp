#include "core/planning/optimization_kernel.hpp"

#include <nlopt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace glidehelm::planning {

std::string_view word(Kernel kernel) {
  switch (kernel) {
    case Kernel::simplex:
      return "simplex";
    case Kernel::subplex:
      return "subplex";
    case Kernel::least_squares:
      return "least-squares";
    case Kernel::quasi_newton:
      return "quasi-newton";
    case Kernel::sqp:
      return "sqp";
  }
  return "?";
}

namespace {

constexpr double kMostToll = 10.0;    // metres, of a constraint
constexpr double kFirstTurn = 0.2;    // radians, of a simplex
constexpr double kFlatEnough = 1e-6;  // of the squared distance: half a millionth of the distance
constexpr double kSmallTurn = 1e-6;   // radians
constexpr std::size_t kAxes = 3;      // of a residual
constexpr double kAnywhere = 1e9;     // units: bounds of a residual

nlopt_algorithm algorithm_of(Kernel kernel) {
  switch (kernel) {
    case Kernel::simplex:
      return NLOPT_LN_NELDERMEAD;
    case Kernel::subplex:
      return NLOPT_LN_SBPLX;
    case Kernel::quasi_newton:
      return NLOPT_LD_LBFGS;
    case Kernel::least_squares:
    case Kernel::sqp:
      break;
  }
  return NLOPT_LD_SLSQP;
}

struct Destroy {
  void operator()(nlopt_opt kernel) const { nlopt_destroy(kernel); }
};
using Handle = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, Destroy>;

/// One run: what NLopt calls back, and the best that it has asked for. The variables are the headings and, for least squares, after
/// them the three residuals.
class KernelRun {
 public:
  KernelRun(const KernelTask& task, std::span<const double> guess)
      : task_{task},
        headings_{guess.size()},
        handle_{nlopt_create(algorithm_of(task.kernel), static_cast<unsigned>(guess.size() + residuals()))},
        best_{guess.begin(), guess.end()} {}

  std::vector<double> best() {
    if (!handle_ || best_.empty() || !look_at(best_.data())) return best_;
    auto* const kernel = handle_.get();
    std::vector<double> x = best_, lowest = best_, highest = best_;
    for (std::size_t k = 0; k < headings_; ++k) {
      lowest[k] -= kPi;
      highest[k] += kPi;
    }
    for (std::size_t i = 0; i < residuals(); ++i) {
      x.push_back(end_.off[static_cast<Eigen::Index>(i)] / task_.unit_m);
      lowest.push_back(-kAnywhere);
      highest.push_back(kAnywhere);
    }
    nlopt_set_lower_bounds(kernel, lowest.data());
    nlopt_set_upper_bounds(kernel, highest.data());
    if (residuals() > 0) {
      const std::array<double, kAxes> exact{kFlatEnough, kFlatEnough, kFlatEnough};
      nlopt_set_min_objective(kernel, &KernelRun::squares, this);
      nlopt_add_equality_mconstraint(kernel, kAxes, &KernelRun::off_by_residuals, this, exact.data());
    } else {
      nlopt_set_min_objective(kernel, &KernelRun::squared_distance, this);
    }
    if (constrained()) nlopt_add_inequality_constraint(kernel, &KernelRun::toll, this, 0.01 * kMostToll / task_.unit_m);
    nlopt_set_initial_step1(kernel, kFirstTurn);
    nlopt_set_maxeval(kernel, static_cast<int>(task_.evaluations));
    nlopt_set_stopval(kernel, std::pow(task_.near_enough_m / task_.unit_m, 2));
    nlopt_set_ftol_rel(kernel, kFlatEnough);
    nlopt_set_xtol_abs1(kernel, kSmallTurn);
    double least = 0;
    // What it returns is of no use: the best headings that were flown are the answer, however it ended.
    (void)nlopt_optimize(kernel, x.data(), &least);
    return best_;
  }

 private:
  [[nodiscard]] std::size_t residuals() const { return task_.kernel == Kernel::least_squares ? kAxes : 0; }
  [[nodiscard]] bool constrained() const {
    return task_.kernel == Kernel::sqp || task_.kernel == Kernel::least_squares;
  }
  [[nodiscard]] bool wants_slopes() const { return task_.kernel != Kernel::simplex && task_.kernel != Kernel::subplex; }

  /// Flies these headings, unless they were the last ones. False when no more may be flown.
  bool look_at(const double* x) {
    if (stopped_) return false;
    if (!at_.empty() && std::equal(at_.begin(), at_.end(), x)) return true;
    at_.assign(x, x + headings_);
    if (!task_.fly(at_, wants_slopes(), end_)) {
      stopped_ = true;
      nlopt_force_stop(handle_.get());
      return false;
    }
    const double merit = end_.off.norm() + end_.toll;
    if (merit < least_merit_) {
      least_merit_ = merit;
      best_ = at_;
    }
    return true;
  }

  /// Distance squared, with the toll added to the distance where the kernel takes no constraint.
  static double squared_distance(unsigned n, const double* x, double* slope, void* self) {
    auto& run = *static_cast<KernelRun*>(self);
    Eigen::Map<Eigen::RowVectorXd> by_turn{slope, slope != nullptr ? static_cast<Eigen::Index>(n) : 0};
    if (!run.look_at(x)) {
      by_turn.setZero();
      return std::numeric_limits<double>::max();
    }
    const auto& end = run.end_;
    const double unit2 = run.task_.unit_m * run.task_.unit_m;
    const double far = end.off.norm(), paid = run.constrained() ? 0 : end.toll;
    if (slope != nullptr) {
      by_turn = end.off.transpose() * end.off_by_turn / std::max(far, 1e-9);
      if (!run.constrained()) by_turn += end.toll_by_turn;
      by_turn *= 2 * (far + paid) / unit2;
    }
    return (far + paid) * (far + paid) / unit2;
  }
  static double toll(unsigned n, const double* x, double* slope, void* self) {
    auto& run = *static_cast<KernelRun*>(self);
    Eigen::Map<Eigen::RowVectorXd> by_turn{slope, slope != nullptr ? static_cast<Eigen::Index>(n) : 0};
    by_turn.setZero();
    if (!run.look_at(x)) return 0;
    if (slope != nullptr)
      by_turn.head(static_cast<Eigen::Index>(run.headings_)) = run.end_.toll_by_turn / run.task_.unit_m;
    return (run.end_.toll - kMostToll) / run.task_.unit_m;
  }
  /// Of the residuals, the last of the variables.
  static double squares(unsigned n, const double* x, double* slope, void*) {
    const Eigen::Map<const Eigen::Vector3d> residuals{x + n - kAxes};
    if (slope != nullptr) {
      std::fill_n(slope, n, 0.0);
      Eigen::Map<Eigen::Vector3d>{slope + n - kAxes} = 2 * residuals;
    }
    return residuals.squaredNorm();
  }
  /// What makes them residuals: off(headings) − residuals = 0.
  static void off_by_residuals(unsigned m, double* result, unsigned n, const double* x, double* slope, void* self) {
    auto& run = *static_cast<KernelRun*>(self);
    if (slope != nullptr) std::fill_n(slope, std::size_t{m} * n, 0.0);
    std::fill_n(result, m, 0.0);
    if (!run.look_at(x)) return;
    const double unit = run.task_.unit_m;
    for (unsigned i = 0; i < m; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const std::size_t variable = n - kAxes + i;
      result[i] = run.end_.off[axis] / unit - x[variable];
      if (slope == nullptr) continue;
      double* const row = slope + std::size_t{i} * n;
      for (std::size_t k = 0; k < run.headings_; ++k)
        row[k] = run.end_.off_by_turn(axis, static_cast<Eigen::Index>(k)) / unit;
      row[variable] = -1;
    }
  }

  const KernelTask& task_;
  std::size_t headings_;
  Handle handle_;
  std::vector<double> best_, at_;
  FlightEnd end_;
  double least_merit_{std::numeric_limits<double>::infinity()};
  bool stopped_{};
};

}  // namespace

std::vector<double> run_kernel(const KernelTask& task, std::span<const double> guess) {
  return KernelRun{task, guess}.best();
}

}  // namespace glidehelm::planning
