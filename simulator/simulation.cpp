#include "simulator/simulation.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <deque>

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
    case RunEnd::aborted:
      return "aborted";
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
        faults{random},
        line_faults{random.stream(1)},
        noise{plan.line.setup, random.stream(2)} {
    result.started_s = plan.setup.start_s;
    glider.watch(plan.goal, plan.goal_radius);
  }

  [[nodiscard]] bool running() const { return result.end == RunEnd::running; }
  [[nodiscard]] double event_s() const { return call ? call->next_s().value_or(call->dive_s()) : glider.surfaced_s(); }
  [[nodiscard]] double next_s() const { return on_way.empty() ? event_s() : std::min(event_s(), on_way.front().at_s); }

  bool strikes(const FaultPlan& fault) { return strikes(fault, faults); }
  bool strikes(const FaultPlan& fault, Random& random) {
    const bool by_chance = random.uniform() < fault.probability;  // always drawn: one fault never shifts another's luck
    return by_chance ||
           std::find(fault.surfacings.begin(), fault.surfacings.end(), result.surfacings) != fault.surfacings.end();
  }

  void finish(RunEnd end, std::string reason, double now_s) {
    result.end = end;
    result.reason = std::move(reason);
    result.ended_s = now_s;
    result.arrived_s = glider.arrived_s();
    result.closest = glider.closest();
    result.energy = glider.energy();
  }

  void surface() {
    if (auto accident = glider.take_fixes()) return finish(RunEnd::accident, accident->message(), accident->t_s);
    ++result.surfacings;
    CallFaults f;
    f.lost = strikes(plan.lost_calls);
    f.not_taken = strikes(plan.not_taken);
    f.no_connection_block = strikes(plan.no_connection_block);
    f.redial = strikes(plan.redial);
    draw_line_faults(f);
    told = {};
    call.emplace(plan.call, f, glider, *folder, on_board);
  }

  void draw_line_faults(CallFaults& f) {
    const auto& p = plan.line;
    auto& r = line_faults;
    f.cut = strikes(p.cut, r);
    f.half_open = strikes(p.half_open, r);
    f.call_back = strikes(p.call_back, r);
    f.late_script = strikes(p.late_script, r);
    f.transfer_cut = strikes(p.transfer_cut, r);
    f.science_files = strikes(p.science_files, r);
    f.wrong_keys = strikes(p.wrong_keys, r);
    f.chatter = strikes(p.chatter, r);
    f.garbled = strikes(p.garbled, r);
    f.injected = strikes(p.injected, r);
    f.injected_lossily = strikes(p.injected_lossily, r);
    f.duplicated = strikes(p.duplicated, r);
    f.slow = strikes(p.slow, r);
    f.at = r.uniform();
    f.how = r.uniform();
  }

  /// What the call said at `now_s` goes out on the line: spoilt, and on a slow line spread over time.
  void send(double now_s, LineEvent event) {
    const auto& f = call->faults();
    if (event.kind == LineEvent::Kind::bytes) event.bytes = noise.spoil(std::move(event.bytes), f);
    double at_s = std::max(now_s, on_way.empty() ? 0.0 : on_way.back().at_s);
    if (event.kind != LineEvent::Kind::bytes || !f.slow) return on_way.push_back({at_s, std::move(event)});
    constexpr double kPieceSeconds = 5;
    const auto piece = static_cast<std::size_t>(std::max(1.0, plan.line.setup.slow_bytes_per_s * kPieceSeconds));
    for (std::size_t from = 0; from < event.bytes.size(); from += piece, at_s += kPieceSeconds)
      on_way.push_back({at_s, {LineEvent::Kind::bytes, event.bytes.substr(from, piece)}});
  }

  /// What comes out at the other end until `now_s`.
  void deliver(double now_s, std::vector<LineOutput>& out) {
    while (!on_way.empty() && on_way.front().at_s <= now_s) {
      auto& event = on_way.front().event;
      if (event.kind == LineEvent::Kind::bytes) {
        if (told.bytes.empty()) {
          told.opened_s = now_s;
          ++told.connections;
        }
        told.bytes += event.bytes;
        told.count += event.bytes.size();
      } else {
        close_log();
      }
      const bool fell = event.kind != LineEvent::Kind::bytes;
      out.push_back({index, std::move(event)});
      on_way.pop_front();
      if (fell) return;  // what follows goes on a new connection, in a step of its own
    }
  }

  /// The log of a connection as a dockserver keeps it, and what of it was whole.
  void close_log() {
    if (told.bytes.empty()) return;
    told.whole_fixes += whole_fix_lines(told.bytes);
    folder->logged({plan.setup.name, plan.call.firmware == Firmware::g1 ? "modem" : "network_net_0",
                    instant_at(told.opened_s), std::move(told.bytes)});
    told.bytes.clear();
  }

  [[nodiscard]] int whole_fix_lines(const std::string& bytes) const {
    const auto fix = dialog::location_line("GPS Location:", dialog::ddmm(glider.fix().lat.degrees(), 3),
                                           dialog::ddmm(glider.fix().lon.degrees(), 3), 0.0);
    const auto head = fix.substr(0, fix.find(" measured"));
    int count = 0;
    for (auto at = bytes.find(head); at != std::string::npos; at = bytes.find(head, at + 1)) {
      const auto end = bytes.find('\n', at);
      const auto line = bytes.substr(at, end == std::string::npos ? end : end - at);
      double age = 0;
      int used = 0;
      const bool glued = at > 0 && std::isalpha(static_cast<unsigned char>(bytes[at - 1])) != 0;
      // A line that lost or gained a byte is not whole, though it may read like one.
      if (!glued && end != std::string::npos && line.size() + 1 == fix.size() &&
          std::sscanf(line.c_str() + head.size(), " measured %lf secs ago%n", &age, &used) == 1 &&
          head.size() + static_cast<std::size_t>(used) + 1 == line.size())
        ++count;
    }
    return count;
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
    on_way.clear();
    close_log();
    r.bytes = told.count;
    r.whole_fixes = told.whole_fixes;
    r.connections = told.connections;
    r.because = glider.because();
    r.fix_is_fresh = glider.fix_is_fresh();
    if (!dives.empty()) r.energy = dives.back().energy;
    if (!r.faults.lost) {
      const double from = glider.fixes_done_s() + plan.call.call_after;
      glider.called(from, std::max(0.0, now_s - plan.setup.times.post_fix - from));
    }
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
    if (error) {
      if (plan.setup.aborts.fallback_calls == 0)
        return finish(RunEnd::behaviour_error, "bad goto list after Ctrl-F, " + error->message(), now_s);
      glider.abort_by_behaviour_error(*error, now_s);
    }
    if (end.at_goal && glider.arrived_s() && *glider.arrived_s() <= surfaced + plan.setup.times.last_fix)
      return finish(RunEnd::arrived, "inside the goal radius", now_s);
    if (glider.fallback_is_over()) return finish(RunEnd::aborted, glider.abort()->message(), now_s);
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
  Random faults, line_faults;
  LineNoise noise;
  struct OnWay {
    double at_s{};
    LineEvent event;
  };
  std::deque<OnWay> on_way;
  struct Told {
    std::string bytes;  ///< of the connection that is open
    double opened_s{};
    std::uint64_t count{};
    int whole_fixes{}, connections{};
  } told;
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
  const double now_s = life.next_s();
  if (life.event_s() > now_s) {
    life.deliver(now_s, out);
  } else if (!life.call) {
    life.surface();
  } else if (life.call->next_s()) {
    for (auto& event : life.call->step()) life.send(now_s, std::move(event));
    life.deliver(now_s, out);
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
