#include "simulator/simulation.hpp"

#include <algorithm>
#include <cmath>

namespace glidehelm::simulator {
namespace {

Instant rounded_up(double t_s) {
  return Instant{std::chrono::milliseconds{static_cast<std::int64_t>(std::ceil(t_s * 1e3 - 1e-3))}};
}

}  // namespace

const char* word(RunEnd end) {
  switch (end) {
    case RunEnd::running:
      return "running";
    case RunEnd::arrived:
      return "arrived";
    case RunEnd::accident:
      return "accident";
    case RunEnd::behaviour_error:
      return "behaviour_error";
    case RunEnd::mission_over:
      return "mission_over";
    case RunEnd::surfacings:
      return "surfacings";
    case RunEnd::days:
      return "days";
  }
  return "";
}

/// One glider's life: under water (no call) or on the surface (a call).
struct Simulation::Life {
  Life(std::size_t which, Member member, ocean::Ocean truth, const chart::Chart& chart, Random random)
      : index{which},
        plan{std::move(member.plan)},
        folder{member.folder},
        glider{plan.setup, truth, chart},
        faults{random} {
    result.started_s = plan.setup.start_s;
    glider.watch(plan.goal, plan.goal_radius);
  }

  [[nodiscard]] bool running() const { return result.end == RunEnd::running; }
  [[nodiscard]] double next_s() const { return call ? call->next_s().value_or(call->dive_s()) : glider.surfaced_s(); }

  bool strikes(const FaultPlan& fault) {
    const bool by_chance = faults.uniform() < fault.probability;  // always drawn: one fault never shifts another's luck
    return by_chance ||
           std::find(fault.surfacings.begin(), fault.surfacings.end(), result.surfacings) != fault.surfacings.end();
  }

  void finish(RunEnd end, std::string reason, double now_s) {
    result.end = end;
    result.reason = std::move(reason);
    result.ended_s = now_s;
    result.arrived_s = glider.arrived_s();
    result.closest = glider.closest();
  }

  void surface() {
    if (auto accident = glider.take_fixes()) return finish(RunEnd::accident, accident->message(), accident->t_s);
    ++result.surfacings;
    CallFaults f;
    f.lost = strikes(plan.lost_calls);
    f.not_taken = strikes(plan.not_taken);
    f.no_connection_block = strikes(plan.no_connection_block);
    f.redial = strikes(plan.redial);
    call.emplace(plan.call, f, glider, *folder, on_board);
  }

  void close_call(double now_s) {
    SurfacingRecord r;
    r.glider = index;
    r.number = result.surfacings;
    r.surfaced_s = glider.surfaced_s();
    r.fix_s = glider.fix_s();
    r.dive_s = now_s;
    r.fix = glider.fix();
    r.water = glider.water();
    r.to_goal = distance(r.fix, plan.goal);
    r.target = glider.navigator().target();
    r.faults = call->faults();
    r.call = call->outcome();
    if (r.call.list) ++result.lists_taken;
    if (r.call.error) ++result.behaviour_errors;
    surfacings.push_back(std::move(r));
    call.reset();
  }

  void leave_surface(const EndPlan& end) {
    const double now_s = call->dive_s();
    const auto error = call->outcome().error;
    close_call(now_s);
    const double surfaced = glider.surfaced_s();
    if (error) return finish(RunEnd::behaviour_error, "bad goto list after Ctrl-F, " + error->message(), now_s);
    if (end.at_goal && glider.arrived_s() && *glider.arrived_s() <= surfaced + plan.setup.times.last_fix)
      return finish(RunEnd::arrived, "inside the goal radius", now_s);
    if (glider.mission_over()) return finish(RunEnd::mission_over, "the goto list ended with end_action 0", now_s);
    if (end.surfacings && result.surfacings >= *end.surfacings)
      return finish(RunEnd::surfacings, "the scenario's number of surfacings", now_s);
    if (end.days && now_s - result.started_s >= *end.days * 86400.0)
      return finish(RunEnd::days, "the scenario's number of days", now_s);
    dives.push_back(glider.dive(now_s));
    if (const auto& accident = dives.back().accident) finish(RunEnd::accident, accident->message(), accident->t_s);
  }

  std::size_t index;
  GliderPlan plan;
  ToGlider* folder;
  Glider glider;
  Random faults;
  std::string on_board;
  std::optional<Call> call;
  std::vector<SurfacingRecord> surfacings;
  std::vector<DiveRecord> dives;
  GliderResult result;
};

Simulation::Simulation(std::vector<Member> members, ocean::Ocean truth, const chart::Chart& chart, EndPlan end,
                       std::uint64_t seed)
    : end_{end} {
  const Random random{seed};
  for (std::size_t i = 0; i < members.size(); ++i)
    lives_.push_back(std::make_unique<Life>(i, std::move(members[i]), truth, chart, random.stream(1000 + i)));
}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

std::optional<std::size_t> Simulation::next_glider() const {
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < lives_.size(); ++i)
    if (lives_[i]->running() && (!first || lives_[i]->next_s() < lives_[*first]->next_s())) first = i;
  return first;
}

std::optional<Instant> Simulation::next_event() const {
  const auto i = next_glider();
  if (!i) return std::nullopt;
  return rounded_up(lives_[*i]->next_s());
}

std::vector<LineOutput> Simulation::step() {
  const auto i = next_glider();
  if (!i) return {};
  auto& life = *lives_[*i];
  std::vector<LineOutput> out;
  if (!life.call) {
    life.surface();
  } else if (life.call->next_s()) {
    for (auto& event : life.call->step()) out.push_back({*i, std::move(event)});
    if (life.call->outcome().error) life.leave_surface(end_);
  } else {
    life.leave_surface(end_);
  }
  return out;
}

std::size_t Simulation::count() const { return lives_.size(); }
const Glider& Simulation::glider(std::size_t i) const { return lives_[i]->glider; }
const GliderPlan& Simulation::plan(std::size_t i) const { return lives_[i]->plan; }
const std::vector<SurfacingRecord>& Simulation::surfacings(std::size_t i) const { return lives_[i]->surfacings; }
const std::vector<DiveRecord>& Simulation::dives(std::size_t i) const { return lives_[i]->dives; }
const GliderResult& Simulation::result(std::size_t i) const { return lives_[i]->result; }
bool Simulation::all_arrived() const {
  return std::all_of(lives_.begin(), lives_.end(),
                     [](const auto& l) { return l->result.arrived_s && l->result.end != RunEnd::accident; });
}

}  // namespace glidehelm::simulator
