#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/mission/pilot.hpp"
#include "daemon/candidate.hpp"
#include "protocol/dialog.hpp"
#include "simulator/simulation.hpp"

namespace glidehelm::cli {

/// A whole mission in one process and no time: the simulated glider and dockserver, the real dialog reader, pilot, planner, writer
/// and judge. Only sockets, journal and folders are missing; the emitter is "put it into to-glider". Deterministic.
class RehearsalFlight {
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

  /// Truth and chart must outlive the flight.
  RehearsalFlight(Setup setup, std::shared_ptr<const daemon::OceanSource> forecast, ocean::Ocean truth,
                  const chart::Chart& chart);

  /// To the end that the setup names. Call once.
  void fly();

  [[nodiscard]] const simulator::Simulation& simulation() const { return *simulation_; }
  [[nodiscard]] const mission::Pilot& pilot() const { return pilot_; }
  [[nodiscard]] const std::vector<Surfaced>& surfacings() const { return surfaced_; }
  [[nodiscard]] const std::vector<mission::Event>& events() const { return events_; }
  [[nodiscard]] const std::vector<mission::Effects>& effects() const { return effects_; }
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }
  /// What the judge found, as `RULE: words`, one entry per rule that did not hold.
  [[nodiscard]] const std::vector<std::string>& refusals() const { return refusals_; }
  /// How often each rule refused a file.
  [[nodiscard]] const std::map<std::string, int>& rules_fired() const { return rules_fired_; }
  [[nodiscard]] const std::vector<planning::Plan>& plans() const { return plans_; }  ///< of the emitted files

 private:
  void take(const simulator::LineEvent& event);
  void hear(const protocol::DialogEvent& event);
  void hear_block(const protocol::BlockRead& read);
  [[nodiscard]] mission::FolderSeen look();
  void run_timers(Instant until);
  // One clock behind both types is enough here: ticks count from 1970 too.
  [[nodiscard]] Tick tick() const { return Tick{utc_.time_since_epoch()}; }
  static Instant utc_of(Tick t) { return Instant{t.time_since_epoch()}; }
  void feed(decltype(mission::Event::what) what);

  void perform(const mission::BeginPlanning& e);
  void perform(const mission::Verify& e);
  void perform(const mission::Emit& e);
  void perform(const mission::InspectFolder& e);
  void perform(const mission::SetTimer& e);
  void perform(const mission::CancelTimer& e);
  void perform(const mission::StopPlanning&) {}
  void perform(const mission::Say&) {}
  void perform(const mission::Record&) {}

  Setup setup_;
  std::shared_ptr<const daemon::OceanSource> forecast_;
  const chart::Chart& chart_;
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
  std::map<std::string, int> rules_fired_;
  std::vector<planning::Plan> plans_;
};

}  // namespace glidehelm::cli
