#include "simulator/prints.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/utc.hpp"

namespace glidehelm::simulator {
namespace {

std::string when(double t_s) { return utc_text(instant_at(t_s)); }

std::string current_text(const std::optional<Current>& c) {
  if (!c) return "none";
  const auto rounded = [](double v) { return std::round(v * 1e3) / 1e3 + 0.0; };  // never a zero with a minus
  return fmt::format("{:+.3f},{:+.3f} m/s", rounded(c->east.si()), rounded(c->north.si()));
}

std::string list_text(const CallOutcome& call) {
  if (call.error) return "BAD (" + call.error->message() + ")";
  if (!call.list) return "none (" + call.note + ")";
  return fmt::format("{} taken, {}", call.list->name, call.reread ? "re-read" : "not re-read");
}

nlohmann::ordered_json time_or_null(const std::optional<double>& t) {
  return t ? nlohmann::ordered_json(utc_text(instant_at(*t), true)) : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string surfacing_line(const SurfacingRecord& r, const GliderPlan& plan) {
  std::string faults;
  if (r.faults.redial) faults += " redialled";
  if (r.faults.no_connection_block) faults += " first block lost";
  for (const auto& name : struck(r.faults))
    if (name != "redial" && name != "no_connection_block" && name != "lost_calls" && name != "not_taken")
      faults += " " + name;
  if (r.call.partial) faults += " (part of a file on board)";
  return fmt::format("{} {} surfacing {}: fix {:.5f},{:.5f} DAC {} file {} goal {:.1f} km{}", when(r.fix_s),
                     plan.setup.name, r.number, r.fix.lat.degrees(), r.fix.lon.degrees(), current_text(r.water),
                     list_text(r.call), r.to_goal.si() / 1000, faults);
}

std::string result_line(const GliderResult& r, const GliderPlan& plan) {
  const std::string head = plan.setup.name + ": ";
  const auto counts = fmt::format("{} surfacings, {} goto lists taken", r.surfacings, r.lists_taken);
  if (!r.arrived_s)
    return head + fmt::format("{} ({}), closest to the goal {:.1f} km, {}", word(r.end), r.reason,
                              r.closest.si() / 1000, counts);
  const auto ended = r.end == RunEnd::arrived ? std::string{} : fmt::format(", then {} ({})", word(r.end), r.reason);
  return head + fmt::format("arrived at {} after {:.2f} h{}, {}", when(*r.arrived_s),
                            (*r.arrived_s - r.started_s) / 3600, ended, counts);
}

std::string results_json(const Simulation& simulation, std::uint64_t seed) {
  nlohmann::ordered_json all;
  all["schema"] = "glidehelm/glidersim/v1";
  all["seed"] = seed;
  all["gliders"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < simulation.count(); ++i) {
    const auto& r = simulation.result(i);
    nlohmann::ordered_json g;
    g["name"] = simulation.plan(i).setup.name;
    g["end"] = word(r.end);
    g["reason"] = r.reason;
    g["arrived"] = r.arrived_s.has_value();
    g["arrival"] = time_or_null(r.arrived_s);
    g["travel_time_s"] =
        r.arrived_s ? nlohmann::ordered_json(*r.arrived_s - r.started_s) : nlohmann::ordered_json(nullptr);
    g["surfacings"] = r.surfacings;
    g["lists_taken"] = r.lists_taken;
    g["behaviour_errors"] = r.behaviour_errors;
    g["closest_m"] = r.closest.si();
    g["energy_wh"] = simulation.glider(i).energy().total_wh();
    g["track"] = nlohmann::ordered_json::array();
    for (const auto& s : simulation.surfacings(i)) {
      nlohmann::ordered_json row;
      row["number"] = s.number;
      row["surfaced"] = utc_text(instant_at(s.surfaced_s), true);
      row["dived"] = utc_text(instant_at(s.dive_s), true);
      row["fix_time"] = utc_text(instant_at(s.fix_s), true);
      row["lat_deg"] = s.fix.lat.degrees();
      row["lon_deg"] = s.fix.lon.degrees();
      row["dac"] =
          s.water ? nlohmann::ordered_json{{"east_m_per_s", s.water->east.si()}, {"north_m_per_s", s.water->north.si()}}
                  : nlohmann::ordered_json(nullptr);
      row["file"] = s.call.list ? nlohmann::ordered_json(s.call.list->name) : nlohmann::ordered_json(nullptr);
      row["note"] = s.call.error ? s.call.error->message() : s.call.note;
      row["partial_file"] = s.call.partial;
      row["faults"] = struck(s.faults);
      row["connections"] = s.connections;
      row["bytes"] = s.bytes;
      row["whole_fixes"] = s.whole_fixes;
      row["because"] = s.because.text;
      row["fix_is_fresh"] = s.fix_is_fresh;
      row["energy_wh"] = {{"pump", s.energy.pump_wh}, {"hotel", s.energy.hotel_wh}, {"call", s.energy.call_wh}};
      row["to_goal_m"] = s.to_goal.si();
      g["track"].push_back(std::move(row));
    }
    all["gliders"].push_back(std::move(g));
  }
  return all.dump(1);
}

}  // namespace glidehelm::simulator
