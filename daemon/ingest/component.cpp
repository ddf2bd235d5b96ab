#include "daemon/ingest/component.hpp"

#include <cmath>
#include <limits>

namespace glidehelm::ingest {

namespace {

/// A number of an attribute as the variable itself would hold it: a double 1.26765e+30 meant for a float is that float.
double in_type(double value, Type type) {
  return type == Type::float32 ? static_cast<double>(static_cast<float>(value)) : value;
}

/// NC_FILL_*: what the library writes where nothing was written.
double default_fill(Type type) {
  switch (type) {
    case Type::int16:
      return -32767;
    case Type::uint16:
      return 65535;
    case Type::int32:
      return -2147483647;
    case Type::uint32:
      return 4294967295;
    case Type::int64:
      return -9223372036854775806.0;
    case Type::uint64:
      return 18446744073709551614.0;
    case Type::float32:
      return static_cast<double>(9.9692099683868690e+36F);
    case Type::float64:
      return 9.9692099683868690e+36;
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

Result<Component> Component::of(const Variable& variable, const Units& units, std::vector<std::string>& warnings) {
  Component component;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  component.stored_low_ = component.value_low_ = -kInfinity;
  component.stored_high_ = component.value_high_ = kInfinity;

  const auto *scale = variable.find("scale_factor"), *offset = variable.find("add_offset");
  const bool packed = scale != nullptr || offset != nullptr;
  if (scale != nullptr && !scale->numbers.empty()) component.scale_ = scale->numbers[0];
  if (offset != nullptr && !offset->numbers.empty()) component.offset_ = offset->numbers[0];
  if (!std::isfinite(component.scale_) || component.scale_ == 0 || !std::isfinite(component.offset_))
    return fault(variable.name + " has the impossible packing scale_factor " + std::to_string(component.scale_) +
                 ", add_offset " + std::to_string(component.offset_));

  for (const char* name : {"_FillValue", "missing_value"})
    if (const auto* attribute = variable.find(name))
      for (const double value : attribute->numbers) component.missing_.push_back(in_type(value, variable.type));
  if (variable.find("_FillValue") == nullptr) component.missing_.push_back(default_fill(variable.type));

  const auto limit = [&](const char* name, std::size_t index, bool low) {
    const auto* attribute = variable.find(name);
    if (attribute == nullptr || attribute->numbers.size() <= index) return;
    const bool unpacked = packed && is_floating(attribute->type) && !is_floating(variable.type);
    const double value = unpacked ? attribute->numbers[index] : in_type(attribute->numbers[index], variable.type);
    if (low)
      (unpacked ? component.value_low_ : component.stored_low_) = value;
    else
      (unpacked ? component.value_high_ : component.stored_high_) = value;
  };
  limit("valid_range", 0, true);
  limit("valid_range", 1, false);
  limit("valid_min", 0, true);
  limit("valid_max", 0, false);

  const auto unit = variable.unit();
  if (!unit) {
    warnings.push_back(variable.name + " has no unit; taken as m/s");
    return component;
  }
  const auto scaling = units.scaling(*unit, "m/s");
  if (!scaling) return fault(variable.name + ": " + scaling.error().what);
  component.to_si_ = *scaling;
  return component;
}

double Component::operator()(double stored) const {
  constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  // Negated, so that NaN is outside.
  if (!(stored >= stored_low_ && stored <= stored_high_)) return kMissing;
  for (const double value : missing_)
    if (stored == value) return kMissing;
  const double value = stored * scale_ + offset_;
  if (!(value >= value_low_ && value <= value_high_) || !std::isfinite(value)) return kMissing;
  return to_si_.slope == 1 && to_si_.intercept == 0 ? value : to_si_(value);
}

}  // namespace glidehelm::ingest
