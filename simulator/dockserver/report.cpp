#include "simulator/dockserver/report.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::simulator {
namespace {

/// The mission runs this long before the first surfacing of the simulation.
constexpr double kBeforeStart = 300.0;

void add_currents(std::vector<SensorValue>& into, const Glider& g, double age) {
  const auto& frame = g.setup().frame;
  const auto put = [&](const char* stem, std::optional<Current> c, bool always) {
    if (!c && !always) return;
    const auto v = frame.local(c.value_or(Current{}));
    const auto when = c ? std::optional<double>{age} : std::nullopt;
    into.push_back({std::string{stem} + "_vx", "m/s", v.x, when});
    into.push_back({std::string{stem} + "_vy", "m/s", v.y, when});
  };
  put("m_final_water", g.water(), false);
  put("m_initial_water", g.initial_water(), false);
  put("m_water", g.water(), true);
}

struct Battery {
  double volts{}, amp_hours{}, charge_percent{};
};

/// Of the energy model when the scenario gives a battery; else a linear drain that nothing depends on. Charge goes with
/// the mean of the two voltages.
Battery battery_of(const Glider& g, double hours) {
  const auto left = g.battery_left();
  if (!left) return {16.4 - 0.0015 * hours, 0.75 + 0.35 * hours, std::fmax(0.0, 99.9 - 0.05 * hours)};
  const auto& spec = g.setup().energy;
  return {spec.volts_empty + (spec.volts_full - spec.volts_empty) * *left,
          g.energy().total_wh() / (0.5 * (spec.volts_full + spec.volts_empty)), 100 * *left};
}

/// In the order of the alphabet, as the dialog has them.
std::vector<SensorValue> sensors_of(const Glider& g, double now_s) {
  const auto& nav = g.navigator();
  const double hours = (now_s - g.setup().start_s + kBeforeStart) / 3600.0;
  const auto battery = battery_of(g, hours);
  const double water_age = now_s - g.water_s() + 3.0;
  const auto at = [](double deg) { return dialog::ddmm(deg, 4); };
  const auto wpt = nav.waypoint();
  const double wpt_age = now_s - nav.waypoint_since_s();
  std::vector<SensorValue> s{{"c_wpt_lat", "lat", at(wpt.lat.degrees()), wpt_age},
                             {"c_wpt_lon", "lon", at(wpt.lon.degrees()), wpt_age},
                             {"m_avg_speed", "m/s", nav.belief().speed.si(), now_s - g.surfaced_s()},
                             {"m_battery", "volts", battery.volts, 3.76},
                             {"m_coulomb_amphr_total", "amp-hrs", battery.amp_hours, 3.872}};
  std::vector<SensorValue> currents;
  add_currents(currents, g, water_age);
  const auto take = [&](std::size_t from, std::size_t n) {
    for (std::size_t i = from; i < from + n && i < currents.size(); ++i) s.push_back(currents[i]);
  };
  const bool measured = currents.size() > 2;
  if (measured) take(0, 2);
  s.push_back({"m_gps_mag_var", "rad", g.setup().frame.magnetic_variation(g.setup().start).si(), now_s - g.fix_s()});
  if (measured) take(2, 2);
  s.push_back({"m_iridium_signal_strength", "nodim", 5, 28.087});
  s.push_back({"m_leakdetect_voltage", "volts", 2.478, 43.821});
  s.push_back({"m_lithium_battery_relative_charge", "%", battery.charge_percent, 3.886});
  s.push_back({"m_vacuum", "inHg", 8.4, 47.783});
  take(measured ? 4 : 0, 2);
  s.push_back({"u_use_current_correction", "nodim", static_cast<double>(nav.belief().correction), std::nullopt});
  const auto last = nav.last_achieved();
  const auto last_age = last ? std::optional<double>{now_s - nav.last_achieved_s()} : std::nullopt;
  s.push_back({"x_last_wpt_lat", "lat", last ? at(last->lat.degrees()) : 0.0, last_age});
  s.push_back({"x_last_wpt_lon", "lon", last ? at(last->lon.degrees()) : 0.0, last_age});
  return s;
}

}  // namespace

Report report_of(const Glider& g, double now_s, double dives_in_s) {
  const auto& setup = g.setup();
  Report r;
  r.glider = setup.name;
  r.clock_s = now_s + setup.clock_skew_s;
  r.mission_s = now_s - setup.start_s + kBeforeStart;
  r.mission_file = setup.mission_file;
  r.mission_started_s = setup.start_s - kBeforeStart + setup.clock_skew_s;
  r.mission_number = setup.mission_number;
  r.segment = g.segment();
  r.reason = g.because().text;
  r.behavior = g.because().behavior;
  r.start_when = g.because().start_when;
  if (g.abort()) r.mission_file = "lastgasp.mi";
  r.dr = g.reckoned();
  r.dr_age_s = now_s - g.fixes_done_s() - 1.1;
  r.invalid = g.invalid_fix();
  r.gps = g.fix();
  r.gps_age_s = now_s - g.fix_s();
  r.sensors = sensors_of(g, now_s);
  r.water_measured = g.water().has_value();
  r.water_final = true;
  const auto way = geodesic(g.fix(), g.navigator().waypoint());
  r.waypoint = WaypointReport{g.navigator().waypoint(), way.length.si() * grid_scale(g.fix()),
                              setup.frame.local_bearing_deg(way.departing), now_s - g.navigator().waypoint_since_s()};
  r.dives_in_s = dives_in_s;
  return r;
}

void tell_only(const Telling& tells, Report& r) {
  const auto value_of = [&](const std::string& name) {
    const auto found = std::find_if(r.sensors.begin(), r.sensors.end(), [&](const auto& s) { return s.name == name; });
    return found == r.sensors.end() ? 0.0 : found->value;
  };
  auto left_out = tells.without;
  if (tells.water_awaited && r.water_measured) {
    constexpr double kIdeally = -57;  // s: what recorded prompts of that kind say
    r.water_final = false;
    r.final_fix_in_s = kIdeally;
    left_out.insert(left_out.end(), {"m_final_water_vx", "m_final_water_vy"});
    for (auto& s : r.sensors)
      if (s.name == "m_water_vx" || s.name == "m_water_vy") s.value = value_of("m_initial_" + s.name.substr(2));
  }
  for (auto& s : r.sensors)
    if (s.name == "m_gps_mag_var") s.value += tells.variation_error.si();
  std::erase_if(r.sensors, [&](const SensorValue& s) {
    return std::find(left_out.begin(), left_out.end(), s.name) != left_out.end();
  });
  if (!tells.waypoint_line) r.waypoint.reset();
}

}  // namespace glidehelm::simulator
