#include "daemon/cli/rehearsal_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/utc.hpp"

namespace glidehelm::cli {

namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

RehearsalSummary summary_of(const std::vector<const Rehearsed*>& runs) {
  RehearsalSummary s;
  s.method = runs.front()->method;
  s.delay_h = runs.front()->delay_h;
  std::vector<double> times, regrets, surfacings, energies;
  for (const auto* r : runs) {
    ++s.flights;
    s.missed += r->missed;
    for (const auto& [rule, refusals] : r->rules) {
      s.refused += refusals;
      s.rules[rule] += refusals;
    }
    surfacings.push_back(r->surfacings);
    if (r->travel_s) times.push_back(*r->travel_s);
    if (const auto more = regret(*r)) regrets.push_back(*more);
    if (r->energy_wh) energies.push_back(*r->energy_wh);
    if (r->closest_coast) s.closest_coast = std::min(s.closest_coast.value_or(*r->closest_coast), *r->closest_coast);
  }
  s.arrived = static_cast<int>(times.size());
  s.median_s = quantile(times, 0.5);
  s.tenth_s = quantile(times, 0.1);
  s.ninetieth_s = quantile(times, 0.9);
  s.median_regret = quantile(regrets, 0.5);
  s.median_surfacings = *quantile(surfacings, 0.5);
  s.median_energy_wh = quantile(energies, 0.5);
  return s;
}

}  // namespace

const std::vector<std::string>& summary_columns() {
  static const std::vector<std::string> columns{"method",     "delay h", "arrived", "median h", "10-90 % h", "regret %",
                                                "surfacings", "missed",  "refused", "coast km", "energy Wh"};
  return columns;
}

std::vector<std::string> summary_row(const RehearsalSummary& s) {
  return {s.method,
          fmt::format("{:g}", s.delay_h),
          fmt::format("{} of {}", s.arrived, s.flights),
          in_hours(s.median_s),
          s.median_s ? in_hours(s.tenth_s) + " - " + in_hours(s.ninetieth_s) : "-",
          in_percent(s.median_regret),
          fmt::format("{:.0f}", s.median_surfacings),
          fmt::format("{}", s.missed),
          fmt::format("{}", s.refused),
          in_kilometres(s.closest_coast),
          in_watt_hours(s.median_energy_wh)};
}

std::string in_hours(const std::optional<double>& seconds) {
  return seconds ? fmt::format("{:.1f}", *seconds / 3600) : "-";
}

std::string in_percent(const std::optional<double>& share) {
  return share ? fmt::format("{:+.1f}", 100 * *share) : "-";
}

std::string in_kilometres(const std::optional<double>& metres) {
  if (!metres) return "-";
  return *metres >= chart::Chart::kHorizon ? fmt::format(">{:.0f}", chart::Chart::kHorizon / 1000)
                                           : fmt::format("{:.1f}", *metres / 1000);
}

std::string in_watt_hours(const std::optional<double>& energy) { return energy ? fmt::format("{:.1f}", *energy) : "-"; }

std::string rules_text(const std::map<std::string, int>& rules) {
  std::string text;
  for (const auto& [rule, times] : rules) text += fmt::format("{}{} x {}", text.empty() ? "" : ", ", times, rule);
  return text;
}

std::optional<double> regret(const Rehearsed& r) {
  if (!r.travel_s || !r.hindcast_s) return std::nullopt;
  return *r.travel_s / *r.hindcast_s - 1;
}

std::string verdict_text(const Rehearsal& rehearsal) {
  std::string text;
  const auto all = summaries(rehearsal);
  for (const auto& ours : all) {
    if (ours.method != rehearsal.method) continue;
    text += fmt::format("Departure {}: {} arrives in {} of {} oceans",
                        utc_text(instant_at(rehearsal.departure_s + 3600 * ours.delay_h)), ours.method, ours.arrived,
                        ours.flights);
    if (ours.median_s) text += fmt::format(", after {} h (median)", in_hours(ours.median_s));
    for (const auto& other : all) {
      if (other.method == ours.method || other.delay_h != ours.delay_h) continue;
      text += fmt::format("; {} in {}", other.method, other.arrived);
      if (other.median_s) text += fmt::format(", after {} h", in_hours(other.median_s));
    }
    text += ".\n";
  }
  return text;
}

std::vector<RehearsalSummary> summaries(const Rehearsal& rehearsal) {
  std::vector<std::vector<const Rehearsed*>> groups;
  for (const auto& run : rehearsal.runs) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return group.front()->method == run.method && group.front()->delay_h == run.delay_h;
    });
    if (same == groups.end())
      groups.push_back({&run});
    else
      same->push_back(&run);
  }
  std::vector<RehearsalSummary> all;
  for (const auto& group : groups) all.push_back(summary_of(group));
  return all;
}

std::string json_text(const Rehearsal& rehearsal) {
  Json runs = Json::array(), summary = Json::array();
  for (const auto& r : rehearsal.runs)
    runs.push_back({{"seed", r.seed},
                    {"delay_h", r.delay_h},
                    {"method", r.method},
                    {"arrived", r.travel_s.has_value()},
                    {"travel_time_s", or_null(r.travel_s)},
                    {"surfacings", r.surfacings},
                    {"files_emitted", r.files},
                    {"windows_missed", r.missed},
                    {"closest_coast_m", or_null(r.closest_coast)},
                    {"closest_goal_m", r.closest_goal},
                    {"energy_wh", or_null(r.energy_wh)},
                    {"hindcast_s", or_null(r.hindcast_s)},
                    {"regret_to_hindcast", or_null(regret(r))},
                    {"rules", Json(r.rules)},
                    {"end", r.end}});
  for (const auto& s : summaries(rehearsal))
    summary.push_back({{"method", s.method},
                       {"delay_h", s.delay_h},
                       {"flights", s.flights},
                       {"arrived", s.arrived},
                       {"median_travel_time_s", or_null(s.median_s)},
                       {"p10_travel_time_s", or_null(s.tenth_s)},
                       {"p90_travel_time_s", or_null(s.ninetieth_s)},
                       {"median_regret_to_hindcast", or_null(s.median_regret)},
                       {"median_surfacings", s.median_surfacings},
                       {"windows_missed", s.missed},
                       {"files_refused", s.refused},
                       {"rules", Json(s.rules)},
                       {"closest_coast_m", or_null(s.closest_coast)},
                       {"median_energy_wh", or_null(s.median_energy_wh)}});
  return Json{{"schema", "glidehelm/rehearsal/v1"}, {"mission", rehearsal.mission}, {"method", rehearsal.method},
              {"forecast", rehearsal.forecast},     {"truth", rehearsal.truth},     {"runs", std::move(runs)},
              {"summary", std::move(summary)}}
             .dump() +
         "\n";
}

std::string table_text(const Rehearsal& rehearsal) {
  const auto all = summaries(rehearsal);
  std::vector<std::vector<std::string>> rows{summary_columns()};
  for (const auto& s : all) rows.push_back(summary_row(s));
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text =
      fmt::format("mission {}, forecast {}\nocean: {}\n\n", rehearsal.mission, rehearsal.forecast, rehearsal.truth);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      text += i == 0 ? fmt::format("{:<{}}", row[i], widths[i]) : fmt::format("  {:>{}}", row[i], widths[i]);
    text += "\n";
  }
  text += "\n" + verdict_text(rehearsal);
  for (const auto& s : all)
    if (!s.rules.empty())
      text += fmt::format("Files refused by the verifier, {}, delay {:g} h: {}.\n", s.method, s.delay_h,
                          rules_text(s.rules));
  for (const auto& r : rehearsal.runs)
    if (!r.travel_s)
      text += fmt::format("Not arrived: {}, seed {}, delay {:g} h: {}, {} km from the goal at best.\n", r.method,
                          r.seed, r.delay_h, r.end, fmt::format("{:.1f}", r.closest_goal / 1000));
  return text +
         "regret: flown against the plan that knew the ocean; missed: surface intervals without a new list; refused: "
         "files "
         "that the verifier did not accept; coast: the closest of all flights\n";
}

}  // namespace glidehelm::cli
