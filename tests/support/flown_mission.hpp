#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/mission/pilot.hpp"
#include "daemon/candidate.hpp"
#include "protocol/dialog.hpp"
#include "simulator/simulation.hpp"
#include "tests/support/fields.hpp"

namespace glidehelm::test {

/// A whole mission in one process and no time: the simulated glider and dockserver, the real dialog reader, pilot, planner, writer
/// and judge. Only sockets, journal and folders are missing; the emitter is "put it into to-glider".
class FlownMission {
 public:
  struct Setup {
    mission::Mission mission;
    simulator::GliderPlan glider;
    simulator::EndPlan end;
    std::uint64_t seed{1};
    std::function<bool(int surfacing)>
        may_emit;  ///< empty: always; false at a surfacing plays a daemon that has no file for it
    std::function<void(model::Surfacing&)> heard_as;  ///< changes what the daemon hears; empty: as the glider says it
  };
  struct Surfaced {
    GeoPoint fix;
    std::optional<GeoPoint> promised;  ///< by the plan of the surfacing before
  };

  FlownMission(Setup setup, std::shared_ptr<const daemon::OceanSource> forecast, ocean::Ocean truth,
               const chart::Chart& chart)
      : setup_{std::move(setup)},
        forecast_{std::move(forecast)},
        chart_{chart},
        truth_{truth},
        pilot_{setup_.mission.glider} {
    simulator::Simulation::Member member{setup_.glider, &folder_};
    simulation_ = std::make_unique<simulator::Simulation>(std::vector{member}, truth_, chart_, setup_.end, setup_.seed);
  }

  void fly() {
    feed(mission::MissionChanged{{{setup_.mission, "yaml", "sha"}}, false, "start"});
    while (const auto next = simulation_->next_event()) {
      run_timers(*next);
      utc_ = *next;
      for (const auto& output : simulation_->step()) take(output.event);
      if (pilot_.watches_folder() && look().found != found_) {
        found_ = look().found;
        feed(look());
      }
    }
  }

  [[nodiscard]] const simulator::Simulation& simulation() const { return *simulation_; }
  [[nodiscard]] const mission::Pilot& pilot() const { return pilot_; }
  [[nodiscard]] const std::vector<Surfaced>& surfacings() const { return surfaced_; }
  [[nodiscard]] const std::vector<mission::Event>& events() const { return events_; }
  [[nodiscard]] const std::vector<mission::Effects>& effects() const { return effects_; }
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }
  [[nodiscard]] const std::vector<std::string>& refusals() const { return refusals_; }
  [[nodiscard]] const std::vector<planning::Plan>& plans() const { return plans_; }  ///< of the emitted files

 private:
  void take(const simulator::LineEvent& event) {
    const auto heard =
        event.kind == simulator::LineEvent::Kind::bytes ? reader_.append(event.bytes, utc_) : reader_.end(utc_);
    for (const auto& what : heard) hear(what);
  }

  void hear(const protocol::DialogEvent& event) {
    if (const auto* name = std::get_if<protocol::NameHeard>(&event)) name_ = name->name;
    if (const auto* block = std::get_if<protocol::BlockRead>(&event); block != nullptr && block->block.gps) {
      auto s = protocol::accept_fix(block->block, name_);
      if (!s) {
        feed(mission::FixRefused{s.error()});
      } else {
        if (setup_.heard_as) setup_.heard_as(*s);
        const auto dive = pilot_.dive_under_way();
        const auto mean =
            dive ? daemon::mean_along(*forecast_, *dive, s->fix, epoch_seconds(s->fix_taken)) : std::nullopt;
        feed(mission::SurfacingHeard{std::move(s).value(), std::nullopt, mean});
      }
    }
    if (const auto* window = std::get_if<protocol::WindowHeard>(&event))
      feed(mission::WindowHeard{Seconds{static_cast<double>(window->seconds)}});
    if (std::holds_alternative<protocol::MissionResumed>(event)) feed(mission::DiveBegan{});
    if (const auto* started = std::get_if<protocol::TransferStarted>(&event))
      feed(mission::TransferHeard{started->file, false});
    if (const auto* done = std::get_if<protocol::TransferDone>(&event)) feed(mission::TransferHeard{done->file, true});
    if (std::holds_alternative<protocol::MafilesReread>(event)) feed(mission::ListReread{});
  }

  /// What lies in to-glider: ours when the bytes are the last emitted ones.
  mission::FolderSeen look() {
    using Found = mission::FolderSeen::Found;
    const auto files = folder_.contents(utc_);
    if (files.empty()) return {Found::nothing, ""};
    return {!files_.empty() && files.front().bytes == files_.back() ? Found::ours : Found::foreign, files.front().name};
  }

  void run_timers(Instant until) {
    while (!timers_.empty()) {
      auto first = timers_.begin();
      for (auto t = timers_.begin(); t != timers_.end(); ++t)
        if (t->at < first->at) first = t;
      const Instant at = utc_of(first->at);
      if (at > until) return;
      utc_ = std::max(utc_, at);
      const auto timer = *first;
      timers_.erase(first);
      feed(mission::TimerFired{timer.timer, timer.serial});
    }
  }
  // One clock behind both types is enough here: ticks count from 1970 too.
  [[nodiscard]] Tick tick() const { return Tick{utc_.time_since_epoch()}; }
  static Instant utc_of(Tick t) { return Instant{t.time_since_epoch()}; }

  void feed(decltype(mission::Event::what) what) {
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

  void perform(const mission::BeginPlanning& e) {
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
  void perform(const mission::Verify& e) {
    const auto verdict = safety::judge(e.dossier, forecast_->forecast.full(), chart_);
    if (!verdict.accepted)
      for (const auto& m : verdict.margins)
        if (!m.holds) refusals_.push_back(m.rule + ": " + m.message);
    waiting_.emplace_back(mission::Judged{e.request, e.number, verdict, ""});
  }
  void perform(const mission::Emit& e) {
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
  void perform(const mission::InspectFolder&) {
    found_ = look().found;
    waiting_.emplace_back(look());
  }
  void perform(const mission::SetTimer& e) {
    perform(mission::CancelTimer{e.timer});
    timers_.push_back(e);
  }
  void perform(const mission::CancelTimer& e) {
    std::erase_if(timers_, [&](const mission::SetTimer& t) { return t.timer == e.timer; });
  }
  void perform(const mission::StopPlanning&) {}
  void perform(const mission::Say&) {}
  void perform(const mission::Record&) {}

  Setup setup_;
  std::shared_ptr<const daemon::OceanSource> forecast_;
  const chart::Chart& chart_;
  ocean::Ocean truth_;
  simulator::MemoryToGlider folder_;
  std::unique_ptr<simulator::Simulation> simulation_;
  mission::FolderSeen::Found found_{};
  protocol::DialogReader reader_;
  std::string name_;
  mission::Pilot pilot_;
  Instant utc_{};
  std::vector<decltype(mission::Event::what)> waiting_;
  bool stepping_{};
  std::vector<mission::SetTimer> timers_;
  std::vector<mission::Event> events_;
  std::vector<mission::Effects> effects_;
  std::vector<Surfaced> surfaced_;
  std::optional<GeoPoint> promised_;
  std::vector<std::string> files_, refusals_;
  std::vector<planning::Plan> plans_;
};

/// A forecast on a 0.02° grid, sampled from analytic fields at `start` over a box around two places: a grid has the fast kernel.
inline std::shared_ptr<const daemon::OceanSource> gridded_forecast(const std::vector<ocean::AnalyticSpec>& specs,
                                                                   GeoPoint from, GeoPoint to, Instant start) {
  constexpr double kStep = 0.02, kAround = 0.6;
  const double south = std::min(from.lat.degrees(), to.lat.degrees()) - kAround,
               north = std::max(from.lat.degrees(), to.lat.degrees()) + kAround;
  const double west = std::min(from.lon.degrees(), to.lon.degrees()) - kAround,
               east = std::max(from.lon.degrees(), to.lon.degrees()) + kAround;
  std::vector<ocean::AnalyticField> fields;
  for (const auto& spec : specs) {
    auto field = ocean::AnalyticField::make(spec, start, {});
    if (!field) throw std::runtime_error(field.error().message());
    fields.push_back(std::move(field).value());
  }
  const auto count = [](double span) { return static_cast<std::size_t>(span / kStep) + 1; };
  auto grid = std::make_shared<ocean::Grid>(
      make_grid(flat_axes(steps(south, kStep, count(north - south)), steps(west, kStep, count(east - west))),
                [&](double lat, double lon, double, double) {
                  double u = 0, v = 0;
                  for (const auto& field : fields) {
                    const auto sample = field.sample(geo_point(lat, lon), Depth{}, epoch_seconds(start));
                    u += sample->current.east.si();
                    v += sample->current.north.si();
                  }
                  return std::pair{u, v};
                }));
  auto forecast = ocean::Forecast::prepare(ocean::view_of(*grid), ocean::DiveProfile{}, {}, grid);
  if (!forecast) throw std::runtime_error(forecast.error().message());
  return std::make_shared<const daemon::OceanSource>(
      daemon::OceanSource{std::move(forecast).value(), std::nullopt, {}, {}, start, {}, {}, {}});
}

}  // namespace glidehelm::test
