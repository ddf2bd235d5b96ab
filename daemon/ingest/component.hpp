#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "daemon/ingest/netcdf_file.hpp"
#include "daemon/ingest/units.hpp"

namespace glidehelm::ingest {

/// Numbers of an attribute; a text that is a number counts too (some writers quote what they mean). Empty when absent.
std::vector<double> numbers_of(const Variable& variable, std::string_view attribute);

/// What marks a stored number as missing.
class Missing {
 public:
  /// NaN, `_FillValue` and `missing_value` (also written `FillValue`, `FillValue_`, `_fillvalue`, `fill_value`), and the
  /// type's default fill value where no fill value is named (not for bytes, as the NetCDF Users' Guide says). Floating
  /// marks count to 1e-6: a mark may be kept in another precision than the values.
  explicit Missing(const Variable& variable);
  [[nodiscard]] bool operator()(double stored) const {
    if (!std::isfinite(stored)) return true;
    return std::any_of(marks_.begin(), marks_.end(), [&](double mark) { return is(stored, mark); });
  }
  /// How a number says that it is missing.
  enum class Mark { not_a_number, fill_value, missing_value };
  /// Of a number that is missing.
  [[nodiscard]] Mark mark_of(double stored) const;
  /// True when a number is a floating mark, to its precision.
  static bool same(double value, double mark) {
    return value == mark || std::abs(value - mark) <= 1e-6 * std::abs(mark);
  }

 private:
  [[nodiscard]] bool is(double stored, double mark) const { return floating_ ? same(stored, mark) : stored == mark; }
  std::vector<double> marks_;  ///< the fill values first
  std::size_t fill_values_{};
  bool floating_{};
};

/// How the stored numbers of a variable become values: which mean "missing", and the way to a unit.
class Component {
 public:
  /// A variable in m/s. A missing unit is m/s, with a warning.
  static Result<Component> of(const Variable& variable, const Units& units, std::vector<std::string>& warnings) {
    return of(variable, units, "m/s", warnings);
  }
  /// A variable in any `target` unit. valid_min, valid_max and valid_range mask nothing: they often are the range of the
  /// producer's whole archive, or of another packing; `outside_valid` says what they would leave out.
  static Result<Component> of(const Variable& variable, const Units& units, const std::string& target,
                              std::vector<std::string>& warnings);

  /// A variable of plain numbers, such as a flag: neither packing nor unit counts.
  static Component plain(const Variable& variable) { return Component{variable}; }

  /// In the target unit, or NaN. In the header because it runs once per number of a file.
  [[nodiscard]] double operator()(double stored) const {
    constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
    if (missing_(stored)) return kMissing;
    const double value = stored * scale_ + offset_;
    if (!std::isfinite(value)) return kMissing;
    for (const double mark : missing_values_)
      if (Missing::same(value, mark)) return kMissing;
    return to_si_.slope == 1 && to_si_.intercept == 0 ? value : to_si_(value);
  }
  /// Of a number for which the value is NaN.
  [[nodiscard]] Missing::Mark mark_of(double stored) const {
    return missing_(stored) ? missing_.mark_of(stored) : Missing::Mark::missing_value;
  }
  /// True when the variable names a valid range.
  [[nodiscard]] bool has_valid_range() const { return stored_low_ || stored_high_ || value_low_ || value_high_; }
  /// True when a number that is not missing lies outside the valid range (of packed variables: in the type of the
  /// attribute, as the NetCDF Users' Guide says).
  [[nodiscard]] bool outside_valid(double stored) const;
  /// "-5 to 5", with "any" for an end that is not named.
  [[nodiscard]] std::string valid_text() const;

 private:
  explicit Component(const Variable& variable) : missing_{variable} {}
  void read_valid_range(const Variable& variable, bool packed);
  Missing missing_;
  std::vector<double> missing_values_;  ///< marks that are written unpacked
  std::optional<double> stored_low_, stored_high_, value_low_, value_high_;
  double scale_{1}, offset_{0};
  Scaling to_si_;
};

}  // namespace glidehelm::ingest
