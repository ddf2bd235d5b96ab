#include "daemon/event_json.hpp"

#include <array>
#include <type_traits>

#include "config/mission.hpp"
#include "daemon/verify/values_json.hpp"

// The members of each type stand in its own namespace, where the shared JSON of values finds them.
namespace glidehelm::ocean {
template <class F>
void members(WaterLayer& l, F&& f) {
  f("depth_m", l.depth), f("temperature_c", l.temperature_c), f("salinity", l.salinity);
}
}  // namespace glidehelm::ocean

namespace glidehelm::vehicle {
template <class F>
void members(Stint& s, F&& f) {
  f("dive", s.dive), f("surface", s.surface), f("dive_s", s.dive_s), f("surface_s", s.surface_s),
      f("heading", s.heading);
  f("dac", s.dac), f("arrives", s.arrives), f("steering_error_m", s.steering_error);
}
}  // namespace glidehelm::vehicle

namespace glidehelm {
inline nlohmann::json write(Heading h) { return values::write(h.from_north()); }
inline void read(const nlohmann::json& j, Heading& h) {
  Radians r;
  values::read(j, r);
  h = Heading{r};
}
}  // namespace glidehelm

namespace glidehelm::vehicle {
inline nlohmann::json write(MotionModel m) { return static_cast<int>(m); }
inline void read(const nlohmann::json& j, MotionModel& m) { values::read_enum(j, m, MotionModel::yo_yo); }
}  // namespace glidehelm::vehicle

namespace glidehelm::planning {
inline nlohmann::json write(PlanStatus s) { return static_cast<int>(s); }
inline void read(const nlohmann::json& j, PlanStatus& s) { values::read_enum(j, s, PlanStatus::closest_approach); }

template <class F>
void members(Statistics& s, F&& f) {
  f("expansions", s.expansions), f("cost_evaluations", s.cost_evaluations),
      f("current_evaluations", s.current_evaluations);
}
template <class F>
void members(Plan& p, F&& f) {
  f("method", p.method), f("status", p.status), f("stints", p.stints), f("arrival_s", p.arrival_s),
      f("remaining_m", p.remaining);
  f("reason", p.reason), f("statistics", p.statistics), f("cut_at", p.cut_at);
}
template <class F>
void members(PointGoal& g, F&& f) {
  f("at", g.at), f("radius_m", g.radius);
}
template <class F>
void members(Departure& d, F&& f) {
  f("fix", d.fix), f("fix_s", d.fix_s);
}
inline nlohmann::json write(GridKind k) { return static_cast<int>(k); }
inline void read(const nlohmann::json& j, GridKind& k) { values::read_enum(j, k, GridKind::triangular); }
inline nlohmann::json write(Heuristic h) { return static_cast<int>(h); }
inline void read(const nlohmann::json& j, Heuristic& h) { values::read_enum(j, h, Heuristic::cost_to_go); }
inline nlohmann::json write(Weighting w) { return static_cast<int>(w); }
inline void read(const nlohmann::json& j, Weighting& w) { values::read_enum(j, w, Weighting::by_depth); }
/// Null: the least time; else the epoch second of the least distance.
inline nlohmann::json write(const Objective& o) {
  const auto* least = std::get_if<MinDistanceAt>(&o);
  return least != nullptr ? nlohmann::json(least->epoch_s) : nlohmann::json(nullptr);
}
inline void read(const nlohmann::json& j, Objective& o) {
  if (j.is_null())
    o = MinTime{};
  else
    o = MinDistanceAt{j.get<double>()};
}
template <class F>
void members(LatticeChoice& l, F&& f) {
  f("neighbours", l.neighbours), f("radius", l.radius), f("grid", l.grid);
}
template <class F>
void members(Guidance& g, F&& f) {
  f("heuristic", g.heuristic), f("weighting", g.weighting), f("weight", g.weight);
}
template <class F>
void members(SectorGrid& g, F&& f) {
  f("sectors", g.sectors), f("spacing_m", g.spacing);
}
template <class F>
void members(Problem& p, F&& f) {
  f("start", p.start), f("goal", std::get<PointGoal>(p.goal)), f("glider", p.glider), f("schedule", p.schedule);
  f("believed_current", p.believed_current), f("horizon_s", p.horizon_s), f("coast_margin_m", p.coast_margin);
  f("headings", p.headings), f("cell_m", p.cell), f("seed", p.seed), f("lattice", p.lattice);
  f("sector_grid", p.sector_grid), f("guidance", p.guidance);
  f("objective", p.objective);
}
}  // namespace glidehelm::planning

namespace glidehelm::model {
template <class F>
void members(WaypointList& l, F&& f) {
  f("points", l.points), f("radius_m", l.radius), f("at_end", l.at_end);
}
template <class F>
void members(Refusal& r, F&& f) {
  f("rule", r.rule), f("reason", r.reason), f("glider", r.glider), f("heard_ms", r.heard), f("lat_ddmm", r.lat_ddmm),
      f("lon_ddmm", r.lon_ddmm);
}
}  // namespace glidehelm::model

namespace glidehelm::mission {

using nlohmann::json;

template <class E>
requires std::is_enum_v<E> json write(E e) { return static_cast<int>(e); }
inline void read(const json& j, EmissionEnded::Outcome& o) { values::read_enum(j, o, EmissionEnded::Outcome::unknown); }
inline void read(const json& j, FolderSeen::Found& o) { values::read_enum(j, o, FolderSeen::Found::unreadable); }
inline void read(const json& j, Timer& o) { values::read_enum(j, o, Timer::late_page); }
inline void read(const json& j, PlanningRequest::Purpose& o) {
  values::read_enum(j, o, PlanningRequest::Purpose::station);
}

inline json write(const MissionText& text) { return {{"yaml", values::write(text.yaml)}, {"sha256", text.sha256}}; }
inline void read(const json& j, MissionText& text) {
  values::read(j.at("yaml"), text.yaml);
  text.sha256 = j.at("sha256").get<std::string>();
  const auto nothing = [](const std::string& path) -> Expected<std::string, config::Unreadable> {
    return unexpected(config::Unreadable{path + " is not part of the journal"});
  };
  auto mission = config::read_mission(text.yaml, "mission of the journal", nothing);
  if (!mission) throw std::runtime_error(mission.error().front().message());
  text.mission = std::move(mission).value();
}

template <class F>
void members(Moment& m, F&& f) {
  f("utc_ms", m.utc), f("tick_ms", m.tick);
}
template <class F>
void members(SourceShare& s, F&& f) {
  f("source", s.source), f("share", s.share);
}
template <class F>
void members(SurfacingHeard& e, F&& f) {
  f("surfacing", e.surfacing), f("coast_distance_m", e.coast_distance), f("forecast", e.forecast);
  f("shares", e.shares), f("extrapolated", e.extrapolated);
}
template <class F>
void members(FixRefused& e, F&& f) {
  f("refusal", e.refusal);
}
template <class F>
void members(WindowHeard& e, F&& f) {
  f("until_diving_s", e.until_diving);
}
template <class F>
void members(WindowExtended& e, F&& f) {
  f("by_s", e.by);
}
template <class F>
void members(DiveBegan&, F&&) {}
template <class F>
void members(TransferHeard& e, F&& f) {
  f("file", e.file), f("ended", e.ended);
}
template <class F>
void members(TransferFailed& e, F&& f) {
  f("file", e.file);
}
template <class F>
void members(ListReread&, F&&) {}
template <class F>
void members(Candidate& c, F&& f) {
  f("request", c.request), f("number", c.number), f("plan", c.plan), f("list", c.list), f("promise", c.promise);
  f("file_name", c.file_name), f("file_bytes", c.file_bytes), f("horizon_s", c.horizon_s), f("forecast", c.forecast);
}
template <class F>
void members(CandidateFound& e, F&& f) {
  f("candidate", e.candidate);
}
template <class F>
void members(PlanningEnded& e, F&& f) {
  f("request", e.request), f("problem", e.problem);
}
template <class F>
void members(Judged& e, F&& f) {
  f("request", e.request), f("number", e.number), f("verdict", e.verdict), f("failure", e.failure);
}
template <class F>
void members(EmissionEnded& e, F&& f) {
  f("outcome", e.outcome), f("surfacing", e.surfacing), f("detail", e.detail);
}
template <class F>
void members(FolderSeen& e, F&& f) {
  f("found", e.found), f("detail", e.detail);
}
template <class F>
void members(TimerFired& e, F&& f) {
  f("timer", e.timer), f("serial", e.serial);
}
template <class F>
void members(MissionChanged& e, F&& f) {
  f("chain", e.chain), f("clock_skew_ok", e.clock_skew_ok), f("by", e.by);
}
template <class F>
void members(Restarted& e, F&& f) {
  f("emission", e.emission);
}

template <class F>
void members(ForecastWater& e, F&& f) {
  f("layers", e.layers), f("words", e.words);
}

template <class F>
void members(QueuedFile& q, F&& f) {
  f("surfacing", q.surfacing), f("name", q.name), f("bytes", q.bytes), f("list", q.list);
}
template <class F>
void members(PlanningRequest& r, F&& f) {
  f("id", r.id), f("surfacing", r.surfacing), f("purpose", r.purpose), f("problem", r.problem), f("method", r.method),
      f("slot", r.slot);
  f("max_waypoints", r.max_waypoints), f("list_radius_m", r.list_radius), f("at_end", r.at_end), f("stamp_ms", r.stamp);
  f("horizon_wanted_s", r.horizon_wanted), f("correction", r.correction), f("motion", r.motion), f("queued", r.queued);
}
template <class F>
void members(BeginPlanning& e, F&& f) {
  f("request", e.request);
}
template <class F>
void members(StopPlanning& e, F&& f) {
  f("request", e.request);
}
template <class F>
void members(Verify& e, F&& f) {
  f("request", e.request), f("number", e.number), f("dossier", e.dossier);
}
template <class F>
void members(InspectFolder&, F&&) {}
template <class F>
void members(SetTimer& e, F&& f) {
  f("timer", e.timer), f("serial", e.serial), f("at_ms", e.at);
}
template <class F>
void members(CancelTimer& e, F&& f) {
  f("timer", e.timer);
}
template <class F>
void members(Say& e, F&& f) {
  f("level", e.level), f("code", e.code), f("text", e.text);
}
template <class F>
void members(Record& e, F&& f) {
  f("kind", e.kind), f("surfacing", e.surfacing), f("text", e.text);
}
inline json write(const Emit& e) {
  return {{"name", e.file.name()},
          {"sha256", e.file.verdict().of.hex()},
          {"bytes", values::write(e.file.bytes())},
          {"surfacing", e.surfacing},
          {"plan_id", e.plan_id},
          {"deadline_ms", e.deadline.time_since_epoch().count()},
          {"replaces", e.replaces}};
}

}  // namespace glidehelm::mission

namespace glidehelm::daemon {

namespace {

using nlohmann::json;

/// The name of each alternative in the journal: never change one.
constexpr std::array<const char*, 17> kEventNames{
    "surfacing_heard", "fix_refused", "window_heard",    "window_extended", "dive_began",    "transfer_heard",
    "transfer_failed", "list_reread", "candidate",       "planning_ended",  "judged",        "emission_ended",
    "folder_seen",     "timer_fired", "mission_changed", "restarted",       "forecast_water"};
constexpr std::array<const char*, 9> kEffectNames{"begin_planning", "stop_planning", "verify",       "emit",
                                                  "inspect_folder", "set_timer",     "cancel_timer", "say",
                                                  "record"};
static_assert(kEventNames.size() == std::variant_size_v<decltype(mission::Event::what)>);
static_assert(kEffectNames.size() == std::variant_size_v<mission::Effect>);

/// Members that an event did not have from the beginning, and what its older records mean by leaving them out: a journal replays
/// to the same bytes whatever version wrote it. Whoever adds a member to an event adds its line here.
struct Newer {
  const char* event;
  const char* member;  ///< JSON pointer from the event
  json meant;
};
const std::vector<Newer>& newer_members() {
  static const std::vector<Newer> kNewer{{"surfacing_heard", "/forecast", nullptr},
                                         {"surfacing_heard", "/shares", json::array()},
                                         {"surfacing_heard", "/extrapolated", false}};
  return kNewer;
}

json completed(const std::string& event, json what) {
  for (const auto& newer : newer_members()) {
    const json::json_pointer member{newer.member};
    if (event == newer.event && what.is_object() && !what.contains(member)) what[member] = newer.meant;
  }
  return what;
}

/// Reads the alternative of that name into the variant.
template <std::size_t I = 0, class Variant>
void read_alternative(const json& j, std::string_view name, Variant& value) {
  if constexpr (I == std::variant_size_v<Variant>) {
    throw std::runtime_error("unknown event " + std::string{name});
  } else {
    if (name != kEventNames[I]) {
      read_alternative<I + 1>(j, name, value);
      return;
    }
    std::variant_alternative_t<I, Variant> alternative{};
    using values::read;
    read(j, alternative);
    value = std::move(alternative);
  }
}

}  // namespace

std::string event_json(std::string_view glider, const mission::Event& event) {
  json j = std::visit([](const auto& what) -> json { return values::write(what); }, event.what);
  return json{{"glider", glider},
              {"now", values::write(event.now)},
              {"event", kEventNames[event.what.index()]},
              {"what", std::move(j)}}
      .dump();
}

Expected<JournalledEvent, std::string> event_from_json(std::string_view text) {
  try {
    const auto j = json::parse(text);
    JournalledEvent result;
    result.glider = j.at("glider").get<std::string>();
    values::read(j.at("now"), result.event.now);
    const auto name = j.at("event").get<std::string>();
    read_alternative(completed(name, j.at("what")), name, result.event.what);
    return result;
  } catch (const std::exception& e) {
    return unexpected(std::string{e.what()});
  }
}

std::string effect_json(const mission::Effect& effect) {
  json j = std::visit(
      [](const auto& what) -> json {
        if constexpr (std::is_same_v<std::decay_t<decltype(what)>, mission::Emit>)
          return mission::write(what);
        else
          return values::write(what);
      },
      effect);
  return json{{"effect", kEffectNames[effect.index()]}, {"what", std::move(j)}}.dump();
}

}  // namespace glidehelm::daemon
