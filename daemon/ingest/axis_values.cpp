#include "daemon/ingest/axis_values.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "daemon/ingest/component.hpp"

namespace glidehelm::ingest {

namespace {

std::string number(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

/// The raw values of a coordinate; fill values and NaN are faults: an axis has no holes.
Result<std::vector<double>> raw_values(const NetcdfFile& file, const Variable& coordinate) {
  auto values = file.read(coordinate);
  if (!values) return values;
  if (values->empty()) return fault("axis " + coordinate.name + " is empty");
  const Missing missing{coordinate};
  for (std::size_t i = 0; i < values->size(); ++i)
    if (missing((*values)[i]) || std::abs((*values)[i]) > 9e36)
      return fault("axis " + coordinate.name + " has no value at index " + std::to_string(i));
  const auto scale = numbers_of(coordinate, "scale_factor"), offset = numbers_of(coordinate, "add_offset");
  for (double& value : *values) {
    if (!scale.empty()) value *= scale[0];
    if (!offset.empty()) value += offset[0];
  }
  return values;
}

/// Turns a descending axis round; anything else than strictly monotone is a fault.
Result<Ascending> ascending(std::vector<double> values, const std::string& name) {
  Ascending axis;
  axis.source.resize(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) axis.source[k] = k;
  if (values.size() > 1 && values.back() < values.front()) {
    std::reverse(values.begin(), values.end());
    std::reverse(axis.source.begin(), axis.source.end());
  }
  for (std::size_t k = 1; k < values.size(); ++k)
    if (!(values[k] > values[k - 1]))
      return fault("axis " + name + " neither ascends nor descends at index " + std::to_string(axis.source[k]) + " (" +
                   number(values[k]) + ")");
  axis.values = std::move(values);
  return axis;
}

Result<std::vector<double>> scaled_values(const NetcdfFile& file, const Variable& coordinate, const Units& units,
                                          const std::string& target, std::vector<std::string>& warnings) {
  auto values = raw_values(file, coordinate);
  if (!values) return values;
  const auto unit = coordinate.unit();
  if (!unit) {
    warnings.push_back("axis " + coordinate.name + " has no unit; taken as " + target);
    return values;
  }
  const auto scaling = units.scaling(*unit, target);
  if (!scaling) return fault("axis " + coordinate.name + ": " + scaling.error().what);
  // A conversion of degrees to degrees must not touch the last digit.
  if (scaling->slope != 1 || scaling->intercept != 0)
    for (double& value : *values) value = (*scaling)(value);
  return values;
}

}  // namespace

Result<Ascending> latitudes(const NetcdfFile& file, const Variable& coordinate, const Units& units,
                            std::vector<std::string>& warnings) {
  auto values = scaled_values(file, coordinate, units, "degrees", warnings);
  if (!values) return unexpected(values.error());
  for (double& value : *values) {
    // A pole that was computed in floats may lie a hair beyond itself.
    if (std::abs(value) > 90 && std::abs(value) < 90.0001) value = std::copysign(90.0, value);
    if (std::abs(value) > 90)
      return fault("latitude " + number(value) + " in " + coordinate.name + ", allowed is -90 to 90");
  }
  if (values->size() < 2) return fault("axis " + coordinate.name + " has one value, allowed is two or more");
  return ascending(std::move(*values), coordinate.name);
}

Result<Ascending> longitudes(const NetcdfFile& file, const Variable& coordinate, const Units& units,
                             std::vector<std::string>& warnings) {
  auto values = scaled_values(file, coordinate, units, "degrees", warnings);
  if (!values) return unexpected(values.error());
  if (values->size() < 2) return fault("axis " + coordinate.name + " has one value, allowed is two or more");
  for (const double value : *values)
    if (std::abs(value) > 540)
      return fault("longitude " + number(value) + " in " + coordinate.name + ", allowed is -360 to 360");
  // A jump of most of a turn within the axis is the seam of the file's convention, not a step of the grid.
  for (std::size_t k = 1; k < values->size(); ++k) {
    double& value = (*values)[k];
    const double step = value - (*values)[k - 1];
    if (step < -180) value += 360 * std::ceil((-step - 180) / 360);
    if (step > 180) value -= 360 * std::ceil((step - 180) / 360);
  }
  auto axis = ascending(std::move(*values), coordinate.name);
  if (!axis) return axis;
  const double turn = 360 * std::floor((axis->values.front() + 180) / 360);
  for (double& value : axis->values) value -= turn;
  while (axis->values.size() > 2 && axis->values.back() - axis->values.front() > 360 - 1e-4) {
    if (axis->values.back() - axis->values.front() > 360 + 1e-4)
      return fault("axis " + coordinate.name + " goes more than once around the globe");
    axis->values.pop_back();
    axis->source.pop_back();
  }
  return axis;
}

Result<Ascending> depths(const NetcdfFile& file, const Variable& coordinate, const Units& units,
                         std::vector<std::string>& warnings) {
  auto values = scaled_values(file, coordinate, units, "m", warnings);
  if (!values) return unexpected(values.error());
  const bool none_below = std::all_of(values->begin(), values->end(), [](double z) { return z <= 0; });
  const bool all_zero = std::all_of(values->begin(), values->end(), [](double z) { return z == 0; });
  if (lower(coordinate.text("positive")) == "up" || (none_below && !all_zero))
    for (double& value : *values) value = 0.0 - value;
  for (const double value : *values)
    if (value < -100 || value > 12000)
      return fault("depth " + number(value) + " m in " + coordinate.name + ", allowed is -100 to 12000");
  return ascending(std::move(*values), coordinate.name);
}

Result<Ascending> times(const NetcdfFile& file, const Variable& coordinate, const Units& units,
                        std::optional<Instant> epoch, std::vector<std::string>& warnings) {
  auto values = raw_values(file, coordinate);
  if (!values) return unexpected(values.error());
  std::string unit = coordinate.unit().value_or("");
  if (!names_epoch(unit)) {
    if (!epoch)
      return fault("axis " + coordinate.name +
                   (unit.empty() ? " has no unit" : " has the unit \"" + unit + "\" without an epoch") +
                   "; say its epoch with --time-epoch TIME");
    if (unit.empty()) {
      unit = "seconds";
      warnings.push_back("axis " + coordinate.name + " has no unit; taken as seconds since the given epoch");
    }
    const auto seconds = units.scaling(unit, "s");
    if (!seconds) return fault("axis " + coordinate.name + ": " + seconds.error().what);
    for (double& value : *values) value = (*seconds)(value) + epoch_seconds(*epoch);
  } else {
    const auto scaling = units.time_scaling(unit, coordinate.text("calendar"));
    if (!scaling) return fault("axis " + coordinate.name + ": " + scaling.error().what);
    if (counts_in_months(unit))
      warnings.push_back("axis " + coordinate.name + " counts in \"" + unit + "\": every such unit is taken as " +
                         number(scaling->slope / 86400) + " days, as UDUNITS does");
    if (coordinate.type == Type::float32) {
      // Whole units and their eighths are what was meant; anything else was rounded when it was stored.
      double rounded = 0;
      for (const double value : *values)
        if (8 * value != std::floor(8 * value)) rounded = std::max(rounded, std::abs(value));
      const double grain = std::abs(scaling->slope) * rounded * 0x1p-24;
      if (grain > 1)
        warnings.push_back("axis " + coordinate.name + " stores times as floats: known to " + number(grain) + " s");
    }
    for (double& value : *values) value = (*scaling)(value);
  }
  for (double& value : *values) {
    value = std::round(value * 1e3) * 1e-3;
    if (!(std::abs(value) < 1e11))
      return fault("axis " + coordinate.name + " has the impossible time " + number(value) + " s since 1970");
  }
  return ascending(std::move(*values), coordinate.name);
}

namespace {

void keep(Ascending& axis, std::size_t first, std::size_t last) {
  const auto part = [&](auto& all) {
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(last) + 1, all.end());
    all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(first));
  };
  part(axis.values);
  part(axis.source);
}

/// Keeps the values that cover [low, high], one beyond each end.
bool cut_axis(Ascending& axis, double low, double high) {
  auto& v = axis.values;
  if (high < v.front() || low > v.back()) return false;
  auto first = static_cast<std::size_t>(std::upper_bound(v.begin(), v.end(), low) - v.begin());
  auto last = static_cast<std::size_t>(std::lower_bound(v.begin(), v.end(), high) - v.begin());
  first = first > 0 ? first - 1 : 0;
  last = std::min(last, v.size() - 1);
  if (first == last) first > 0 ? --first : ++last;
  keep(axis, first, last);
  return true;
}

bool around_globe(const std::vector<double>& lons) {
  double widest = 0;
  for (std::size_t i = 1; i < lons.size(); ++i) widest = std::max(widest, lons[i] - lons[i - 1]);
  return 360 - (lons.back() - lons.front()) <= 1.001 * widest;
}

/// Rotates a global axis so that it begins with the last column at or west of `west`.
void rotate_to(Ascending& axis, double west) {
  const double from = axis.values.front();
  west = from + std::fmod(std::fmod(west - from, 360) + 360, 360);
  const auto above = std::upper_bound(axis.values.begin(), axis.values.end(), west);
  const auto first = above - axis.values.begin() - 1;
  std::rotate(axis.source.begin(), axis.source.begin() + first, axis.source.end());
  std::rotate(axis.values.begin(), axis.values.begin() + first, axis.values.end());
  for (auto value = axis.values.end() - first; value != axis.values.end(); ++value) *value += 360;
}

}  // namespace

Result<Done> cut(Ascending& lats, Ascending& lons, const Area& area) {
  const auto extent = [](const Ascending& axis) {
    return number(axis.values.front()) + " to " + number(axis.values.back());
  };
  const std::string covers = "the grid covers latitudes " + extent(lats) + ", longitudes " + extent(lons);
  if (around_globe(lons.values) && area.east - area.west < 359) rotate_to(lons, area.west);
  const double turn =
      360 * std::round((0.5 * (lons.values.front() + lons.values.back()) - 0.5 * (area.west + area.east)) / 360);
  const bool global = area.east - area.west >= 359;
  if (!cut_axis(lats, area.south, area.north) || (!global && !cut_axis(lons, area.west + turn, area.east + turn)))
    return fault("nothing of it lies in the area asked for: " + covers);
  const double back = 360 * std::floor((lons.values.front() + 180) / 360);
  for (double& value : lons.values) value -= back;
  return Done{};
}

}  // namespace glidehelm::ingest
