#include "daemon/cli/rehearsal_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/utc.hpp"
#include "daemon/cli/new_file.hpp"

namespace glidehelm::cli {

namespace {

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
  /// Degrees at the edges; the longitudes are not folded.
  [[nodiscard]] double west() const { return middle_ + west_; }
  [[nodiscard]] double east() const { return west() + kWidth / scale_ / squeeze_; }
  [[nodiscard]] double south() const { return north_ - height_ / scale_; }
  [[nodiscard]] double north() const { return north_; }
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

/// 1, 2 or 5 times a power of ten: the largest that is no more than `most`.
double round_number(double most) {
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, escaped(text));
}

std::string line_at(const char* name, double x0, double y0, double x1, double y1) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", name, x0, y0, x1,
                     y1);
}

std::string degrees_text(double degrees, const char* positive, const char* negative) {
  const double folded = std::remainder(degrees, 360.0);
  return fmt::format("{:g}\u00b0{}", std::round(std::abs(folded) * 1e4) / 1e4, folded < 0 ? negative : positive);
}

/// Meridians and parallels at round degrees, and a bar of round kilometres.
std::string scales_of(const Picture& picture) {
  const double step = round_number(std::max(picture.east() - picture.west(), picture.north() - picture.south()) / 3);
  const double wide = Picture::kWidth, high = picture.height();
  std::string svg;
  for (double lon = std::ceil(picture.west() / step) * step; lon < picture.east(); lon += step) {
    const double x = wide * (lon - picture.west()) / (picture.east() - picture.west());
    svg += line_at("grid", x, 0, x, high) + text_at(x + 3, high - 5, "start", degrees_text(lon, "E", "W"));
  }
  for (double lat = std::ceil(picture.south() / step) * step; lat < picture.north(); lat += step) {
    const double y = high * (picture.north() - lat) / (picture.north() - picture.south());
    svg += line_at("grid", 0, y, wide, y) + text_at(4, y - 3, "start", degrees_text(lat, "N", "S"));
  }
  const double kilometre = picture.pixels(Metres{1000}), bar = round_number(0.25 * wide / kilometre);
  const double right = wide - 12, left = right - bar * kilometre;
  return svg + line_at("bar", left, 16, right, 16) +
         text_at(0.5 * (left + right), 30, "middle", fmt::format("{:g} km", bar));
}

const char* class_of(const Rehearsal& all, const Rehearsed& run) { return run.method == all.method ? "ours" : "other"; }

std::string map_of(const Rehearsal& all, const chart::Chart& chart) {
  const Picture picture{all};
  std::string svg = fmt::format("<svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"map of the flights\">\n",
                                Picture::kWidth, picture.height());
  svg += land_of(picture, all, chart) + scales_of(picture);
  for (const auto& run : all.runs) {
    std::string way;
    for (const auto& p : run.track) way += (way.empty() ? "" : " ") + picture.at(p);
    svg += fmt::format("<polyline class=\"{}\" points=\"{}\"><title>seed {}, {}: {}</title></polyline>\n",
                       class_of(all, run), way, run.seed, escaped(run.method),
                       run.travel_s ? in_hours(run.travel_s) + " h" : "not arrived");
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
    svg += line_at("grid", x(h), 0, x(h), bottom) + text_at(x(h), bottom + 16, "middle", fmt::format("{:g} h", h));
  double y = 0.5 * kRow + 3;
  for (const auto& row : rows) {
    svg +=
        text_at(6, y + 4, "start", row.delay_h == 0 ? row.method : fmt::format("{}, +{:g} h", row.method, row.delay_h));
    for (const auto& run : all.runs)
      if (run.method == row.method && run.delay_h == row.delay_h && run.travel_s)
        svg += fmt::format(
            "<circle class=\"dot-{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\"><title>seed {}: {} h</title></circle>\n",
            class_of(all, run), x(*run.travel_s / 3600), y, run.seed, in_hours(run.travel_s));
    if (row.median_s) svg += line_at("median", x(*row.median_s / 3600), y - 10, x(*row.median_s / 3600), y + 10);
    y += kRow;
  }
  return svg + "</svg>\n";
}

constexpr const char* kStyle =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:900px;margin:2em auto;padding:0 1em;color:#1b2a33}"
    "svg{width:100%;background:#e8f1f6;border:1px solid #b9ccd6}svg text{font-size:12px;fill:#3b4f5a}"
    ".land{fill:#c9bfa5}.grid{stroke:#b9ccd6;stroke-width:.8}.bar{stroke:#1b2a33;stroke-width:3}"
    ".ours{fill:none;stroke:#0b6e99;stroke-width:1.6}"
    ".other{fill:none;stroke:#b4552d;stroke-width:1;stroke-dasharray:4 3}"
    ".dot-ours{fill:#0b6e99;fill-opacity:.55}.dot-other{fill:#b4552d;fill-opacity:.55}"
    ".median{stroke:#1b2a33;stroke-width:2}.start{fill:#1b2a33}.goal{fill:none;stroke:#1b2a33}"
    "table{border-collapse:collapse;margin:1em 0;width:100%}"
    "th,td{padding:.25em .5em;text-align:right;border-bottom:1px solid #d6e0e6}"
    "th:first-child,td:first-child,td.words{text-align:left}";

/// `words`: from this column on the cells are left-aligned.
std::string table_of(const std::vector<std::string>& heads, const std::vector<std::vector<std::string>>& rows,
                     std::size_t words) {
  std::string table = "<table><tr>";
  for (const auto& head : heads) table += "<th>" + head + "</th>";
  table += "</tr>\n";
  for (const auto& row : rows) {
    table += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      table += (i < words ? "<td>" : "<td class=\"words\">") + escaped(row[i]) + "</td>";
    table += "</tr>\n";
  }
  return table + "</table>\n";
}

std::string flights_of(const Rehearsal& all) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& r : all.runs)
    rows.push_back(
        {r.method, fmt::format("{}", r.seed), fmt::format("{:g}", r.delay_h), in_hours(r.travel_s),
         in_percent(regret(r)), fmt::format("{}", r.surfacings), fmt::format("{}", r.files),
         fmt::format("{}", r.missed), in_kilometres(r.closest_coast), in_watt_hours(r.energy_wh),
         r.travel_s ? "arrived" : r.end + fmt::format(", {:.1f} km from the goal at best", r.closest_goal / 1000),
         r.rules.empty() ? "-" : rules_text(r.rules)});
  return table_of({"method", "seed", "delay h", "hours", "regret %", "surfacings", "files", "missed", "coast km",
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
      title + "</title><style>" + kStyle + "</style></head><body>\n<h1>" + title + "</h1>\n<p>" +
      escaped(verdict_text(rehearsal)) + "</p>\n<p>Forecast: " + escaped(rehearsal.forecast) +
      "<br>Ocean: " + escaped(rehearsal.truth) + "</p>\n" + map_of(rehearsal, chart) +
      "<p>Solid: " + escaped(rehearsal.method) +
      ". Dashed: straight to the goal. Dot: start. Circle: goal radius. Point at a line to see whose it is.</p>\n" +
      "<h2>Travel time</h2>\n" + times_of(rehearsal) +
      "<p>A dot per flight that arrived; the bar is the median.</p>\n<h2>Summary</h2>\n" +
      table_of(summary_columns(), rows, rows.empty() ? 0 : rows.front().size()) +
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
