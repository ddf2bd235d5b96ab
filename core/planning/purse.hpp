#pragma once

#include <algorithm>

#include "core/planning/planner.hpp"

namespace glidehelm::planning {

/// The work of one answer, spent by several searches and refinements in turn: a count says where the last one was cut, so that
/// a replay with that count as its work stops at the same place.
class Purse {
 public:
  explicit Purse(const Budget& budget) : budget_{budget} {}
  [[nodiscard]] Budget rest() const {
    Budget rest = budget_;
    rest.work -= std::min(rest.work, spent_.expansions);
    return rest;
  }
  /// What a part of the work cost, and whether the clock ended it.
  void take(const Statistics& statistics, bool cut) {
    spent_ += statistics;
    if (cut) cut_at_ = spent_.expansions;
    cut_ = cut_ || cut;
  }
  [[nodiscard]] const Statistics& spent() const { return spent_; }
  [[nodiscard]] std::uint64_t cut_at() const { return cut_at_; }
  [[nodiscard]] bool is_empty() const { return cut_ || spent_.expansions >= budget_.work; }

 private:
  const Budget& budget_;
  Statistics spent_;
  std::uint64_t cut_at_{};
  bool cut_{};
};

}  // namespace glidehelm::planning
