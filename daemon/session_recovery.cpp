#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "daemon/event_json.hpp"
#include "daemon/session.hpp"
#include "daemon/world/program_version.hpp"

// How one glider's session comes back from the journal.
namespace glidehelm::daemon {

namespace {

/// The version of the program that wrote the records behind this one; empty in journals of before it was recorded.
std::string version_in(const JournalRecord& epoch) {
  const auto json = nlohmann::json::parse(epoch.payload, nullptr, false);
  return json.is_object() && json.contains("version") && json["version"].is_string()
             ? json["version"].get<std::string>()
             : std::string{};
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

void Session::recover(const std::vector<JournalRecord>& past) {
  const auto& clock = desk_.world.clock;
  std::uint64_t replayed = 0;
  std::string writer;
  for (const auto& record : past) {
    if (record.type == RecordType::epoch) writer = version_in(record);
    if (record.type != RecordType::event) continue;
    auto event = event_from_json(record.payload);
    if (!event) {
      desk_.log.alert(entry_.name,
                      fmt::format("record {} of the journal, written by {}, cannot be replayed by this {}: {}",
                                  record.sequence, writer.empty() ? "an unknown version" : "version " + writer,
                                  world::program_version(), event.error()));
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
