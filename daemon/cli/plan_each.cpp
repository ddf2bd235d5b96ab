#include "daemon/cli/plan_each.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/planning/flight.hpp"
#include "daemon/candidate.hpp"
#include "daemon/cli/plan_members.hpp"
#include "daemon/cli/progress_bar.hpp"
#include "daemon/world/workers.hpp"

namespace glidehelm::cli {

namespace {

using Json = nlohmann::ordered_json;

/// What is left of a problem where there is no plan.
planning::Plan nothing_planned(const planning::Problem& problem, const std::string& reason) {
  planning::Plan plan;
  plan.remaining = distance(problem.start.fix, planning::disc_of(problem).centre);
  plan.reason = reason;
  return plan;
}

planning::Plan plan_in(const Case& c, const daemon::OceanSource& member) {
  std::optional<planning::Plan> best;
  const auto problem = daemon::answer(c.request, member, c.chart->chart, {},
                                      [&](const mission::Candidate& candidate) { best = candidate.plan; });
  return best ? *best : nothing_planned(c.request.problem, problem);
}

std::vector<planning::MemberPlan> beside_of(const std::vector<EachPlan>& plans) {
  std::vector<planning::MemberPlan> all;
  for (const auto& plan : plans) all.push_back(plan.beside);
  return all;
}

template <class Unit, class Number>
Json value(const std::optional<Unit>& unit, const Number& number) {
  return unit ? Json(number(*unit)) : Json(nullptr);
}
Json seconds_or_null(const std::optional<Seconds>& v) {
  return value(v, [](Seconds s) { return s.count(); });
}
Json metres_or_null(const std::optional<Metres>& v) {
  return value(v, [](Metres m) { return m.si(); });
}
Json degrees_or_null(const std::optional<Radians>& v) {
  return value(v, [](Radians r) { return in_degrees(r); });
}

std::string side(Radians turn) {
  const double degrees = in_degrees(turn);
  return fmt::format("{:.0f}\u00b0 {}", std::abs(degrees), degrees < 0 ? "left" : "right");
}

}  // namespace

Expected<std::vector<EachPlan>, Trouble> plan_in_members(const Case& c, const std::optional<planning::Plan>& control,
                                                         int members, bool progress, world::World& world,
                                                         std::ostream& err, unsigned threads) {
  const auto count = static_cast<std::size_t>(members);
  std::vector<planning::Plan> plans(count);
  std::vector<std::optional<Trouble>> troubles(count);
  plans[0] = control ? *control : nothing_planned(c.request.problem, "the control has no plan");
  world::Turns outside;  // members are read, let go and told of one at a time
  std::size_t done = 1;
  world::for_each_index(count - 1, threads, [&](std::size_t index) {
    const auto k = index + 1;
    std::shared_ptr<const daemon::OceanSource> member;
    outside.take([&] {
      auto loaded = load_member(c, static_cast<std::uint32_t>(k), world);
      if (loaded)
        member = std::move(loaded).value();
      else
        troubles[k] = loaded.error();
    });
    if (member) plans[k] = plan_in(c, *member);
    outside.take([&] {
      member.reset();
      if (progress) err << "\r" << progress_bar(++done, count) << std::flush;
    });
  });
  if (progress) err << "\r" << std::string(progress_bar(count, count).size(), ' ') << "\r" << std::flush;
  for (const auto& trouble : troubles)
    if (trouble) return unexpected(*trouble);
  std::vector<EachPlan> each;
  for (const auto& plan : plans)
    each.push_back({planning::member_plan(plan, plans[0], c.request.problem), plan.method, plan.reason});
  return each;
}

Json each_json(const std::vector<EachPlan>& plans) {
  const auto all = planning::summary_of(beside_of(plans));
  Json j{{"members", all.plans},
         {"arrived", all.arrived},
         {"travel_time_s",
          {{"p10", seconds_or_null(all.tenth)},
           {"median", seconds_or_null(all.median)},
           {"p90", seconds_or_null(all.ninetieth)}}},
         {"first_turn_deg", {{"p10", degrees_or_null(all.turned_left)}, {"p90", degrees_or_null(all.turned_right)}}},
         {"apart_m", {{"median", metres_or_null(all.apart_median)}, {"most", metres_or_null(all.apart_most)}}}};
  j["plans"] = Json::array();
  for (std::size_t k = 0; k < plans.size(); ++k) {
    const auto& [beside, method, reason] = plans[k];
    j["plans"].push_back({{"member", k},
                          {"method", method.empty() ? Json(nullptr) : Json(method)},
                          {"travel_time_s", seconds_or_null(beside.travel)},
                          {"remaining_distance_m", beside.remaining.si()},
                          {"first_heading_deg", value(beside.first, [](Heading h) { return h.degrees(); })},
                          {"first_turn_deg", degrees_or_null(beside.turn)},
                          {"apart_m", metres_or_null(beside.apart)},
                          {"reason", reason}});
  }
  return j;
}

void print_each(const std::vector<EachPlan>& plans, std::ostream& out) {
  const auto all = planning::summary_of(beside_of(plans));
  out << fmt::format("planned in each of {} members: {} of the plans arrive", all.plans, all.arrived);
  if (all.median)
    out << fmt::format(", after {:.1f} h (median; 10 to 90 %: {:.1f} h to {:.1f} h)", all.median->count() / 3600,
                       all.tenth->count() / 3600, all.ninetieth->count() / 3600);
  out << "\n";
  if (all.turned_left && all.apart_median)
    out << fmt::format(
        "first heading from {} to {} of the control's (10 to 90 %); the ways stray {:.1f} km from its way (median; at "
        "most {:.1f} km)\n",
        side(*all.turned_left), side(*all.turned_right), all.apart_median->si() / 1000, all.apart_most->si() / 1000);
  for (std::size_t k = 0; k < plans.size(); ++k)
    if (!plans[k].beside.travel)
      out << fmt::format("member {:3}: its plan comes within {:.1f} km: {}\n", k, plans[k].beside.remaining.si() / 1000,
                         plans[k].reason);
}

}  // namespace glidehelm::cli
