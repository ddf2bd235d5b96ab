#include "daemon/cli/rehearsal_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/utc.hpp"
#include "daemon/cli/map_picture.hpp"
#include "daemon/cli/new_file.hpp"

namespace glidehelm::cli {

namespace {

const char* class_of(const Rehearsal& all, const Rehearsed& run) { return run.method == all.method ? "ours" : "other"; }

std::string map_of(const Rehearsal& all, const chart::Chart& chart) {
  auto points = std::vector{all.start, all.goal};
  for (const auto& run : all.runs) points.insert(points.end(), run.track.begin(), run.track.end());
  const MapPicture picture{points};
  std::string svg = picture.opening("map of the flights") + picture.land(chart) + picture.scales();
  for (const auto& run : all.runs)
    svg += fmt::format("<polyline class=\"{}\" points=\"{}\"><title>seed {}, {}: {}</title></polyline>\n",
                       class_of(all, run), picture.way(run.track), run.seed, escaped(run.method),
                       run.travel_s ? in_hours(run.travel_s) + " h" : "not arrived");
  return svg + picture.circle(all.start, 4, "start") +
         picture.circle(all.goal, std::max(4.0, picture.pixels(all.goal_radius)), "goal") + "</svg>\n";
}

/// A dot per flight at its travel time, a row per method and departure.
std::string times_of(const Rehearsal& all) {
  constexpr double kLeft = 150, kRight = 740, kRow = 26;
  double longest = 0;
  for (const auto& run : all.runs) longest = std::max(longest, run.travel_s.value_or(0) / 3600);
  if (longest <= 0) return "";
  const double step = round_number(longest / 4), end = step * std::ceil(longest / step);
  const auto x = [&](double hours) { return kLeft + (kRight - kLeft) * hours / end; };
  const auto rows = summaries(all);
  const double bottom = kRow * static_cast<double>(rows.size()) + 6;
  std::string svg =
      fmt::format("<svg viewBox=\"0 0 760 {:.0f}\" role=\"img\" aria-label=\"travel times\">\n", bottom + 22);
  for (double h = 0; h <= end * (1 + 1e-9); h += step)
    svg += svg_line("grid", x(h), 0, x(h), bottom) + svg_text(x(h), bottom + 16, "middle", fmt::format("{:g} h", h));
  double y = 0.5 * kRow + 3;
  for (const auto& row : rows) {
    svg += svg_text(6, y + 4, "start",
                    row.delay_h == 0 ? row.method : fmt::format("{}, +{:g} h", row.method, row.delay_h));
    for (const auto& run : all.runs)
      if (run.method == row.method && run.delay_h == row.delay_h && run.travel_s)
        svg += fmt::format(
            "<circle class=\"dot-{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\"><title>seed {}: {} h</title></circle>\n",
            class_of(all, run), x(*run.travel_s / 3600), y, run.seed, in_hours(run.travel_s));
    if (row.median_s) svg += svg_line("median", x(*row.median_s / 3600), y - 10, x(*row.median_s / 3600), y + 10);
    y += kRow;
  }
  return svg + "</svg>\n";
}

constexpr const char* kStyle =
    ".ours{fill:none;stroke:#0b6e99;stroke-width:1.6}"
    ".other{fill:none;stroke:#b4552d;stroke-width:1;stroke-dasharray:4 3}"
    ".dot-ours{fill:#0b6e99;fill-opacity:.55}.dot-other{fill:#b4552d;fill-opacity:.55}"
    ".median{stroke:#1b2a33;stroke-width:2}";

std::string flights_of(const Rehearsal& all) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& r : all.runs)
    rows.push_back(
        {r.method, fmt::format("{}", r.seed), fmt::format("{:g}", r.delay_h), in_hours(r.travel_s),
         in_percent(regret(r)), fmt::format("{}", r.surfacings), fmt::format("{}", r.files),
         fmt::format("{}", r.missed), in_kilometres(r.closest_coast), in_watt_hours(r.energy_wh),
         r.travel_s ? "arrived" : r.end + fmt::format(", {:.1f} km from the goal at best", r.closest_goal / 1000),
         r.rules.empty() ? "-" : rules_text(r.rules)});
  return html_table({"method", "seed", "delay h", "hours", "regret %", "surfacings", "files", "missed", "coast km",
                     "energy Wh", "end", "files refused"},
                    rows, 10);
}

}  // namespace

std::string html_text(const Rehearsal& rehearsal, const chart::Chart& chart) {
  const auto title = "Rehearsal of " + escaped(rehearsal.mission);
  std::vector<std::vector<std::string>> rows;
  for (const auto& s : summaries(rehearsal)) rows.push_back(summary_row(s));
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\"><title>" +
      title + "</title><style>" + kPageStyle + kStyle + "</style></head><body>\n<h1>" + title + "</h1>\n<p>" +
      escaped(verdict_text(rehearsal)) + "</p>\n<p>Forecast: " + escaped(rehearsal.forecast) +
      "<br>Ocean: " + escaped(rehearsal.truth) + "</p>\n" + map_of(rehearsal, chart) +
      "<p>Solid: " + escaped(rehearsal.method) +
      ". Dashed: straight to the goal. Dot: start. Circle: goal radius. Point at a line to see whose it is.</p>\n" +
      "<h2>Travel time</h2>\n" + times_of(rehearsal) +
      "<p>A dot per flight that arrived; the bar is the median.</p>\n<h2>Summary</h2>\n" +
      html_table(summary_columns(), rows, rows.empty() ? 0 : rows.front().size()) +
      "<ul><li>regret: flown against the plan that knew the ocean (median)"
      "<li>missed: surface intervals without a new list<li>refused: files that the verifier did not accept"
      "<li>coast: the closest of all flights<li>energy: of a flight (median), by the simulator's model</ul>\n"
      "<h2>Flights</h2>\n" +
      flights_of(rehearsal) + "</body></html>\n";
  return page;
}

std::string save_page(const Rehearsal& rehearsal, const chart::Chart& chart, const std::string& path,
                      world::Files& files) {
  const auto problem = write_new_file(path, html_text(rehearsal, chart), files);
  return problem.empty() ? "" : "--html: " + problem;
}

}  // namespace glidehelm::cli
