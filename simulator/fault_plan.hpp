#pragma once

#include <algorithm>
#include <vector>

#include "simulator/random.hpp"

namespace glidehelm::simulator {

/// A fault that happens by chance, at named surfacings (counted from 1), or both.
struct FaultPlan {
  double probability{};
  std::vector<int> surfacings;
  friend bool operator==(const FaultPlan&, const FaultPlan&) = default;
};

/// Whether the fault strikes at a surfacing. One number is drawn in any case: one fault never shifts another's luck.
inline bool strikes(const FaultPlan& fault, int surfacing, Random& random) {
  const bool by_chance = random.uniform() < fault.probability;
  return by_chance || std::find(fault.surfacings.begin(), fault.surfacings.end(), surfacing) != fault.surfacings.end();
}

}  // namespace glidehelm::simulator
