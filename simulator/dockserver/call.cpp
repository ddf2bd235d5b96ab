#include "simulator/dockserver/call.hpp"

#include <algorithm>
#include <cstdio>

#include "core/base/text.hpp"
#include "simulator/dockserver/report.hpp"

namespace glidehelm::simulator {
namespace {

constexpr double kDropAfter = 20;    // from the at-surface block until the link falls
constexpr double kRedialAfter = 45;  // from there until the glider calls again
constexpr double kKeyAfter = 5;      // a script waits this long for its answer before the next key
constexpr double kResumeBefore = 2;  // Ctrl-R comes just before the keystroke window would run out

std::string slot_file(int slot) {
  char name[24];
  std::snprintf(name, sizeof name, "goto_l%02d.ma", slot);
  return name;
}

}  // namespace

Call::Call(const CallSetup& setup, CallFaults faults, Glider& glider, ToGlider& folder, std::string& on_board)
    : setup_{setup}, faults_{faults}, glider_{&glider}, folder_{&folder}, on_board_{&on_board} {
  const auto& times = glider.setup().times;
  dive_s_ = glider.fix_s() + times.surface;
  resume_s_ = dive_s_ - times.post_fix;
  if (faults.lost) {
    outcome_.note = "no call";
    return;
  }
  const double call_s = glider.fix_s() + setup.call_after;
  if (!faults.no_connection_block) plan(call_s, What::connect);
  plan(call_s + setup.at_surface_after, What::at_surface);
  if (faults.redial) plan(call_s + setup.at_surface_after + kDropAfter, What::drop);
  if (!faults.not_taken)
    plan(call_s + setup.dockzr_after, What::dockzr);
  else
    outcome_.note = "the script did not run";
  plan(resume_s_ - kResumeBefore, What::resume);
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
  plan(now_s + seconds, What::sent);
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
  s += dialog::timed_line(report_of(*glider_, now_s, 0).mission_s, "behavior surface_4: ! succeeded:dockzr *");
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
  const auto report = report_of(*glider_, now_s, left(now_s));
  std::string s = dialog::reread(report.mission_s, report.behavior);
  outcome_.reread = true;
  if (on_board_->empty()) {
    glider_->restart_list(now_s);
    return s;
  }
  const auto read = glider_->read_list(*on_board_, now_s);
  if (read) return s;
  outcome_.error = read.error();
  due_.clear();
  return s + dialog::behaviour_error(report.mission_s, read.error().message());
}

std::vector<LineEvent> Call::step() {
  const Due now = due_.front();
  due_.erase(due_.begin());
  const auto report = [&] { return report_of(*glider_, now.at_s, left(now.at_s)); };
  std::string s;
  switch (now.what) {
    case What::connect:
      s = dialog::connection_block(report());
      break;
    case What::at_surface:
    case What::reprint:
      if (!busy_) s = dialog::at_surface_block(report());
      plan(now.at_s + setup_.reprint_every, What::reprint);
      break;
    case What::drop: {
      // The link falls in the middle of a line, as most recorded dialogs end.
      auto cut = dialog::at_surface_block(report());
      cut.resize(cut.size() / 2);
      const double again = now.at_s + kRedialAfter;
      forget(What::reprint);
      forget(What::dockzr);
      plan(again, What::connect);
      plan(again + setup_.at_surface_after, What::at_surface);
      if (!faults_.not_taken) plan(again + setup_.dockzr_after, What::dockzr);
      return {{LineEvent::Kind::bytes, cut}, {LineEvent::Kind::dropped, {}}};
    }
    case What::dockzr:
      s = dockzr(now.at_s);
      break;
    case What::sent:
      s = sent(now.at_s);
      break;
    case What::reread:
      s = reread(now.at_s);
      break;
    case What::resume:
      s = dialog::resuming(report(), true);
      if (setup_.resume_at_once) dive_s_ = now.at_s + kResumeBefore + glider_->setup().times.post_fix;
      due_.clear();
      break;
  }
  if (s.empty()) return {};
  return {{LineEvent::Kind::bytes, s}};
}

}  // namespace glidehelm::simulator
