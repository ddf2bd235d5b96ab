#include "daemon/ingest/water.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/text.hpp"
#include "daemon/ingest/box.hpp"
#include "daemon/ingest/recognise.hpp"

namespace glidehelm::ingest {

namespace {

/// A name and whether it means the potential (of salinities: absolute) kind.
struct WaterName {
  std::string_view name;
  bool other_kind;
};
constexpr std::array<WaterName, 3> kTemperatures{{{"sea_water_temperature", false},
                                                  {"sea_water_potential_temperature", true},
                                                  {"sea_water_conservative_temperature", true}}};
constexpr std::array<WaterName, 3> kSalinities{
    {{"sea_water_practical_salinity", false}, {"sea_water_salinity", false}, {"sea_water_absolute_salinity", true}}};
constexpr std::array<WaterName, 7> kTemperatureNames{{{"temp", true},
                                                      {"thetao", true},
                                                      {"votemper", true},
                                                      {"water_temp", false},
                                                      {"temperature", false},
                                                      {"theta", true},
                                                      {"toce", true}}};
constexpr std::array<WaterName, 6> kSalinityNames{
    {{"salt", false}, {"so", false}, {"vosaline", false}, {"salinity", false}, {"soce", false}, {"psal", false}}};

struct WaterChoice {
  Found found;
  bool other_kind{};
  std::string why;
};

/// Of the variables whose text (`of`) is one of `known` the one with the most dimensions; of equals the one that is known first.
template <std::size_t N, class Of>
std::optional<WaterChoice> choose(const ModelFiles& files, const std::array<WaterName, N>& known, const char* what,
                                  Of of) {
  std::optional<WaterChoice> choice;
  for (const auto& one : known)
    for (const auto* file : files.files())
      for (const auto& variable : file->variables()) {
        const std::size_t rank = variable.dimensions.size();
        if (!is_number(variable.type) || rank < 2 || lower(of(variable)) != one.name) continue;
        if (choice && choice->found.variable->dimensions.size() >= rank) continue;
        choice = {{file, &variable}, one.other_kind, std::string{what} + " " + std::string{one.name}};
      }
  return choice;
}

template <std::size_t N, std::size_t M>
std::optional<WaterChoice> recognise(const ModelFiles& files, const std::array<WaterName, N>& standard,
                                     const std::array<WaterName, M>& names) {
  if (auto found = choose(files, standard, "standard_name", [](const Variable& v) { return v.text("standard_name"); }))
    return found;
  return choose(files, names, "name", [](const Variable& v) { return v.name; });
}

bool spelt(std::string_view text, std::initializer_list<std::string_view> list) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

/// The variable with another unit, which it does not lack.
Result<Component> component_in(Variable variable, const std::string& unit, const Units& units,
                               const std::string& target) {
  std::erase_if(variable.attributes,
                [](const Attribute& a) { return lower(a.name) == "units" || lower(a.name) == "unit"; });
  variable.attributes.push_back({"units", Type::text, unit, {}});
  std::vector<std::string> ignored;
  return Component::of(variable, units, target, ignored);
}

std::string names_of(const WaterVariables& variables) {
  return variables.temperature.variable->name + " and " + variables.salinity.variable->name;
}

/// By node [latitude][longitude]: a current at the shallowest depth at any time. Empty where the box has other nodes.
std::vector<bool> nodes_with_current(const ocean::Grid& currents, const Box& box) {
  const auto& axes = currents.axes;
  if (axes.lats_deg != box.lats.values || axes.lons_deg != box.lons.values) return {};
  const std::size_t plane = axes.lats_deg.size() * axes.lons_deg.size();
  std::vector<bool> wet(plane, false);
  for (std::size_t t = 0; t < axes.times_s.size(); ++t)
    for (std::size_t n = 0; n < plane; ++n)
      if (!std::isnan(currents.values[2 * (t * axes.depths_m.size() * plane + n)])) wet[n] = true;
  return wet;
}

/// One variable over its box.
struct WaterField {
  const NetcdfFile& file;
  const Variable& variable;
  Axes axes;
  Box box;
  Component component;
  std::vector<float> values{};  ///< of one time

  Result<Done> read(std::size_t time) {
    Box one = box;
    one.times = {{box.times.values[time]}, {box.times.source[time]}};
    values.resize(one.axes().nodes());
    const auto told = read_values(file, variable, axes, one, component, values.data(), 1);
    if (!told) return unexpected(told.error());
    return Done{};
  }
};

Result<WaterField> field_of(const Found& found, Result<Component> component, const Units& units,
                            const ReadOptions& options) {
  if (!component) return unexpected(component.error());
  const auto axes = recognise_axes(*found.file, *found.variable);
  if (!axes) return unexpected(axes.error());
  std::vector<std::string> said_of_the_currents;
  auto box = read_box(*found.file, *axes, units, options, said_of_the_currents);
  if (!box) return unexpected(box.error());
  return WaterField{*found.file, *found.variable, *axes, std::move(*box), *component};
}

void add_columns(const WaterField& temperature, const WaterField& salinity, const std::vector<bool>& wet,
                 WaterMean& mean) {
  const std::size_t levels = temperature.box.depths.values.size(), plane = temperature.values.size() / levels;
  std::vector<double> t(levels), s(levels);
  for (std::size_t n = 0; n < plane; ++n) {
    if (!wet.empty() && !wet[n]) continue;
    for (std::size_t k = 0; k < levels; ++k) {
      t[k] = temperature.values[k * plane + n];
      s[k] = salinity.values[k * plane + n];
    }
    mean.add(t, s);
  }
}

}  // namespace

std::optional<WaterVariables> recognise_water(const ModelFiles& files) {
  const auto temperature = recognise(files, kTemperatures, kTemperatureNames);
  const auto salinity = recognise(files, kSalinities, kSalinityNames);
  if (!temperature || !salinity) return std::nullopt;
  const bool said = temperature->why.starts_with("name") &&
                    lower(temperature->found.variable->text("long_name")).find("potential") != std::string::npos;
  return WaterVariables{temperature->found, salinity->found, temperature->other_kind || said, salinity->other_kind,
                        temperature->why};
}

Result<Component> temperature_component(const Variable& variable, const Units& units) {
  std::string unit = variable.unit().value_or("celsius"), plain = lower(trimmed(unit));
  std::replace(plain.begin(), plain.end(), '_', ' ');
  if (spelt(plain, {"c", "deg c", "degree c", "degrees c", "degc", "degsc", "degreec", "degreesc", "°c", "celcius",
                    "centigrade", "degree celsius", "degrees celsius", "deg celsius"}))
    unit = "celsius";
  if (spelt(plain, {"k", "deg k", "degk", "degrees k", "degree k"})) unit = "kelvin";
  return component_in(variable, unit, units, "celsius");
}

Result<Component> salinity_component(const Variable& variable, const Units& units) {
  constexpr const char* kCounted = "1e-3";  // g/kg: the number that a practical salinity has too
  std::string unit = variable.unit().value_or(kCounted);
  // A practical salinity of 35 "1" is 35, not 35 parts of one; UDUNITS knows neither psu nor that ppt is a thousandth here.
  if (spelt(lower(trimmed(unit)), {"1", "psu", "pss", "pss-78", "pss78", "practical salinity unit",
                                   "practical salinity units", "ppt", "parts per thousand", "per mil", "‰", "o/oo"}))
    unit = kCounted;
  return component_in(variable, unit, units, kCounted);
}

std::vector<std::size_t> times_to_read(std::size_t times) {
  constexpr std::size_t kAtMost = 8;
  std::vector<std::size_t> chosen;
  const std::size_t count = std::min(times, kAtMost);
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(count == 1 ? 0 : k * (times - 1) / (count - 1));
  return chosen;
}

ocean::GridWater no_water(const WaterVariables& variables, const std::string& why) {
  return {{}, names_of(variables) + " are not used: " + why};
}

ocean::GridWater water_of(const WaterMean& mean, const std::vector<double>& depths_m, const WaterVariables& variables,
                          std::size_t times_read, std::size_t times) {
  if (mean.impossible()) return no_water(variables, "they hold " + *mean.impossible());
  auto layers = mean.layers(depths_m);
  if (layers.empty()) return no_water(variables, "they have no value in the water");
  if (layers.size() < 2) return no_water(variables, "they are of one depth only");
  for (auto& layer : layers) {
    if (variables.absolute) layer.salinity = ocean::practical_salinity(layer.salinity);
    if (variables.potential)
      layer.temperature_c = ocean::in_situ_temperature(layer.salinity, layer.temperature_c,
                                                       ocean::pressure_at(Metres{std::max(0.0, layer.depth.si())}));
    if (!ocean::plausible(layer))
      return no_water(variables,
                      printed("the mean is %.6g °C with salinity %.6g", layer.temperature_c, layer.salinity));
  }
  return {std::move(layers), names_of(variables) + " (" + variables.why + "), the mean of " +
                                 std::to_string(mean.columns()) + " columns of water, " + std::to_string(times_read) +
                                 " of " + std::to_string(times) + (times == 1 ? " time" : " times")};
}

ocean::GridWater read_water(const NetcdfFile& file, const Units& units, const ReadOptions& options,
                            const ocean::Grid& currents) {
  const ModelFiles files{{&file}};
  const auto variables = recognise_water(files);
  if (!variables) return {};
  auto temperature =
      field_of(variables->temperature, temperature_component(*variables->temperature.variable, units), units, options);
  if (!temperature) return no_water(*variables, temperature.error().what);
  auto salinity =
      field_of(variables->salinity, salinity_component(*variables->salinity.variable, units), units, options);
  if (!salinity) return no_water(*variables, salinity.error().what);
  const auto &a = temperature->box, &b = salinity->box;
  if (a.lats.values != b.lats.values || a.lons.values != b.lons.values || a.depths.values != b.depths.values ||
      a.times.values.size() != b.times.values.size())
    return no_water(*variables, "they lie on different nodes");
  if (!a.has_depth) return no_water(*variables, "they are of one depth only");
  if (a.depths.values.size() > kWaterLevelsAtMost) return no_water(*variables, "they have too many depths");
  const auto wet = nodes_with_current(currents, a);
  WaterMean mean{a.depths.values.size()};
  const auto times = times_to_read(a.times.values.size());
  for (const std::size_t time : times) {
    for (auto* field : {&*temperature, &*salinity})
      if (auto read = field->read(time); !read) return no_water(*variables, read.error().what);
    add_columns(*temperature, *salinity, wet, mean);
  }
  return water_of(mean, a.depths.values, *variables, times.size(), a.times.values.size());
}

}  // namespace glidehelm::ingest
