#include "daemon/emitter.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cmath>
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
constexpr const char* kEpochName = "epoch";
constexpr const char* kAside = "foreign";

std::string parent_of(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  const auto slash = path.find_last_of('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

bool same_folder(const world::FileStat& a, const world::FileStat& b) {
  return a.device == b.device && a.inode == b.inode;
}

/// Bytes that are no UTF-8 must not stop a record: they are replaced, the hash beside them is exact.
std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

Expected<std::unique_ptr<Emitter>, std::string> Emitter::open(world::Files& files, const std::string& to_glider,
                                                              int slot, bool need_marker) {
  const auto wrong = [&](const std::string& what) { return unexpected("to_glider " + to_glider + ": " + what); };
  std::unique_ptr<Emitter> emitter{new Emitter{files}};
  emitter->set_slot(slot);
  emitter->target_path_ = to_glider;
  while (emitter->target_path_.size() > 1 && emitter->target_path_.back() == '/') emitter->target_path_.pop_back();
  auto target = files.open_folder(emitter->target_path_);
  if (!target)
    return wrong(target.error().code == ELOOP || target.error().code == ENOTDIR
                     ? "is no folder (a symbolic link is not followed)"
                     : target.error().message());
  emitter->target_ = std::move(target).value();
  const auto target_stat = emitter->target_->stat_self();
  if (!target_stat) return wrong(target_stat.error().message());
  emitter->target_stat_ = *target_stat;
  const auto beside = parent_of(emitter->target_path_);
  if (need_marker && !files.stat(beside + "/" + kMarkerName))
    return wrong("the clock is simulated and glidersim did not make " + beside + " (no file " + kMarkerName +
                 " in it): nothing is written there");
  if (auto problem = emitter->open_stage(beside)) return wrong(*problem);
  if (auto problem = emitter->count_epoch()) return wrong(*problem);
  // Can a file be moved in and out? Found out now, not at 3 a.m.
  if (auto moves = emitter->stage_->check_moves_to(*emitter->target_); !moves) {
    const auto code = moves.error().code;
    return wrong(code == EXDEV
                     ? "lies on another mount than " + emitter->stage_path_ +
                           ": a file cannot be moved between them in one step (one ReadWritePaths= entry must "
                           "hold both)"
                 : code == EINVAL || code == ENOSYS
                     ? "its file system cannot exchange two names in one step (renameat2): " + moves.error().message()
                     : "a file cannot be moved into it: " + moves.error().message());
  }
  return emitter;
}

std::optional<std::string> Emitter::open_stage(const std::string& beside) {
  stage_path_ = (beside == "/" ? "" : beside) + "/" + kStageName;
  auto stage = files_.make_folder(stage_path_, 0750);
  if (!stage) return "the staging folder beside it cannot be made: " + stage.error().message();
  stage_ = std::move(stage).value();
  const auto stat = stage_->stat_self();
  if (!stat) return stat.error().message();
  stage_stat_ = *stat;
  if (stat->device != target_stat_.device)
    return "lies on another file system than " + stage_path_ + ": a file cannot be moved between them in one step";
  if ((stat->mode & 0002U) != 0) return "everybody may write into the staging folder " + stage_path_;
  auto lock = stage_->lock("lock");
  if (!lock && lock.error().code == EAGAIN)
    return "another process flies this glider (" + stage_path_ + "/lock is held by another process)";
  if (!lock) return "the staging folder cannot be used: " + lock.error().message();
  lock_ = std::move(lock).value();
  return std::nullopt;
}

/// One more than the last process that flew this glider. Under the lock, so nobody counts at the same time.
std::optional<std::string> Emitter::count_epoch() {
  const auto text = stage_->read(kEpochName, 64);
  if (!text && text.error().code != ENOENT) return "its epoch cannot be read: " + text.error().message();
  if (text) {
    const auto digits = trimmed(*text);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), epoch_);
    if (error != std::errc{} || end != digits.data() + digits.size())
      return stage_path_ + "/" + kEpochName + " holds no number; remove it when no other daemon flies this glider";
  }
  ++epoch_;
  const std::string fresh = std::string{kEpochName} + ".tmp";
  static_cast<void>(stage_->unlink(fresh));
  const auto made = stage_->create(fresh, std::to_string(epoch_) + "\n", 0640);
  if (!made) return "the staging folder is not writable: " + made.error().message();
  const auto moved = stage_->rename_over(fresh, *stage_, kEpochName);
  if (!moved) return "the staging folder is not writable: " + moved.error().message();
  const auto synced = stage_->sync();
  if (!synced) return "the staging folder is not writable: " + synced.error().message();
  return std::nullopt;
}

void Emitter::set_slot(int slot) { name_ = fmt::format("goto_l{:02}.ma", slot); }

world::FileResult<std::string> Emitter::stage(std::string_view bytes, std::uint64_t number) {
  const auto staged = fmt::format(".{}.{}-{}.tmp", name_, epoch_, number);
  if (auto made = stage_->create(staged, bytes, 0640); !made) return unexpected(made.error());
  // The name is durable too: an INTENT whose staged file is neither here nor in to-glider then means that it was taken.
  if (auto synced = stage_->sync(); !synced) return unexpected(synced.error());
  return staged;
}

world::FileResult<std::unique_ptr<world::OpenFile>> Emitter::open_staged(const std::string& staged) {
  return stage_->open(staged);
}

void Emitter::discard(const std::string& staged) {
  if (pinned_.count(staged) == 0) static_cast<void>(stage_->unlink(staged));
}

Emitter::Found Emitter::look(world::Folder& folder, const std::string& name) {
  const auto content = folder.read(name, kLargestForeign);
  if (content) return {Found::What::file, Sha256::of(std::string_view{*content}), ""};
  switch (content.error().code) {
    case ENOENT:
      return {};
    case EINVAL:
    case ELOOP:
    case EFBIG:
    case ENXIO:
      return {Found::What::strange, {}, content.error().message()};
    default:
      return {Found::What::problem, {}, content.error().message()};
  }
}

FolderView Emitter::inspect() {
  const auto names = target_->list();
  if (!names) return {FolderView::What::unreadable, names.error().message()};
  FolderView view;
  for (const auto& found : *names) {
    if (!equal_without_case(found, name_)) continue;  // DOS knows no case: the glider would take any of them for ours
    const auto stat = target_->stat(found);
    if (!stat && stat.error().code == ENOENT) continue;  // taken since it was listed
    std::string what = found;
    if (stat)
      what += fmt::format(" of uid {}, written {}", stat->owner,
                          utc_text(Instant{std::chrono::milliseconds{stat->modified_ns / 1'000'000}}));
    if (found == name_ && stat && stat->regular && stat->links == 1) {
      const auto content = look(*target_, found);
      if (content.what == Found::What::absent) continue;
      const auto ours = ours_.find(name_);
      if (ours != ours_.end() && content.is(ours->second)) {
        if (view.what == FolderView::What::nothing) view = {FolderView::What::ours, what};
        continue;
      }
      what += content.what == Found::What::file ? ", sha256 " + content.hash.hex().substr(0, 12)
                                                : ", unreadable: " + content.problem;
    }
    view = {FolderView::What::foreign, what + " was not written by us"};
  }
  return view;
}

std::string Emitter::glance() {
  const auto names = target_->list();
  if (!names) return names.error().message();
  std::string text;
  for (const auto& found : *names) {
    if (!equal_without_case(found, name_)) continue;
    const auto stat = target_->stat(found);
    text += stat ? fmt::format("{} {} {} {} {} {} {}\n", found, stat->device, stat->inode, stat->size,
                               stat->modified_ns, stat->links, stat->regular)
                 : found + " " + stat.error().message() + "\n";
  }
  return text;
}

/// E5: everything that may have changed since the verdict, cheapest last. What cannot be checked forbids.
std::optional<std::string> Emitter::objection(const EmissionOrder&) {
  if (transfer_open_) return "a transfer to the glider is open: nothing is changed under it";
  const auto hold = stage_->stat(kHoldName);
  if (hold) return std::string{"the file "} + kHoldName + " in " + stage_path_ + " forbids every emission";
  if (hold.error().code != ENOENT) return hold.error().message();
  const auto epoch = stage_->read(kEpochName, 64);
  if (!epoch || *epoch != std::to_string(epoch_) + "\n") return "another process has taken this glider over (epoch)";
  // Both folders are still what their paths lead to: somebody may have moved them away and made new ones.
  const auto target = files_.open_folder(target_path_);
  const auto target_stat = target ? (*target)->stat_self() : world::FileResult<world::FileStat>{target_stat_};
  if (!target || !target_stat || !same_folder(*target_stat, target_stat_))
    return "the to-glider folder was replaced since the start";
  const auto stage = files_.open_folder(stage_path_);
  const auto stage_stat = stage ? (*stage)->stat_self() : world::FileResult<world::FileStat>{stage_stat_};
  if (!stage || !stage_stat || !same_folder(*stage_stat, stage_stat_) || stage_stat->owner != stage_stat_.owner ||
      stage_stat->mode != stage_stat_.mode)
    return "the staging folder was replaced or its rights changed since the start";
  return std::nullopt;
}

Emission Emitter::emit(const safety::VerifiedFile& file, const std::string& staged, const EmissionOrder& order,
                       Journal& journal, const world::Clock& clock) {
  if (file.name() != name_)
    return {Outcome::aborted, "the file is named " + file.name() + ", the slot's name is " + name_, false};
  const auto bytes = stage_->read(staged, kLargestForeign);
  if (!bytes || *bytes != file.bytes())
    return {Outcome::aborted, "the staged file is not the one that was judged", false};
  const auto before = inspect();
  if (before.what == FolderView::What::foreign) return {Outcome::foreign_file, before.detail, false};
  if (before.what == FolderView::What::unreadable) return {Outcome::aborted, before.detail, false};
  if (auto why = objection(order)) return {Outcome::aborted, *why, false};
  if (clock.tick() >= order.deadline) return {Outcome::late, "the window is over", false};
  const bool exchange = before.what == FolderView::What::ours;

  Json intent{{"glider", order.glider},
              {"surfacing", order.surfacing},
              {"plan", order.plan_id},
              {"name", name_},
              {"length", file.bytes().size()},
              {"crc32c", crc32c(std::string_view{file.bytes()})},
              {"sha256", file.verdict().of.hex()},
              {"replaces", exchange ? ours_.at(name_).hex() : "absent"},
              {"replacement", order.replaces},
              {"staged", staged},
              {"folder_epoch", epoch_},
              {"deadline_ms", order.deadline.time_since_epoch().count()},
              {"bytes", file.bytes()}};
  Json margins = Json::array();
  for (const auto& m : file.verdict().margins) {
    Json margin{{"rule", m.rule}, {"holds", m.holds}};
    if (std::isfinite(m.found)) margin["found"] = m.found;
    if (std::isfinite(m.limit)) margin["limit"] = m.limit;
    if (!m.unit.empty()) margin["unit"] = m.unit;
    margins.push_back(std::move(margin));
  }
  intent["margins"] = std::move(margins);
  world::failpoint("before_intent");
  pinned_.insert(staged);
  const auto written =
      journal.append(RecordType::intent, text_of(intent), clock.utc(), clock.tick(), Journal::Durable::yes);
  if (!written) {
    pinned_.erase(staged);
    return {Outcome::aborted, written.error().message, written.error().fatal};
  }
  world::failpoint("after_intent");
  if (auto why = objection(order))
    return abort(journal, *written, order, staged, {Outcome::aborted, *why, false}, clock);
  if (clock.tick() >= order.deadline)
    return abort(journal, *written, order, staged, {Outcome::late, "the window is over", false}, clock);
  world::failpoint("before_rename");
  const auto visible = make_visible(file, staged, exchange);
  if (visible.outcome == Outcome::unknown) return visible;  // its INTENT stays open: the next start looks again
  if (visible.outcome != Outcome::queued) return abort(journal, *written, order, staged, visible, clock);
  world::failpoint("after_rename");
  return make_durable(order, file, staged, journal, clock, *written);
}

/// E6: the one step that others see.
Emission Emitter::make_visible(const safety::VerifiedFile& file, const std::string& staged, bool exchange) {
  const auto& ours = file.verdict().of;
  if (!exchange) {
    const auto moved = stage_->rename_new(staged, *target_, name_);
    if (moved) return {Outcome::queued, "", false};
    if (moved.error().code == EEXIST)
      return {Outcome::foreign_file, name_ + " appeared there while ours was being made", false};
    // An error does not prove that nothing happened.
    if (look(*target_, name_).is(ours)) return {Outcome::queued, "", false};
    return {Outcome::aborted, moved.error().message(), false};
  }
  const auto swapped = stage_->exchange(staged, *target_, name_);
  if (!swapped && !look(*target_, name_).is(ours)) {
    if (swapped.error().code != ENOENT) return {Outcome::aborted, swapped.error().message(), false};
    return {Outcome::aborted, "our previous file was taken at this moment: the glider may be receiving it", false};
  }
  const auto out = look(*stage_, staged);
  if (out.is(ours_.at(name_))) return {Outcome::queued, "", false};
  if (out.what == Found::What::problem)  // nobody knows whose it is: it is kept, and the next start looks again
    return {Outcome::unknown,
            name_ + " is visible, what it replaced cannot be read (" + out.problem + "): it is " + stage_path_ + "/" +
                keep_aside(staged),
            false};
  return put_back(staged, name_, ours);
}

/// What came out of the exchange is somebody else's file: it goes back at once, and durably, before anything else is
/// said. `ours` is what must come out then.
Emission Emitter::put_back(const std::string& staged, const std::string& name, const Sha256& ours) {
  const auto twice = [&] {
    return Emission{Outcome::unknown,
                    name + " was changed twice while ours was being made; the other file is " + stage_path_ + "/" +
                        keep_aside(staged),
                    false};
  };
  if (const auto there = look(*target_, name); there.what != Found::What::absent && !there.is(ours)) return twice();
  auto back = stage_->exchange(staged, *target_, name);
  const bool taken = !back && back.error().code == ENOENT;  // ours was taken meanwhile
  if (taken) back = stage_->rename_new(staged, *target_, name);
  if (!back)
    return {Outcome::unknown,
            "a human's file was swapped out and could not be put back (" + back.error().message() + "): it is " +
                stage_path_ + "/" + keep_aside(staged),
            false};
  if (const auto problem = sync_both()) return {Outcome::unknown, problem->message(), problem->failed_sync()};
  if (taken)
    return {Outcome::unknown,
            name +
                " was changed while ours was being made; it was put back, but ours may have been "
                "taken before",
            false};
  if (const auto out = look(*stage_, staged); !out.is(ours) && out.what != Found::What::absent) return twice();
  return {Outcome::foreign_file, name + " was changed while ours was being made; it was put back", false};
}

/// A file of somebody else that lies in our staging folder gets a name that is never cleaned away and that recovery
/// finds.
std::string Emitter::keep_aside(const std::string& staged) {
  const auto name = aside_of(staged);
  if (name == staged || !stage_->rename_new(staged, *stage_, name)) return staged;
  static_cast<void>(stage_->sync());
  return name;
}

std::string Emitter::aside_of(const std::string& staged) {
  return staged.rfind(kAside, 0) == 0 ? staged : std::string{kAside} + staged;
}

std::optional<world::FileError> Emitter::sync_both() {
  for (auto* folder : {target_.get(), stage_.get()})
    if (auto synced = folder->sync(); !synced) return synced.error();
  return std::nullopt;
}

/// E7–E9. An error after the rename cannot be undone quietly.
Emission Emitter::make_durable(const EmissionOrder& order, const safety::VerifiedFile& file, const std::string& staged,
                               Journal& journal, const world::Clock& clock, std::uint64_t intent) {
  ours_[name_] = file.verdict().of;
  if (const auto problem = sync_both()) return {Outcome::unknown, problem->message(), true};
  world::failpoint("after_folder_sync");
  const auto stat = target_->stat(name_);
  const Json committed{{"glider", order.glider},
                       {"surfacing", order.surfacing},
                       {"intent", intent},
                       {"inode", stat ? stat->inode : 0},
                       {"modified_ns", stat ? stat->modified_ns : 0}};
  world::failpoint("before_committed");
  const auto written =
      journal.append(RecordType::committed, text_of(committed), clock.utc(), clock.tick(), Journal::Durable::yes);
  if (!written)
    return {Outcome::unknown, name_ + " is visible but that cannot be recorded: " + written.error().message,
            written.error().fatal};
  world::failpoint("after_committed");
  // After an exchange the swapped-out copy lies under the staged name; its bytes are in the journal.
  pinned_.erase(staged);
  discard(staged);
  return {Outcome::queued, fmt::format("{} is queued in {}", name_, target_path_), false};
}

/// A: nothing of ours is visible. The staged file goes only when its INTENT has a durable end: while it is there,
/// recovery knows that it was never taken.
Emission Emitter::abort(Journal& journal, std::uint64_t intent, const EmissionOrder& order, const std::string& staged,
                        Emission why, const world::Clock& clock) {
  const Json aborted{{"glider", order.glider}, {"surfacing", order.surfacing}, {"intent", intent}, {"why", why.detail}};
  const auto written =
      journal.append(RecordType::aborted, text_of(aborted), clock.utc(), clock.tick(), Journal::Durable::yes);
  if (written) {
    pinned_.erase(staged);
    discard(staged);
  } else {
    why.fatal = why.fatal || written.error().fatal;
  }
  return why;
}

}  // namespace glidehelm::daemon
