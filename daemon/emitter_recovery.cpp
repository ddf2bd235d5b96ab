#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "daemon/emitter.hpp"

// trust.md 6.2. What is durable decides: the INTENTs of the journal, and what lies in the two folders now. A plan is never
// finished from the journal; while the window is open a new one is made.

namespace glidehelm::daemon {

namespace {

using Json = nlohmann::ordered_json;
using Outcome = Emission::Outcome;

std::string string_of(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

std::uint64_t number_of(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

/// A staged file of ours, by its name: `.goto_lNN.ma.EPOCH-NUMBER.tmp`.
bool is_staged_name(std::string_view name) { return name.rfind(".goto_l", 0) == 0 && name.ends_with(".tmp"); }

}  // namespace

/// INTENTs without an end, in order. On the way: which file was made visible last, by name.
std::vector<Emitter::Open> Emitter::read_past(const std::string& glider, const std::vector<JournalRecord>& past) {
  std::map<std::uint64_t, Open> open;
  for (const auto& record : past) {
    if (record.type != RecordType::intent && record.type != RecordType::committed &&
        record.type != RecordType::aborted && record.type != RecordType::recovered)
      continue;
    const auto json = Json::parse(record.payload, nullptr, false);
    if (!json.is_object() || string_of(json, "glider") != glider) continue;
    if (record.type == RecordType::intent) {
      Open intent{record.sequence, string_of(json, "surfacing"), string_of(json, "name"), string_of(json, "staged"), {},
                  std::nullopt};
      if (!Sha256::from_hex(string_of(json, "sha256"), intent.wanted)) continue;
      if (Sha256 before; Sha256::from_hex(string_of(json, "replaces"), before)) intent.replaced = before;
      open[record.sequence] = std::move(intent);
      continue;
    }
    const auto ended = open.find(number_of(json, "intent"));
    if (ended == open.end()) continue;
    if (record.type == RecordType::committed) ours_[ended->second.name] = ended->second.wanted;
    open.erase(ended);
  }
  std::vector<Open> result;
  for (auto& [sequence, intent] : open) result.push_back(std::move(intent));
  return result;
}

std::vector<RecoveredEmission> Emitter::recover(const std::string& glider, const std::vector<JournalRecord>& past,
                                                Journal& journal, Instant utc, Tick now) {
  std::vector<RecoveredEmission> settled;
  std::vector<std::string> needed;  // staged files of INTENTs that stay open
  for (const auto& intent : read_past(glider, past)) {
    auto [emission, closed] = settle(intent);
    if (closed) {
      const auto type = emission.outcome == Outcome::queued    ? RecordType::committed
                        : emission.outcome == Outcome::unknown ? RecordType::recovered
                                                               : RecordType::aborted;
      const Json end{{"glider", glider},
                     {"surfacing", intent.surfacing},
                     {"intent", intent.sequence},
                     {"why", emission.detail},
                     {"folder_epoch", epoch_}};
      const auto written = journal.append(type, end.dump(-1, ' ', false, Json::error_handler_t::replace), utc, now,
                                          Journal::Durable::yes);
      if (!written) {
        emission.fatal = emission.fatal || written.error().fatal;
        closed = false;
      }
    }
    if (!closed) needed.push_back(intent.staged);
    const bool ends = emission.fatal;
    settled.push_back({intent.surfacing, std::move(emission)});
    if (ends) return settled;
  }
  if (const auto names = stage_->list())
    for (const auto& name : *names)
      if (is_staged_name(name) && std::find(needed.begin(), needed.end(), name) == needed.end()) discard(name);
  return settled;
}

Emitter::Settled Emitter::settle(const Open& intent) {
  const auto target = look(*target_, intent.name);
  const auto staged = look(*stage_, intent.staged);
  for (const auto* found : {&target, &staged})
    if (found->what == Found::What::problem) return {{Outcome::unknown, found->problem, false}, false};
  if (target.is(intent.wanted)) return settle_visible(intent, staged);
  // Still staged: it never was visible, or a file that it met was put back.
  if (staged.is(intent.wanted)) return {{Outcome::aborted, "the crash came before the file was visible", false}};
  return settle_gone(intent, target, staged);
}

/// Our file lies in to-glider. After an exchange the one that it replaced lies under the staged name; should that be
/// somebody else's, the crash came before it could be put back.
Emitter::Settled Emitter::settle_visible(const Open& intent, const Found& staged) {
  if (staged.what == Found::What::file && !staged.is(intent.wanted) &&
      !(intent.replaced && staged.is(*intent.replaced))) {
    const auto back = put_back(intent.staged, intent.name, intent.wanted);
    return {back, back.outcome != Outcome::unknown};
  }
  if (const auto problem = sync_both()) return {{Outcome::unknown, problem->message(), problem->failed_sync()}, false};
  ours_[intent.name] = intent.wanted;
  return {{Outcome::queued, fmt::format("{} was visible before the crash and is queued", intent.name), false}};
}

/// Our file is in neither folder.
Emitter::Settled Emitter::settle_gone(const Open& intent, const Found& target, const Found& staged) {
  if (intent.replaced && target.is(*intent.replaced))
    return {{Outcome::aborted, "the crash came before the file was visible; the one before it lies there", false}};
  std::string more;
  if (staged.what == Found::What::file && !(intent.replaced && staged.is(*intent.replaced))) {
    // The exchange had met somebody else's file, and then ours was taken: theirs goes back.
    const auto back = target.what == Found::What::absent
                          ? stage_->rename_new(intent.staged, *target_, intent.name)
                          : world::FileResult<Done>{unexpected(world::FileError{"rename", intent.name, EEXIST})};
    if (const auto problem = sync_both())
      return {{Outcome::unknown, problem->message(), problem->failed_sync()}, false};
    more = back ? "; a human's file that it had met was put back"
                : "; a human's file that it had met is " + stage_path_ + "/" + keep_aside(intent.staged);
  }
  if (target.what != Found::What::absent)
    return {{Outcome::foreign_file, intent.name + " was written by somebody else since the crash" + more, false}};
  return {{Outcome::unknown,
           "the file may have been taken between its rename and the crash; only the dialog's Waypoint: line will tell" +
               more,
           false}};
}

}  // namespace glidehelm::daemon
