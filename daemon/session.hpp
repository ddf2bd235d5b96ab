#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/daemon.hpp"
#include "core/mission/pilot.hpp"
#include "daemon/emitter.hpp"
#include "daemon/forecast_watch.hpp"
#include "daemon/journal.hpp"
#include "daemon/line.hpp"
#include "daemon/log.hpp"
#include "daemon/planning_worker.hpp"
#include "protocol/dialog.hpp"

namespace glidehelm::daemon {

/// What a session asks of the service that owns it.
struct Desk {
  world::World world;
  Log& log;
  Journal& journal;
  PlanningWorker& worker;
  std::string grids;              ///< folder of flat grids
  std::function<void()> changed;  ///< something began or ended: the daemon may be quiescent
  std::function<void(const std::string&, std::uint64_t)> handled;  ///< bytes of a line, in total, are handled
  std::function<void(const std::string&)> fatal;  ///< the journal or a folder failed in a way that ends the process
  std::shared_ptr<GridCache> cache{};             ///< of the folder of grids, for all sessions
  OceanPool* oceans{};                            ///< forecasts shared with other gliders; none: shared with nobody
};

/// One glider: its line and dialog (session_line.cpp), its pilot (session.cpp), the hands that carry out what the pilot wants
/// (session_answer.cpp), and how it comes back after a crash (session_recovery.cpp). Runs in the loop's thread.
///
/// Whatever comes from the line, it holds at most what its reader holds (DialogReader), and says what was not used: when a
/// console opens and when the connection closes.
class Session {
 public:
  Session(config::GliderEntry entry, Desk desk);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Opens the to-glider folder and its lock. The message says what is wrong.
  [[nodiscard]] Expected<Done, std::string> open(int slot);
  /// Replays the journal's events into the pilot and settles what a crash left. Before `start`.
  void recover(const std::vector<JournalRecord>& past);
  /// Opens the line.
  [[nodiscard]] Expected<Done, std::string> start();
  /// What another entry of the same glider needs, opened and not yet in force: a reload is all or nothing.
  struct Change {
    config::GliderEntry entry;
    std::unique_ptr<Emitter> emitter;  ///< null: the folder stays
    std::unique_ptr<Line> line;        ///< null: the line stays
  };
  [[nodiscard]] Expected<Change, std::string> prepare(const config::GliderEntry& entry);
  void apply(Change change);
  /// The missions in force, first the one that begins.
  void fly(std::vector<mission::MissionText> chain, const std::string& by);
  /// Looks for new forecast files.
  void look_at_forecast() { forecast_.look(); }

  [[nodiscard]] const config::GliderEntry& entry() const { return entry_; }
  [[nodiscard]] const mission::Pilot& pilot() const { return pilot_; }
  /// Nothing is awaited: no plan, verdict, emission or forecast.
  [[nodiscard]] bool quiet() const;

 private:
  // the line
  [[nodiscard]] std::unique_ptr<Line> line_of(const config::GliderEntry& entry);
  void opened(std::uint64_t connection, std::string_view peer, bool replaced);
  void received(std::string_view bytes);
  void closed(std::string_view reason);
  void hear(const protocol::DialogEvent& event);
  void hear_name(const std::string& name);
  void hear_block(const protocol::SurfaceBlock& block);
  void flush_when_idle();
  void tell_unused();

  // the pilot
  void feed(decltype(mission::Event::what) what);
  void perform(const mission::Effects& effects);
  void carry_out(const mission::BeginPlanning& e);
  void carry_out(const mission::StopPlanning& e);
  void carry_out(const mission::Verify& e);
  void carry_out(const mission::Emit& e);
  void carry_out(const mission::InspectFolder& e);
  void carry_out(const mission::SetTimer& e);
  void carry_out(const mission::CancelTimer& e);
  void carry_out(const mission::Say& e);
  void carry_out(const mission::Record& e);
  static mission::EmissionEnded ended(const Emission& emission, const std::string& surfacing);
  void judged(std::uint64_t request, std::uint64_t number, const world::ProcessResult& result);
  void plan_waiting();
  [[nodiscard]] mission::FolderSeen look_into_folder();
  void watch_folder();
  /// What the forecast in use said of the dive that this surfacing ends.
  void add_forecast_of_dive(mission::SurfacingHeard& heard) const;
  void follow_mission();
  void tell_water();
  [[nodiscard]] verify::VerifyRequest verify_request(const mission::Verify& e) const;
  void note(RecordType type, const std::string& payload);

  config::GliderEntry entry_;
  Desk desk_;
  mission::Pilot pilot_;
  std::unique_ptr<Emitter> emitter_;
  ForecastWatch forecast_;
  std::unique_ptr<Line> line_;
  protocol::DialogReader reader_;
  protocol::DialogCounts told_;  ///< what was said of this connection's lines
  std::string name_;             ///< heard on this connection
  bool connected_{}, stepping_{}, mute_{};
  std::uint64_t bytes_{};
  world::TimerId idle_timer_{}, folder_timer_{};
  bool watching_folder_{};
  std::string glanced_{"?"};  ///< at the to-glider folder, when it was looked into last; "?": not yet
  std::vector<decltype(mission::Event::what)> waiting_;

  std::shared_ptr<const ChartSource> chart_;
  std::optional<ChartOrder> chart_for_;                   ///< what the chart was loaded for; none: to be loaded anew
  std::optional<mission::BeginPlanning> planning_waits_;  ///< for its forecast
  struct Asked {
    std::uint64_t ticket{};
    std::shared_ptr<const OceanSource> ocean;
    std::shared_ptr<const ChartSource> chart;
  };
  std::map<std::uint64_t, Asked> asked_;       ///< by request
  std::map<std::string, std::string> staged_;  ///< staged file by the hash of its bytes
  std::uint64_t staged_count_{}, pending_{};
  std::map<mission::Timer, world::TimerId> timers_;
  std::shared_ptr<bool> alive_;
};

}  // namespace glidehelm::daemon
