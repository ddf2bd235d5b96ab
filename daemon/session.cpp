#include "daemon/session.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "daemon/event_json.hpp"
#include "daemon/world/failpoint.hpp"

namespace glidehelm::daemon {

namespace {

constexpr int kDefaultSlot = 10;

RecordType type_of(const std::string& kind) {
  for (const auto type :
       {RecordType::surfacing, RecordType::refusal, RecordType::duplicate, RecordType::plan, RecordType::verdict,
        RecordType::proposal, RecordType::keep, RecordType::emission, RecordType::mission})
    if (kind == word(type)) return type;
  return RecordType::alert;
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
                   tell_water();
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
                desk_.cache,
                ForecastWatch::kSettle,
                desk_.oceans},
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
  tell_water();
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
      if (!chart_->chart.has_coast() && !mission->currents.has_files())
        desk_.log.warn(entry_.name, "no coastline (safety.coast) and no forecast files: nothing is land");
    } else {
      chart_.reset();
      desk_.log.alert(entry_.name, chart.error() + ". Nothing is planned without the coast");
    }
  }
  forecast_.follow(*mission);
}

/// The pilot hears of the forecast's water when its mission's body takes it and it is another than it knows: what it decides then stands in
/// the journal, and a replay needs no forecast.
void Session::tell_water() {
  const auto& mission = pilot_.mission();
  const auto ocean = forecast_.current();
  if (!mission || !ocean || !takes_forecast_water(*mission)) return;
  const auto& water = ocean->forecast.facts().water;
  mission::ForecastWater heard{water.layers, water.words};
  if (pilot_.forecast_water() != heard) feed(std::move(heard));
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

}  // namespace glidehelm::daemon
