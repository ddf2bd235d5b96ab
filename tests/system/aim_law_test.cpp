#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <iostream>

#include "core/base/local_metric.hpp"
#include "core/base/utc.hpp"
#include "core/mission/estimate.hpp"
#include "core/ocean/corrected.hpp"
#include "core/planning/flight.hpp"
#include "core/vehicle/steering.hpp"
#include "tests/support/flown_mission.hpp"
#include "tests/support/random_sea.hpp"

// What is left between a plan and the surfacing that it leads to, where truth is the forecast, and what it is made of.
using namespace glidehelm;
using test::FlownMission;

namespace {

constexpr double kSpeed = 0.30, kStint = 4 * 3600.0, kLength = kSpeed * kStint;

/// The parts, in the order in which the plan's inputs are exchanged for the glider's own.
constexpr std::array<const char*, 9> kParts{
    "integration: steps of the plan and of dead reckoning",
    "ring radius, switching to the next waypoint",
    "learned correction of a forecast that is right",
    "learned speed and heading bias",
    "dive place: predicted surface drift",
    "length of the stint",
    "believed current",
    "text: printed fix, waypoints of the file",
    "not accounted for",
};

/// What was planned at one surfacing and emitted.
struct Order {
  mission::PlanningRequest request;
  mission::Candidate candidate;
};

std::optional<Order> order_of(const FlownMission& flown, const std::string& bytes) {
  Order order;
  for (const auto& event : flown.events())
    if (const auto* found = std::get_if<mission::CandidateFound>(&event.what);
        found != nullptr && found->candidate.file_bytes == bytes)
      order.candidate = found->candidate;
  for (const auto& effects : flown.effects())
    for (const auto& effect : effects)
      if (const auto* begin = std::get_if<mission::BeginPlanning>(&effect);
          begin != nullptr && begin->request.id == order.candidate.request)
        order.request = begin->request;
  if (order.candidate.file_bytes.empty() || order.request.id != order.candidate.request) return std::nullopt;
  return order;
}

/// One dive of the simulated glider by itself: all that decides where it comes up.
struct Flight {
  GeoPoint dive;
  double dive_s{}, stint_s{}, speed{}, believed{}, cycle_s{4};
  Radians bias{};
  int correction{};
  Current used;
  simulator::GotoList list;
  ocean::Ocean ocean;

  [[nodiscard]] GeoPoint surface(const chart::Chart& chart) const {
    simulator::GliderSetup s;
    s.start = dive;
    s.start_s = dive_s;
    s.hull.speed = MetresPerSecond{speed};
    s.hull.heading_bias = bias;
    s.belief = {MetresPerSecond{believed}, correction};
    s.prior_water = used;
    s.stint_s = stint_s;
    s.cycle_s = cycle_s;
    s.list = list;
    simulator::Glider glider{s, ocean, chart};
    return glider.dive(dive_s).surface;
  }
};

simulator::GotoList list_of(const model::WaypointList& list) {
  simulator::GotoList l;
  for (const auto& point : list.points) l.waypoints.push_back(point.at);
  l.radius = list.radius;
  l.initial = 0;
  l.legs = list.at_end == model::AtEnd::loop ? -1 : -2;
  l.end_action = 6;
  return l;
}

struct Vector {
  double east{}, north{};
  [[nodiscard]] double length() const { return std::hypot(east, north); }
  friend Vector operator-(Vector a, Vector b) { return {a.east - b.east, a.north - b.north}; }
};

Vector offset(GeoPoint from, GeoPoint to) {
  const auto o = local_offset(from.lat.radians(), from.lon.radians(), to.lat.radians(), to.lon.radians());
  return {o.east, o.north};
}

GeoPoint moved(GeoPoint from, Vector by) {
  return destination(from, Bearing{Radians{std::atan2(by.east, by.north)}}, Metres{by.length()});
}

/// The way from the promised place to the real one, in `kParts`: the simulated dive is flown again and again, each time
/// with one more input as it truly was.
std::array<Vector, kParts.size()> parts_of(const Order& order, const simulator::DiveRecord& dive,
                                           const simulator::SurfacingRecord& before, double cycle_s, ocean::Ocean truth,
                                           const chart::Chart& chart) {
  const auto& [request, candidate] = order;
  auto problem = request.problem;
  problem.horizon_s = candidate.horizon_s;
  std::optional<ocean::CorrectedOcean> corrected;
  if (request.correction && request.correction->plausible()) corrected.emplace(truth, *request.correction);
  const ocean::Ocean planned_ocean = corrected ? corrected->ocean() : truth;
  const auto& planned = candidate.plan.stints.front();
  const GeoPoint promised = candidate.promise.next_surfacing;

  Flight f{planned.dive,
           planned.dive_s,
           planned.surface_s - planned.dive_s,
           problem.glider.horizontal_speed.si(),
           problem.glider.believed_speed.si(),
           cycle_s,
           problem.glider.heading_bias,
           problem.glider.current_correction,
           problem.believed_current.value_or(Current{}),
           list_of(candidate.list),
           planned_ocean};
  // Its heading held to the end, by either integrator: the list ends with its first waypoint.
  auto held = candidate.list;
  held.points.resize(1);
  held.at_end = model::AtEnd::wait;
  const auto by_plan = vehicle::fly_list(held, planning::flight_of(problem), {planned_ocean, chart, Metres{0}});
  auto holding = f;
  holding.list = list_of(held);

  std::array<Vector, kParts.size()> parts;
  std::size_t part = 0;
  Vector before_it;
  const auto put = [&](Vector now) {
    parts.at(part++) = now - before_it;
    before_it = now;
  };
  const Vector integration = offset(promised, holding.surface(chart)) - offset(promised, by_plan.stints.at(0).surface);
  put(integration);
  put(offset(promised, f.surface(chart)));
  f.ocean = truth;
  put(corrected ? offset(promised, f.surface(chart)) : before_it);
  f.speed = kSpeed;
  f.believed = kSpeed;
  f.bias = Radians{};
  put(offset(promised, f.surface(chart)));
  // As if the dialog had printed the fix to the last digit.
  const Vector rounding = offset(problem.start.fix, before.fix);
  f.dive = moved(dive.dive, Vector{} - rounding);
  f.dive_s = dive.dive_s;
  put(offset(promised, f.surface(chart)));
  f.stint_s = dive.surface_s - dive.dive_s;
  put(offset(promised, f.surface(chart)));
  f.used = before.water.value_or(Current{});
  put(f.correction == 0 ? before_it : offset(promised, f.surface(chart)));
  f.dive = dive.dive;
  f.list = simulator::read_goto_list(candidate.file_bytes).value();
  put(offset(promised, f.surface(chart)));
  put(offset(promised, dive.surface));
  return parts;
}

double worst(const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); }

}  // namespace

TEST_CASE("where truth is the forecast 200 stints in currents up to 3 U end within 3 % of their length from the plan") {
  for (const int correction : {1, 0}) {
    std::vector<double> errors;
    std::array<std::vector<double>, kParts.size()> by_part;
    int seas = 0, strong = 0;
    double fastest = 0, gap = 0;
    std::string steepest;
    for (std::uint64_t seed = 1; errors.size() < 200 && seed < 60; ++seed) {
      test::Dice dice{seed * 104729 + static_cast<std::uint64_t>(correction)};
      for (int i = 0; i < 8; ++i) static_cast<void>(dice.roll());
      const double c = dice.between(0, 0.8), towards = dice.between(0, 2 * kPi), way = dice.between(0, 2 * kPi);
      const auto from = geo_point(40.75, 4.45), goal = destination(from, Bearing{Radians{way}}, Metres{70'000});
      const auto forecast =
          test::gridded_forecast(test::random_sea(dice, from, 0.10, c * std::sin(towards), c * std::cos(towards)),
                                 geo_point(40, 3.4), geo_point(41.5, 5.5), test::kSeaStart);
      const chart::Chart open_ocean;
      auto s = test::leg_setup(from, goal, correction, test::kSeaStart);
      s.mission.horizon = Seconds{36 * 3600.0};
      s.glider.setup.stint_s = kStint;
      s.glider.setup.prior_water =
          Current{MetresPerSecond{c * std::sin(towards)}, MetresPerSecond{c * std::cos(towards)}};
      s.end.surfacings = 7;
      const auto truth = forecast->forecast.ocean();
      FlownMission flown{s, forecast, truth, open_ocean};
      flown.fly();
      ++seas;
      const auto& dives = flown.simulation().dives(0);
      const auto& promised = flown.surfacings();
      if (flown.plans().size() + 1 < promised.size()) continue;  // a surfacing without a file flies no plan
      for (std::size_t j = 1; j < promised.size() && j - 1 < dives.size() && errors.size() < 200; ++j) {
        const auto& plan = flown.plans()[j - 1];
        if (!promised[j].promised || plan.stints.empty() || plan.stints.front().arrives) continue;
        const auto& dive = dives[j - 1];
        const auto order = order_of(flown, flown.files().at(j - 1));
        REQUIRE(order);
        REQUIRE(order->candidate.promise.next_surfacing == *promised[j].promised);
        // The fix is a minute later than the surfacing: up to 60 m of drift that no plan is to blame for.
        const double error = distance(dive.surface, *promised[j].promised).si();
        const auto parts = parts_of(*order, dive, flown.simulation().surfacings(0).at(j - 1), s.glider.setup.cycle_s,
                                    truth, open_ocean);
        constexpr std::size_t kDivePlace = 4;
        if (by_part.at(kDivePlace).empty() ||
            100 * parts.at(kDivePlace).length() / kLength > worst(by_part.at(kDivePlace))) {
          const auto& first = order->candidate.plan.stints.front();
          const auto believed = order->request.problem.believed_current.value_or(Current{});
          steepest = fmt::format(
              "  at worst the dive place was {:.2f} m off and the surfacing {:.1f} m for it; believed current {:.3f} "
              "m/s, first "
              "waypoint {:.0f} m away\n",
              distance(first.dive, dive.dive).si(), parts.at(kDivePlace).length(), believed.speed().si(),
              distance(dive.dive, order->candidate.list.points.front().at).si());
        }
        Vector sum;
        for (std::size_t i = 0; i < parts.size(); ++i) {
          by_part.at(i).push_back(100 * parts.at(i).length() / kLength);
          sum = {sum.east + parts.at(i).east, sum.north + parts.at(i).north};
        }
        gap = std::max(gap, std::abs(sum.length() - error));
        errors.push_back(100 * error / kLength);
        fastest = std::max(fastest, dive.truth.water.speed().si());
        strong += dive.truth.water.speed().si() > kSpeed ? 1 : 0;
      }
    }
    std::cout << fmt::format(
        "correction {}: {} stints of {:.0f} m in {} seas, {} of them in more than U, fastest {:.2f} U\n"
        "  {:54}    median      worst, % of the stint's length\n",
        correction, errors.size(), kLength, seas, strong, fastest / kSpeed, "part");
    for (std::size_t i = 0; i < kParts.size(); ++i)
      std::cout << fmt::format("  {:54} {:9.4f}  {:9.4f}\n", kParts.at(i), mission::median_of(by_part.at(i)),
                               worst(by_part.at(i)));
    std::cout << fmt::format("  {:54} {:9.4f}  {:9.4f}\n", "surfacing to plan", mission::median_of(errors),
                             worst(errors))
              << steepest;
    CHECK(errors.size() == 200);
    CHECK(worst(errors) < 3.0);
    CHECK(fastest > 0.80);
    CHECK(strong > 80);
    // The parts add up to the whole: offsets of one plane against a geodesic of at most 130 m, and what remains is the
    // rounding of the same arithmetic done twice.
    CHECK(gap < 0.01);
    CHECK(worst(by_part.back()) * kLength / 100 < 0.01);
  }
}
