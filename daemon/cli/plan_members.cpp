#include "daemon/cli/plan_members.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "config/load.hpp"
#include "core/base/utc.hpp"
#include "core/vehicle/yo_field.hpp"
#include "daemon/cli/progress_bar.hpp"

namespace glidehelm::cli {

namespace {

using Json = nlohmann::ordered_json;

Json seconds(const std::optional<Seconds>& value) { return value ? Json(value->count()) : Json(nullptr); }
Json metres(const std::optional<Metres>& value) { return value ? Json(value->si()) : Json(nullptr); }
std::string hours(const std::optional<Seconds>& value) {
  return value ? fmt::format("{:.1f} h", value->count() / 3600) : std::string{"-"};
}

/// The waters of a member as the request's motion model meets them.
planning::MemberFlight fly_in(const ocean::Forecast& member, const planning::Plan& plan, const Case& c) {
  const auto& problem = c.request.problem;
  const auto waters = member.ocean();
  if (c.request.motion != vehicle::MotionModel::yo_yo || member.facts().levels <= 1)
    return planning::fly_in_member(plan, problem, waters, c.chart->chart);
  const auto full = member.full();
  const vehicle::YoField yo{full, problem.glider, problem.schedule, problem.start.fix_s};
  return planning::fly_in_member(plan, problem, ocean::Ocean{yo, waters.surface}, c.chart->chart);
}

/// An error of the mission's `currents.ensemble`, or of its `currents` when it has none.
Trouble trouble_of(const Case& c, const std::string& problem) {
  const char* key = c.mission.currents.ensemble ? "currents.ensemble" : "currents";
  return {1, config::error_at(c.mission_text, c.mission_file, key, problem).message()};
}

/// Epoch second that names the cycle of a forecast; none of one without time.
std::optional<double> cycle_of(const ocean::ForecastFacts& facts, bool by_reference) {
  if (by_reference) return facts.reference_s;
  return facts.has_time ? std::optional{facts.first_s} : std::nullopt;
}

}  // namespace

Expected<int, Trouble> members_to_fly(const Case& c, const PlanOptions& options, world::World& world) {
  const auto& ensemble = c.mission.currents.ensemble;
  const int members = options.members > 0 ? options.members : ensemble && !options.member ? ensemble->members : 0;
  if (!ensemble) return members;
  std::string missing, example;
  for (int member = 0; member < members; ++member)
    for (const auto& pattern : ensemble->files.empty() ? std::vector<std::string>{} : ensemble->files_of(member)) {
      if (pattern.find("://") != std::string::npos || !world.files.glob(pattern).empty()) continue;
      missing += (missing.empty() ? "" : ", ") + std::to_string(ensemble->first + member);
      if (example.empty()) example = pattern;
      break;
    }
  if (missing.empty()) return members;
  return unexpected(
      trouble_of(c, "members without a file, by their numbers: " + missing + "; nothing matches " + example));
}

Expected<std::shared_ptr<const daemon::OceanSource>, Trouble> load_member(const Case& c, std::uint32_t member,
                                                                          world::World& world) {
  auto order = c.order;
  order.member = member;
  auto ocean = daemon::load_ocean(order, world);
  if (!ocean) return unexpected(Trouble{1, "member " + std::to_string(member) + ": " + ocean.error()});
  const auto &own = (*ocean)->forecast.facts(), &control = c.ocean->forecast.facts();
  const bool by_reference = std::isfinite(own.reference_s) && std::isfinite(control.reference_s);
  const auto cycle = cycle_of(own, by_reference), expected = cycle_of(control, by_reference);
  const auto text = [](const std::optional<double>& cycle_s) {
    return cycle_s ? utc_text(instant_at(*cycle_s)) : std::string{"no time"};
  };
  if (cycle != expected)
    return unexpected(
        trouble_of(c, fmt::format("members of different cycles: member {} {} {}, the one that is planned in {}", member,
                                  by_reference ? "has the reference time" : "begins at", text(cycle), text(expected))));
  return std::move(ocean).value();
}

Expected<std::vector<planning::MemberFlight>, Trouble> fly_in_members(const Case& c, const planning::Plan& plan,
                                                                      int members, bool progress, world::World& world,
                                                                      std::ostream& err) {
  std::vector<planning::MemberFlight> flights;
  const auto count = static_cast<std::size_t>(members);
  const auto tell = [&](const std::string& line) {
    if (progress) err << "\r" << line << std::flush;
  };
  for (std::uint32_t member = 0; member < count; ++member) {
    tell(progress_bar(flights.size(), count));
    const auto ocean = load_member(c, member, world);
    if (!ocean) {
      if (progress) err << "\n";
      return unexpected(ocean.error());
    }
    flights.push_back(fly_in((*ocean)->forecast, plan, c));
  }
  tell(std::string(progress_bar(count, count).size(), ' ') + "\r");
  return flights;
}

Json members_json(const std::vector<planning::MemberFlight>& flights) {
  const auto all = planning::summary_of(flights);
  Json j{{"members", all.flights},
         {"arrived", all.arrived},
         {"arrival_share", all.share()},
         {"travel_time_s",
          {{"p10", seconds(all.tenth)}, {"median", seconds(all.median)}, {"p90", seconds(all.ninetieth)}}},
         {"closest_coast_m", metres(all.coast)}};
  j["flights"] = Json::array();
  for (std::size_t k = 0; k < flights.size(); ++k) {
    const auto& f = flights[k];
    j["flights"].push_back({{"member", k},
                            {"travel_time_s", seconds(f.travel)},
                            {"remaining_distance_m", f.remaining.si()},
                            {"closest_coast_m", metres(f.coast)},
                            {"lost", f.lost ? Json(std::string{vehicle::word(*f.lost)}) : Json(nullptr)}});
  }
  return j;
}

void print_members(const std::vector<planning::MemberFlight>& flights, std::ostream& out) {
  const auto all = planning::summary_of(flights);
  out << fmt::format("flown in {} members: it arrives in {} of them ({:.0f} %)", all.flights, all.arrived,
                     100 * all.share());
  if (all.median)
    out << fmt::format(", after {} (median; 10 to 90 %: {} to {})", hours(all.median), hours(all.tenth),
                       hours(all.ninetieth));
  out << "\n";
  if (all.coast)
    out << fmt::format("closest coast in any member {}{:.1f} km\n",
                       all.coast->si() >= chart::Chart::kHorizon ? ">" : "", all.coast->si() / 1000);
  for (std::size_t k = 0; k < flights.size(); ++k)
    if (!flights[k].travel)
      out << fmt::format("member {:3}: comes within {:.1f} km{}\n", k, flights[k].remaining.si() / 1000,
                         flights[k].lost ? ", then " + std::string{vehicle::word(*flights[k].lost)} : "");
}

}  // namespace glidehelm::cli
