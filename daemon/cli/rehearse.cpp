#include "daemon/cli/rehearse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/planning/flight.hpp"
#include "core/planning/registry.hpp"
#include "daemon/cli/plan_case.hpp"
#include "daemon/cli/rehearsal_flight.hpp"
#include "daemon/cli/rehearsal_report.hpp"
#include "simulator/ocean_error.hpp"
#include "simulator/random.hpp"

namespace glidehelm::cli {

namespace {

constexpr double kDegree = kPi / 180.0;

/// An ocean to fly in, and the same as a planner would see it.
struct TrueOcean {
  simulator::PerturbedField full, surface, dive;
  TrueOcean(const ocean::Forecast& model, const simulator::OceanError& error, double start_s)
      : full{model.full(), error, start_s},
        surface{model.ocean().surface, error, start_s},
        dive{model.ocean().dive, error, start_s} {}
  [[nodiscard]] ocean::Ocean flown() const { return {full, surface}; }
  [[nodiscard]] ocean::Ocean planned() const { return {dive, surface}; }
};

simulator::OceanError error_for(const RehearseOptions& o, std::uint64_t seed) {
  simulator::Random dice = simulator::Random{seed}.stream(1);
  simulator::OceanError error;
  if (!o.truth.empty()) return error;  // that truth is another forecast: it differs by itself
  error.seed = seed;
  error.shift_km = o.shift_km;
  error.shift_toward_deg = dice.uniform(0, 360);
  error.late_h = dice.uniform(-o.late_h, o.late_h);
  error.noise_m_per_s = o.noise_m_per_s;
  return error;
}

RehearsalFlight::Setup setup_for(const Case& c, std::uint64_t seed, double start_s, const std::string& method) {
  simulator::Random dice = simulator::Random{seed}.stream(2);
  const auto& m = c.mission;
  RehearsalFlight::Setup s;
  s.mission = m;
  s.mission.method = method;
  s.mission.approval = mission::Approval::automatic;  // nobody is there to approve
  s.seed = seed;
  auto& g = s.glider.setup;
  g.name = m.glider;
  g.slot = m.slot;
  g.start = *m.start;
  g.start_s = start_s;
  g.hull.speed = m.horizontal_speed * dice.uniform(0.97, 1.03);
  g.hull.heading_bias = Radians{dice.uniform(-2, 2) * kDegree};
  g.hull.glide_angle = m.glide_angle;
  g.hull.dive_depth = m.dive_depth;
  g.hull.climb_to = m.climb_to;
  g.belief = {m.horizontal_speed, m.current_correction};
  g.frame.rotation = m.frame_rotation.value_or(Radians{});
  g.stint_s = m.stint.count();
  g.stint_jitter = 0.03;
  g.cycle_s = 20;
  g.times.surface = m.surface.count();
  g.list.waypoints = {m.goal};
  g.list.radius = Metres{std::max(100.0, 0.25 * m.goal_radius.si())};
  g.list.initial = 0;
  g.seed = seed;
  if (!m.slocum_mission.empty()) g.mission_file = m.slocum_mission;
  s.glider.goal = m.goal;
  s.glider.goal_radius = m.goal_radius;
  return s;
}

double closest_coast(const RehearsalFlight& flight, const chart::Chart& chart) {
  double closest = chart::Chart::kHorizon;
  for (const auto& dive : flight.simulation().dives(0)) {
    const auto way = geodesic(dive.dive, dive.surface);
    const int pieces = 1 + static_cast<int>(way.length.si() / 1000.0);
    for (int i = 0; i <= pieces; ++i) {
      const auto at = destination(dive.dive, way.departing, way.length * (static_cast<double>(i) / pieces));
      closest = std::min(closest, chart.distance_to_coast(at).si());
    }
  }
  return closest;
}

/// Travel time of the plan that knows the ocean; none when even that does not arrive.
std::optional<double> hindcast(const Case& c, const ocean::Ocean& truth, double start_s) {
  auto problem = c.request.problem;
  problem.horizon_s += start_s - problem.start.fix_s;
  problem.start.fix_s = start_s;
  const std::array<ocean::Ocean, 1> members{truth};
  const auto planner = planning::planner_named(c.mission.method);
  const auto plan = planner->plan(problem, members, c.chart->chart, {daemon::kStageWork, {}}, {});
  if (!plan || !plan->reaches_goal()) return std::nullopt;
  return plan->arrival_s - start_s;
}

Rehearsed result_of(const RehearsalFlight& flight, const Case& c, const std::string& method) {
  const auto& result = flight.simulation().result(0);
  Rehearsed r;
  r.method = method;
  r.end = result.reason;
  if (result.arrived_s) r.travel_s = *result.arrived_s - result.started_s;
  r.surfacings = result.surfacings;
  r.files = static_cast<int>(flight.files().size());
  for (const auto& s : flight.simulation().surfacings(0)) {
    r.missed += !s.call.list;
    r.track.push_back(s.fix);
  }
  if (c.chart->chart.has_coast()) r.closest_coast = closest_coast(flight, c.chart->chart);
  r.closest_goal = result.closest.si();
  r.rules = flight.rules_fired();
  return r;
}

/// What the ocean of the rehearsal is made of: the forecast itself, or other files.
Expected<std::shared_ptr<const daemon::OceanSource>, Trouble> model_of_truth(const RehearseOptions& o, const Case& c,
                                                                             world::World& world) {
  if (o.truth.empty()) return c.ocean;
  auto mission = c.mission;
  mission.currents.files = o.truth;
  auto ocean = daemon::load_ocean({mission, world.files.scratch(), c.chart->chart.has_coast(),
                                   instant_at(c.request.problem.start.fix_s), mission.start},
                                  world);
  if (!ocean) return unexpected(Trouble{1, "--truth: " + ocean.error()});
  return std::move(ocean).value();
}

}  // namespace

int run_rehearse(const RehearseOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  const auto c = prepare_case(options.plan, world, err);
  const auto fail = [&](const Trouble& trouble) {
    err << "glidehelm rehearse: " << trouble.message << "\n";
    return trouble.code;
  };
  if (!c) return fail(c.error());
  if (const auto wrong = planning::check_ends(c->request.problem, c->ocean->forecast.ocean(), c->chart->chart))
    return fail({1, wrong->message});
  const auto model = model_of_truth(options, *c, world);
  if (!model) return fail(model.error());

  Rehearsal all;
  all.mission = c->mission.name;
  all.method = c->mission.method;
  all.start = *c->mission.start;
  all.goal = c->mission.goal;
  all.goal_radius = c->mission.goal_radius;
  all.forecast = c->ocean->label();
  all.truth = options.truth.empty()
                  ? fmt::format("the forecast shifted by {:g} km, up to {:g} h early or late, with eddies of {:g} m/s",
                                options.shift_km, options.late_h, options.noise_m_per_s)
                  : (*model)->label();
  const auto first = epoch_seconds(instant_at(c->request.problem.start.fix_s));
  const std::size_t flights = options.delays_h.size() * static_cast<std::size_t>(options.seeds) * 2;
  for (const double delay : options.delays_h)
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const double start_s = first + 3600 * delay;
      const auto number = static_cast<std::uint64_t>(seed);
      const TrueOcean truth{(*model)->forecast, error_for(options, number), start_s};
      const auto known = hindcast(*c, truth.planned(), start_s);
      for (const auto& method : {c->mission.method, std::string{"direct"}}) {
        if (method == "direct" && c->mission.method == "direct" && !all.runs.empty() && all.runs.back().seed == seed &&
            all.runs.back().delay_h == delay)
          continue;
        auto setup = setup_for(*c, number, start_s, method);
        setup.end.days = (c->request.problem.horizon_s - c->request.problem.start.fix_s) / 86400;
        RehearsalFlight flight{std::move(setup), c->ocean, truth.flown(), c->chart->chart};
        flight.fly();
        auto r = result_of(flight, *c, method);
        r.seed = seed;
        r.delay_h = delay;
        r.hindcast_s = known;
        all.runs.push_back(std::move(r));
        err << "\r" << progress_bar(all.runs.size(), flights) << std::flush;
      }
    }
  err << "\r" << std::string(60, ' ') << "\r";
  if (!options.html.empty())
    if (const auto problem = save_page(all, c->chart->chart, options.html, world.files); !problem.empty())
      return fail({1, problem});
  out << (options.json ? json_text(all) : table_text(all));
  return std::all_of(all.runs.begin(), all.runs.end(),
                     [&](const Rehearsed& r) { return r.method != all.method || r.travel_s.has_value(); })
             ? 0
             : 1;
}

}  // namespace glidehelm::cli
