#include "simulator/dockserver/call.hpp"

#include <algorithm>
#include <cstdio>

#include "core/base/text.hpp"

namespace glidehelm::simulator {
namespace {

constexpr double kDropAfter = 20;    // from the at-surface block until the link falls
constexpr double kRedialAfter = 45;  // from there until the glider calls again
constexpr double kKeyAfter = 5;      // a script waits this long for its answer before the next key
constexpr double kResumeBefore = 2;  // Ctrl-R comes just before the keystroke window would run out
constexpr int kCallBackMinutes = 5;
constexpr double kFetchBefore = 40, kFetchTakes = 20;  // science files go before the script's `!dockzr *`
constexpr double kLate = 60, kLatest = 660;            // a late script
constexpr double kAbortBefore = 4 * 86400;             // the last abort: so long before the mission

std::string slot_file(int slot) {
  char name[24];
  std::snprintf(name, sizeof name, "goto_l%02d.ma", slot);
  return name;
}

}  // namespace

Call::Call(const CallSetup& setup, CallFaults faults, Glider& glider, ToGlider& folder, std::string& on_board)
    : setup_{setup}, faults_{faults}, glider_{&glider}, folder_{&folder}, on_board_{&on_board} {
  const auto& times = glider.setup().times;
  dive_s_ = glider.fixes_done_s() + times.surface;
  resume_s_ = dive_s_ - times.post_fix;
  if (faults.lost) {
    outcome_.note = "no call";
    return;
  }
  call_s_ = glider.fixes_done_s() + setup.call_after;
  const double at_surface_s = call_s_ + setup.at_surface_after;
  if (!faults.no_connection_block) plan(call_s_, What::connect);
  plan(at_surface_s, What::at_surface);
  if (faults.chatter) plan(at_surface_s + 5, What::chatter);
  if (faults.wrong_keys) plan(at_surface_s + 10, What::wrong_key);
  if (faults.redial || faults.half_open) plan(at_surface_s + kDropAfter, What::drop);
  if (faults.call_back) plan(at_surface_s + kDropAfter + 10, What::call_back);
  // Anywhere from the first byte to a little after the usual end of the script.
  if (faults.cut) plan(call_s_ + faults.at * (setup.dockzr_after + 120), What::cut);
  if (faults.not_taken) outcome_.note = "the script did not run";
  plan_script(call_s_);
  plan(resume_s_ - kResumeBefore, What::resume);
}

void Call::plan_script(double call_s) {
  if (faults_.not_taken) return;
  const double late = faults_.late_script ? kLate + faults_.how * (kLatest - kLate) : 0.0;
  const double dockzr_s = call_s + setup_.dockzr_after + late;
  if (dockzr_s >= resume_s_ - kResumeBefore) outcome_.note = "the window ended before the script sent anything";
  if (faults_.science_files) plan(dockzr_s - kFetchBefore, What::science);
  plan(dockzr_s, What::dockzr);
}

Report Call::report(double now_s) const {
  auto r = report_of(*glider_, now_s, left(now_s));
  r.firmware = setup_.firmware;
  r.aborts.total = setup_.aborts;
  r.aborts.at_s = r.mission_started_s - kAbortBefore;
  r.aborts.mission_number = std::max(0, r.mission_number - 1);
  if (const auto& abort = glider_->abort()) {
    ++r.aborts.total;
    r.aborts.cause = abort->cause;
    r.aborts.details = abort->details;
    r.aborts.at_s = abort->at_s + glider_->setup().clock_skew_s;
    r.aborts.mission_number = r.mission_number;
    r.aborts.segment = r.segment;
  }
  tell_only(setup_.tells, r);
  return r;
}

/// What would happen after the keystroke window does not happen any more.
void Call::plan(double at_s, What what) {
  if (what != What::resume && at_s >= resume_s_ - kResumeBefore) return;
  const auto later = [](const Due& a, const Due& b) { return a.at_s < b.at_s; };
  const Due due{at_s, what};
  due_.insert(std::upper_bound(due_.begin(), due_.end(), due, later), due);
}

void Call::forget(What what) {
  due_.erase(std::remove_if(due_.begin(), due_.end(), [&](const Due& d) { return d.what == what; }), due_.end());
}

std::optional<double> Call::next_s() const {
  if (due_.empty()) return std::nullopt;
  return due_.front().at_s;
}

std::string Call::dockzr(double now_s) {
  sending_ = folder_->contents(instant_at(now_s));
  if (sending_.empty()) {
    outcome_.note = "to-glider was empty";
    if (setup_.reread_always) plan(now_s + kKeyAfter, What::reread);
    if (setup_.resume_at_once) {
      forget(What::resume);
      plan(now_s + 2 * kKeyAfter, What::resume);
    }
    return dialog::nothing_to_send();
  }
  busy_ = true;
  std::string s = "!dockzr *\r\n**B00000000000000\r\n";
  double seconds = 0;
  for (const auto& file : sending_) {
    seconds += setup_.transfer_overhead + static_cast<double>(file.bytes.size()) / setup_.bytes_per_s;
    s += dialog::sending_starts(file.name, glider_->setup().name, file.bytes.size());
  }
  if (now_s + seconds >= resume_s_) {
    outcome_.note = "the window ended during the transfer";
    sending_.clear();
  }
  const bool tears = faults_.transfer_cut && !torn_ && !sending_.empty();
  plan(now_s + (tears ? 0.5 : 1.0) * seconds, tears ? What::torn : What::sent);
  return s;
}

std::string Call::sent(double now_s) {
  busy_ = false;
  std::string s;
  for (const auto& file : sending_) {
    s += dialog::sending_ends(file.name, file.bytes.size());
    outcome_.sent.push_back(file.name);
    if (equal_without_case(file.name, slot_file(glider_->setup().slot))) {
      *on_board_ = file.bytes;
      outcome_.list = file;
    }
    folder_->sent(file, instant_at(now_s));
  }
  s += dialog::timed_line(report(now_s).mission_s, "behavior surface_4: ! succeeded:dockzr *");
  sending_.clear();
  if (!outcome_.list) outcome_.note = "no " + slot_file(glider_->setup().slot) + " in to-glider";
  if (setup_.reread_always || outcome_.list) plan(now_s + kKeyAfter, What::reread);
  if (setup_.resume_at_once) {
    forget(What::resume);
    plan(now_s + 2 * kKeyAfter, What::resume);
  }
  return s;
}

std::string Call::reread(double now_s) {
  const auto now = report(now_s);
  std::string s = dialog::reread(now.mission_s, now.behavior);
  outcome_.reread = true;
  if (on_board_->empty()) {
    glider_->restart_list(now_s);
    return s;
  }
  const auto read = glider_->read_list(*on_board_, now_s);
  if (read) return s;
  outcome_.error = read.error();
  due_.clear();
  return s + dialog::behaviour_error(now.mission_s, read.error().message());
}

std::string Call::science(double now_s) {
  busy_ = true;
  const auto now = report(now_s);
  Random random{static_cast<std::uint64_t>(faults_.how * 0x1p53) ^ static_cast<std::uint64_t>(now.segment)};
  std::string s = "s *.sbd *.tbd\r\n";
  for (const auto& name : dialog::science_files(now)) {
    const auto size = static_cast<std::size_t>(random.uniform(300, 2500));
    fetching_.push_back({name, LineNoise::binary(size, random.stream(size))});
    s += dialog::science_starts(name, now.glider, fetching_.back().bytes.size()) + fetching_.back().bytes;
  }
  plan(now_s + kFetchTakes, What::fetched);
  return s;
}

std::string Call::fetched(double now_s) {
  busy_ = false;
  std::string s;
  for (const auto& file : fetching_) {
    s += dialog::science_ends(file.name, file.bytes.size());
    folder_->received(file, instant_at(now_s));
  }
  fetching_.clear();
  return s + dialog::timed_line(report(now_s).mission_s, "behavior surface_4: ! succeeded:s *.sbd *.tbd");
}

/// The link falls behind `last`. Only the glider's own clock goes on: it calls again after `again_after` seconds (never,
/// when negative) and the script begins anew.
std::vector<LineEvent> Call::link_falls(double now_s, std::string last, double again_after, LineEvent::Kind kind) {
  for (const auto what : {What::reprint, What::chatter, What::wrong_key, What::drop, What::call_back, What::science,
                          What::fetched, What::dockzr, What::torn, What::sent, What::reread})
    forget(what);
  busy_ = false;
  sending_.clear();
  fetching_.clear();
  if (again_after < 0) {
    for (const auto what : {What::connect, What::at_surface, What::resume}) forget(what);
    if (!outcome_.list) outcome_.note = "the link fell and the glider did not call again";
  } else {
    const double again = now_s + again_after;
    plan(again, What::connect);
    plan(again + setup_.at_surface_after, What::at_surface);
    plan_script(again);
  }
  return {{LineEvent::Kind::bytes, std::move(last)}, {kind, {}}};
}

/// The first part of what was being sent is on the glider; the folder keeps its file for the next try.
std::vector<LineEvent> Call::transfer_is_torn(double now_s) {
  torn_ = true;
  const auto& first = sending_.front();
  std::string got =
      first.bytes.substr(0, static_cast<std::size_t>(faults_.at * static_cast<double>(first.bytes.size())));
  if (equal_without_case(first.name, slot_file(glider_->setup().slot))) {
    outcome_.partial = true;
    *on_board_ = std::move(got);
  }
  outcome_.note = "the link fell in the transfer";
  constexpr double kCallsAgain = 0.7;
  return link_falls(now_s,
                    "**B0100000023be50\r\n\x18"
                    "B08",
                    faults_.how < kCallsAgain ? kRedialAfter : -1.0, LineEvent::Kind::dropped);
}

std::vector<LineEvent> Call::step() {
  const Due now = due_.front();
  due_.erase(due_.begin());
  // The link falls in the middle of a line, as most recorded dialogs end.
  const auto half_a_block = [&](double share) {
    auto cut = dialog::at_surface_block(report(now.at_s));
    cut.resize(static_cast<std::size_t>(share * static_cast<double>(cut.size())));
    return cut;
  };
  std::string s;
  switch (now.what) {
    case What::connect:
      s = dialog::connection_block(report(now.at_s));
      break;
    case What::at_surface:
    case What::reprint:
      if (!busy_) s = dialog::at_surface_block(report(now.at_s));
      plan(now.at_s + setup_.reprint_every, What::reprint);
      break;
    case What::chatter:
      s = dialog::chatter(report(now.at_s));
      break;
    case What::wrong_key:
      s = dialog::wrong_key(static_cast<int>(faults_.how * 3));
      break;
    case What::drop:
      return link_falls(now.at_s, half_a_block(0.5), kRedialAfter,
                        faults_.half_open ? LineEvent::Kind::abandoned : LineEvent::Kind::dropped);
    case What::call_back: {
      const auto r = report(now.at_s);
      return link_falls(now.at_s, "H 5\r\n" + dialog::hangs_up(r.mission_s, r.behavior, kCallBackMinutes),
                        60.0 * kCallBackMinutes, LineEvent::Kind::dropped);
    }
    case What::cut:
      forget(What::connect);
      forget(What::at_surface);
      return link_falls(now.at_s, half_a_block(faults_.how), -1.0, LineEvent::Kind::dropped);
    case What::science:
      s = science(now.at_s);
      break;
    case What::fetched:
      s = fetched(now.at_s);
      break;
    case What::dockzr:
      s = dockzr(now.at_s);
      break;
    case What::torn:
      return transfer_is_torn(now.at_s);
    case What::sent:
      s = sent(now.at_s);
      break;
    case What::reread:
      s = reread(now.at_s);
      break;
    case What::resume:
      s = dialog::resuming(report(now.at_s), true);
      if (setup_.resume_at_once) dive_s_ = now.at_s + kResumeBefore + glider_->setup().times.post_fix;
      due_.clear();
      break;
  }
  if (s.empty()) return {};
  return {{LineEvent::Kind::bytes, s}};
}

}  // namespace glidehelm::simulator
