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
    auto [emission, closed, remove] = settle(intent);
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
    if (closed && !remove.empty()) discard(remove);
    const bool ends = emission.fatal;
    settled.push_back({intent.surfacing, std::move(emission)});
    if (ends) return settled;
  }
  if (const auto names = stage_->list())
    for (const auto& name : *names)
      if (is_staged_name(name) && std::find(needed.begin(), needed.end(), name) == needed.end()) discard(name);
  return settled;
}

Emitter::Settled Emitter::settle(Open intent) {
  const auto target = look(*target_, intent.name);
  auto staged = look(*stage_, intent.staged);
  if (staged.what == Found::What::absent) {  // kept aside when the way back failed
    const auto aside = aside_of(intent.staged);
    if (const auto kept = look(*stage_, aside); kept.what != Found::What::absent) {
      staged = kept;
      intent.staged = aside;
    }
  }
  for (const Found* found : {&target, static_cast<const Found*>(&staged)})
    if (found->what == Found::What::problem) return {{Outcome::unknown, found->problem, false}, false, ""};
  const auto is_ours = [&](const Found& found) {
    return found.is(intent.wanted) || (intent.replaced && found.is(*intent.replaced));
  };
  const bool staged_is_foreign = staged.what != Found::What::absent && !is_ours(staged);
  // An exchange had met somebody else's file, and the crash or an error came before it was back.
  if (is_ours(target) && staged_is_foreign) {
    const auto back = put_back(intent.staged, intent.name, target.hash);
    return {back, back.outcome != Outcome::unknown, intent.staged};
  }
  Settled settled =
      target.is(intent.wanted)   ? settle_visible(intent)
      : staged.is(intent.wanted) ? Settled{{Outcome::aborted, "the crash came before the file was visible", false}}
      : is_ours(target)          ? Settled{{Outcome::aborted,
                                            "the crash came before the file was visible; the one before it lies there", false}}
                                 : settle_gone(intent, target, staged_is_foreign);
  if (!staged_is_foreign) settled.remove = intent.staged;
  return settled;
}

/// Our file lies in to-glider, and after an exchange the one that it replaced under the staged name.
Emitter::Settled Emitter::settle_visible(const Open& intent) {
  if (const auto problem = sync_both())
    return {{Outcome::unknown, problem->message(), problem->failed_sync()}, false, ""};
  ours_[intent.name] = intent.wanted;
  return {{Outcome::queued, fmt::format("{} was visible before the crash and is queued", intent.name), false}};
}

/// Our file is in neither folder, and neither is the one that it was to replace.
Emitter::Settled Emitter::settle_gone(const Open& intent, const Found& target, bool staged_is_foreign) {
  std::string more;
  if (staged_is_foreign) {  // ours was taken before theirs could be put back
    const auto back = target.what == Found::What::absent
                          ? stage_->rename_new(intent.staged, *target_, intent.name)
                          : world::FileResult<Done>{unexpected(world::FileError{"rename", intent.name, EEXIST})};
    if (const auto problem = sync_both())
      return {{Outcome::unknown, problem->message(), problem->failed_sync()}, false, ""};
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
