#include "daemon/ingest/component.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/base/text.hpp"

namespace glidehelm::ingest {

namespace {

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

constexpr const char* kFillNames[] = {"_FillValue", "FillValue", "FillValue_", "_fillvalue", "fill_value"};

/// A number of an attribute as the variable itself would hold it: a double 1.26765e+30 meant for a float is that float.
double in_type(double value, Type type) {
  return type == Type::float32 ? static_cast<double>(static_cast<float>(value)) : value;
}

}  // namespace

std::vector<double> numbers_of(const Variable& variable, std::string_view attribute) {
  const auto* found = variable.find(attribute);
  if (found == nullptr) return {};
  if (found->numbers.empty())
    if (const auto number = number_from(trimmed(found->text))) return {*number};
  return found->numbers;
}

Missing::Missing(const Variable& variable) : floating_{is_floating(variable.type)} {
  for (const char* name : kFillNames)
    for (const double value : numbers_of(variable, name)) marks_.push_back(variable.as_meant(value));
  if (marks_.empty()) marks_.push_back(default_fill(variable.type));
  fill_values_ = marks_.size();
  for (const double value : numbers_of(variable, "missing_value")) marks_.push_back(variable.as_meant(value));
}

Missing::Mark Missing::mark_of(double stored) const {
  if (!std::isfinite(stored)) return Mark::not_a_number;
  const auto fill = marks_.begin() + static_cast<std::ptrdiff_t>(fill_values_);
  return std::any_of(marks_.begin(), fill, [&](double mark) { return is(stored, mark); }) ? Mark::fill_value
                                                                                          : Mark::missing_value;
}

Result<Component> Component::of(const Variable& variable, const Units& units, const std::string& target,
                                std::vector<std::string>& warnings) {
  Component component{variable};
  const auto scale = numbers_of(variable, "scale_factor"), offset = numbers_of(variable, "add_offset");
  const bool packed = !scale.empty() || !offset.empty();
  if (!scale.empty()) component.scale_ = scale[0];
  if (!offset.empty()) component.offset_ = offset[0];
  if (!std::isfinite(component.scale_) || component.scale_ == 0 || !std::isfinite(component.offset_))
    return fault(variable.name + " has the impossible packing scale_factor " + std::to_string(component.scale_) +
                 ", add_offset " + std::to_string(component.offset_));
  if (const auto* mark = variable.find("missing_value");
      mark != nullptr && packed && is_floating(mark->type) && !is_floating(variable.type))
    component.missing_values_ = mark->numbers;
  component.read_valid_range(variable, packed);

  const auto unit = variable.unit();
  if (!unit) {
    warnings.push_back(variable.name + " has no unit; taken as " + target);
    return component;
  }
  const auto scaling = units.scaling(*unit, target);
  if (!scaling) return fault(variable.name + ": " + scaling.error().what);
  component.to_si_ = *scaling;
  return component;
}

void Component::read_valid_range(const Variable& variable, bool packed) {
  const auto limit = [&](const char* name, std::size_t index, bool low) {
    const auto numbers = numbers_of(variable, name);
    if (numbers.size() <= index) return;
    const bool unpacked = packed && is_floating(variable.find(name)->type) && !is_floating(variable.type);
    const double value = unpacked ? numbers[index] : in_type(variable.as_meant(numbers[index]), variable.type);
    if (low)
      (unpacked ? value_low_ : stored_low_) = value;
    else
      (unpacked ? value_high_ : stored_high_) = value;
  };
  limit("valid_range", 0, true);
  limit("valid_range", 1, false);
  limit("valid_min", 0, true);
  limit("valid_max", 0, false);
}

bool Component::outside_valid(double stored) const {
  if (stored_low_ && stored < *stored_low_) return true;
  if (stored_high_ && stored > *stored_high_) return true;
  if (!value_low_ && !value_high_) return false;
  const double value = stored * scale_ + offset_;
  return (value_low_ && value < *value_low_) || (value_high_ && value > *value_high_);
}

std::string Component::valid_text() const {
  const auto text = [](const std::optional<double>& stored, const std::optional<double>& value) {
    if (!stored && !value) return std::string{"any"};
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.6g", value ? *value : *stored);
    return std::string{buffer};
  };
  return text(stored_low_, value_low_) + " to " + text(stored_high_, value_high_);
}

}  // namespace glidehelm::ingest
