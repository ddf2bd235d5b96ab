#include "daemon/cli/compare_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/utc.hpp"
#include "daemon/cli/map_picture.hpp"

namespace glidehelm::cli {

namespace {

using Json = nlohmann::ordered_json;

bool arrives(const Compared& a) { return a.plan && a.plan->reaches_goal(); }
double travel_s(const Comparison& c, const Compared& a) { return a.plan->arrival_s - c.start_s; }
double km_per_day(const Comparison& c, const Compared& a) { return c.way_m() / 1000 / (travel_s(c, a) / 86400); }
bool has_arrival_bound(const Comparison& c) {
  return c.bound && c.bound->kind == planning::Bound::Kind::arrival && c.bound->travel_s > 0;
}
double gap(const Comparison& c, const Compared& a) { return travel_s(c, a) / c.bound->travel_s - 1; }

/// The answers from the best to the worst; of equals the one asked first.
std::vector<const Compared*> ranked(const Comparison& c) {
  std::vector<const Compared*> all;
  for (const auto& a : c.answers) all.push_back(&a);
  const auto rank = [](const Compared& a) { return arrives(a) ? 0 : a.plan ? 1 : 2; };
  std::stable_sort(all.begin(), all.end(), [&](const Compared* a, const Compared* b) {
    if (rank(*a) != rank(*b)) return rank(*a) < rank(*b);
    if (rank(*a) == 0) return a->plan->arrival_s < b->plan->arrival_s;
    return rank(*a) == 1 && a->plan->remaining < b->plan->remaining;
  });
  return all;
}

std::string in_thousands(std::uint64_t count) {
  return count < 10'000       ? fmt::format("{}", count)
         : count < 10'000'000 ? fmt::format("{:.0f} k", static_cast<double>(count) / 1e3)
                              : fmt::format("{:.0f} M", static_cast<double>(count) / 1e6);
}

const char* status_word(const Comparison& c, const Compared& a) {
  if (arrives(a)) return "reaches_goal";
  if (c.bound && c.bound->kind == planning::Bound::Kind::unreachable) return "proven_unreachable";
  return a.plan ? "closest_approach" : "no_plan";
}

constexpr std::array<const char*, 8> kColours{"#0b6e99", "#b4552d", "#3f7d3a", "#7a4ba0",
                                              "#a5811d", "#c23b6b", "#417b8a", "#5a5a5a"};
const char* colour_of(std::size_t i) { return kColours[i % kColours.size()]; }

std::vector<GeoPoint> track_of(const Comparison& c, const Compared& a) {
  std::vector<GeoPoint> track{c.start};
  if (a.plan)
    for (const auto& s : a.plan->stints) {
      track.push_back(s.dive);
      track.push_back(s.surface);
    }
  return track;
}

std::string map_of(const Comparison& c, const chart::Chart& chart) {
  std::vector<GeoPoint> points{c.start, c.goal};
  for (const auto& a : c.answers)
    for (const auto& p : track_of(c, a)) points.push_back(p);
  const MapPicture picture{points};
  std::string svg = picture.opening("map of the plans") + picture.land(chart) + picture.scales();
  for (std::size_t i = 0; i < c.answers.size(); ++i) {
    const auto& a = c.answers[i];
    if (!a.plan) continue;
    svg += fmt::format("<polyline class=\"plan\" stroke=\"{}\" points=\"{}\"><title>{}</title></polyline>\n",
                       colour_of(i), picture.way(track_of(c, a)), escaped(a.method));
  }
  return svg + picture.circle(c.start, 4, "start") +
         picture.circle(c.goal, std::max(4.0, picture.pixels(c.goal_radius)), "goal") + "</svg>\n";
}

std::string legend_of(const Comparison& c) {
  std::string legend = "<p>";
  for (std::size_t i = 0; i < c.answers.size(); ++i)
    if (c.answers[i].plan)
      legend +=
          fmt::format("<span style=\"color:{}\">\u25ac {}</span>&ensp;", colour_of(i), escaped(c.answers[i].method));
  return legend + "</p>\n";
}

}  // namespace

std::vector<std::string> comparison_columns() {
  return {"method", "made by",    "hours",     "km/day",       "above bound %", "left km",
          "wall s", "expansions", "cost eval", "current eval", "remark"};
}

std::vector<std::vector<std::string>> comparison_rows(const Comparison& c) {
  std::vector<std::vector<std::string>> rows;
  for (const auto* a : ranked(c)) {
    const auto wall = fmt::format("{:.3f}", a->wall_s);
    if (!a->plan) {
      rows.push_back({a->method, "-", "-", "-", "-", "-", wall, "-", "-", "-", a->problem});
      continue;
    }
    const auto& p = *a->plan;
    const auto& s = p.statistics;
    rows.push_back({a->method, p.method, arrives(*a) ? fmt::format("{:.2f}", travel_s(c, *a) / 3600) : "-",
                    arrives(*a) ? fmt::format("{:.1f}", km_per_day(c, *a)) : "-",
                    arrives(*a) && has_arrival_bound(c) ? fmt::format("{:.2f}", 100 * gap(c, *a)) : "-",
                    arrives(*a) ? "0" : fmt::format("{:.1f}", p.remaining.si() / 1000), wall,
                    in_thousands(s.expansions), in_thousands(s.cost_evaluations), in_thousands(s.current_evaluations),
                    p.reason});
  }
  return rows;
}

std::string bound_text(const Comparison& c) {
  if (!c.bound) return "";
  switch (c.bound->kind) {
    case planning::Bound::Kind::arrival:
      return fmt::format("No vehicle arrives earlier than {:.2f} h after the fix (error bar of {:.2f} h subtracted).",
                         c.bound->travel_s / 3600, c.bound->error_s / 3600);
    case planning::Bound::Kind::unreachable:
      return "Proven unreachable: " + c.bound->reason + ".";
    case planning::Bound::Kind::cut:
      break;
  }
  return "No bound: " + c.bound->reason + ".";
}

std::string comparison_text(const Comparison& c) {
  auto rows = comparison_rows(c);
  rows.insert(rows.begin(), comparison_columns());
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text = fmt::format("{}: {:.0f} km, {}\n", c.mission, c.way_m() / 1000, c.forecast);
  if (const auto bound = bound_text(c); !bound.empty()) text += bound + "\n";
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += i < 2 || i + 1 == row.size() ? fmt::format("{:<{}}  ", row[i], widths[i])
                                           : fmt::format("{:>{}}  ", row[i], widths[i]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string comparison_json(std::span<const Comparison> comparisons) {
  Json all{{"schema", "glidehelm/comparison/v1"}, {"missions", Json::array()}};
  for (const auto& c : comparisons) {
    const bool bounded = has_arrival_bound(c);
    Json m{{"mission", c.mission},
           {"forecast", c.forecast},
           {"start",
            {{"lat_deg", c.start.lat.degrees()},
             {"lon_deg", c.start.lon.degrees()},
             {"time", utc_text(instant_at(c.start_s), true)}}},
           {"goal",
            {{"lat_deg", c.goal.lat.degrees()}, {"lon_deg", c.goal.lon.degrees()}, {"radius_m", c.goal_radius.si()}}},
           {"distance_m", c.way_m()},
           {"lower_bound_s", bounded ? Json(c.bound->travel_s) : Json(nullptr)},
           {"lower_bound_error_s", bounded ? Json(c.bound->error_s) : Json(nullptr)},
           {"plans", Json::array()}};
    for (const auto& a : c.answers) {
      const bool there = arrives(a);
      const planning::Statistics s = a.plan ? a.plan->statistics : planning::Statistics{};
      m["plans"].push_back({{"asked", a.method},
                            {"method", a.plan ? Json(a.plan->method) : Json(nullptr)},
                            {"status", status_word(c, a)},
                            {"reason", a.plan ? a.plan->reason : a.problem},
                            {"travel_time_s", there ? Json(travel_s(c, a)) : Json(nullptr)},
                            {"effective_speed_km_per_day", there ? Json(km_per_day(c, a)) : Json(nullptr)},
                            {"gap", there && bounded ? Json(gap(c, a)) : Json(nullptr)},
                            {"remaining_distance_m", a.plan ? Json(a.plan->remaining.si()) : Json(nullptr)},
                            {"stints", a.plan ? Json(a.plan->stints.size()) : Json(nullptr)},
                            {"wall_s", a.wall_s},
                            {"expansions", s.expansions},
                            {"cost_evaluations", s.cost_evaluations},
                            {"current_evaluations", s.current_evaluations}});
    }
    all["missions"].push_back(std::move(m));
  }
  return all.dump() + "\n";
}

std::string comparison_page(std::span<const Comparison> comparisons, std::span<const chart::Chart* const> charts) {
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\"><title>Methods compared</title><style>" +
      std::string{kPageStyle} +
      "body{max-width:1100px}.plan{fill:none;stroke-width:1.6}</style></head><body>\n<h1>Methods compared</h1>\n";
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    const auto& c = comparisons[i];
    page += "<h2>" + escaped(c.mission) + "</h2>\n<p>" +
            fmt::format("{:.0f} km. Forecast: {}. {}", c.way_m() / 1000, escaped(c.forecast), escaped(bound_text(c))) +
            "</p>\n" + map_of(c, *charts[i]) + legend_of(c) + html_table(comparison_columns(), comparison_rows(c), 10);
  }
  return page +
         "<ul><li>made by: the stage whose plan it is<li>above bound: by how much the plan is slower than the earliest "
         "arrival that any "
         "vehicle of this speed and dive schedule could have<li>cost eval: stints flown; current eval: currents looked "
         "up</ul>\n</body></html>\n";
}

}  // namespace glidehelm::cli
