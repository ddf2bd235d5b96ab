#include "daemon/emitter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <nlohmann/json.hpp>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "daemon/world/failpoint.hpp"

namespace glidehelm::daemon {

namespace {

using Json = nlohmann::ordered_json;
using Outcome = Emission::Outcome;

constexpr std::size_t kLargestForeign = 64U << 10;
constexpr const char* kStageName = ".glidehelm";
constexpr const char* kMarkerName = ".glidersim";
constexpr const char* kHoldName = "HOLD";

std::string parent_of(const std::string& path) {
  const auto slash = path.find_last_of('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

/// Names that the glider would take for our list: DOS knows no case.
bool is_slot_name(std::string_view found, std::string_view name) { return equal_without_case(found, name); }

}  // namespace

Expected<std::unique_ptr<Emitter>, std::string> Emitter::open(world::Files& files, const std::string& to_glider,
                                                              int slot, bool need_marker) {
  const auto wrong = [&](const std::string& what) { return unexpected("to_glider " + to_glider + ": " + what); };
  std::unique_ptr<Emitter> emitter{new Emitter};
  emitter->set_slot(slot);
  auto target = files.open_folder(to_glider);
  if (!target)
    return wrong(target.error().code == ELOOP || target.error().code == ENOTDIR
                     ? "is no folder (a symbolic link is not followed)"
                     : target.error().message());
  emitter->target_ = std::move(target).value();
  const auto target_stat = emitter->target_->stat_self();
  if (!target_stat) return wrong(target_stat.error().message());
  emitter->target_stat_ = *target_stat;
  const auto beside = parent_of(to_glider);
  if (need_marker && !files.stat(beside + "/" + kMarkerName))
    return wrong("the clock is simulated and glidersim did not make " + beside + " (no file " + kMarkerName +
                 " in it): nothing is written there");
  auto stage = files.make_folder(beside + "/" + kStageName, 0750);
  if (!stage) return wrong("the staging folder beside it cannot be made: " + stage.error().message());
  emitter->stage_ = std::move(stage).value();
  const auto stage_stat = emitter->stage_->stat_self();
  if (!stage_stat) return wrong(stage_stat.error().message());
  if (stage_stat->device != target_stat->device)
    return wrong("lies on another file system than " + emitter->stage_->path() +
                 ": a file cannot be moved between them in one step");
  auto lock = emitter->stage_->lock("lock");
  if (!lock)
    return wrong(lock.error().code == EAGAIN
                     ? "another process flies this glider (it holds " + emitter->stage_->path() + "/lock)"
                     : lock.error().message());
  emitter->lock_ = std::move(lock).value();
  // Can a file be moved in and out? Found out now, not at 3 a.m.
  static_cast<void>(emitter->stage_->unlink("probe"));
  if (auto probe = emitter->stage_->create("probe", "", 0640); !probe)
    return wrong("the staging folder is not writable: " + probe.error().message());
  const std::string probe_name = ".glidehelm-probe";
  auto moved = emitter->stage_->rename_new("probe", *emitter->target_, probe_name);
  if (!moved && moved.error().code == EEXIST) moved = Done{};
  if (!moved) {
    static_cast<void>(emitter->stage_->unlink("probe"));
    return wrong("a file cannot be moved into it: " + moved.error().message());
  }
  if (auto gone = emitter->target_->unlink(probe_name); !gone)
    return wrong("a file of ours cannot be removed from it: " + gone.error().message());
  static_cast<void>(emitter->stage_->unlink("probe"));
  return emitter;
}

void Emitter::set_slot(int slot) { name_ = fmt::format("goto_l{:02}.ma", slot); }

world::FileResult<std::string> Emitter::stage(std::string_view bytes, std::uint64_t number) {
  const auto staged = fmt::format(".{}.{}.tmp", name_, number);
  static_cast<void>(stage_->unlink(staged));  // left by a process that crashed with the same number
  if (auto made = stage_->create(staged, bytes, 0640); !made) return unexpected(made.error());
  return staged;
}

world::FileResult<std::unique_ptr<world::OpenFile>> Emitter::open_staged(const std::string& staged) {
  return stage_->open(staged);
}

void Emitter::discard(const std::string& staged) { static_cast<void>(stage_->unlink(staged)); }

std::optional<Sha256> Emitter::hash_in_target(std::string* problem) {
  const auto content = target_->read(name_, kLargestForeign);
  if (content) return Sha256::of(std::string_view{*content});
  if (problem != nullptr && content.error().code != ENOENT) *problem = content.error().message();
  return std::nullopt;
}

FolderView Emitter::inspect() {
  const auto names = target_->list();
  if (!names) return {FolderView::What::unreadable, names.error().message()};
  FolderView view;
  for (const auto& found : *names) {
    if (!is_slot_name(found, name_)) continue;
    const auto stat = target_->stat(found);
    std::string what = found;
    if (stat)
      what += fmt::format(" of uid {}, written {}", stat->owner,
                          utc_text(Instant{std::chrono::milliseconds{stat->modified_ns / 1'000'000}}));
    if (found == name_ && stat && stat->regular && stat->links == 1) {
      std::string problem;
      const auto hash = hash_in_target(&problem);
      if (hash && (hash == ours_ || std::find(ours_before_.begin(), ours_before_.end(), *hash) != ours_before_.end())) {
        if (view.what == FolderView::What::nothing) view = {FolderView::What::ours, what};
        continue;
      }
      if (hash) what += ", sha256 " + hash->hex().substr(0, 12);
    }
    view = {FolderView::What::foreign, what + " was not written by us"};
  }
  return view;
}

/// E5: everything that may have changed since the verdict, cheapest and last.
std::optional<std::string> Emitter::objection(const EmissionOrder& order, Tick now) {
  if (now >= order.deadline) return "the window is over";
  const auto here = target_->stat_self();
  if (!here || here->links == 0 || here->inode != target_stat_.inode || here->device != target_stat_.device)
    return "the to-glider folder was replaced";
  if (stage_->stat(kHoldName))
    return std::string{"the file "} + kHoldName + " in " + stage_->path() + " forbids every emission";
  if (transfer_open_ && order.replaces) return "a transfer to the glider has begun: nothing is exchanged any more";
  return std::nullopt;
}

Emission Emitter::emit(const safety::VerifiedFile& file, const std::string& staged, const EmissionOrder& order,
                       Journal& journal, Instant utc, Tick now) {
  if (file.name() != name_)
    return {Outcome::aborted, "the file is named " + file.name() + ", the slot's name is " + name_, false};
  const auto bytes = stage_->read(staged, kLargestForeign);
  if (!bytes || *bytes != file.bytes())
    return {Outcome::aborted, "the staged file is not the one that was judged", false};
  const auto before = inspect();
  if (before.what == FolderView::What::foreign) return {Outcome::foreign_file, before.detail, false};
  if (before.what == FolderView::What::unreadable) return {Outcome::aborted, before.detail, false};
  const bool exchange = before.what == FolderView::What::ours;

  Json intent{{"glider", order.glider},
              {"surfacing", order.surfacing},
              {"plan", order.plan_id},
              {"name", name_},
              {"length", file.bytes().size()},
              {"crc32c", crc32c(std::string_view{file.bytes()})},
              {"sha256", file.verdict().of.hex()},
              {"replaces", exchange && hash_in_target(nullptr) ? hash_in_target(nullptr)->hex() : "absent"},
              {"staged", staged},
              {"bytes", file.bytes()}};
  Json margins = Json::array();
  for (const auto& m : file.verdict().margins) margins.push_back({{"rule", m.rule}, {"holds", m.holds}});
  intent["margins"] = std::move(margins);
  world::failpoint("before_intent");
  const auto written = journal.append(RecordType::intent, intent.dump(), utc, now, Journal::Durable::yes);
  if (!written) return {Outcome::aborted, written.error().message, written.error().fatal};
  world::failpoint("after_intent");
  if (auto why = objection(order, now))
    return abort(journal, *written, order, {now >= order.deadline ? Outcome::late : Outcome::aborted, *why, false}, utc,
                 now);
  const auto visible = make_visible(file, staged, order, exchange);
  if (visible.outcome != Outcome::queued) return abort(journal, *written, order, visible, utc, now);
  world::failpoint("after_rename");
  return make_durable(order, file, journal, utc, now, *written);
}

/// E6: the one step that others see.
Emission Emitter::make_visible(const safety::VerifiedFile& file, const std::string& staged, const EmissionOrder&,
                               bool exchange) {
  if (!exchange) {
    const auto moved = stage_->rename_new(staged, *target_, name_);
    if (moved) return {Outcome::queued, "", false};
    if (moved.error().code == EEXIST)
      return {Outcome::foreign_file, name_ + " appeared there while ours was being made", false};
    return {Outcome::aborted, moved.error().message(), false};
  }
  const auto swapped = stage_->exchange(staged, *target_, name_);
  if (!swapped) {
    if (swapped.error().code != ENOENT) return {Outcome::aborted, swapped.error().message(), false};
    return {Outcome::aborted, "our previous file was taken at this moment: the glider may be receiving it", false};
  }
  const auto out = stage_->read(staged, kLargestForeign);
  const bool ours = out && (Sha256::of(std::string_view{*out}) == ours_ ||
                            std::find(ours_before_.begin(), ours_before_.end(), Sha256::of(std::string_view{*out})) !=
                                ours_before_.end());
  if (ours) return {Outcome::queued, "", false};
  const auto back = stage_->exchange(staged, *target_, name_);
  if (!back)
    return {Outcome::unknown,
            "a human's file was swapped out and could not be put back (" + back.error().message() + "): it is " +
                stage_->path() + "/" + staged,
            false};
  static_cast<void>(file);
  return {Outcome::foreign_file, name_ + " was changed while ours was being made; it was put back", false};
}

/// E7–E9. An error after the rename cannot be undone quietly.
Emission Emitter::make_durable(const EmissionOrder& order, const safety::VerifiedFile& file, Journal& journal,
                               Instant utc, Tick now, std::uint64_t intent) {
  for (auto* folder : {target_.get(), stage_.get()})
    if (auto synced = folder->sync(); !synced) return {Outcome::unknown, synced.error().message(), true};
  world::failpoint("after_folder_sync");
  const auto stat = target_->stat(name_);
  const Json committed{
      {"glider", order.glider}, {"surfacing", order.surfacing}, {"intent", intent}, {"inode", stat ? stat->inode : 0}};
  const auto written = journal.append(RecordType::committed, committed.dump(), utc, now, Journal::Durable::yes);
  if (!written) return {Outcome::unknown, written.error().message, written.error().fatal};
  world::failpoint("after_committed");
  if (ours_) ours_before_.push_back(*ours_);
  ours_ = file.verdict().of;
  // After an exchange the swapped-out copy lies under the staged name; its bytes are in the journal.
  const auto names = stage_->list();
  if (names)
    for (const auto& name : *names)
      if (name.ends_with(".tmp")) static_cast<void>(stage_->unlink(name));
  return {Outcome::queued, fmt::format("{} is queued in {}", name_, target_->path()), false};
}

Emission Emitter::abort(Journal& journal, std::uint64_t intent, const EmissionOrder& order, Emission why, Instant utc,
                        Tick now) {
  const Json aborted{{"glider", order.glider}, {"surfacing", order.surfacing}, {"intent", intent}, {"why", why.detail}};
  const auto written = journal.append(RecordType::aborted, aborted.dump(), utc, now);
  if (!written) why.fatal = why.fatal || written.error().fatal;
  return why;
}

std::vector<RecoveredEmission> Emitter::recover(const std::string& glider, const std::vector<JournalRecord>& past,
                                                Journal& journal, Instant utc, Tick now) {
  std::map<std::uint64_t, std::string> open;  // INTENTs without an end, by sequence number
  for (const auto& record : past) {
    if (record.type != RecordType::intent && record.type != RecordType::committed && record.type != RecordType::aborted)
      continue;
    const auto json = Json::parse(record.payload, nullptr, false);
    if (json.is_discarded() || json.value("glider", "") != glider) continue;
    if (record.type == RecordType::intent) {
      Sha256 hash;
      if (Sha256::from_hex(json.value("sha256", ""), hash)) ours_before_.push_back(hash);
      open[record.sequence] = record.payload;
    } else {
      open.erase(json.value("intent", std::uint64_t{0}));
    }
  }
  std::vector<RecoveredEmission> settled;
  for (const auto& [sequence, payload] : open) {
    std::string surfacing;
    auto emission = settle(payload, journal, utc, now, surfacing);
    const Json end{{"glider", glider}, {"surfacing", surfacing}, {"intent", sequence}, {"why", emission.detail}};
    const auto type = emission.outcome == Outcome::queued ? RecordType::committed : RecordType::aborted;
    const auto written = journal.append(type, end.dump(), utc, now, Journal::Durable::yes);
    if (!written) emission.fatal = written.error().fatal;
    settled.push_back({surfacing, emission});
  }
  if (const auto names = stage_->list())
    for (const auto& name : *names)
      if (name.ends_with(".tmp")) static_cast<void>(stage_->unlink(name));
  return settled;
}

/// One INTENT that a crash left open, by what lies in to-glider now. A plan is never finished from the journal.
Emission Emitter::settle(const std::string& intent_json, Journal&, Instant, Tick, std::string& surfacing) {
  const auto intent = Json::parse(intent_json, nullptr, false);
  surfacing = intent.value("surfacing", "");
  Sha256 wanted;
  if (!Sha256::from_hex(intent.value("sha256", ""), wanted))
    return {Outcome::unknown, "the INTENT cannot be read", false};
  std::string problem;
  const auto found = hash_in_target(&problem);
  if (!problem.empty()) return {Outcome::unknown, problem, false};
  if (found == wanted) {
    for (auto* folder : {target_.get(), stage_.get()})
      if (auto synced = folder->sync(); !synced) return {Outcome::unknown, synced.error().message(), true};
    ours_ = wanted;
    return {Outcome::queued, fmt::format("{} was visible before the crash and is queued", name_), false};
  }
  // Not visible. Still staged: it never was. Gone from both: it was taken between the rename and the crash.
  const auto staged = stage_->read(intent.value("staged", ""), kLargestForeign);
  const bool still_staged = staged && Sha256::of(std::string_view{*staged}) == wanted;
  if (still_staged) return {Outcome::aborted, "the crash came before the file was visible", false};
  if (!found)
    return {Outcome::unknown,
            "the file may have been taken between its rename and the crash; only the dialog's Waypoint: line will tell",
            false};
  return {Outcome::foreign_file, name_ + " was written by somebody else since the crash", false};
}

}  // namespace glidehelm::daemon
