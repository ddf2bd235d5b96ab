#include "daemon/cli/rehearse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/utc.hpp"
#include "core/planning/flight.hpp"
#include "core/planning/registry.hpp"
#include "daemon/cli/new_file.hpp"
#include "daemon/cli/plan_case.hpp"
#include "daemon/cli/rehearsal_flight.hpp"
#include "daemon/cli/rehearsal_page.hpp"
#include "simulator/ocean_error.hpp"
#include "simulator/random.hpp"

namespace glidehelm::cli {

namespace {

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

/// Along the straight lines from dive to surfacing to dive. The distance changes by no more than the way made, so that a step as
/// long as the shore is farther away than the closest place yet passes over nothing; the shortest step is twice the error.
double closest_coast(const RehearsalFlight& flight, const chart::Chart& chart) {
  constexpr double kShortest = 100;
  double closest = chart::Chart::kHorizon;
  const auto look_along = [&](GeoPoint from, GeoPoint to) {
    const auto way = geodesic(from, to);
    for (double made = 0;;) {
      const auto here = destination(from, way.departing, Metres{made});
      const double d = chart.distance_to_coast(here).si();
      closest = std::min(closest, d);
      if (made >= way.length.si()) return;
      made = std::min(way.length.si(), made + std::max(kShortest, d - closest));
    }
  };
  GeoPoint before = flight.simulation().plan(0).setup.start;
  for (const auto& dive : flight.simulation().dives(0)) {
    look_along(before, dive.dive);
    look_along(dive.dive, dive.surface);
    before = dive.surface;
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
  r.energy_wh = result.energy.total_wh();
  r.rules = flight.rules_fired();
  return r;
}

/// What the ocean of the rehearsal is made of: the forecast itself, or other files.
Expected<std::shared_ptr<const daemon::OceanSource>, Trouble> model_of_truth(const RehearseOptions& o, const Case& c,
                                                                             world::World& world) {
  if (o.truth.empty()) return c.ocean;
  auto mission = c.mission;
  mission.currents.sources.clear();
  mission.currents.ensemble.reset();
  mission.currents.files = o.truth;
  auto ocean = daemon::load_ocean({mission, world.files.scratch(), c.chart->chart.has_coast(),
                                   instant_at(c.request.problem.start.fix_s), mission.start},
                                  world);
  if (!ocean) return unexpected(Trouble{2, "--truth: " + ocean.error()});
  return std::move(ocean).value();
}

/// Tells how far the flights are, as the options want it.
class Teller {
 public:
  Teller(RehearseOptions::Progress kind, std::size_t flights, std::ostream& err)
      : kind_{kind}, flights_{flights}, err_{err} {}

  void one_more() {
    ++done_;
    if (kind_ == RehearseOptions::Progress::bar) err_ << "\r" << progress_bar(done_, flights_) << std::flush;
    if (kind_ != RehearseOptions::Progress::lines || 10 * done_ / flights_ == 10 * (done_ - 1) / flights_) return;
    err_ << fmt::format("{} of {} flights ({} %)\n", done_, flights_, 100 * done_ / flights_) << std::flush;
  }
  void end() {
    if (kind_ == RehearseOptions::Progress::bar)
      err_ << "\r" << std::string(progress_bar(done_, flights_).size(), ' ') << "\r" << std::flush;
  }

 private:
  RehearseOptions::Progress kind_;
  std::size_t flights_, done_{};
  std::ostream& err_;
};

/// What makes flying pointless, before anything is flown.
std::optional<Trouble> objection(const RehearseOptions& o, const Case& c, world::Files& files) {
  for (std::size_t i = 0; i < o.delays_h.size(); ++i)
    if (std::find(o.delays_h.begin(), o.delays_h.begin() + static_cast<std::ptrdiff_t>(i), o.delays_h[i]) !=
        o.delays_h.begin() + static_cast<std::ptrdiff_t>(i))
      return Trouble{2, fmt::format("--delays: {:g} h is given twice", o.delays_h[i])};
  const auto& facts = c.ocean->forecast.facts();
  const double latest = c.request.problem.start.fix_s + 3600 * *std::max_element(o.delays_h.begin(), o.delays_h.end());
  if (facts.has_time && facts.first_s < facts.last_s && latest > facts.last_s &&
      c.mission.currents.outside_time != ocean::OutsideTime::cycle)
    return Trouble{2, fmt::format("--delays: a departure at {} lies outside the forecast, which reaches to {}",
                                  utc_text(instant_at(latest)), utc_text(instant_at(facts.last_s)))};
  if (!o.html.empty())
    if (const auto problem = why_not_new(o.html, files); !problem.empty()) return Trouble{2, "--html: " + problem};
  if (const auto wrong = planning::check_ends(c.request.problem, c.ocean->forecast.ocean(), c.chart->chart))
    return Trouble{1, wrong->message};
  return std::nullopt;
}

Rehearsal title_of(const RehearseOptions& o, const Case& c, const daemon::OceanSource& model) {
  Rehearsal all;
  all.mission = c.mission.name;
  all.method = c.mission.method;
  all.start = *c.mission.start;
  all.goal = c.mission.goal;
  all.goal_radius = c.mission.goal_radius;
  all.departure_s = c.request.problem.start.fix_s;
  all.forecast = c.ocean->label();
  all.truth = o.truth.empty()
                  ? fmt::format("the forecast shifted by {:g} km, up to {:g} h early or late, with eddies of {:g} m/s",
                                o.shift_km, o.late_h, o.noise_m_per_s)
                  : model.label();
  return all;
}

}  // namespace

int run_rehearse(const RehearseOptions& options, world::World& world, std::ostream& out, std::ostream& err) {
  const auto fail = [&](const Trouble& trouble) {
    err << "glidehelm rehearse: " << trouble.message << "\n";
    return trouble.code;
  };
  const auto c = prepare_case(options.plan, world, err);
  if (!c) return fail(c.error());
  if (const auto trouble = objection(options, *c, world.files)) return fail(*trouble);
  const auto model = model_of_truth(options, *c, world);
  if (!model) return fail(model.error());

  auto all = title_of(options, *c, **model);
  std::vector<std::string> methods{c->mission.method};
  if (methods.front() != "direct") methods.emplace_back("direct");
  Teller teller{options.progress, options.delays_h.size() * static_cast<std::size_t>(options.seeds) * methods.size(),
                err};
  for (const double delay : options.delays_h)
    for (int seed = 1; seed <= options.seeds; ++seed) {
      const double start_s = c->request.problem.start.fix_s + 3600 * delay;
      const auto number = static_cast<std::uint64_t>(seed);
      const TrueOcean truth{(*model)->forecast, error_for(options, number), start_s};
      const auto known = hindcast(*c, truth.planned(), start_s);
      for (const auto& method : methods) {
        auto setup = setup_for(*c, number, start_s, method);
        setup.end.days = (c->request.problem.horizon_s - c->request.problem.start.fix_s) / 86400;
        RehearsalFlight flight{std::move(setup), c->ocean, truth.flown(), c->chart->chart};
        flight.fly();
        auto r = result_of(flight, *c, method);
        r.seed = seed;
        r.delay_h = delay;
        r.hindcast_s = known;
        all.runs.push_back(std::move(r));
        teller.one_more();
      }
    }
  teller.end();
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
