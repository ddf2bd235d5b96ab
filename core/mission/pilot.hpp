#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/mission/event.hpp"
#include "core/mission/in_water.hpp"
#include "core/mission/learning.hpp"

namespace glidehelm::mission {

/// Where the answer to the current surfacing stands.
enum class Stage {
  idle,        ///< no surfacing is open
  planning,    ///< candidates are being made and judged
  proposed,    ///< approval.mode manual: a proven file waits, nothing is emitted
  emitting,    ///< the emission is under way
  queued,      ///< the file lies in to-glider
  kept,        ///< nothing is emitted for this surfacing; the reason was said
  stood_down,  ///< a human's file lies there: theirs wins
  dived,       ///< the window is over
};
std::string_view word(Stage stage);

/// The pilot of one glider: a value machine. `step` takes what happened and returns what to do; it never waits, reads,
/// writes or asks the time, so that a journal of events replays to the same effects, byte for byte.
///
/// What it promises (product.md 4, trust.md P1–P6): at most one emission per surfacing (a recorded replacement of our
/// own, still queued file apart); nothing is emitted unless a verifier accepted those bytes for the surfacing that is
/// current, before the deadline, after the at-surface block named the mission (unless emit_on: connection); a human's
/// file makes it stand down; every refusal and every `keep` says why.
///
/// What surfacings teach (`Learning`) is part of the value, and so is how far the last file has come (`FileOnItsWay`). A
/// plan and its verdict use what was known when the plan began.
class Pilot {
 public:
  explicit Pilot(std::string glider);
  Effects step(const Event& event);

  // What status pages ask; all derived from the events so far.
  [[nodiscard]] Stage stage() const { return stage_; }
  [[nodiscard]] const std::optional<model::Surfacing>& last() const { return last_; }
  [[nodiscard]] const std::string& surfacing_key() const { return key_; }
  [[nodiscard]] int surfacings() const { return count_; }
  [[nodiscard]] bool arrived() const { return arrived_; }
  [[nodiscard]] const std::optional<Mission>& mission() const { return mission_; }
  /// True while a planning answer, a verdict or an emission is awaited: the daemon is not quiescent.
  [[nodiscard]] bool awaits_answer() const;
  /// What plan, watch and margins use now.
  [[nodiscard]] const Learned& learned() const { return learned_; }
  /// The water of the forecast as it was heard last; none yet: nobody has told.
  [[nodiscard]] const std::optional<ForecastWater>& forecast_water() const {
    return water_waits_ ? water_waits_ : water_;
  }
  /// The file that was emitted last, and how far it has come.
  [[nodiscard]] const FileOnItsWay& file() const { return file_; }
  /// The dive that the next surfacing ends, for the forecast's mean along it; none before the first surfacing.
  [[nodiscard]] std::optional<Dive> dive_under_way() const;
  /// A window is open or a file of ours is queued: the folder must be looked at every second.
  [[nodiscard]] bool watches_folder() const;

 private:
  static constexpr Seconds kEmitBeforeDeadline{30};  // product.md 4.6
  static Tick later(Tick t, Seconds dt) { return t + std::chrono::duration_cast<Tick::duration>(dt); }

  struct Ranked {
    Candidate candidate;
    enum class Proof { none, asked, accepted, refused } proof{Proof::none};
    std::optional<safety::VerifiedFile> file;
  };

  void on(const SurfacingHeard& e);
  void on(const FixRefused& e);
  void on(const WindowHeard& e);
  void on(const WindowExtended& e);
  void on(const DiveBegan& e);
  void on(const TransferHeard& e);
  void on(const TransferFailed& e);
  void on(const ListReread& e);
  void on(const CandidateFound& e);
  void on(const PlanningEnded& e);
  void on(const Judged& e);
  void on(const EmissionEnded& e);
  void on(const FolderSeen& e);
  void on(const TimerFired& e);
  void on(const MissionChanged& e);
  void on(const Restarted& e);
  void on(const ForecastWater& e);

  // accepting a fix
  [[nodiscard]] bool is_duplicate(const model::Surfacing& s) const;
  [[nodiscard]] bool is_same_surfacing(const model::Surfacing& s) const;
  [[nodiscard]] std::optional<model::Refusal> objection(const SurfacingHeard& e);
  [[nodiscard]] std::optional<model::Refusal> jump(const model::Surfacing& s);
  void take_repeat(const model::Surfacing& s);
  [[nodiscard]] bool plan_again_for_water(const model::Surfacing& s);
  void plan_again();
  void open_surfacing(const SurfacingHeard& e);
  void take_later_fix(const model::Surfacing& s);
  void note_dialog(const model::Surfacing& s);
  void remember(const model::Surfacing& s);

  // learning (pilot_learning.cpp)
  void begin_learning(const SurfacingHeard& e);
  void learn_more(const model::Surfacing& s);
  void learn();
  void tell_learned();
  void set_mission(std::optional<Mission> mission);
  bool take_water(const ForecastWater& water);
  void tell_water(const InWater& vehicle);

  // after the emission (pilot_delivery.cpp)
  [[nodiscard]] bool is_of_our_name(const std::string& file) const;
  void hear_waypoint(const model::Surfacing& s);
  void tell_file(const std::string& code, const std::string& text, Level level = Level::info);
  [[nodiscard]] bool is_queued_file(const Candidate& candidate) const;
  void keep_queued_file();
  void warn_of_queued_file();
  void note_exchange();

  // answering it
  void begin_planning();
  [[nodiscard]] planning::Problem problem_now() const;
  void ask_verdict();
  [[nodiscard]] safety::Dossier dossier_for(const Candidate& candidate) const;
  void emit_if_due();
  [[nodiscard]] std::optional<std::string> reason_to_hold() const;
  void keep(const std::string& code, const std::string& why);
  void set_deadline(Tick deadline);
  [[nodiscard]] Ranked* best_proven();
  void take_over(const MissionChanged& change);
  void arrive_if_there(const model::Surfacing& s);
  void greet(const model::Surfacing& s);
  [[nodiscard]] std::string measured_text() const;

  // watching (pilot_watch.cpp)
  void expect_next();
  void expect_place();
  void watch_for_call();
  [[nodiscard]] std::string compared_with_expected(const model::Surfacing& s);
  void tell_far_off();
  [[nodiscard]] std::string overdue() const;

  // saying
  void say(Level level, std::string code, std::string text);
  void record(std::string kind, std::string text);
  void set_timer(Timer timer, Tick at);
  void cancel_timer(Timer timer);

  std::string glider_;
  std::vector<MissionText> chain_;        ///< missions in force: the first is flown, the others wait for its goal
  std::optional<Mission> mission_;        ///< the one that is flown, its body in the forecast's water
  std::optional<MissionChanged> change_;  ///< waits for the next surfacing
  bool skew_ok_{};
  std::optional<ForecastWater> water_;        ///< that the body of the mission is weighed in
  std::optional<ForecastWater> water_waits_;  ///< for the next surfacing

  Moment now_{};
  Effects out_;

  // the glider as far as known
  std::optional<model::Surfacing> last_;         ///< newest accepted fix
  std::deque<model::Surfacing> recent_;          ///< accepted fixes of the last surfacings, for S4
  std::optional<model::Surfacing> quarantined_;  ///< a jump that waits for a second fix to agree (S5)
  std::optional<Instant> dived_at_;              ///< when the dialog last said that the glider goes under
  std::optional<Current> believed_;              ///< measured DAC, true frame
  Learning learning_before_, learning_;          ///< before the surfacing that is open, and with it
  SurfacingSeen seen_;                           ///< the surfacing that is open or was the last
  Learned learned_, in_use_;                     ///< now, and as the current plan began
  Learned told_;                                 ///< as last said to the operator
  bool contradiction_told_{}, unknown_frame_told_{};
  int count_{};  ///< surfacings accepted
  bool arrived_{};

  // the surfacing that is open
  std::string key_, segment_;
  Stage stage_{Stage::idle};
  bool at_surface_seen_{}, mission_named_{};
  std::string wrong_mission_;
  Tick first_heard_{}, deadline_{};
  Instant deadline_utc_{};  ///< the same moment, for a restart: ticks of another boot mean nothing
  bool budget_over_{}, planning_over_{};
  std::uint64_t request_{};
  std::vector<Ranked> ranked_;
  std::string problem_;
  std::optional<GeoPoint> planned_from_;
  bool transfer_began_{}, replacing_{}, alerted_{};
  std::optional<model::Refusal> refused_;  ///< the last one, so that its reprints are not said again
  std::optional<std::string> skew_;

  // the file that was emitted last
  FileOnItsWay file_;
  std::optional<QueuedFile> emitting_;
  bool waypoint_told_{};
  bool failure_told_{};   ///< of the transfer that is or was under way
  bool half_on_board_{};  ///< the last transfer of a list failed, and none ended since

  // what was promised for the next one
  struct Expectation {
    GeoPoint at;
    Heading heading;
    double along{}, across{};  ///< standard deviations, metres, along and across the heading
  };
  std::optional<Expectation> expected_;
  std::optional<double> expected_s_;
  bool late_said_{}, far_off_said_{};
  std::optional<std::string> far_off_;  ///< waits for the proof that the glider flew our list

  std::uint64_t serials_[5]{};
};

}  // namespace glidehelm::mission
