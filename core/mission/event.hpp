#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/mission/delivery.hpp"
#include "core/mission/mission.hpp"
#include "core/mission/source_errors.hpp"
#include "core/model/surfacing.hpp"
#include "core/ocean/corrected.hpp"
#include "core/planning/planner.hpp"
#include "core/safety/judge.hpp"

/// What happens to a pilot and what a pilot wants: plain values, so that a mission can be journalled and replayed to
/// the same bytes.
namespace glidehelm::mission {

/// The two clocks at the moment of an event. A pilot reads no other.
struct Moment {
  Instant utc;
  Tick tick;
  friend bool operator==(const Moment&, const Moment&) = default;
};

/// Everything a planning worker needs beside the forecast and the chart: request in, candidates out.
struct PlanningRequest {
  enum class Purpose { goal, station };
  std::uint64_t id{};
  std::string surfacing;  ///< key of the surfacing that the file will answer
  Purpose purpose{Purpose::goal};
  planning::Problem problem;
  std::string method;  ///< of planning.method
  int slot{10};
  int max_waypoints{8};
  std::optional<Metres> list_radius;
  model::AtEnd at_end{model::AtEnd::loop};
  Instant stamp;                                     ///< for the file's comment
  Seconds horizon_wanted{};                          ///< 0 = automatic: 3 × the still-water time
  std::optional<ocean::LocalCorrection> correction;  ///< of the forecast, by the currents that the glider measured
  vehicle::MotionModel motion{};  ///< of the plan; what is promised is flown in all depths either way
  /// A file of ours that still lies in to-glider: it is flown from this fix and given as the first candidate, its bytes
  /// unchanged, so that the verifier judges it for this surfacing.
  std::optional<QueuedFile> queued;
  friend bool operator==(const PlanningRequest&, const PlanningRequest&) = default;
};

/// A plan with the file that flies it and what that file promises.
struct Candidate {
  std::uint64_t request{};
  std::uint64_t number{};  ///< within the request, from 1; higher is better
  planning::Plan plan;
  model::WaypointList list;
  safety::Promise promise;
  std::string file_name, file_bytes;
  double horizon_s{};    ///< epoch second to which plan and list were flown
  std::string forecast;  ///< provenance: cycle and hash
  friend bool operator==(const Candidate&, const Candidate&) = default;
};

// ---- events ---------------------------------------------------------------------------------------------------------

/// A fix passed the rules that need no memory. `coast_distance`: negative inland; none without a coastline. `forecast`:
/// the uncorrected forecast's mean along the dive that ended here (from `Pilot::dive_under_way`), none without; `shares`: of its sources,
/// `extrapolated`: a value was borrowed, both at the middle of the dive.
struct SurfacingHeard {
  model::Surfacing surfacing;
  std::optional<Metres> coast_distance;
  std::optional<Current> forecast{};
  std::vector<SourceShare> shares{};
  bool extrapolated{};
  friend bool operator==(const SurfacingHeard&, const SurfacingHeard&) = default;
};
struct FixRefused {
  model::Refusal refusal;
  friend bool operator==(const FixRefused&, const FixRefused&) = default;
};
/// `Time until diving` was printed, or Ctrl-E extended the window.
struct WindowHeard {
  Seconds until_diving{};
  friend bool operator==(const WindowHeard&, const WindowHeard&) = default;
};
struct WindowExtended {
  Seconds by{300};
  friend bool operator==(const WindowExtended&, const WindowExtended&) = default;
};
/// The dialog says that the glider goes under.
struct DiveBegan {
  friend bool operator==(DiveBegan, DiveBegan) = default;
};
/// A transfer to the glider began or ended; `file` as the dialog names it.
struct TransferHeard {
  std::string file;
  bool ended{};
  friend bool operator==(const TransferHeard&, const TransferHeard&) = default;
};
/// A transfer of `file` to the glider ended without the whole file: half of it may be on board.
struct TransferFailed {
  std::string file;
  friend bool operator==(const TransferFailed&, const TransferFailed&) = default;
};
struct ListReread {
  friend bool operator==(ListReread, ListReread) = default;
};
struct CandidateFound {
  Candidate candidate;
  friend bool operator==(const CandidateFound&, const CandidateFound&) = default;
};
/// Nothing better is left to try; `problem` says why when there was nothing at all.
struct PlanningEnded {
  std::uint64_t request{};
  std::string problem;
  friend bool operator==(const PlanningEnded&, const PlanningEnded&) = default;
};
/// The verifier's answer, or why there is none (then the file counts as refused).
struct Judged {
  std::uint64_t request{}, number{};
  std::optional<safety::Verdict> verdict;
  std::string failure;
  friend bool operator==(const Judged&, const Judged&) = default;
};
struct EmissionEnded {
  enum class Outcome { queued, foreign_file, late, aborted, unknown };
  Outcome outcome{};
  std::string surfacing, detail;
  friend bool operator==(const EmissionEnded&, const EmissionEnded&) = default;
};
/// What lies in `to-glider` under our name. `detail` says who and when for a foreign file.
struct FolderSeen {
  enum class Found { nothing, ours, foreign, unreadable };
  Found found{};
  std::string detail;
  friend bool operator==(const FolderSeen&, const FolderSeen&) = default;
};
/// The forecast in use has this water, or none (no layers). For a body that the mission gives no water; before the plans that are made in it.
struct ForecastWater {
  std::vector<ocean::WaterLayer> layers;
  std::string words;  ///< of which variables, or why there is none
  friend bool operator==(const ForecastWater&, const ForecastWater&) = default;
};
enum class Timer { budget, deadline, late_note, late_alert, late_page };
struct TimerFired {
  Timer timer{};
  std::uint64_t serial{};  ///< of the SetTimer that asked for it; an older one is ignored
  friend bool operator==(const TimerFired&, const TimerFired&) = default;
};
/// A mission with the file it was read from, so that a replay of the journal reads it again.
struct MissionText {
  Mission mission;
  std::string yaml;    ///< the mission in full, every default written out
  std::string sha256;  ///< of the file as the pilot wrote it
  friend bool operator==(const MissionText&, const MissionText&) = default;
};
/// A reload, or the start: in force at the next surfacing.
struct MissionChanged {
  std::vector<MissionText> chain;  ///< the first begins, the next takes over at its goal (`after_goal`); empty: none
  bool clock_skew_ok{};
  std::string by;  ///< "start", "SIGHUP", "uid 1000"
  friend bool operator==(const MissionChanged&, const MissionChanged&) = default;
};
/// The process starts again and this journal was replayed: what became of an emission that was under way.
struct Restarted {
  std::optional<EmissionEnded> emission;
  friend bool operator==(const Restarted&, const Restarted&) = default;
};

struct Event {
  Moment now;
  std::variant<SurfacingHeard, FixRefused, WindowHeard, WindowExtended, DiveBegan, TransferHeard, TransferFailed,
               ListReread, CandidateFound, PlanningEnded, Judged, EmissionEnded, FolderSeen, TimerFired, MissionChanged,
               Restarted, ForecastWater>
      what;
  friend bool operator==(const Event&, const Event&) = default;
};

// ---- effects --------------------------------------------------------------------------------------------------------

struct BeginPlanning {
  PlanningRequest request;
  friend bool operator==(const BeginPlanning&, const BeginPlanning&) = default;
};
/// No answer to this request is wanted any more.
struct StopPlanning {
  std::uint64_t request{};
  friend bool operator==(const StopPlanning&, const StopPlanning&) = default;
};
/// Stage the dossier's bytes and have them judged.
struct Verify {
  std::uint64_t request{}, number{};
  safety::Dossier dossier;
  friend bool operator==(const Verify&, const Verify&) = default;
};
/// Make the file visible, once. Nothing but a VerifiedFile can be in here.
struct Emit {
  safety::VerifiedFile file;
  std::string surfacing;  ///< key: at most one emission (and its recorded replacements) per key
  std::string plan_id;
  Tick deadline;
  bool replaces{};  ///< exchange for our own file that is still queued
  friend bool operator==(const Emit&, const Emit&) = default;
};
struct InspectFolder {
  friend bool operator==(InspectFolder, InspectFolder) = default;
};
/// Replaces a timer of the same kind.
struct SetTimer {
  Timer timer{};
  std::uint64_t serial{};
  Tick at;
  friend bool operator==(const SetTimer&, const SetTimer&) = default;
};
struct CancelTimer {
  Timer timer{};
  friend bool operator==(const CancelTimer&, const CancelTimer&) = default;
};
enum class Level { info, note, alert, page, clear };
/// One fact of the mission in the words of a pilot: a log line, and for note and above an alert.
/// `code` is stable for scripts and for all-clears: "late", "foreign-file", "refused-fix", …
struct Say {
  Level level{};
  std::string code, text;
  friend bool operator==(const Say&, const Say&) = default;
};
/// A decision to keep: appended to the journal beside the event that led to it.
struct Record {
  std::string kind;       ///< "surfacing", "refusal", "duplicate", "plan", "verdict", "emission", "keep", "mission"
  std::string surfacing;  ///< key, empty when there is none
  std::string text;
  friend bool operator==(const Record&, const Record&) = default;
};

using Effect =
    std::variant<BeginPlanning, StopPlanning, Verify, Emit, InspectFolder, SetTimer, CancelTimer, Say, Record>;
using Effects = std::vector<Effect>;

}  // namespace glidehelm::mission
