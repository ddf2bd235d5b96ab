#pragma once

#include <memory>
#include <string>

#include "daemon/ingest/fault.hpp"

namespace glidehelm::ingest {

/// value in the target unit = slope · value + intercept.
struct Scaling {
  double slope{1}, intercept{0};
  [[nodiscard]] double operator()(double value) const { return slope * value + intercept; }
};

/// The unit database of UDUNITS-2, read once.
class Units {
 public:
  /// Fails when the database is missing (package libudunits2-data).
  static Result<Units> load();
  ~Units();
  Units(Units&&) noexcept;
  Units& operator=(Units&&) noexcept;

  /// Conversion of `unit` to `target` (both as UDUNITS writes them). "kn", "kts" and "knots" are taken for knots, which
  /// UDUNITS calls kt, and "deg" for degrees. A unit that cannot be read, or is of another kind ("degC" where "m/s" is needed), is a fault.
  [[nodiscard]] Result<Scaling> scaling(const std::string& unit, const std::string& target) const;

  /// Conversion of "days since 1950-01-01 00:00:00" and its like to epoch seconds. `calendar` as CF names it: empty,
  /// "standard", "gregorian" (mixed: UDUNITS' own) and "proleptic_gregorian" are read, others refused by name.
  [[nodiscard]] Result<Scaling> time_scaling(const std::string& unit, const std::string& calendar) const;

 private:
  struct System;
  explicit Units(std::unique_ptr<System> system);
  std::unique_ptr<System> system_;
};

}  // namespace glidehelm::ingest
