#pragma once

#include <vector>

#include "daemon/ingest/netcdf_file.hpp"
#include "daemon/ingest/units.hpp"

namespace glidehelm::ingest {

/// How the stored numbers of a variable become values: which mean "missing", and the way to m/s.
class Component {
 public:
  /// Missing are NaN, _FillValue, every missing_value, the type's default fill value where no _FillValue is named (not for
  /// bytes), and what lies outside valid_min, valid_max, valid_range (of packed variables: in the type of the attribute,
  /// as the NetCDF Users' Guide says). A missing unit is m/s, with a warning.
  static Result<Component> of(const Variable& variable, const Units& units, std::vector<std::string>& warnings);

  /// m/s, or NaN.
  [[nodiscard]] double operator()(double stored) const;

 private:
  std::vector<double> missing_;
  double stored_low_, stored_high_, value_low_, value_high_;
  double scale_{1}, offset_{0};
  Scaling to_si_;
};

}  // namespace glidehelm::ingest
