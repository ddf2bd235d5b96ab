#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/mission/pilot.hpp"
#include "core/mission/wording.hpp"
#include "core/planning/flight.hpp"

// From a surfacing to its file: the request, the candidates, the verdicts, the emission.
namespace glidehelm::mission {

planning::Problem Pilot::problem_now() const {
  const auto& m = *mission_;
  planning::Problem p;
  p.start = {last_->fix, epoch_seconds(last_->fix_taken)};
  p.goal = planning::PointGoal{m.goal, m.goal_radius};
  p.glider.name = glider_;
  p.glider.horizontal_speed = in_use_.speed;
  p.glider.believed_speed = in_use_.believed_speed;
  p.glider.glide_angle = m.glide_angle;
  p.glider.dive_depth = m.dive_depth;
  p.glider.climb_to = m.climb_to;
  p.glider.current_correction = seen_.at.current_correction.value_or(m.current_correction);
  p.glider.heading_bias = in_use_.heading_bias;
  // The configured first stint is the first of the mission; all others are as long as they were found to be.
  const bool first = count_ == 1 && m.first_stint != m.stint;
  p.schedule = {in_use_.stint, first ? m.first_stint : in_use_.stint, in_use_.surface, in_use_.surface};
  p.believed_current = believed_;
  p.coast_margin = m.min_distance_to_coast;
  p.headings = m.headings;
  p.cell = m.cell.value_or(Metres{0});
  p.seed = m.seed;
  p.guidance = {m.heuristic, m.weighting, m.weight};
  p.lattice = m.lattice;
  p.sector_grid = m.sector_grid;
  p.objective = planning::objective_at(m.nearest_at ? std::optional{epoch_seconds(*m.nearest_at)} : std::nullopt, p);
  return p;
}

void Pilot::begin_planning() {
  ++request_;
  planned_from_ = last_->fix;
  in_use_ = learned_;
  in_use_.believed_speed = seen_.at.believed_speed.value_or(learned_.believed_speed);
  PlanningRequest request;
  request.id = request_;
  request.surfacing = key_;
  request.purpose = arrived_ ? PlanningRequest::Purpose::station : PlanningRequest::Purpose::goal;
  request.problem = problem_now();
  request.method = mission_->method;
  request.slot = mission_->slot;
  request.max_waypoints = mission_->max_waypoints;
  request.list_radius = mission_->list_radius;
  request.at_end = mission_->at_end;
  request.stamp = now_.utc;
  request.horizon_wanted = mission_->horizon.value_or(Seconds{0});
  request.correction = in_use_.correction;
  request.motion = mission_->motion;
  if (file_.in_folder()) request.queued = file_.file();
  out_.push_back(BeginPlanning{std::move(request)});
  set_timer(Timer::budget, later(first_heard_, mission_->budget));
}

void Pilot::on(const CandidateFound& e) {
  if (e.candidate.request != request_ || stage_ != Stage::planning) return;
  const auto& plan = e.candidate.plan;
  record("plan", fmt::format("candidate {} of {}: {}", e.candidate.number, plan.method,
                             plan.reaches_goal()
                                 ? "arrives " + clock_text(instant_at(plan.arrival_s))
                                 : fmt::format("comes within {:.1f} km: {}", plan.remaining.si() / 1000, plan.reason)));
  ranked_.push_back({e.candidate, Ranked::Proof::none, std::nullopt});
  ask_verdict();
}

void Pilot::on(const PlanningEnded& e) {
  if (e.request != request_ || stage_ != Stage::planning) return;
  planning_over_ = true;
  problem_ = e.problem;
  emit_if_due();
}

/// One verdict is asked at a time, for the best candidate that has none: the newest.
void Pilot::ask_verdict() {
  const auto asked = [](const Ranked& r) { return r.proof == Ranked::Proof::asked; };
  if (std::any_of(ranked_.begin(), ranked_.end(), asked)) return;
  for (auto r = ranked_.rbegin(); r != ranked_.rend(); ++r) {
    if (r->proof == Ranked::Proof::accepted) return;  // a better one is proven already
    if (r->proof != Ranked::Proof::none) continue;
    r->proof = Ranked::Proof::asked;
    out_.push_back(Verify{request_, r->candidate.number, dossier_for(r->candidate)});
    return;
  }
}

namespace {
/// The tail is flown with two standard deviations of what is learned, where that is more than the rule's usual share.
void widen_tail(safety::Rules& rules, const Learned& known) {
  const double stint = known.stint_spread / known.stint, speed = known.speed_spread.si() / known.speed.si();
  rules.tail_stint = std::clamp(2 * stint, rules.tail_stint, 0.25);
  rules.tail_slower = std::clamp(2 * speed, rules.tail_slower, 0.4);
  rules.tail_faster = std::clamp(2 * speed, rules.tail_faster, 0.3);
}
}  // namespace

safety::Dossier Pilot::dossier_for(const Candidate& c) const {
  const auto problem = problem_now();
  safety::Dossier d;
  d.file_name = c.file_name;
  d.file_bytes = c.file_bytes;
  d.glider_expected = glider_;
  d.at = *last_;
  d.current_surfacing = key_;
  d.answers_surfacing = key_;
  d.glider = problem.glider;
  d.believed_current = believed_;
  d.schedule = problem.schedule;
  d.correction = in_use_.correction;
  d.fix_s = problem.start.fix_s;
  d.horizon_s = c.horizon_s;
  d.rules.coast_margin = mission_->min_distance_to_coast;
  d.rules.max_waypoints = mission_->max_waypoints;
  d.rules.slot = mission_->slot;
  d.rules.max_wpt_distance = mission_->max_wpt_distance;
  widen_tail(d.rules, in_use_);
  d.promise = c.promise;
  d.judged_s = epoch_seconds(now_.utc);
  d.deadline_s = d.judged_s + Seconds{deadline_ - now_.tick}.count();
  return d;
}

void Pilot::on(const Judged& e) {
  if (e.request != request_ || stage_ != Stage::planning) return;
  const auto ranked =
      std::find_if(ranked_.begin(), ranked_.end(), [&](const Ranked& r) { return r.candidate.number == e.number; });
  if (ranked == ranked_.end()) return;
  ranked->proof = Ranked::Proof::refused;
  if (e.verdict) {
    auto file = safety::accept(ranked->candidate.file_name, ranked->candidate.file_bytes, *e.verdict);
    if (file) {
      ranked->proof = Ranked::Proof::accepted;
      ranked->file = std::move(file).value();
    }
  }
  if (ranked->proof == Ranked::Proof::accepted) {
    record("verdict", fmt::format("candidate {} of {} accepted", e.number, ranked->candidate.plan.method));
  } else {
    std::string why = e.verdict ? "" : "no verdict: " + e.failure;
    if (e.verdict)
      for (const auto& margin : e.verdict->margins)
        if (!margin.holds) why += (why.empty() ? "" : "; ") + margin.rule + ": " + margin.message;
    if (why.empty()) why = "the verdict is for other bytes";
    record("verdict", fmt::format("candidate {} of {} refused: {}", e.number, ranked->candidate.plan.method, why));
    if (is_queued_file(ranked->candidate)) {
      say(Level::note, "still-queued", "the file that still lies in to-glider is not safe from here: " + why);
    } else {
      problem_ = why;
      say(Level::alert, "refused-file",
          fmt::format("the verifier refuses the {} plan: {}", ranked->candidate.plan.method, why));
    }
  }
  ask_verdict();
  emit_if_due();
}

Pilot::Ranked* Pilot::best_proven() {
  for (auto r = ranked_.rbegin(); r != ranked_.rend(); ++r)  // a queued file that was taken meanwhile is no choice
    if (r->proof == Ranked::Proof::accepted && (!is_queued_file(r->candidate) || file_.in_folder())) return &*r;
  return nullptr;
}

/// Why a proven file may not go out (yet); nothing when it may.
std::optional<std::string> Pilot::reason_to_hold() const {
  if (skew_) return *skew_;
  if (mission_->emit_on_connection) return std::nullopt;
  if (!at_surface_seen_) return "the at-surface block has not named the running mission";
  if (!mission_named_)
    return fmt::format("the glider runs mission {}, configured is {}", wrong_mission_, mission_->slocum_mission);
  return std::nullopt;
}

/// Emits at the earliest of: nothing better left to try, the budget is over, 30 s before the deadline (product.md 4.6).
void Pilot::emit_if_due() {
  if (stage_ != Stage::planning && stage_ != Stage::proposed) return;
  const bool last_call = now_.tick >= later(deadline_, -kEmitBeforeDeadline);
  const bool asked =
      std::any_of(ranked_.begin(), ranked_.end(), [](const Ranked& r) { return r.proof == Ranked::Proof::asked; });
  const bool nothing_better = planning_over_ && !asked;
  if (!nothing_better && !budget_over_ && !last_call) return;
  Ranked* best = best_proven();
  if (best == nullptr) {
    if (nothing_better)
      keep("no-plan", problem_.empty() ? "no plan was found" : problem_);
    else if (last_call)
      keep("late", "no proven file was ready 30 s before the glider dives");
    return;
  }
  if (const auto hold = reason_to_hold()) {
    if (last_call) keep("held", *hold);
    return;
  }
  if (stage_ == Stage::proposed) return;
  if (is_queued_file(best->candidate)) {
    keep_queued_file();
    return;
  }
  const auto& plan = best->candidate.plan;
  const std::string arrival =
      arrived_ ? "holding at the goal"
      : plan.reaches_goal()
          ? fmt::format("arrives {} ({} from the fix)", clock_text(instant_at(plan.arrival_s)),
                        hours(Seconds{plan.arrival_s - epoch_seconds(last_->fix_taken)}))
          : fmt::format("comes within {:.1f} km of the goal: {}", plan.remaining.si() / 1000, plan.reason);
  if (mission_->approval == Approval::manual || (mission_->approval == Approval::auto_if_safe && alerted_)) {
    stage_ = Stage::proposed;
    record("proposal", fmt::format("{} by {}, {}", best->candidate.file_name, plan.method, arrival));
    say(Level::note, "proposed",
        fmt::format("proposal: {} by {}, {}; {}, nothing is emitted", best->candidate.file_name, plan.method, arrival,
                    alerted_ && mission_->approval == Approval::auto_if_safe
                        ? "approval.mode is auto-if-safe and there was an alert"
                        : "approval.mode is manual"));
    return;
  }
  stage_ = Stage::emitting;
  say(Level::info, "plan",
      fmt::format("plan by {}: {}, next surfacing expected {} at {}, {:.0f} s left in the window", plan.method, arrival,
                  clock_text(after(last_->fix_taken, learned_.surface + learned_.stint)),
                  place(best->candidate.promise.next_surfacing), Seconds{deadline_ - now_.tick}.count()));
  emitting_ = QueuedFile{key_, best->candidate.file_name, best->candidate.file_bytes, best->candidate.list};
  out_.push_back(Emit{*best->file, key_, fmt::format("{}#{}", key_, request_), deadline_, replacing_});
}

void Pilot::on(const EmissionEnded& e) {
  if (e.surfacing != key_ || stage_ != Stage::emitting) return;
  record("emission", e.detail);
  using Outcome = EmissionEnded::Outcome;
  switch (e.outcome) {
    case Outcome::queued:
      stage_ = Stage::queued;
      say(Level::info, "queued", e.detail);
      note_exchange();
      expect_next();
      return;
    case Outcome::foreign_file:
      stage_ = Stage::stood_down;
      say(Level::alert, "foreign-file", "standing down for this surfacing: " + e.detail);
      return;
    case Outcome::late:
      keep("late", e.detail);
      return;
    case Outcome::aborted:
      keep("emission", e.detail);
      return;
    case Outcome::unknown:
      stage_ = Stage::kept;
      say(Level::page, "emission", "it is not known whether the file went out: " + e.detail);
      return;
  }
}

/// Nothing is emitted for this surfacing. The glider restarts its list at w_1, and the operator hears why.
void Pilot::keep(const std::string& code, const std::string& why) {
  stage_ = Stage::kept;
  record("keep", why);
  say(Level::alert, code,
      fmt::format("nothing is emitted: {}. The glider keeps its list and starts it again at its first waypoint", why));
  warn_of_queued_file();
  expect_next();
}

}  // namespace glidehelm::mission
