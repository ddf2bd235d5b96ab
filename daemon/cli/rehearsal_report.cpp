#include "daemon/cli/rehearsal_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "daemon/cli/new_file.hpp"

namespace glidehelm::cli {

namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::optional<double> regret(const Rehearsed& r) {
  if (!r.travel_s || !r.hindcast_s) return std::nullopt;
  return *r.travel_s / *r.hindcast_s - 1;
}

int refused(const Rehearsed& r) {
  int count = 0;
  for (const auto& [rule, times] : r.rules) count += times;
  return count;
}

RehearsalSummary summary_of(const std::vector<const Rehearsed*>& runs) {
  RehearsalSummary s;
  s.method = runs.front()->method;
  s.delay_h = runs.front()->delay_h;
  std::vector<double> times, regrets, surfacings, energies;
  for (const auto* r : runs) {
    ++s.flights;
    s.missed += r->missed;
    s.refused += refused(*r);
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

std::string hours(const std::optional<double>& seconds) {
  return seconds ? fmt::format("{:.1f}", *seconds / 3600) : "-";
}

std::string percent(const std::optional<double>& share) { return share ? fmt::format("{:+.1f}", 100 * *share) : "-"; }

std::string kilometres(const std::optional<double>& metres) {
  return metres ? fmt::format("{:.1f}", *metres / 1000) : "-";
}

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else
      safe += c;
  }
  return safe;
}

/// Longitude and latitude to the plane of a picture: equirectangular about the middle, north up.
class Picture {
 public:
  explicit Picture(const Rehearsal& all) {
    auto points = std::vector{all.start, all.goal};
    for (const auto& run : all.runs) points.insert(points.end(), run.track.begin(), run.track.end());
    middle_ = points.front().lon.degrees();
    double west = 0, east = 0, south = 90, north = -90;
    for (const auto& p : points) {
      west = std::min(west, turned(p.lon.degrees()));
      east = std::max(east, turned(p.lon.degrees()));
      south = std::min(south, p.lat.degrees());
      north = std::max(north, p.lat.degrees());
    }
    squeeze_ = std::cos((south + north) / 360 * kPi);
    const double wide = (east - west) * squeeze_, high = north - south, margin = 0.1 * std::max({wide, high, 0.1});
    west_ = west - margin / squeeze_;
    north_ = north + margin;
    scale_ = kWidth / (wide + 2 * margin);
    height_ = (high + 2 * margin) * scale_;
  }
  [[nodiscard]] std::string at(double lat_deg, double lon_deg) const {
    return fmt::format("{:.1f},{:.1f}", (turned(lon_deg) - west_) * squeeze_ * scale_, (north_ - lat_deg) * scale_);
  }
  [[nodiscard]] std::string at(GeoPoint p) const { return at(p.lat.degrees(), p.lon.degrees()); }
  [[nodiscard]] double pixels(Metres length) const { return length.si() / 111'195 * scale_; }
  [[nodiscard]] double height() const { return height_; }
  static constexpr double kWidth = 760;

 private:
  [[nodiscard]] double turned(double lon_deg) const { return std::remainder(lon_deg - middle_, 360.0); }
  double middle_{}, squeeze_{1}, west_{}, north_{}, scale_{1}, height_{};
};

/// Land as a mosaic: the chart answers for a place, and a few thousand places are a picture.
std::string land_of(const Picture& picture, const Rehearsal& all, const chart::Chart& chart) {
  if (!chart.has_coast()) return "";
  constexpr int kAcross = 160;
  const double step = Picture::kWidth / kAcross;
  std::string land;
  const double degree = picture.pixels(Metres{111'195});
  const double squeeze = std::cos(all.start.lat.radians());
  const auto origin = picture.at(all.start);
  const double x0 = std::stod(origin), y0 = std::stod(origin.substr(origin.find(',') + 1));
  for (int row = 0; row * step < picture.height(); ++row)
    for (int column = 0; column < kAcross; ++column) {
      const double x = (column + 0.5) * step, y = (row + 0.5) * step;
      const auto p =
          GeoPoint::from_degrees(all.start.lat.degrees() - (y - y0) / degree,
                                 std::remainder(all.start.lon.degrees() + (x - x0) / degree / squeeze, 360.0));
      if (p && chart.is_land(*p))
        land += fmt::format("M{:.1f},{:.1f}h{:.2f}v{:.2f}h-{:.2f}z", column * step, row * step, step + 0.05,
                            step + 0.05, step + 0.05);
    }
  return "<path class=\"land\" d=\"" + land + "\"/>\n";
}

std::string map_of(const Rehearsal& all, const chart::Chart& chart) {
  const Picture picture{all};
  std::string svg = fmt::format("<svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"map of the flights\">\n",
                                Picture::kWidth, picture.height());
  svg += land_of(picture, all, chart);
  for (const auto& run : all.runs) {
    std::string way;
    for (const auto& p : run.track) way += (way.empty() ? "" : " ") + picture.at(p);
    svg += fmt::format("<polyline class=\"{}\" points=\"{}\"><title>seed {}, {}: {}</title></polyline>\n",
                       run.method == all.method ? "ours" : "other", way, run.seed, escaped(run.method),
                       run.travel_s ? hours(run.travel_s) + " h" : "not arrived");
  }
  const auto place = [&](GeoPoint p, double radius, const char* name) {
    const auto at = picture.at(p);
    const auto comma = at.find(',');
    return fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{:.1f}\"/>\n", name, at.substr(0, comma),
                       at.substr(comma + 1), radius);
  };
  svg += place(all.start, 4, "start") + place(all.goal, std::max(4.0, picture.pixels(all.goal_radius)), "goal");
  return svg + "</svg>\n";
}

constexpr const char* kStyle =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:860px;margin:2em auto;padding:0 1em;color:#1b2a33}"
    "svg{width:100%;background:#e8f1f6;border:1px solid "
    "#b9ccd6}.land{fill:#c9bfa5}.ours{fill:none;stroke:#0b6e99;stroke-width:1.6}"
    ".other{fill:none;stroke:#b4552d;stroke-width:1;stroke-dasharray:4 "
    "3}.start{fill:#1b2a33}.goal{fill:none;stroke:#1b2a33}"
    "table{border-collapse:collapse;margin:1em 0;width:100%}th,td{padding:.25em "
    ".6em;text-align:right;border-bottom:1px solid #d6e0e6}"
    "th:first-child,td:first-child{text-align:left}";

std::vector<std::string> row_of(const RehearsalSummary& s) {
  return {s.method,
          fmt::format("{:g}", s.delay_h),
          fmt::format("{} of {}", s.arrived, s.flights),
          hours(s.median_s),
          hours(s.tenth_s) + " - " + hours(s.ninetieth_s),
          percent(s.median_regret),
          fmt::format("{:.0f}", s.median_surfacings),
          fmt::format("{}", s.missed),
          fmt::format("{}", s.refused),
          kilometres(s.closest_coast),
          s.median_energy_wh ? fmt::format("{:.0f}", *s.median_energy_wh) : "-"};
}

const std::vector<std::string> kColumns{"method",     "delay h", "arrived", "median h", "10-90 % h", "regret %",
                                        "surfacings", "missed",  "refused", "coast km", "energy Wh"};

}  // namespace

std::optional<double> quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const double at = q * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at), high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
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
                       {"closest_coast_m", or_null(s.closest_coast)},
                       {"median_energy_wh", or_null(s.median_energy_wh)}});
  return Json{{"schema", "glidehelm/rehearsal/v1"}, {"mission", rehearsal.mission}, {"method", rehearsal.method},
              {"forecast", rehearsal.forecast},     {"truth", rehearsal.truth},     {"runs", std::move(runs)},
              {"summary", std::move(summary)}}
             .dump() +
         "\n";
}

std::string table_text(const Rehearsal& rehearsal) {
  std::vector<std::vector<std::string>> rows{kColumns};
  for (const auto& s : summaries(rehearsal)) rows.push_back(row_of(s));
  std::vector<std::size_t> widths(kColumns.size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text =
      fmt::format("mission {}, forecast {}\nocean: {}\n", rehearsal.mission, rehearsal.forecast, rehearsal.truth);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      text += i == 0 ? fmt::format("{:<{}}", row[i], widths[i]) : fmt::format("  {:>{}}", row[i], widths[i]);
    text += "\n";
  }
  return text + "regret: flown against the plan that knew the ocean; missed: surface intervals without a new list\n";
}

std::string html_text(const Rehearsal& rehearsal, const chart::Chart& chart) {
  std::string page = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Rehearsal of " +
                     escaped(rehearsal.mission) + "</title><style>" + kStyle +
                     "</style></head><body>\n<h1>Rehearsal of " + escaped(rehearsal.mission) +
                     "</h1>\n<p>Forecast: " + escaped(rehearsal.forecast) + "<br>Ocean: " + escaped(rehearsal.truth) +
                     "</p>\n" + map_of(rehearsal, chart) + "<p>Solid: " + escaped(rehearsal.method) +
                     ". Dashed: straight to the goal. Dot: start. Circle: goal radius.</p>\n<table><tr>";
  for (const auto& column : kColumns) page += "<th>" + column + "</th>";
  page += "</tr>\n";
  for (const auto& s : summaries(rehearsal)) {
    page += "<tr>";
    for (const auto& cell : row_of(s)) page += "<td>" + escaped(cell) + "</td>";
    page += "</tr>\n";
  }
  return page +
         "</table>\n<p>Regret: flown against the plan that knew the ocean. Missed: surface intervals without a new "
         "list.</p>\n</body></html>\n";
}

std::string save_page(const Rehearsal& rehearsal, const chart::Chart& chart, const std::string& path,
                      world::Files& files) {
  const auto problem = write_new_file(path, html_text(rehearsal, chart), files);
  return problem.empty() ? "" : "--html: " + problem;
}

std::string progress_bar(std::size_t done, std::size_t of) {
  constexpr std::size_t kWide = 30;
  const auto filled = of == 0 ? kWide : done * kWide / of;
  return fmt::format("[{}{}] {} of {} flights", std::string(filled, '#'), std::string(kWide - filled, ' '), done, of);
}

}  // namespace glidehelm::cli
