#include "daemon/cli/polar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/mission/in_water.hpp"
#include "core/vehicle/force_balance.hpp"
#include "daemon/cli/mission_file.hpp"
#include "daemon/cli/new_file.hpp"
#include "daemon/ocean_source.hpp"

namespace glidehelm::cli {

namespace {

using vehicle::PolarPoint;
using Curves = std::vector<std::vector<PolarPoint>>;

constexpr double kCubicCentimetre = 1e-6;

/// What the polar is of.
struct Body {
  vehicle::FlightModel model;
  Metres climb_to, dive_depth;
  mission::WaterFrom water{};
};

std::vector<double> pump_volumes() {
  std::vector<double> all;
  for (int cm3 = 300; cm3 >= -300; cm3 -= 50)
    if (cm3 != 0) all.push_back(cm3 * kCubicCentimetre);
  return all;
}

const PolarPoint* fastest_of(const std::vector<PolarPoint>& curve) {
  const auto found = std::max_element(curve.begin(), curve.end(),
                                      [](const auto& a, const auto& b) { return a.horizontal < b.horizontal; });
  return found == curve.end() ? nullptr : &*found;
}

std::string csv(const Curves& curves) {
  std::string text = "pumped_cm3,pitch_deg,angle_of_attack_deg,horizontal_m_per_s,vertical_m_per_s\n";
  for (const auto& curve : curves)
    for (const auto& p : curve)
      text += fmt::format("{:.0f},{:.0f},{:.4f},{:.5f},{:.5f}\n", p.pumped_m3 / kCubicCentimetre, in_degrees(p.pitch),
                          in_degrees(p.angle_of_attack), p.horizontal.si(), p.vertical.si());
  return text;
}

/// The picture: 0 to the fastest horizontal speed to the right, climbs above, dives below, a tick each tenth of a metre a second.
std::string svg(const Curves& curves, double depth_m) {
  double right = 0.1, up = 0.1, down = 0.1;
  for (const auto& curve : curves)
    for (const auto& p : curve) {
      right = std::max(right, p.horizontal.si());
      up = std::max(up, p.vertical.si());
      down = std::max(down, -p.vertical.si());
    }
  constexpr double kScale = 600, kMargin = 60;  // pixels for a metre a second, and around
  const double width = right * kScale + 2 * kMargin + 40, height = (up + down) * kScale + 2 * kMargin;
  const auto x = [&](double horizontal) { return kMargin + horizontal * kScale; };
  const auto y = [&](double vertical) { return kMargin + (up - vertical) * kScale; };
  std::string s = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#fff\"/>\n<title>Glide polar at {2:.0f} m</title>\n",
      width, height, depth_m);
  const auto line = [&](double x1, double y1, double x2, double y2, const char* colour) {
    s += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1, y1, x2, y2,
                     colour);
  };
  const auto text = [&](double at_x, double at_y, const char* anchor, const std::string& words) {
    s += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", at_x, at_y, anchor, words);
  };
  for (int k = 0; k * 0.1 <= right; ++k) {
    line(x(k * 0.1), y(up), x(k * 0.1), y(-down), "#eee");
    text(x(k * 0.1), y(-down) + 18, "middle", fmt::format("{:.1f}", k * 0.1));
  }
  for (int k = -static_cast<int>(down * 10); k * 0.1 <= up; ++k) {
    line(x(0), y(k * 0.1), x(right), y(k * 0.1), k == 0 ? "#888" : "#eee");
    text(x(0) - 6, y(k * 0.1) + 4, "end", fmt::format("{:.1f}", k * 0.1));
  }
  text(x(0.5 * right), y(-down) + 38, "middle", "horizontal speed, m/s");
  text(x(0), y(up) - 30, "start",
       fmt::format("vertical speed, m/s (climbs above), at {:.0f} m; pump volumes in cm³; dots: every 10° of pitch",
                   depth_m));
  for (const auto& curve : curves) {
    if (curve.empty()) continue;
    s += fmt::format("<polyline fill=\"none\" stroke=\"{}\" points=\"",
                     curve.front().pumped_m3 > 0 ? "#1668a8" : "#b5471b");
    for (const auto& p : curve) s += fmt::format("{:.1f},{:.1f} ", x(p.horizontal.si()), y(p.vertical.si()));
    s += "\"/>\n";
    for (const auto& p : curve)
      if (std::lround(in_degrees(p.pitch)) % 10 == 0)
        s += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\"/>\n", x(p.horizontal.si()), y(p.vertical.si()));
    const auto& best = *fastest_of(curve);
    text(x(best.horizontal.si()) + 5, y(best.vertical.si()) + 4, "start",
         fmt::format("{:+.0f}", best.pumped_m3 / kCubicCentimetre));
  }
  return s + "</svg>\n";
}

nlohmann::json json_of(const Curves& curves, double depth_m, mission::WaterFrom water, const vehicle::YoMeans& yo) {
  nlohmann::json j{{"schema", "glidehelm/polar/v1"},
                   {"depth_m", depth_m},
                   {"water", mission::word(water)},
                   {"yo",
                    {{"horizontal_speed_m_per_s", yo.horizontal.si()},
                     {"glide_angle_deg", in_degrees(yo.glide_angle)},
                     {"down_s", yo.down.count()},
                     {"up_s", yo.up.count()}}},
                   {"best", nlohmann::json::array()},
                   {"points", nlohmann::json::array()}};
  for (const auto& curve : curves) {
    for (const auto& p : curve)
      j["points"].push_back({{"pumped_cm3", p.pumped_m3 / kCubicCentimetre},
                             {"pitch_deg", in_degrees(p.pitch)},
                             {"angle_of_attack_deg", in_degrees(p.angle_of_attack)},
                             {"horizontal_m_per_s", p.horizontal.si()},
                             {"vertical_m_per_s", p.vertical.si()}});
    if (const auto* best = fastest_of(curve))
      j["best"].push_back({{"pumped_cm3", best->pumped_m3 / kCubicCentimetre},
                           {"pitch_deg", in_degrees(best->pitch)},
                           {"horizontal_m_per_s", best->horizontal.si()}});
  }
  return j;
}

/// The water of the mission's forecast, or why there is no forecast.
Expected<ocean::GridWater, std::string> forecast_water(const mission::Mission& m, world::World& world) {
  const auto now = world.clock.utc();
  const auto ocean =
      daemon::load_ocean({m, world.files.scratch(), !m.coast_file.empty(), m.start_time.value_or(now), m.start}, world);
  if (!ocean) return unexpected(ocean.error());
  return (*ocean)->forecast.facts().water;
}

/// The body of the options, or the exit code.
Expected<Body, int> body_of(const PolarOptions& options, world::World& world, std::ostream& err) {
  using mission::WaterFrom;
  const mission::Mission standard;
  if (options.mission.empty() && options.forecast) {
    err << "--forecast needs a MISSION, whose forecast it is\n";
    return unexpected(2);
  }
  if (options.mission.empty()) return Body{{}, standard.climb_to, standard.dive_depth, WaterFrom::climatology};
  std::string text;
  const auto mission = mission_from(options.mission, world.files, text);
  if (!mission) {
    err << mission.error().message << "\n";
    return unexpected(mission.error().code);
  }
  if (!mission->flight_model)
    err << "note: " << options.mission
        << " has no vehicle.force_balance: this is the polar of the section's defaults\n";
  Body body{mission->flight_model.value_or(vehicle::FlightModel{}), mission->climb_to, mission->dive_depth};
  body.water = body.model.water.empty() ? WaterFrom::climatology : WaterFrom::mission;
  if (!options.forecast) return body;
  if (body.water == WaterFrom::mission) {
    err << "note: the mission gives its own water: the forecast's is not taken\n";
    return body;
  }
  const auto water = forecast_water(*mission, world);
  if (!water) {
    err << water.error() << "\n";
    return unexpected(1);
  }
  if (water->layers.empty()) {
    err << "note: the forecast has no water: "
        << (water->words.empty() ? "it has no temperature and salinity" : water->words) << "\n";
    return body;
  }
  err << "note: water of the forecast: " << water->words << "\n";
  body.model.water = water->layers;
  body.water = WaterFrom::forecast;
  return body;
}

}  // namespace

int run_polar(const PolarOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  for (const auto& file : {options.csv, options.svg})
    if (!file.empty())
      if (const auto why = why_not_new(file, world.files); !why.empty()) {
        err << why << "\n";
        return 2;
      }
  const auto body = body_of(options, world, err);
  if (!body) return body.error();
  const auto& [model, climb_to, dive_depth, whose] = *body;
  const auto water = model.column();
  const auto yo = vehicle::yo_means(model.hull, model.trim, water, climb_to, dive_depth);
  if (!yo) {
    err << yo.error() << "\n";
    return 1;
  }
  const auto curves = vehicle::glide_polar(model.hull, water, Metres{options.depth_m}, pump_volumes());
  for (const auto& [file, bytes] :
       {std::pair{options.csv, csv(curves)}, std::pair{options.svg, svg(curves, options.depth_m)}})
    if (!file.empty())
      if (const auto why = write_new_file(file, bytes, world.files); !why.empty()) {
        err << why << "\n";
        return 2;
      }
  if (options.json) {
    out << json_of(curves, options.depth_m, whose, *yo).dump(2) << "\n";
    return 0;
  }
  out << fmt::format(
      "In {}, over the yo between {:.0f} and {:.0f} m: {:.3f} m/s horizontally, path {:.1f} degrees below the horizon, "
      "{:.0f} "
      "s down and {:.0f} s "
      "up.\nAt {:.0f} m, by pump volume, the pitch that goes forward fastest:\n\n  pump cm3   pitch   horizontal m/s   "
      "vertical m/s\n",
      mission::words(whose), climb_to.si(), dive_depth.si(), yo->horizontal.si(), in_degrees(yo->glide_angle),
      yo->down.count(), yo->up.count(), options.depth_m);
  for (const auto& curve : curves)
    if (const auto* best = fastest_of(curve))
      out << fmt::format("  {:+8.0f} {:5.0f}°   {:14.3f}   {:+12.3f}\n", best->pumped_m3 / kCubicCentimetre,
                         in_degrees(best->pitch), best->horizontal.si(), best->vertical.si());
  return 0;
}

}  // namespace glidehelm::cli
