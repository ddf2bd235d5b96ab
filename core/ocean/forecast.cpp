#include "core/ocean/forecast.hpp"

#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

namespace glidehelm::ocean {

/// The fields themselves; built in place, because the sums refer to their neighbours.
struct Forecast::Parts {
  std::optional<GriddedField> dive, surface, full;
  std::vector<AnalyticField> analytic;
  std::optional<FieldSum> dive_sum, surface_sum, full_sum;
  ForecastFacts facts;

  /// The gridded field, or it and the analytic ones, or these alone.
  [[nodiscard]] FieldRef pick(const std::optional<GriddedField>& gridded, const std::optional<FieldSum>& sum) const {
    if (sum) return *sum;
    if (gridded) return *gridded;
    return analytic.front();
  }
  void add_up() {
    const auto sum_of = [this](const std::optional<GriddedField>& gridded) -> std::optional<FieldSum> {
      if (analytic.size() + (gridded ? 1 : 0) < 2) return std::nullopt;
      std::vector<FieldRef> refs;
      if (gridded) refs.emplace_back(*gridded);
      for (const auto& field : analytic) refs.emplace_back(field);
      return FieldSum{std::move(refs)};
    };
    dive_sum = sum_of(dive);
    surface_sum = sum_of(surface);
    full_sum = sum_of(full);
  }
};

namespace {

void append(std::string& text, double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, " %.17g", value);
  text += buffer;
}

/// Every number of a specification in a fixed order: what its hash is taken of.
std::string canonical(const AnalyticField& field) {
  const auto& spec = field.spec();
  std::string text = "analytic " + spec.kind;
  for (const double value :
       {spec.origin.lat.degrees(), spec.origin.lon.degrees(), spec.length_scale.si(), spec.speed_scale.si(),
        spec.time_scale ? spec.time_scale->count() : 0.0, field.t0_s(), spec.south ? 1.0 : 0.0})
    append(text, value);
  for (const auto& [name, value] : spec.params) {
    text += " " + name;
    append(text, value);
  }
  for (const auto& row : spec.gaussians)
    for (const double value : row) append(text, value);
  return text;
}

std::string names_of(const std::vector<AnalyticField>& fields) {
  std::string names;
  for (const auto& field : fields) names += (names.empty() ? "analytic " : " + analytic ") + field.spec().kind;
  return names;
}

std::string speed_text(double speed) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.2f m/s", speed);
  return buffer;
}

std::optional<ForecastError> check_speed(double fastest, std::vector<std::string>& warnings) {
  if (!(fastest <= Forecast::kRefusedSpeed * (1 + 1e-5)))
    return ForecastError{"the fastest current is " + speed_text(fastest) + ", allowed is at most " +
                         speed_text(Forecast::kRefusedSpeed)};
  if (fastest > Forecast::kWarnedSpeed) warnings.push_back("the fastest current is " + speed_text(fastest));
  return std::nullopt;
}

}  // namespace

Expected<Forecast, ForecastError> Forecast::prepare(const GridView& grid, const DiveProfile& profile,
                                                    const GriddedOptions& options,
                                                    std::shared_ptr<const void> keep_alive,
                                                    const std::vector<AnalyticField>& added) {
  auto parts = std::make_shared<Parts>();
  parts->full.emplace(grid, options, std::move(keep_alive));
  if (grid.axes.depths_m.size() == 1) {
    parts->dive = parts->full;
    parts->surface = parts->full;
  } else {
    parts->surface = parts->full->shallowest();
    Grid mean = depth_average(grid, profile);
    if (statistics_of(view_of(mean)).wet_fraction == 0)
      return unexpected(ForecastError{"no column has a current within the dive"});
    parts->dive.emplace(std::move(mean), options);
  }
  auto& facts = parts->facts;
  facts.warnings = grid.facts.warnings;
  const auto statistics = statistics_of(grid);
  if (statistics.wet_fraction == 0) return unexpected(ForecastError{"no node has a current"});
  if (auto error = check_speed(statistics.fastest, facts.warnings)) return unexpected(std::move(*error));

  const Coverage box = parts->full->coverage();
  for (const auto& field : added) parts->analytic.push_back(field.within({box.south, box.north, box.west, box.east}));
  facts.name = grid.facts.cycle;
  facts.reference_s = grid.facts.reference_s;
  facts.first_s = box.first_s;
  facts.last_s = box.last_s;
  facts.has_time = grid.axes.has_time;
  facts.levels = grid.axes.depths_m.size();
  facts.provenance = grid.provenance;
  if (!added.empty()) {
    facts.name += " + " + names_of(added);
    std::string all = grid.provenance.hex();
    for (const auto& field : added) all += "\n" + canonical(field);
    facts.provenance = Sha256::of(all);
  }
  if (options.mask_is_land) facts.warnings.emplace_back("no coastline: the model's mask is taken as land");
  if (options.outside_time == OutsideTime::cycle && facts.has_time && facts.last_s - facts.first_s < kTidalCycle)
    facts.warnings.emplace_back("the forecast is shorter than 24.84 h: its last field holds instead of a tidal cycle");
  parts->add_up();
  return Forecast{std::move(parts)};
}

Expected<Forecast, ForecastError> Forecast::prepare(const std::vector<AnalyticField>& fields) {
  if (fields.empty()) return unexpected(ForecastError{"no field was given"});
  auto parts = std::make_shared<Parts>();
  parts->analytic = fields;
  parts->facts.name = names_of(fields);
  std::string all;
  for (const auto& field : fields) all += canonical(field) + "\n";
  parts->facts.provenance = Sha256::of(all);
  parts->add_up();
  return Forecast{std::move(parts)};
}

Ocean Forecast::ocean() const {
  return {parts_->pick(parts_->dive, parts_->dive_sum), parts_->pick(parts_->surface, parts_->surface_sum)};
}
FieldRef Forecast::full() const { return parts_->pick(parts_->full, parts_->full_sum); }
const ForecastFacts& Forecast::facts() const { return parts_->facts; }

Seconds Forecast::age(Instant now) const {
  const auto& facts = parts_->facts;
  if (!std::isnan(facts.reference_s)) return Seconds{epoch_seconds(now) - facts.reference_s};
  if (!facts.has_time) return Seconds{0};
  return Seconds{epoch_seconds(now) - facts.first_s};
}

}  // namespace glidehelm::ocean
