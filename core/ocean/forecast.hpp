#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/ocean/analytic.hpp"
#include "core/ocean/composite.hpp"
#include "core/ocean/depth_average.hpp"
#include "core/ocean/gridded.hpp"

namespace glidehelm::ocean {

/// What a forecast says of itself, for log, journal and answers.
struct ForecastFacts {
  std::string name;                                              ///< source and cycle, or the analytic kinds
  double reference_s{std::numeric_limits<double>::quiet_NaN()};  ///< forecast reference time; NaN when not named
  double first_s{-1e18}, last_s{1e18};                           ///< epoch seconds of the first and last field
  std::optional<double> issued_s;                                ///< from when it ages, see freshness.hpp
  bool has_time{};                                               ///< false: the same at every instant
  std::size_t levels{1};                                         ///< depth levels
  Sha256 provenance;                                             ///< over everything that went in
  std::vector<std::string> sources;                              ///< names, most trusted first; empty without `sources`
  std::vector<std::string> warnings;
  GridWater water;  ///< of the most trusted source that has one
};

/// Why numbers are no forecast to plan on.
struct ForecastError {
  std::string what;
  [[nodiscard]] const std::string& message() const { return what; }
  friend bool operator==(const ForecastError&, const ForecastError&) = default;
};

/// One source of a forecast: a grid and what it counts for.
struct ForecastSource {
  std::string name;  ///< empty: the only one
  GridView grid;
  GriddedOptions options;
  std::shared_ptr<const void> keep_alive;  ///< owns the grid's bytes
  SourceRegion region{};
  double from_s{-1e18}, to_s{1e18};  ///< epoch seconds
};

/// The water of the most trusted source that has one; without any, what is said of why.
GridWater water_of(const std::vector<ForecastSource>& sources);

/// One forecast, prepared for planning: the mean over the dive profile that moves a diving glider, the shallowest current
/// that moves a drifting one, and the full field that the verifier flies in. A value: copies share the fields, which are
/// immutable, so a plan that runs keeps the forecast it started with.
class Forecast {
 public:
  /// Currents faster than this are not believed (product.md 7); from `kWarnedSpeed` on they are warned about.
  static constexpr double kRefusedSpeed = 5.0, kWarnedSpeed = 3.5;

  /// From a grid. `keep_alive` owns the grid's bytes (a mapping). A two-dimensional grid is used in place; of a grid with
  /// depths the dive mean is computed and owned (O(values), once). Analytic fields are added to it, on its box. Refused:
  /// no water at all, or a current faster than kRefusedSpeed. `turning`: where the bottom limits the dive.
  static Expected<Forecast, ForecastError> prepare(const GridView& grid, const DiveProfile& profile,
                                                   const GriddedOptions& options,
                                                   std::shared_ptr<const void> keep_alive,
                                                   const std::vector<AnalyticField>& added = {},
                                                   const TurningDepth& turning = {});
  /// From sources in order of trust (at least one), one over the other as CompositeField has it; one that counts everywhere
  /// and always is as above. What is wrong with them taken together is a warning.
  static Expected<Forecast, ForecastError> prepare(const std::vector<ForecastSource>& sources, const Seams& seams,
                                                   const DiveProfile& profile,
                                                   const std::vector<AnalyticField>& added = {},
                                                   const TurningDepth& turning = {});
  /// From analytic fields alone (at least one).
  static Expected<Forecast, ForecastError> prepare(const std::vector<AnalyticField>& fields);

  /// What planners take. The references stay valid as long as any copy of this forecast lives.
  [[nodiscard]] Ocean ocean() const;
  /// With depth where the source has it: what the verifier takes.
  [[nodiscard]] FieldRef full() const;
  /// The share of each source in the dive mean there, in the order of trust: {1} for a forecast of one, empty for formulas.
  [[nodiscard]] std::vector<double> shares(GeoPoint p, double t_s) const;
  [[nodiscard]] const ForecastFacts& facts() const;
  /// Time since the forecast's reference time, or since its first field when none is named; 0 for fields without time.
  [[nodiscard]] Seconds age(Instant now) const;

 private:
  struct Parts;
  explicit Forecast(std::shared_ptr<const Parts> parts) : parts_{std::move(parts)} {}
  std::shared_ptr<const Parts> parts_;
};

}  // namespace glidehelm::ocean
