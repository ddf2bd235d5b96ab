#include "daemon/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "daemon/candidate.hpp"
#include "daemon/event_json.hpp"
#include "daemon/world/failpoint.hpp"

namespace glidehelm::daemon {

namespace {

constexpr int kDefaultSlot = 10;
constexpr Seconds kIdle{2};
constexpr Seconds kVerifierDeadline{10};
// A sanitizer reserves terabytes of address space before main: under a limit its programs cannot start.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kVerifierMemory = 0;
#else
constexpr std::size_t kVerifierMemory = std::size_t{4} << 30;
#endif

RecordType type_of(const std::string& kind) {
  for (const auto type :
       {RecordType::surfacing, RecordType::refusal, RecordType::duplicate, RecordType::plan, RecordType::verdict,
        RecordType::proposal, RecordType::keep, RecordType::emission, RecordType::mission})
    if (kind == word(type)) return type;
  return RecordType::alert;
}

mission::EmissionEnded ended(const Emission& emission, const std::string& surfacing) {
  using To = mission::EmissionEnded::Outcome;
  constexpr std::array<To, 5> kOutcomes{To::queued, To::foreign_file, To::late, To::aborted, To::unknown};
  return {kOutcomes[static_cast<std::size_t>(emission.outcome)], surfacing, emission.detail};
}

/// How the emission for `surfacing` ended, when its end is in the journal and the crash came before the pilot was told. An
/// aborted one counts as none: nothing was visible.
std::optional<mission::EmissionEnded> end_in(const std::vector<JournalRecord>& past, const std::string& glider,
                                             const std::string& surfacing) {
  using Outcome = mission::EmissionEnded::Outcome;
  for (auto record = past.rbegin(); record != past.rend(); ++record) {
    if (record->type != RecordType::committed && record->type != RecordType::recovered) continue;
    const auto json = nlohmann::json::parse(record->payload, nullptr, false);
    const auto is = [&](const char* key, const std::string& text) { return json.contains(key) && json[key] == text; };
    if (!json.is_object() || !is("glider", glider) || !is("surfacing", surfacing)) continue;
    if (record->type == RecordType::committed)
      return mission::EmissionEnded{Outcome::queued, surfacing, "the file was queued before the crash"};
    return mission::EmissionEnded{Outcome::unknown, surfacing, "the crash before the last one left that open"};
  }
  return std::nullopt;
}

}  // namespace

Session::Session(config::GliderEntry entry, Desk desk)
    : entry_{std::move(entry)},
      desk_{std::move(desk)},
      pilot_{entry_.name},
      forecast_{desk_.world,
                desk_.grids,
                {[this](const std::shared_ptr<const OceanSource>& ocean) {
                   std::string text = "forecast in use: " + forecast_.in_use();
                   for (const auto& warning : ocean->forecast.facts().warnings) text += "; warning: " + warning;
                   desk_.log.info(entry_.name, text);
                 },
                 [this](const std::string& problem) {
                   desk_.log.alert(entry_.name, forecast_.current() ? "a forecast is refused: " + problem +
                                                                          ". In use stays " + forecast_.in_use()
                                                                    : "no forecast: " + problem);
                 },
                 [this](const std::string& note) { desk_.log.warn(entry_.name, note); },
                 [this] {
                   plan_waiting();
                   desk_.changed();
                 }},
                desk_.cache},
      alive_{std::make_shared<bool>(true)} {}

Session::~Session() {
  *alive_ = false;
  for (const auto& [timer, id] : timers_) desk_.world.clock.cancel(id);
  desk_.world.clock.cancel(idle_timer_);
  desk_.world.clock.cancel(folder_timer_);
  for (const auto& [request, asked] : asked_) desk_.worker.stop(asked.ticket);
}

Expected<Done, std::string> Session::open(int slot) {
  auto emitter = Emitter::open(desk_.world.files, entry_.to_glider, slot, desk_.world.clock.simulated());
  if (!emitter) return unexpected(emitter.error());
  emitter_ = std::move(emitter).value();
  return Done{};
}

std::unique_ptr<Line> Session::line_of(const config::GliderEntry& entry) {
  return std::make_unique<Line>(
      desk_.world, entry.line,
      Line::Handlers{[this](std::uint64_t connection, std::string_view peer, bool replaced) {
                       opened(connection, peer, replaced);
                     },
                     [this](std::uint64_t, std::string_view bytes) { received(bytes); },
                     [this](std::uint64_t, std::string_view reason) { closed(reason); },
                     [this](std::string_view problem) { desk_.log.warn(entry_.name, problem); }});
}

Expected<Done, std::string> Session::start() {
  line_ = line_of(entry_);
  const auto started = line_->start();
  if (!started) return unexpected("line of " + entry_.name + ": " + started.error().message());
  return Done{};
}

Expected<Session::Change, std::string> Session::prepare(const config::GliderEntry& entry) {
  Change change{entry, nullptr, nullptr};
  if (entry.to_glider != entry_.to_glider) {
    const int slot = pilot_.mission() ? pilot_.mission()->slot : kDefaultSlot;
    auto emitter = Emitter::open(desk_.world.files, entry.to_glider, slot, desk_.world.clock.simulated());
    if (!emitter) return unexpected(emitter.error());
    change.emitter = std::move(emitter).value();
  }
  if (entry.line != entry_.line) {
    change.line = line_of(entry);
    const auto started = change.line->start();
    if (!started) return unexpected("line of " + entry.name + ": " + started.error().message());
  }
  return change;
}

void Session::apply(Change change) {
  if (change.line) {
    closed("the line moves");
    line_ = std::move(change.line);
  }
  if (change.emitter) {
    emitter_ = std::move(change.emitter);
    glanced_ = "?";
  }
  entry_ = std::move(change.entry);
}

bool Session::quiet() const {
  return pending_ == 0 && !planning_waits_ && !forecast_.loading() && waiting_.empty() && !stepping_;
}

// ---- the line -------------------------------------------------------------------------------------------------------

void Session::opened(std::uint64_t, std::string_view peer, bool replaced) {
  reader_ = {};
  name_.clear();
  connected_ = true;
  emitter_->set_transfer_open(false);  // a transfer does not outlive its call
  desk_.log.info(entry_.name,
                 fmt::format("line: {} connected{}", peer, replaced ? ", replacing the older connection" : ""));
}

void Session::received(std::string_view bytes) {
  world::failpoint("first_byte");
  bytes_ += bytes.size();
  for (const auto& event : reader_.append(bytes, desk_.world.clock.utc())) {
    if (!connected_) break;  // a second name closed the connection
    hear(event);
  }
  flush_when_idle();
  desk_.handled(entry_.name, bytes_);
}

/// A prompt has no line end, and a cut dialog no last line: after two silent seconds what is whole is used.
void Session::flush_when_idle() {
  desk_.world.clock.cancel(idle_timer_);
  if (!connected_) return;
  idle_timer_ =
      desk_.world.clock.call_at(desk_.world.clock.tick() + std::chrono::duration_cast<Tick::duration>(kIdle), [this] {
        for (const auto& event : reader_.flush_idle(desk_.world.clock.utc())) hear(event);
        desk_.changed();
      });
}

void Session::closed(std::string_view reason) {
  if (!connected_) return;
  for (const auto& event : reader_.end(desk_.world.clock.utc())) hear(event);
  connected_ = false;
  desk_.world.clock.cancel(idle_timer_);
  const auto& counts = reader_.counts();
  desk_.log.info(entry_.name, fmt::format("line: closed, {}{}", reason,
                                          counts.damaged_lines > 0
                                              ? fmt::format(" ({} damaged lines were not used)", counts.damaged_lines)
                                              : ""));
}

void Session::hear_name(const std::string& name) {
  if (name_.empty() && equal_without_case(name, entry_.name)) {
    name_ = name;
    return;
  }
  if (!name_.empty() && equal_without_case(name, name_)) return;
  desk_.log.alert(entry_.name,
                  name_.empty()
                      ? fmt::format("the dialog on this line is of glider '{}', configured is {}: connection closed",
                                    name, entry_.name)
                      : fmt::format("two names on one connection, {} and '{}': connection closed", name_, name));
  connected_ = false;
  line_->drop("another glider's name");
}

void Session::hear_block(const protocol::SurfaceBlock& block) {
  if (!block.gps && !block.gps_damaged) return;
  auto surfacing = protocol::accept_fix(block, name_);
  if (!surfacing) {
    feed(mission::FixRefused{surfacing.error()});
    return;
  }
  std::optional<Metres> coast;
  if (chart_ && chart_->chart.has_coast()) coast = chart_->chart.distance_to_coast(surfacing->fix);
  const auto forecast = forecast_of_dive(*surfacing);
  feed(mission::SurfacingHeard{std::move(surfacing).value(), coast, forecast});
}

/// The forecast in use, along the dive that this fix ends: what the pilot compares with the measured current.
std::optional<Current> Session::forecast_of_dive(const model::Surfacing& surfacing) const {
  const auto dive = pilot_.dive_under_way();
  const auto ocean = forecast_.current();
  if (!dive || !ocean) return std::nullopt;
  return mean_along(*ocean, *dive, surfacing.fix, epoch_seconds(surfacing.fix_taken));
}

void Session::hear(const protocol::DialogEvent& event) {
  struct Ear {
    Session& session;
    void operator()(const protocol::ConnectionOpened&) const {}
    void operator()(const protocol::NameHeard& e) const { session.hear_name(e.name); }
    void operator()(const protocol::BlockRead& e) const { session.hear_block(e.block); }
    void operator()(const protocol::WindowHeard& e) const {
      session.feed(mission::WindowHeard{Seconds{static_cast<double>(e.seconds)}});
    }
    void operator()(const protocol::WindowExtended& e) const { session.feed(mission::WindowExtended{e.by}); }
    void operator()(const protocol::MissionResumed&) const {
      session.emitter_->set_transfer_open(false);
      session.feed(mission::DiveBegan{});
    }
    void operator()(const protocol::MissionEnded& e) const {
      session.desk_.log.alert(session.entry_.name, "the dialog says that the glider's mission has ended: " + e.cause);
    }
    void operator()(const protocol::DockserverBlock&) const {}
    void operator()(const protocol::TransferStarted& e) const {
      if (lower(e.file).ends_with(session.emitter_->file_name())) session.emitter_->set_transfer_open(true);
      session.feed(mission::TransferHeard{e.file, false});
    }
    void operator()(const protocol::TransferDone& e) const {
      if (lower(e.file).ends_with(session.emitter_->file_name())) session.emitter_->set_transfer_open(false);
      session.feed(mission::TransferHeard{e.file, true});
    }
    void operator()(const protocol::TransferFailed& e) const {
      if (!lower(e.file).ends_with(session.emitter_->file_name())) return;
      session.emitter_->set_transfer_open(false);
      session.desk_.log.alert(session.entry_.name,
                              fmt::format("the transfer of {} failed: half of it may be on the glider, send it again "
                                          "before Ctrl-F",
                                          e.file));
    }
    void operator()(const protocol::CommandEnded& e) const {
      if (!e.succeeded)
        session.desk_.log.warn(session.entry_.name, "the glider refused the command: " + e.command.substr(0, 80));
    }
    void operator()(const protocol::NothingToSend& e) const {
      session.desk_.log.info(session.entry_.name,
                             fmt::format("'{}' found no file in to-glider: a list that comes now waits for the next "
                                         "surfacing",
                                         e.command.substr(0, 80)));
    }
    void operator()(const protocol::MafilesReread&) const { session.feed(mission::ListReread{}); }
    void operator()(const protocol::AbortSeen& e) const {
      session.desk_.log.alert(session.entry_.name,
                              fmt::format("the dialog says that a mission was aborted: {}", e.cause));
    }
    void operator()(const protocol::PromptSeen&) const {}
    void operator()(const protocol::KeyHeard&) const {}
  };
  std::visit(Ear{*this}, event);
}

// ---- the pilot ------------------------------------------------------------------------------------------------------

void Session::note(RecordType type, const std::string& payload) {
  const auto& clock = desk_.world.clock;
  const auto written = desk_.journal.append(type, payload, clock.utc(), clock.tick());
  if (written) return;
  if (written.error().fatal) {
    desk_.fatal(written.error().message);
    return;
  }
  if (!mute_)
    desk_.log.fact(mission::Level::page, entry_.name,
                   written.error().message + ". Nothing is emitted while nothing can be recorded");
  mute_ = true;
}

/// Journals an event, lets the pilot take it, carries out what it wants. Effects may bring further events at once: they wait their turn.
void Session::feed(decltype(mission::Event::what) what) {
  waiting_.push_back(std::move(what));
  if (stepping_) return;
  stepping_ = true;
  while (!waiting_.empty()) {
    const mission::Event event{{desk_.world.clock.utc(), desk_.world.clock.tick()}, std::move(waiting_.front())};
    waiting_.erase(waiting_.begin());
    note(RecordType::event, event_json(entry_.name, event));
    if (std::holds_alternative<mission::SurfacingHeard>(event.what)) world::failpoint("surfacing_recorded");
    perform(pilot_.step(event));
  }
  stepping_ = false;
  follow_mission();
  watch_folder();
  desk_.changed();
}

void Session::perform(const mission::Effects& effects) {
  for (const auto& effect : effects) std::visit([this](const auto& e) { carry_out(e); }, effect);
}

/// The chart and the forecast are those of the mission that is flown.
void Session::follow_mission() {
  const auto& mission = pilot_.mission();
  if (!mission) return;
  emitter_->set_slot(mission->slot);
  if (const ChartOrder wanted{*mission}; wanted != chart_for_) {
    chart_for_ = wanted;
    auto chart = load_chart(*mission, desk_.world.files);
    if (chart) {
      chart_ = std::move(chart).value();
      if (!chart_->chart.has_coast() && mission->currents.files.empty())
        desk_.log.warn(entry_.name, "no coastline (safety.coast) and no forecast files: nothing is land");
    } else {
      chart_.reset();
      desk_.log.alert(entry_.name, chart.error() + ". Nothing is planned without the coast");
    }
  }
  forecast_.follow(*mission);
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
  ++pending_;
  auto& net = desk_.world.net;
  const auto post = [this, alive = alive_, &net](std::function<void()> then) {
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
  const auto& ocean = *asked->second.ocean;
  request.grid = ocean.grid;
  request.grid_options = ocean.options;
  request.analytic = ocean.analytic;
  request.analytic_start = ocean.analytic_start;
  request.analytic_box = ocean.analytic_box;
  request.coast = asked->second.chart->coast;
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

void Session::carry_out(const mission::SetTimer& e) {
  carry_out(mission::CancelTimer{e.timer});
  timers_[e.timer] = desk_.world.clock.call_at(e.at, [this, e] { feed(mission::TimerFired{e.timer, e.serial}); });
}

void Session::carry_out(const mission::CancelTimer& e) {
  const auto timer = timers_.find(e.timer);
  if (timer == timers_.end()) return;
  desk_.world.clock.cancel(timer->second);
  timers_.erase(timer);
}

void Session::carry_out(const mission::Say& e) {
  desk_.log.fact(e.level, entry_.name, e.text);
  if (e.level == mission::Level::alert || e.level == mission::Level::page)
    note(RecordType::alert, nlohmann::json{{"glider", entry_.name}, {"code", e.code}, {"text", e.text}}.dump());
}

void Session::carry_out(const mission::Record& e) {
  note(type_of(e.kind),
       nlohmann::json{{"glider", entry_.name}, {"kind", e.kind}, {"surfacing", e.surfacing}, {"text", e.text}}.dump());
}

void Session::fly(std::vector<mission::MissionText> chain, const std::string& by) {
  chart_for_.reset();  // a file of the same name may have another coast now
  feed(mission::MissionChanged{std::move(chain), entry_.clock_skew_ok, by});
}

// ---- after a crash ----------------------------------------------------------------------------------------------------

void Session::recover(const std::vector<JournalRecord>& past) {
  const auto& clock = desk_.world.clock;
  std::uint64_t replayed = 0;
  for (const auto& record : past) {
    if (record.type != RecordType::event) continue;
    auto event = event_from_json(record.payload);
    if (!event) {
      desk_.log.alert(entry_.name,
                      fmt::format("record {} of the journal cannot be replayed: {}", record.sequence, event.error()));
      continue;
    }
    if (event->glider != entry_.name) continue;
    static_cast<void>(pilot_.step(event->event));
    ++replayed;
  }
  const auto settled = emitter_->recover(entry_.name, past, desk_.journal, clock.utc(), clock.tick());
  for (const auto& recovered : settled) {
    // What became of the surfacing at hand is said by the pilot, which hears it below.
    if (replayed == 0 || recovered.surfacing != pilot_.surfacing_key())
      desk_.log.warn(entry_.name, "after a crash: " + recovered.emission.detail);
    if (recovered.emission.fatal) desk_.fatal(recovered.emission.detail);
  }
  if (replayed == 0) return;
  desk_.log.info(entry_.name, fmt::format("back with {} surfacings from the journal ({} events); the last one: {}",
                                          pilot_.surfacings(), replayed, mission::word(pilot_.stage())));
  mission::Restarted restarted;
  for (const auto& recovered : settled)
    if (recovered.surfacing == pilot_.surfacing_key())
      restarted.emission = ended(recovered.emission, recovered.surfacing);
  if (!restarted.emission && pilot_.stage() == mission::Stage::emitting)
    restarted.emission = end_in(past, entry_.name, pilot_.surfacing_key());
  feed(restarted);
}

}  // namespace glidehelm::daemon
