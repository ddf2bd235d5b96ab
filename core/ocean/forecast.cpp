#include "core/ocean/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "core/ocean/freshness.hpp"

namespace glidehelm::ocean {

/// The fields themselves; built in place, because the sums refer to their neighbours.
struct Forecast::Parts {
  /// One of the three fields: of one source or of several, with formulas or without.
  struct Role {
    std::optional<GriddedField> one;
    std::optional<CompositeField> many;
    std::optional<FieldSum> sum;
    /// The gridded part, if there is one.
    [[nodiscard]] std::optional<FieldRef> gridded() const {
      if (many) return FieldRef{*many};
      if (one) return FieldRef{*one};
      return std::nullopt;
    }
  };
  Role dive, surface, full;
  std::vector<AnalyticField> analytic;
  ForecastFacts facts;

  /// The gridded field, or it and the analytic ones, or these alone.
  [[nodiscard]] FieldRef pick(const Role& role) const {
    if (role.sum) return *role.sum;
    if (const auto gridded = role.gridded()) return *gridded;
    return analytic.front();
  }
  void add_up() {
    for (auto* role : {&dive, &surface, &full}) {
      std::vector<FieldRef> refs;
      if (const auto gridded = role->gridded()) refs.push_back(*gridded);
      for (const auto& field : analytic) refs.emplace_back(field);
      if (refs.size() > 1) role->sum.emplace(std::move(refs));
    }
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

/// The three fields of one source.
struct Prepared {
  GriddedField dive, surface, full;
};

Expected<Prepared, ForecastError> prepare_source(const ForecastSource& source, const DiveProfile& profile,
                                                 const TurningDepth& turning) {
  GriddedField full{source.grid, source.options, source.keep_alive};
  if (source.grid.axes.depths_m.size() == 1) return Prepared{full, full, full};
  Grid mean = depth_average(source.grid, profile, turning);
  if (statistics_of(view_of(mean)).wet_fraction == 0)
    return unexpected(ForecastError{"no column has a current within the dive"});
  return Prepared{GriddedField{std::move(mean), source.options}, full.shallowest(), full};
}

/// The facts of one source; a warning names it where there are several.
std::optional<ForecastError> add_facts(const ForecastSource& source, const GriddedField& full, bool several,
                                       ForecastFacts& facts) {
  const auto& grid = source.grid;
  const bool first = facts.name.empty();
  std::vector<std::string> warnings = grid.facts.warnings;
  const auto statistics = statistics_of(grid);
  if (statistics.wet_fraction == 0) return ForecastError{"no node has a current"};
  if (auto error = check_speed(statistics.fastest, warnings)) return error;
  const auto& options = source.options;
  const auto box = full.coverage();
  if (options.mask_is_land) warnings.emplace_back("no coastline: the model's mask is taken as land");
  if (options.outside_time == OutsideTime::cycle && grid.axes.has_time && box.last_s - box.first_s < kTidalCycle)
    warnings.emplace_back("the forecast is shorter than 24.84 h: its last field holds instead of a tidal cycle");
  for (const auto& warning : warnings)
    facts.warnings.push_back(several ? "source '" + source.name + "': " + warning : warning);
  facts.name += (first ? "" : " over ") + grid.facts.cycle;
  if (std::isnan(facts.reference_s)) facts.reference_s = grid.facts.reference_s;
  if (const auto issued = issued_s(grid.axes, grid.facts, options.outside_time))
    facts.issued_s = std::min(*issued, facts.issued_s.value_or(*issued));
  facts.has_time = facts.has_time || grid.axes.has_time;
  facts.levels = std::max(facts.levels, grid.axes.depths_m.size());
  return std::nullopt;
}

/// One name for all that went in: of a single grid its own.
Sha256 provenance_of(const std::vector<ForecastSource>& sources, const Seams& seams,
                     const std::vector<AnalyticField>& added) {
  const auto& only = sources.front();
  std::string all = only.grid.provenance.hex();
  if (sources.size() > 1 || !only.name.empty()) {
    all = "composite";
    append(all, seams.blend.si());
    append(all, seams.join.count());
    for (const auto& source : sources) {
      all += "\n" + source.grid.provenance.hex() + " " + source.name;
      append(all, source.from_s);
      append(all, source.to_s);
      for (const auto& corner : source.region.corners()) {
        append(all, corner.lat.radians());
        append(all, corner.lon.radians());
      }
    }
  } else if (added.empty()) {
    return only.grid.provenance;
  }
  for (const auto& field : added) all += "\n" + canonical(field);
  return Sha256::of(all);
}

}  // namespace

GridWater water_of(const std::vector<ForecastSource>& sources) {
  GridWater found;
  for (const auto& source : sources) {
    const auto& water = source.grid.facts.water;
    if (water.layers.empty() && (water.words.empty() || !found.words.empty())) continue;
    found = water;
    if (sources.size() > 1) found.words = "source '" + source.name + "': " + water.words;
    if (!found.layers.empty()) break;
  }
  return found;
}

Expected<Forecast, ForecastError> Forecast::prepare(const GridView& grid, const DiveProfile& profile,
                                                    const GriddedOptions& options,
                                                    std::shared_ptr<const void> keep_alive,
                                                    const std::vector<AnalyticField>& added,
                                                    const TurningDepth& turning) {
  return prepare({ForecastSource{{}, grid, options, std::move(keep_alive)}}, Seams{}, profile, added, turning);
}

Expected<Forecast, ForecastError> Forecast::prepare(const std::vector<ForecastSource>& sources, const Seams& seams,
                                                    const DiveProfile& profile, const std::vector<AnalyticField>& added,
                                                    const TurningDepth& turning) {
  if (sources.empty()) return unexpected(ForecastError{"no source was given"});
  const auto& only = sources.front();
  const bool several = sources.size() > 1;
  const bool limited = !only.region.everywhere() || only.from_s > -1e17 || only.to_s < 1e17;
  auto parts = std::make_shared<Parts>();
  auto& facts = parts->facts;
  std::vector<CompositeSource> dive, surface, full;
  for (const auto& source : sources) {
    const auto wrong = [&](const ForecastError& error) {
      return unexpected(ForecastError{several ? "source '" + source.name + "': " + error.what : error.what});
    };
    auto fields = prepare_source(source, profile, turning);
    if (!fields) return wrong(fields.error());
    if (auto error = add_facts(source, fields->full, several, facts)) return wrong(*error);
    if (!source.name.empty()) facts.sources.push_back(source.name);
    dive.push_back({source.name, fields->dive, source.region, source.from_s, source.to_s});
    surface.push_back({source.name, fields->surface, source.region, source.from_s, source.to_s});
    full.push_back({source.name, fields->full, source.region, source.from_s, source.to_s});
  }
  if (several || limited) {
    parts->dive.many.emplace(std::move(dive), seams);
    parts->surface.many.emplace(std::move(surface), seams);
    parts->full.many.emplace(std::move(full), seams);
    for (auto& fault : parts->full.many->faults()) facts.warnings.push_back(std::move(fault));
  } else {
    parts->dive.one = dive.front().field;
    parts->surface.one = surface.front().field;
    parts->full.one = full.front().field;
  }
  const Coverage box = parts->full.gridded()->coverage();
  facts.first_s = box.first_s;
  facts.last_s = box.last_s;
  for (const auto& field : added) parts->analytic.push_back(field.within({box.south, box.north, box.west, box.east}));
  if (!added.empty()) facts.name += " + " + names_of(added);
  facts.provenance = provenance_of(sources, seams, added);
  facts.water = water_of(sources);
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

Ocean Forecast::ocean() const { return {parts_->pick(parts_->dive), parts_->pick(parts_->surface)}; }
FieldRef Forecast::full() const { return parts_->pick(parts_->full); }
std::vector<double> Forecast::shares(GeoPoint p, double t_s) const {
  if (parts_->dive.many) return parts_->dive.many->weights(p, Depth{}, t_s);
  return std::vector<double>(parts_->dive.one ? 1 : 0, 1.0);
}
const ForecastFacts& Forecast::facts() const { return parts_->facts; }

Seconds Forecast::age(Instant now) const {
  const auto& facts = parts_->facts;
  if (!std::isnan(facts.reference_s)) return Seconds{epoch_seconds(now) - facts.reference_s};
  if (!facts.has_time) return Seconds{0};
  return Seconds{epoch_seconds(now) - facts.first_s};
}

}  // namespace glidehelm::ocean
