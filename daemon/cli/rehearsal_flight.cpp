#include "daemon/cli/rehearsal_flight.hpp"

#include <algorithm>

#include "core/mission/in_water.hpp"
#include "protocol/accept_fix.hpp"

namespace glidehelm::cli {

RehearsalFlight::RehearsalFlight(Setup setup, std::shared_ptr<const daemon::OceanSource> forecast, ocean::Ocean truth,
                                 const chart::Chart& chart)
    : setup_{std::move(setup)}, forecast_{std::move(forecast)}, chart_{chart}, pilot_{setup_.mission.glider} {
  simulator::Simulation::Member member{setup_.glider, &folder_};
  simulation_ = std::make_unique<simulator::Simulation>(std::vector{member}, truth, chart_, setup_.end, setup_.seed);
}

void RehearsalFlight::fly() {
  feed(mission::MissionChanged{{{setup_.mission, "yaml", "sha"}}, false, "start"});
  const auto& water = forecast_->forecast.facts().water;
  if (takes_forecast_water(setup_.mission)) feed(mission::ForecastWater{water.layers, water.words});
  while (const auto next = simulation_->next_event()) {
    run_timers(*next);
    utc_ = *next;
    for (const auto& output : simulation_->step()) take(output.event);
    if (!pilot_.watches_folder()) continue;
    if (const auto seen = look(); seen.found != found_) {
      found_ = seen.found;
      feed(seen);
    }
  }
}

void RehearsalFlight::take(const simulator::LineEvent& event) {
  const auto heard =
      event.kind == simulator::LineEvent::Kind::bytes ? reader_.append(event.bytes, utc_) : reader_.end(utc_);
  for (const auto& what : heard) hear(what);
}

void RehearsalFlight::hear(const protocol::DialogEvent& event) {
  if (const auto* name = std::get_if<protocol::NameHeard>(&event)) name_ = name->name;
  if (const auto* read = std::get_if<protocol::BlockRead>(&event); read != nullptr && read->block.gps)
    hear_block(*read);
  if (const auto* window = std::get_if<protocol::WindowHeard>(&event))
    feed(mission::WindowHeard{Seconds{static_cast<double>(window->seconds)}});
  if (std::holds_alternative<protocol::MissionResumed>(event)) feed(mission::DiveBegan{});
  if (const auto* started = std::get_if<protocol::TransferStarted>(&event))
    feed(mission::TransferHeard{started->file, false});
  if (const auto* done = std::get_if<protocol::TransferDone>(&event)) feed(mission::TransferHeard{done->file, true});
  if (std::holds_alternative<protocol::MafilesReread>(event)) feed(mission::ListReread{});
}

void RehearsalFlight::hear_block(const protocol::BlockRead& read) {
  auto s = protocol::accept_fix(read.block, name_);
  if (!s) return feed(mission::FixRefused{s.error()});
  if (setup_.heard_as) setup_.heard_as(*s);
  const auto dive = pilot_.dive_under_way();
  const auto mean = dive ? daemon::mean_along(*forecast_, *dive, s->fix, epoch_seconds(s->fix_taken)) : std::nullopt;
  feed(mission::SurfacingHeard{std::move(s).value(), std::nullopt, mean});
}

/// What lies in to-glider: ours when the bytes are the last emitted ones.
mission::FolderSeen RehearsalFlight::look() {
  using Found = mission::FolderSeen::Found;
  const auto files = folder_.contents(utc_);
  if (files.empty()) return {Found::nothing, ""};
  const bool ours = !files_.empty() && files.front().bytes == files_.back();
  return {ours ? Found::ours : Found::foreign, files.front().name};
}

void RehearsalFlight::run_timers(Instant until) {
  while (!timers_.empty()) {
    const auto first =
        std::min_element(timers_.begin(), timers_.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
    const Instant at = utc_of(first->at);
    if (at > until) return;
    utc_ = std::max(utc_, at);
    const auto timer = *first;
    timers_.erase(first);
    feed(mission::TimerFired{timer.timer, timer.serial});
  }
}

void RehearsalFlight::feed(decltype(mission::Event::what) what) {
  waiting_.push_back(std::move(what));
  if (stepping_) return;
  stepping_ = true;
  while (!waiting_.empty()) {
    events_.push_back({{utc_, tick()}, std::move(waiting_.front())});
    waiting_.erase(waiting_.begin());
    effects_.push_back(pilot_.step(events_.back()));
    const auto effects = effects_.back();
    for (const auto& effect : effects) std::visit([this](const auto& e) { perform(e); }, effect);
  }
  stepping_ = false;
}

void RehearsalFlight::perform(const mission::BeginPlanning& e) {
  if (pilot_.surfacings() > static_cast<int>(surfaced_.size())) {
    surfaced_.push_back({e.request.problem.start.fix, promised_});
    promised_.reset();
  }
  if (setup_.may_emit && !setup_.may_emit(pilot_.surfacings())) {
    waiting_.emplace_back(mission::PlanningEnded{e.request.id, "played: no file at this surfacing"});
    return;
  }
  const auto problem = daemon::answer(e.request, *forecast_, chart_, {}, [&](mission::Candidate c) {
    waiting_.emplace_back(mission::CandidateFound{std::move(c)});
  });
  waiting_.emplace_back(mission::PlanningEnded{e.request.id, problem});
}

void RehearsalFlight::perform(const mission::Verify& e) {
  const auto verdict = safety::judge(e.dossier, forecast_->forecast.full(), chart_);
  for (const auto& m : verdict.margins)
    if (!verdict.accepted && !m.holds) {
      refusals_.push_back(m.rule + ": " + m.message);
      ++rules_fired_[m.rule];
    }
  waiting_.emplace_back(mission::Judged{e.request, e.number, verdict, ""});
}

void RehearsalFlight::perform(const mission::Emit& e) {
  folder_.offer(e.file.name(), e.file.bytes());
  files_.push_back(e.file.bytes());
  found_ = mission::FolderSeen::Found::ours;
  for (auto event = events_.rbegin(); event != events_.rend(); ++event)
    if (const auto* found = std::get_if<mission::CandidateFound>(&event->what);
        found != nullptr && found->candidate.file_bytes == e.file.bytes()) {
      promised_ = found->candidate.promise.next_surfacing;
      plans_.push_back(found->candidate.plan);
      break;
    }
  waiting_.emplace_back(mission::EmissionEnded{mission::EmissionEnded::Outcome::queued, e.surfacing, "queued"});
}

void RehearsalFlight::perform(const mission::InspectFolder&) {
  const auto seen = look();
  found_ = seen.found;
  waiting_.emplace_back(seen);
}

void RehearsalFlight::perform(const mission::SetTimer& e) {
  perform(mission::CancelTimer{e.timer});
  timers_.push_back(e);
}

void RehearsalFlight::perform(const mission::CancelTimer& e) {
  std::erase_if(timers_, [&](const mission::SetTimer& t) { return t.timer == e.timer; });
}

}  // namespace glidehelm::cli
