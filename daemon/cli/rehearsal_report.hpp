#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/quantile.hpp"
#include "core/chart/chart.hpp"
#include "daemon/cli/progress_bar.hpp"

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
  double departure_s{};  ///< epoch seconds, without a delay
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
  std::map<std::string, int> rules;  ///< of all flights
};
std::vector<RehearsalSummary> summaries(const Rehearsal& rehearsal);

/// Flown over planned with knowledge of the ocean, less one; none when either does not arrive.
std::optional<double> regret(const Rehearsed& run);

/// The document of product.md 9, with a line feed at its end.
std::string json_text(const Rehearsal& rehearsal);
/// The table for a terminal.
std::string table_text(const Rehearsal& rehearsal);
/// A sentence for each departure: who arrives, and when.
std::string verdict_text(const Rehearsal& rehearsal);
/// Heads and cells of the table, also of the page's.
const std::vector<std::string>& summary_columns();
std::vector<std::string> summary_row(const RehearsalSummary& summary);
/// Numbers as the tables have them, without units; "-" when there is none. ">60" kilometres: farther than a chart looks.
std::string in_hours(const std::optional<double>& seconds);
std::string in_percent(const std::optional<double>& share);
std::string in_kilometres(const std::optional<double>& metres);
std::string in_watt_hours(const std::optional<double>& energy);
/// "2 x promise arrival, 1 x 2 land".
std::string rules_text(const std::map<std::string, int>& rules);

}  // namespace glidehelm::cli
