#include <fmt/format.h>

#include <algorithm>

#include "core/base/text.hpp"
#include "core/mission/pilot.hpp"
#include "core/mission/wording.hpp"

// What becomes of a file after it was emitted, as folder and dialog tell it.
namespace glidehelm::mission {

void Pilot::tell_file(const std::string& code, const std::string& text, Level level) {
  record("emission", text);
  say(level, code, text);
}

bool Pilot::watches_folder() const { return (stage_ != Stage::idle && stage_ != Stage::dived) || file_.in_folder(); }

bool Pilot::is_queued_file(const Candidate& candidate) const {
  return file_.file() && file_.file()->surfacing != key_ && candidate.file_bytes == file_.file()->bytes;
}

/// A file of the list's name, ours or a human's; without a mission no file is.
bool Pilot::is_of_our_name(const std::string& file) const {
  return mission_ && lower(file).ends_with(fmt::format("goto_l{:02}.ma", mission_->slot));
}

void Pilot::on(const TransferHeard& e) {
  if (!is_of_our_name(e.file)) return;
  transfer_began_ = true;
  failure_told_ = false;
  if (e.ended) half_on_board_ = false;
  const std::string name = file_.file() ? file_.file()->name : e.file;
  if (!e.ended) {
    const bool ours = file_.transfer_began();
    tell_file("transfer", ours ? fmt::format("the dockserver is sending {} to the glider", name)
                               : "the file is going to the glider");
    return;
  }
  const bool ours = file_.transfer_ended();
  tell_file("transfer", ours ? fmt::format("{} went to the glider; it flies it once it has read its lists again", name)
                             : "the file went to the glider");
}

/// What lies in to-glider after this is asked of the folder: dockservers differ in whether they take a file away that did
/// not arrive.
void Pilot::on(const TransferFailed& e) {
  if (!is_of_our_name(e.file) || failure_told_) return;
  failure_told_ = half_on_board_ = transfer_began_ = true;
  const bool ours = file_.transfer_failed();
  tell_file("transfer-failed",
            fmt::format("the transfer of {} failed: half of it may be on the glider, send it again before Ctrl-F{}",
                        ours ? file_.file()->name : e.file,
                        ours ? "; what still lies in to-glider then is judged again at the next surfacing" : ""),
            Level::alert);
  out_.push_back(InspectFolder{});
}

void Pilot::on(const ListReread&) {
  if (half_on_board_)
    tell_file("reread",
              "the glider reads its lists again after a transfer that failed: half a list may be in force; its next "
              "Waypoint: line tells",
              Level::alert);
  else if (file_.list_reread())
    tell_file("reread", fmt::format("the glider reads its lists again, {} with them; its next Waypoint: line will "
                                    "prove it",
                                    file_.file()->name));
  else if (file_.in_folder())
    tell_file("reread",
              "the glider reads its lists again, but our file is still in to-glider: it starts its old list at the "
              "first waypoint",
              Level::note);
  else
    say(Level::info, "reread", "the glider reads its lists again");
}

/// A `Waypoint:` line is the only proof of what a glider flies (slocum.md W8).
void Pilot::hear_waypoint(const model::Surfacing& s) {
  if (!s.aim) return;
  if (file_.waypoint_heard(s.aim->at)) {
    half_on_board_ = false;
    tell_file("flying", fmt::format("the glider flies our list: it steers to waypoint {} of {}, {}",
                                    file_.number_of(s.aim->at).value_or(0), file_.file()->name, place(s.aim->at)));
    tell_far_off();
    return;
  }
  if (waypoint_told_ || file_.state() == Delivery::none || file_.state() == Delivery::flying) return;
  if (file_.in_folder()) return;  // not taken yet: it cannot fly it
  if (file_.of_older_list(s.aim->at)) {
    waypoint_told_ = true;
    tell_file("old-list",
              fmt::format("the glider still steers to {} of an older list of ours: {} is not in force",
                          place(s.aim->at), file_.file()->name),
              Level::note);
  } else if (!file_.number_of(s.aim->at)) {
    waypoint_told_ = true;
    tell_file("other-list", fmt::format("the glider steers to {}, a waypoint of no list of ours", place(s.aim->at)),
              Level::note);
  }
}

void Pilot::on(const FolderSeen& e) {
  using Found = FolderSeen::Found;
  const bool open = stage_ != Stage::idle && stage_ != Stage::dived && stage_ != Stage::stood_down;
  switch (e.found) {
    case Found::nothing:
      if (!file_.seen_no_file()) return;
      if (file_.state() == Delivery::unknown)
        tell_file("gone",
                  fmt::format("{} is gone from to-glider, and its transfer failed: only the glider's next Waypoint: "
                              "line tells what it flies",
                              file_.file()->name),
                  Level::note);
      else
        tell_file("gone", fmt::format("{} is gone from to-glider: picked up, most likely; the glider's next Waypoint: "
                                      "line will prove what it flies",
                                      file_.file()->name));
      return;
    case Found::ours:
      if (file_.seen_in_folder() && open) {
        tell_file("still-queued", fmt::format("{} lies in to-glider again: it is judged again", file_.file()->name),
                  Level::note);
        if (stage_ == Stage::planning) plan_again();
      }
      return;
    case Found::foreign: {
      const bool instead_of_ours = file_.seen_foreign();
      if (!open && !instead_of_ours) return;
      if (request_ != 0 && stage_ == Stage::planning) out_.push_back(StopPlanning{request_});
      if (open) stage_ = Stage::stood_down;
      record("keep", "foreign file: " + e.detail);
      say(Level::alert, "foreign-file",
          fmt::format("standing down for this surfacing{}: {}",
                      instead_of_ours ? ", somebody put another file in the place of ours" : "", e.detail));
      return;
    }
    case Found::unreadable:
      if (open) say(Level::alert, "folder", "the to-glider folder cannot be read: " + e.detail);
      return;
  }
}

/// Nothing better was proven than the file that lies there already.
void Pilot::keep_queued_file() {
  stage_ = Stage::queued;
  tell_file(
      "kept",
      fmt::format("{} of the surfacing {} stays in to-glider: it was judged again and is safe from here{}",
                  file_.file()->name, file_.file()->surfacing, problem_.empty() ? "" : "; no new one: " + problem_));
  expect_next();
}

/// Nothing is emitted, and a file of an earlier surfacing may be sent all the same.
void Pilot::warn_of_queued_file() {
  if (!file_.in_folder() || !file_.file() || file_.file()->surfacing == key_) return;
  const auto judged =
      std::find_if(ranked_.begin(), ranked_.end(), [&](const Ranked& r) { return is_queued_file(r.candidate); });
  const bool safe = judged != ranked_.end() && judged->proof == Ranked::Proof::accepted;
  if (safe)
    tell_file("kept",
              fmt::format("{} of the surfacing {} stays in to-glider: it was judged again and is safe from here",
                          file_.file()->name, file_.file()->surfacing));
  else
    tell_file(
        "still-queued",
        fmt::format(
            "{} of the surfacing {} still lies in to-glider and {} from here: take it away by hand before "
            "the script sends it",
            file_.file()->name, file_.file()->surfacing,
            judged != ranked_.end() && judged->proof == Ranked::Proof::refused ? "is not safe" : "was not judged"),
        Level::page);
}

/// Our file became visible: from now on it is the one that is followed.
void Pilot::note_exchange() {
  if (!emitting_) return;
  if (file_.in_folder())
    tell_file("exchanged", fmt::format("the {} that still lay there, of the surfacing {}, was exchanged for this one",
                                       file_.file()->name, file_.file()->surfacing));
  file_.queued(*std::exchange(emitting_, std::nullopt));
  far_off_.reset();  // where the glider came up says nothing of the new list
}

}  // namespace glidehelm::mission
