#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/chart/chart.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::cli {

/// One rehearsed flight.
struct Rehearsed {
  int seed{};
  double delay_h{};
  std::string method;
  std::string end;  ///< in the simulator's words
  std::optional<double> travel_s;
  std::optional<double> hindcast_s;  ///< planned with knowledge of that ocean
  int surfacings{}, files{}, missed{};
  std::optional<double> closest_coast;  ///< metres; none without a coastline
  double closest_goal{};                ///< metres
  std::optional<double> energy_wh;
  std::map<std::string, int> rules;  ///< verifier's rules that refused a file, with their number
  std::vector<GeoPoint> track;       ///< fixes
};

/// What a rehearsal showed.
struct Rehearsal {
  std::string mission, method, forecast, truth;
  GeoPoint start, goal;
  Metres goal_radius;
  std::vector<Rehearsed> runs;
};

/// Of one method and departure.
struct RehearsalSummary {
  std::string method;
  double delay_h{};
  int flights{}, arrived{}, missed{}, refused{};
  std::optional<double> median_s, tenth_s, ninetieth_s;  ///< travel times of those that arrived
  std::optional<double> median_regret;
  double median_surfacings{};
  std::optional<double> closest_coast, median_energy_wh;
};
std::vector<RehearsalSummary> summaries(const Rehearsal& rehearsal);

/// The share q of sorted values, with linear interpolation between the two nearest; none of nothing.
std::optional<double> quantile(std::vector<double> values, double q);

/// The document of product.md 9, with a line feed at its end.
std::string json_text(const Rehearsal& rehearsal);
/// The table for a terminal.
std::string table_text(const Rehearsal& rehearsal);
/// One page without anything from outside: map and table.
std::string html_text(const Rehearsal& rehearsal, const chart::Chart& chart);
/// Writes the page to a new file; what went wrong, or nothing.
std::string save_page(const Rehearsal& rehearsal, const chart::Chart& chart, const std::string& path,
                      world::Files& files);
/// "[####      ] 4 of 10 flights".
std::string progress_bar(std::size_t done, std::size_t of);

}  // namespace glidehelm::cli
