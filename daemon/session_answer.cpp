#include <fmt/format.h>

#include <array>

#include "core/base/text.hpp"
#include "daemon/candidate.hpp"
#include "daemon/session.hpp"
#include "daemon/world/failpoint.hpp"

// How one glider's surfacing is answered: plan, verdict, emission, and what lies in to-glider.
namespace glidehelm::daemon {

namespace {

constexpr Seconds kVerifierDeadline{10};
// A sanitizer reserves terabytes of address space before main: under a limit its programs cannot start.
#if defined(GLIDEHELM_SANITIZED)
constexpr std::size_t kVerifierMemory = 0;
#else
constexpr std::size_t kVerifierMemory = std::size_t{4} << 30;
#endif

}  // namespace

mission::EmissionEnded Session::ended(const Emission& emission, const std::string& surfacing) {
  using To = mission::EmissionEnded::Outcome;
  constexpr std::array<To, 5> kOutcomes{To::queued, To::foreign_file, To::late, To::aborted, To::unknown};
  return {kOutcomes[static_cast<std::size_t>(emission.outcome)], surfacing, emission.detail};
}

void Session::carry_out(const mission::BeginPlanning& e) {
  follow_mission();
  forecast_.look();
  planning_waits_ = e;
  if (!forecast_.holds_up()) plan_waiting();
}

/// Starts the plan that waits for its forecast; without one there is nothing to plan with.
void Session::plan_waiting() {
  if (!planning_waits_) return;
  const auto request = planning_waits_->request;
  planning_waits_.reset();
  const auto ocean = forecast_.current();
  if (!ocean || !chart_) {
    feed(mission::PlanningEnded{request.id,
                                !chart_ ? "the coast file cannot be read" : "no forecast: " + forecast_.problem()});
    return;
  }
  if (const auto expired = forecast_.expired()) {
    feed(mission::PlanningEnded{request.id, *expired});
    return;
  }
  if (forecast_.old()) desk_.log.warn(entry_.name, "the forecast is old: " + forecast_.in_use());
  ++pending_;
  auto& net = desk_.world.net;
  const auto post = [alive = alive_, &net](std::function<void()> then) {
    net.post([alive, then = std::move(then)] {
      if (*alive) then();
    });
  };
  const auto ticket =
      desk_.worker.submit([this, request, ocean, chart = chart_, post](const std::atomic<bool>& expired) {
        const auto problem = answer(
            request, *ocean, chart->chart, [&] { return expired.load(); },
            [&](mission::Candidate candidate) {
              post([this, candidate = std::move(candidate)] {
                world::failpoint("planned");
                feed(mission::CandidateFound{candidate});
              });
            });
        post([this, request, problem] {
          --pending_;
          feed(mission::PlanningEnded{request.id, problem});
        });
      });
  asked_[request.id] = {ticket, ocean, chart_};
  while (asked_.size() > 4) asked_.erase(asked_.begin());
}

void Session::carry_out(const mission::StopPlanning& e) {
  if (planning_waits_ && planning_waits_->request.id == e.request) planning_waits_.reset();
  const auto asked = asked_.find(e.request);
  if (asked != asked_.end()) desk_.worker.stop(asked->second.ticket);
}

verify::VerifyRequest Session::verify_request(const mission::Verify& e) const {
  verify::VerifyRequest request;
  request.dossier = e.dossier;
  const auto asked = asked_.find(e.request);
  if (asked == asked_.end()) return request;
  put_ocean(*asked->second.ocean, request);
  request.coast = asked->second.chart->coast;
  request.bathymetry = asked->second.chart->bathymetry;
  request.least_depth = asked->second.chart->least_depth;
  request.keep_in = asked->second.chart->keep_in;
  request.keep_out = asked->second.chart->keep_out;
  return request;
}

void Session::carry_out(const mission::Verify& e) {
  const auto staged = emitter_->stage(e.dossier.file_bytes, ++staged_count_);
  if (!staged && staged.error().failed_sync()) {
    desk_.fatal(staged.error().message());
    return;
  }
  if (!staged) {
    feed(mission::Judged{e.request, e.number, std::nullopt, staged.error().message()});
    return;
  }
  world::failpoint("staged");
  staged_[Sha256::of(std::string_view{e.dossier.file_bytes}).hex()] = *staged;
  auto descriptor = emitter_->open_staged(*staged);
  if (!descriptor) {
    feed(mission::Judged{e.request, e.number, std::nullopt, descriptor.error().message()});
    return;
  }
  world::ProcessRequest child;
  child.program = "glidehelm-verify";
  child.input = verify::to_json(verify_request(e));
  child.descriptor3 = std::move(descriptor).value();
  child.deadline = kVerifierDeadline;
  child.memory_at_most = kVerifierMemory;
  ++pending_;
  desk_.world.procs.run(std::move(child),
                        [this, alive = alive_, request = e.request, number = e.number](world::ProcessResult result) {
                          if (!*alive) return;
                          --pending_;
                          judged(request, number, result);
                        });
}

void Session::judged(std::uint64_t request, std::uint64_t number, const world::ProcessResult& result) {
  using End = world::ProcessResult::End;
  world::failpoint("verified");
  if (result.end != End::exited || (result.code != 0 && result.code != 4)) {
    std::string why = result.end == End::deadline
                          ? fmt::format("glidehelm-verify took longer than {:.0f} s", kVerifierDeadline.count())
                      : result.end == End::not_started ? "glidehelm-verify cannot be started"
                      : result.end == End::signalled   ? fmt::format("glidehelm-verify died of signal {}", result.code)
                                                       : std::string{trimmed(result.err.substr(0, 500))};
    feed(mission::Judged{request, number, std::nullopt, why});
    return;
  }
  auto verdict = verify::verdict_from_json(result.out);
  if (verdict)
    feed(mission::Judged{request, number, std::move(verdict).value(), ""});
  else
    feed(mission::Judged{request, number, std::nullopt,
                         "glidehelm-verify's answer cannot be read: " + verdict.error().message()});
}

void Session::carry_out(const mission::Emit& e) {
  const auto& clock = desk_.world.clock;
  const auto staged = staged_.find(e.file.verdict().of.hex());
  Emission emission{Emission::Outcome::aborted, "the proven file is not staged any more", false};
  if (staged != staged_.end())
    emission = emitter_->emit(e.file, staged->second, {entry_.name, e.surfacing, e.plan_id, e.deadline, e.replaces},
                              desk_.journal, clock);
  if (emission.fatal) {
    desk_.fatal(emission.detail);
    return;
  }
  for (const auto& [hash, name] : staged_) emitter_->discard(name);
  staged_.clear();
  if (emission.outcome == Emission::Outcome::queued) glanced_ = emitter_->glance();
  feed(ended(emission, e.surfacing));
}

void Session::carry_out(const mission::InspectFolder&) { feed(look_into_folder()); }

mission::FolderSeen Session::look_into_folder() {
  using What = FolderView::What;
  using Found = mission::FolderSeen::Found;
  glanced_ = emitter_->glance();  // before: what changes meanwhile is seen at the next look
  const auto view = emitter_->inspect();
  const auto found = view.what == What::nothing   ? Found::nothing
                     : view.what == What::ours    ? Found::ours
                     : view.what == What::foreign ? Found::foreign
                                                  : Found::unreadable;
  return {found, view.detail};
}

/// Every second while a window is open or a file of ours lies there: a human's file must be heard of at once, and so must
/// a file that was taken. Only what changed becomes an event. On whole seconds, so that the gliders of a fleet look
/// together and a simulated clock stops once for all of them.
void Session::watch_folder() {
  if (watching_folder_ || !pilot_.watches_folder()) return;
  watching_folder_ = true;
  auto& clock = desk_.world.clock;
  const auto next = std::chrono::floor<std::chrono::seconds>(clock.tick()) + std::chrono::seconds{1};
  folder_timer_ = clock.call_at(next, [this] {
    watching_folder_ = false;
    if (emitter_->glance() != glanced_)
      feed(look_into_folder());
    else
      watch_folder();
  });
}

}  // namespace glidehelm::daemon
