#include "core/mission/pilot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "core/mission/wording.hpp"
#include "core/planning/flight.hpp"

namespace glidehelm::mission {

namespace {

constexpr std::size_t kRemembered = 16;         // fixes kept for recognising repeats
constexpr double kStrongestCurrent = 2.5;       // m/s, for the jump limit: Gulf Stream with a margin
constexpr double kMoveForReplacement = 1000.0;  // m, product.md 4.2
constexpr double kWaterChange = 0.005;          // m/s: 70 m over a stint of 4 h
constexpr double kInlandRefused = 500.0;        // m, product.md 4.2
constexpr Seconds kSkewHeld{300};               // product.md 4, Clocks
constexpr Seconds kSecondFixApart{60};          // trust.md I-5

}  // namespace

std::string_view word(Stage stage) {
  switch (stage) {
    case Stage::idle:
      return "none yet";
    case Stage::planning:
      return "being planned";
    case Stage::proposed:
      return "proposed, waiting for a human";
    case Stage::emitting:
      return "its file was being written";
    case Stage::queued:
      return "its file is queued";
    case Stage::kept:
      return "no file, the glider keeps its list";
    case Stage::stood_down:
      return "left to a human";
    case Stage::dived:
      return "under water";
  }
  return "?";
}

Pilot::Pilot(std::string glider) : glider_{std::move(glider)} { set_mission(std::nullopt); }

Effects Pilot::step(const Event& event) {
  now_ = event.now;
  out_.clear();
  std::visit([this](const auto& what) { on(what); }, event.what);
  return std::move(out_);
}

bool Pilot::awaits_answer() const {
  if (stage_ == Stage::emitting) return true;
  if (stage_ != Stage::planning) return false;
  if (!planning_over_) return true;
  return std::any_of(ranked_.begin(), ranked_.end(), [](const Ranked& r) { return r.proof == Ranked::Proof::asked; });
}

// ---- accepting a fix ------------------------------------------------------------------------------------------------

void Pilot::on(const SurfacingHeard& e) {
  const auto& s = e.surfacing;
  if (is_duplicate(s)) {
    take_repeat(s);
    return;
  }
  if (auto refusal = objection(e)) {
    on(FixRefused{*refusal});
    return;
  }
  if (stage_ != Stage::idle && is_same_surfacing(s)) {
    take_later_fix(s);
  } else {
    open_surfacing(e);
  }
}

void Pilot::on(const FixRefused& e) {
  const auto& r = e.refusal;
  if (refused_ && refused_->rule == r.rule && refused_->lat_ddmm == r.lat_ddmm && refused_->lon_ddmm == r.lon_ddmm) {
    record("duplicate", "refused fix heard again (" + r.rule + ")");
    return;
  }
  refused_ = r;
  record("refusal", r.rule + ": " + r.reason);
  say(Level::note, "refused-fix", fmt::format("fix refused ({}): {}", r.rule, r.reason));
}

bool Pilot::is_duplicate(const model::Surfacing& s) const {
  return std::any_of(recent_.begin(), recent_.end(), [&](const model::Surfacing& r) { return model::same_fix(r, s); });
}

/// A surfacing is one mission segment when the segment is printed, else all fixes without submerged time between them.
bool Pilot::is_same_surfacing(const model::Surfacing& s) const {
  if (!last_) return false;
  if (!s.segment.empty() && !segment_.empty()) return s.segment == segment_;
  if (dived_at_ && s.fix_taken > *dived_at_) return false;
  const Seconds window = mission_ ? mission_->window_max : Seconds{900};
  return between(last_->fix_taken, s.fix_taken) <= window;
}

std::optional<model::Refusal> Pilot::objection(const SurfacingHeard& e) {
  const auto& s = e.surfacing;
  const auto refuse = [&](std::string rule, std::string reason) {
    return model::Refusal{std::move(rule), std::move(reason), s.glider, s.heard, s.lat_ddmm, s.lon_ddmm};
  };
  if (!equal_without_case(s.glider, glider_))
    return refuse("S2", fmt::format("the dialog is of glider {}, this line is configured for {}", s.glider, glider_));
  if (last_ && s.fix_taken <= last_->fix_taken)
    return refuse("S6", fmt::format("the fix of {} is not newer than the last accepted one of {}",
                                    clock_text(s.fix_taken), clock_text(last_->fix_taken)));
  if (dived_at_ && s.fix_taken < *dived_at_)
    return refuse("S6", fmt::format("the fix of {} is from before the dive at {}", clock_text(s.fix_taken),
                                    clock_text(*dived_at_)));
  if (e.coast_distance && e.coast_distance->si() < -kInlandRefused)
    return refuse("S5", fmt::format("the fix {} lies {:.1f} km inside the coastline; allowed is 0.5 km", place(s.fix),
                                    -e.coast_distance->si() / 1000));
  return jump(s);
}

/// S5: no fix farther away than physics allows, unless a second fix, at least a minute later, agrees with the first.
std::optional<model::Refusal> Pilot::jump(const model::Surfacing& s) {
  if (!last_) return std::nullopt;
  const double speed = 1.2 * ((mission_ ? mission_->horizontal_speed.si() : 0.5) + kStrongestCurrent);
  const auto reach = [&](const model::Surfacing& from) {
    return speed * between(from.fix_taken, s.fix_taken).count() + 1000.0;
  };
  const double moved = distance(last_->fix, s.fix).si();
  if (moved <= reach(*last_)) {
    quarantined_.reset();
    return std::nullopt;
  }
  if (quarantined_ && between(quarantined_->fix_taken, s.fix_taken) >= kSecondFixApart &&
      distance(quarantined_->fix, s.fix).si() <= reach(*quarantined_)) {
    say(Level::clear, "jump",
        fmt::format("a second fix at {} confirms the jump of {:.0f} km", place(s.fix), moved / 1000));
    quarantined_.reset();
    return std::nullopt;
  }
  quarantined_ = s;
  return model::Refusal{
      "S5",
      fmt::format("the fix {} is {:.1f} km from the last one ({} earlier); at most {:.1f} km are possible. "
                  "It is taken when a second fix at least a minute later agrees",
                  place(s.fix), moved / 1000, hours(between(last_->fix_taken, s.fix_taken)), reach(*last_) / 1000),
      s.glider,
      s.heard,
      s.lat_ddmm,
      s.lon_ddmm};
}

/// The same fix printed again changes nothing but what the block says beside it: mission, window, water velocity.
void Pilot::take_repeat(const model::Surfacing& s) {
  if (stage_ == Stage::idle || !last_ || !model::same_fix(*last_, s)) {
    record("duplicate", fmt::format("fix of {} heard again", clock_text(s.fix_taken)));
    return;
  }
  if (stage_ == Stage::dived) {
    record("duplicate", fmt::format("fix of {} heard again after the dive", clock_text(s.fix_taken)));
    return;
  }
  note_dialog(s);
  if (!plan_again_for_water(s)) emit_if_due();
}

/// The connection block may still print the initial current; the glider dives with the final one of the at-surface
/// block. A plan for another current is aimed wrong by the difference times the stint.
bool Pilot::plan_again_for_water(const model::Surfacing& s) {
  const auto water = believed_current(s, learned_.rotation.clockwise);
  if (!water || stage_ != Stage::planning || !mission_) return false;
  const double change =
      believed_ ? std::hypot(water->east.si() - believed_->east.si(), water->north.si() - believed_->north.si())
                : water->speed().si();
  if (change < kWaterChange) return false;
  believed_ = water;
  last_->water = s.water;
  last_->water_is_final = s.water_is_final;
  say(Level::info, "water",
      fmt::format("the measured current became {:.2f} m/s towards {:03.0f} deg: planning again", water->speed().si(),
                  Course::of(water->east.si(), water->north.si()).degrees()));
  plan_again();
  return true;
}

void Pilot::plan_again() {
  if (stage_ == Stage::planning && !planning_over_) out_.push_back(StopPlanning{request_});
  budget_over_ = planning_over_ = false;
  ranked_.clear();
  problem_.clear();
  stage_ = Stage::planning;
  begin_planning();
}

void Pilot::remember(const model::Surfacing& s) {
  last_ = s;
  recent_.push_back(s);
  if (recent_.size() > kRemembered) recent_.pop_front();
}

/// What a block says beside the fix. A value once known is not lost when a later block leaves it out.
void Pilot::note_dialog(const model::Surfacing& s) {
  learn_more(s);
  hear_waypoint(s);
  if (!s.segment.empty()) segment_ = s.segment;
  if (s.at_surface) {
    at_surface_seen_ = true;
    const bool named =
        mission_ && (mission_->slocum_mission.empty() || equal_without_case(mission_->slocum_mission, s.mission));
    mission_named_ = named;
    wrong_mission_ = named ? "" : s.mission;
  }
  if (s.until_diving) set_deadline(later(now_.tick, *s.until_diving));
}

void Pilot::open_surfacing(const SurfacingHeard& e) {
  const auto& s = e.surfacing;
  if (change_) take_over(*std::exchange(change_, std::nullopt));
  if (water_waits_) take_water(*std::exchange(water_waits_, std::nullopt));
  if (request_ != 0 && stage_ == Stage::planning) out_.push_back(StopPlanning{request_});
  begin_learning(e);
  key_ = fmt::format("{}/{}", glider_, clock_text(s.fix_taken));
  segment_.clear();
  dived_at_.reset();
  ++count_;
  at_surface_seen_ = mission_named_ = budget_over_ = planning_over_ = transfer_began_ = replacing_ = alerted_ = false;
  waypoint_told_ = false;
  file_.call_ended();
  wrong_mission_.clear();
  ranked_.clear();
  problem_.clear();
  planned_from_.reset();
  first_heard_ = now_.tick;
  deadline_ = Tick{};
  failure_told_ = false;
  far_off_.reset();
  if (std::exchange(late_said_, false)) say(Level::clear, "late", "the glider called: all clear");

  believed_ = believed_current(s, learned_.rotation.clockwise);
  const Seconds skew{std::abs(static_cast<double>(
      (s.curr_time.time_since_epoch() - std::chrono::floor<std::chrono::seconds>(s.heard.time_since_epoch()))
          .count()))};
  skew_.reset();
  if (skew > kSkewHeld && !skew_ok_)
    skew_ = fmt::format(
        "the glider's clock differs from ours by {:.0f} s; allowed are 300 s (clock_skew_ok: true accepts it)",
        skew.count());
  greet(s);
  remember(s);
  expected_.reset();
  watch_for_call();
  record("surfacing", fmt::format("accepted fix {} taken {}", place(s.fix), clock_text(s.fix_taken)));
  set_deadline(later(now_.tick, mission_ ? mission_->window_max : Seconds{900}));
  note_dialog(s);
  tell_learned();
  stage_ = Stage::planning;
  out_.push_back(InspectFolder{});
  if (file_.in_folder())
    tell_file("still-queued",
              fmt::format("{} of the surfacing {} still lies in to-glider: it missed its call and is judged again",
                          file_.file()->name, file_.file()->surfacing),
              Level::note);
  if (!mission_) {
    keep("no-mission", "no mission is configured for this glider");
    return;
  }
  if (skew_) say(Level::alert, "clock", *skew_ + ": planning, but nothing is emitted");
  begin_planning();
}

/// A later fix of the same surfacing updates the state; our queued file is exchanged only when the glider has moved on.
void Pilot::take_later_fix(const model::Surfacing& s) {
  const auto moved_from = planned_from_.value_or(s.fix);
  const double moved = distance(moved_from, s.fix).si();
  remember(s);
  record("surfacing",
         fmt::format("later fix {} taken {}, {:.0f} m from the first", place(s.fix), clock_text(s.fix_taken), moved));
  if (stage_ == Stage::dived) return;
  note_dialog(s);
  if (moved <= kMoveForReplacement || transfer_began_ || stage_ != Stage::queued || file_.state() != Delivery::queued) {
    emit_if_due();
    return;
  }
  say(Level::info, "later-fix",
      fmt::format("the glider drifted {:.1f} km since the plan was made: planning again", moved / 1000));
  replacing_ = true;
  plan_again();
}

/// Inside the goal radius the mission has arrived; `after_goal` hands over at once, as often as the glider is there already.
void Pilot::arrive_if_there(const model::Surfacing& s) {
  while (mission_ && !arrived_ && distance(s.fix, mission_->goal) <= mission_->goal_radius) {
    say(Level::info, "arrived",
        fmt::format("mission {} arrived: {:.1f} km from the goal", mission_->name,
                    distance(s.fix, mission_->goal).si() / 1000));
    if (chain_.size() < 2) {
      arrived_ = true;
      return;
    }
    chain_.erase(chain_.begin());
    set_mission(chain_.front().mission);
    record("mission", fmt::format("{} takes over", mission_->name));
    say(Level::info, "mission", fmt::format("mission {} takes over: goal {}", mission_->name, place(mission_->goal)));
  }
}

// ---- the window -----------------------------------------------------------------------------------------------------

void Pilot::set_deadline(Tick deadline) {
  const Seconds cap = mission_ ? mission_->window_max : Seconds{900};
  deadline_ = std::min(deadline, later(first_heard_, cap));
  deadline_utc_ = now_.utc + std::chrono::duration_cast<Instant::duration>(deadline_ - now_.tick);
  set_timer(Timer::deadline, later(deadline_, -kEmitBeforeDeadline));
}

void Pilot::on(const WindowHeard& e) {
  if (stage_ == Stage::idle || stage_ == Stage::dived) return;
  set_deadline(later(now_.tick, e.until_diving));
}

void Pilot::on(const WindowExtended& e) {
  if (stage_ == Stage::idle || stage_ == Stage::dived) return;
  set_deadline(later(deadline_, e.by));
  say(Level::info, "window", fmt::format("somebody extended the window by {:.0f} s", e.by.count()));
}

void Pilot::on(const DiveBegan&) {
  if (stage_ == Stage::idle || stage_ == Stage::dived) return;
  dived_at_ = now_.utc;
  if (stage_ == Stage::planning || stage_ == Stage::proposed) keep("dived", "the glider dived before a file was ready");
  if (request_ != 0) out_.push_back(StopPlanning{request_});
  cancel_timer(Timer::deadline);
  cancel_timer(Timer::budget);
  stage_ = Stage::dived;
  say(Level::info, "dived", "the glider goes under");
}

// ---- steering the pilot ---------------------------------------------------------------------------------------------

void Pilot::on(const MissionChanged& e) {
  if (!change_ && e.chain == chain_ && e.clock_skew_ok == skew_ok_) return;
  if (change_ && e.chain == change_->chain && e.clock_skew_ok == change_->clock_skew_ok) return;
  const bool at_once = !mission_ || stage_ == Stage::idle;
  for (const auto& text : e.chain) {
    const auto& m = text.mission;
    record("mission", fmt::format("{} ({}) by {}", m.name, text.sha256.substr(0, 12), e.by));
    say(Level::info, "mission",
        fmt::format("mission {}: goal {}, {:.1f} km radius, {} h stints, method {}, approval {}{}", m.name,
                    place(m.goal), m.goal_radius.si() / 1000, m.stint.count() / 3600, m.method,
                    m.approval == Approval::manual      ? "manual"
                    : m.approval == Approval::automatic ? "auto"
                                                        : "auto-if-safe",
                    at_once ? "" : "; in force at the next surfacing"));
  }
  if (e.chain.empty())
    say(Level::note, "mission", "no mission is configured any more; at the next surfacing nothing is planned");
  if (at_once)
    take_over(e);
  else
    change_ = e;
}

void Pilot::take_over(const MissionChanged& change) {
  chain_ = change.chain;
  set_mission(chain_.empty() ? std::nullopt : std::optional{chain_.front().mission});
  skew_ok_ = change.clock_skew_ok;
  arrived_ = false;
}

/// After a crash: what was under way is settled. A plan is never finished from the journal; a new one is made while the
/// window is open (trust.md 6.2).
void Pilot::on(const Restarted& e) {
  if (!last_ || stage_ == Stage::idle) return;
  watch_for_call();  // ticks of before the restart may be of another boot
  if (stage_ == Stage::dived) return;
  // Ticks of before the restart may be of another boot: the deadline is rebuilt from UTC.
  const Seconds cap = mission_ ? mission_->window_max : Seconds{900};
  first_heard_ = later(now_.tick, -between(last_->heard, now_.utc));
  deadline_ = std::min(later(now_.tick, between(now_.utc, deadline_utc_)), later(first_heard_, cap));
  if (e.emission && e.emission->surfacing == key_ && e.emission->outcome != EmissionEnded::Outcome::aborted) {
    stage_ = Stage::emitting;
    on(*e.emission);
    return;
  }
  if (stage_ == Stage::queued || stage_ == Stage::stood_down || stage_ == Stage::kept) return;
  if (now_.tick >= later(deadline_, -kEmitBeforeDeadline)) {
    keep("restart", "the program was restarted and the window is over");
    return;
  }
  say(Level::info, "restart", "planning again after a restart");
  set_deadline(deadline_);
  out_.push_back(InspectFolder{});
  planning_over_ = true;  // whatever was asked before the restart has no one left to answer it
  plan_again();
}

// ---- saying ---------------------------------------------------------------------------------------------------------

void Pilot::say(Level level, std::string code, std::string text) {
  if (level == Level::alert || level == Level::page) alerted_ = true;
  out_.push_back(Say{level, std::move(code), std::move(text)});
}

void Pilot::record(std::string kind, std::string text) {
  out_.push_back(Record{std::move(kind), key_, std::move(text)});
}

void Pilot::set_timer(Timer timer, Tick at) {
  out_.push_back(SetTimer{timer, ++serials_[static_cast<std::size_t>(timer)], at});
}

void Pilot::cancel_timer(Timer timer) {
  ++serials_[static_cast<std::size_t>(timer)];
  out_.push_back(CancelTimer{timer});
}

}  // namespace glidehelm::mission
