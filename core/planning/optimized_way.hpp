#pragma once

#include <limits>
#include <vector>

#include "core/planning/optimization_kernel.hpp"
#include "core/planning/planner.hpp"
#include "core/planning/purse.hpp"

namespace glidehelm::planning {

/// Where an optimisation begins.
enum class FirstWay {
  straight,  ///< towards the goal from every surfacing (Thesis 4.6, "DtG"): fast, and trapped behind land
  searched,  ///< a coarse CTS-A* (4.6.2, "intelligent initialization")
  both       ///< each in turn; the better result counts
};

/// What is chosen about an optimisation.
struct OptimizationSettings {
  Kernel kernel{Kernel::sqp};
  FirstWay first{FirstWay::both};
  std::size_t evaluations{300};  ///< most of one run of a kernel; simplex kernels: for every stint
};

/// Held headings, and where they lead by the lanes' integration.
struct OptimizedWay {
  std::vector<double> headings;  ///< radians
  double arrival_s{HeldLanes::kNever};
  double end_s{};        ///< epoch second of the last surfacing, or of the horizon when it is earlier
  double lat{}, lon{};   ///< radians: there
  double remaining_m{};  ///< from there to the goal's centre
  bool safe{true};       ///< it keeps the margin and stays in water with data
  [[nodiscard]] bool arrives() const { return arrival_s < HeldLanes::kNever; }
};
/// Safe beats unsafe, arriving beats not arriving, then earlier, then nearer.
bool better_way(const OptimizedWay& a, const OptimizedWay& b);

/// First ways, and what kernels make of them, under one purse. `Budget::work` counts flights of a kernel and expansions of the search.
class WayOptimizer {
 public:
  /// `spare`: clearance that ways keep beside the coastal margin. A start that is nearer to land keeps what it has.
  WayOptimizer(const Problem& problem, const ocean::Ocean& ocean, const chart::Chart& chart, Metres spare,
               const OptimizationSettings& settings, Purse& purse);

  [[nodiscard]] OptimizedWay straight();
  /// Without an arrival the way nearest to the goal, made as long as the horizon allows. Work ended: the straight way.
  [[nodiscard]] OptimizedWay searched();
  /// Least distance at the end of the way (Thesis 3.4) or, for a way that arrives, at the instant of its arrival, and again at the
  /// earlier one: as long as that pays by 5 s. The instant looked at runs ahead of the arrival by what the round before has gained.
  [[nodiscard]] OptimizedWay improve(OptimizedWay way);
  /// Algorithm 4.4: an optimistic number of stints, distance/(U_g + U_cmax) (erratum of line 9), optimised for least distance, and
  /// longer by the same measure until the goal is entered; then `improve`. Ends early at the horizon, and where even the
  /// optimum runs aground.
  [[nodiscard]] OptimizedWay grow();
  /// These headings as they are flown.
  [[nodiscard]] OptimizedWay measured(std::vector<double> headings);

 private:
  [[nodiscard]] std::vector<double> kernel(std::vector<double> headings, double until_s, Metres buffer);
  [[nodiscard]] OptimizedWay improve_with(OptimizedWay way, Metres buffer);
  /// The way lengthened by up to `stints` stints towards the goal.
  [[nodiscard]] OptimizedWay lengthened(OptimizedWay way, int stints);

  const Problem& problem_;
  const ocean::Ocean& ocean_;
  const chart::Chart& chart_;
  Metres spare_, margin_;
  const OptimizationSettings& settings_;
  Purse& purse_;
  HeldFlight flight_;
  int most_;  ///< stints of a way
  bool paid_toll_{};
};

}  // namespace glidehelm::planning
