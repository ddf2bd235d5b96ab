#pragma once

#include "core/ocean/field.hpp"

namespace glidehelm::ocean {

/// What a measured current says about a forecast near it: measured less forecast mean along the dive just flown, and how
/// far that may be believed. A plain value: it travels with a planning request and in a verifier's dossier.
///
/// It is added to the forecast at every depth with the weight exp(−d²/2L²)·exp(−|t − t0|/T), where d is the distance
/// from `at`, L `length` and T `time` (docs/decisions/012). One centre, so nothing that a glider measured days ago and
/// far away comes back.
struct LocalCorrection {
  GeoPoint at;                ///< middle of the dive
  double at_s{};              ///< epoch second of its middle
  Current added;              ///< at the centre
  MetresPerSecond spread;     ///< standard deviation of each component of `added`
  Metres length{30'000};      ///< L
  Seconds time{24 * 3600.0};  ///< T
  /// Everything finite, scales positive, and the current no faster than `kStrongest`.
  [[nodiscard]] bool plausible() const;
  static constexpr double kStrongest = 1.0;  ///< m/s
  friend bool operator==(const LocalCorrection&, const LocalCorrection&) = default;
};

/// A field with a local correction. Where the field has no current there is none; the bound grows by the correction's
/// speed. Non-owning like FieldRef: the field must outlive it.
class CorrectedField {
 public:
  /// Precondition: `correction.plausible()`.
  CorrectedField(FieldRef field, const LocalCorrection& correction);

  [[nodiscard]] Expected<Sample, NoCurrent> sample(GeoPoint p, Depth z, double t_s) const;
  [[nodiscard]] Coverage coverage() const { return field_.coverage(); }
  [[nodiscard]] MetresPerSecond fastest() const { return field_.fastest() + correction_.added.speed(); }
  /// One step with the kernel of the field itself: the correction where the step begins is part of the velocity through
  /// water, and half of its change to where the step ends is added there (trapezoidal rule, second order in the step).
  void advance(Lanes& lanes, double t_s, double dt) const;
  /// 1 at the centre, falling towards 0. Radians and epoch seconds.
  [[nodiscard]] double weight(double lat, double lon, double t_s) const;

 private:
  FieldRef field_;
  LocalCorrection correction_;
  LocalMetric metric_;
  double lat_, lon_;
};

/// What planners take, corrected. The fields behind `ocean` must outlive it; it stays where it was made.
class CorrectedOcean {
 public:
  CorrectedOcean(const Ocean& ocean, const LocalCorrection& correction)
      : dive_{ocean.dive, correction}, surface_{ocean.surface, correction} {}
  CorrectedOcean(const CorrectedOcean&) = delete;
  CorrectedOcean& operator=(const CorrectedOcean&) = delete;
  [[nodiscard]] Ocean ocean() const { return {dive_, surface_}; }

 private:
  CorrectedField dive_, surface_;
};

}  // namespace glidehelm::ocean
