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

/// The way from a value of a time axis to epoch seconds of the real world.
struct TimeScaling {
  enum class Kind {
    linear,   ///< slope · value + intercept
    no_leap,  ///< the same counts seconds of a calendar without 29 February, whose dates are the real ones
    coded     ///< the value is a date and a part of the day: 20240131.25
  };
  Kind kind{Kind::linear};
  double slope{1}, intercept{0};
  /// Epoch seconds; NaN for a coded value that is no date.
  [[nodiscard]] double operator()(double value) const;
};

/// True when a time unit names its own epoch ("hours since …", "day as %Y%m%d.%f", "modified Julian day").
bool names_epoch(const std::string& unit);
/// True when a time unit counts in months or years, which UDUNITS takes as 30.44 and 365.24 days.
bool counts_in_months(const std::string& unit);

/// The unit database of UDUNITS-2, read once.
class Units {
 public:
  /// Fails when the database is missing (package libudunits2-data).
  static Result<Units> load();
  ~Units();
  Units(Units&&) noexcept;
  Units& operator=(Units&&) noexcept;

  /// Conversion of `unit` to `target` (both as UDUNITS writes them). "kn", "kts" and "knots" are taken for knots, which
  /// UDUNITS calls kt, "deg" for degrees, "mps" and "ms-1" for m/s; what is unknown in capitals is tried in small letters.
  /// A unit that cannot be read, or is of another kind ("degC" where "m/s" is needed), is a fault.
  [[nodiscard]] Result<Scaling> scaling(const std::string& unit, const std::string& target) const;

  /// Conversion of "days since 1950-01-01 00:00:00" and its like to epoch seconds: every unit of time that UDUNITS knows,
  /// and what is often met besides: "since", "after", "from", "ref" and "@"; dates as 1950-1-1, 1950/01/01, 19500101;
  /// "1950-01-01_00:00:00"; "day as %Y%m%d.%f"; "modified Julian day", "Julian day". A date that does not exist (31
  /// February, 1-1-1970 with the year behind, month 13, which UDUNITS reads as something else) is a fault, and so is the
  /// year 0 but in the proleptic calendar: writers disagree by a day about what it means.
  ///
  /// `calendar` as CF names it: empty, "standard", "gregorian" (mixed: UDUNITS' own), "proleptic_gregorian", "julian",
  /// "noleap" and "365_day" are read; "360_day", "all_leap" and "366_day", which have days that never were, "utc" and
  /// "tai", which count leap seconds, and all others are refused by name.
  [[nodiscard]] Result<TimeScaling> time_scaling(const std::string& unit, const std::string& calendar) const;

 private:
  struct System;
  explicit Units(std::unique_ptr<System> system);
  std::unique_ptr<System> system_;
};

}  // namespace glidehelm::ingest
