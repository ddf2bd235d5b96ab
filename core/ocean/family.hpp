#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/ocean/field.hpp"

/// The members of an ensemble as one thing: where they agree about the current, and how far they are apart.
namespace glidehelm::ocean {

/// Standard deviation of a current per component, m/s.
struct Spread {
  MetresPerSecond east, north;
  /// √(east² + north²): the rms length of the vector by which a member differs from the mean. The same in every frame.
  [[nodiscard]] MetresPerSecond vector() const { return Current{east, north}.speed(); }
  friend bool operator==(const Spread&, const Spread&) = default;
};

/// Mean and spread of currents that come one after the other, none of which is kept.
///
/// The members are draws from what may be, and their mean is taken from themselves: Σ(c − c̄)² has the expectation (n − 1)σ², so
/// the spread divides by n − 1. The sums are Welford's (Technometrics 4, 1962): n·c̄ and Σ(c − c̄)² are brought up to date with
/// each value, so that small differences of large currents are not lost as they are in Σc² − n·c̄². Same order, same bits. O(1) each.
class CurrentMoments {
 public:
  void add(const Current& current);
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Still water before the first one.
  [[nodiscard]] Current mean() const { return {MetresPerSecond{east_.mean}, MetresPerSecond{north_.mean}}; }
  /// None of fewer than two: one draw says nothing of the others.
  [[nodiscard]] std::optional<Spread> spread() const;

 private:
  struct Component {
    double mean{}, squares{};  ///< squares: Σ(c − c̄)²
    void add(double value, double count);
  };
  std::size_t count_{};
  Component east_, north_;
};

/// What the members of a family say of one place and time.
struct FamilySample {
  Current mean;
  std::optional<Spread> spread;  ///< none of a single member
  std::size_t members{};         ///< that have a current there
  bool extrapolated{};           ///< at least one of them borrows it from the nearest wet node
  friend bool operator==(const FamilySample&, const FamilySample&) = default;
};

/// N members as one field family. A view: the fields must outlive it. Immutable, callable from several threads at once.
///
/// Members may disagree about where there is water (a file with a hole, another mask). A place has a mean and a spread where at
/// least half of them have a current, over those that have one: the rule of a sample over the corners of a cell (product.md 6).
/// Elsewhere it has none, for the reason of the first member that has none. Mean and spread are for people and margins, not for
/// planning: no member has the mean current (docs/decisions/026).
class Family {
 public:
  /// In the order of the ensemble, the control first. Precondition: at least one.
  explicit Family(std::vector<FieldRef> members) : members_{std::move(members)} {}

  [[nodiscard]] std::size_t size() const { return members_.size(); }
  [[nodiscard]] FieldRef member(std::size_t k) const { return members_[k]; }
  /// As FieldRef::sample. One sample of each member, no memory.
  [[nodiscard]] Expected<FamilySample, NoCurrent> sample(GeoPoint p, Depth z, double t_s) const;

 private:
  std::vector<FieldRef> members_;
};

}  // namespace glidehelm::ocean
