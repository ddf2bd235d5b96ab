#include "simulator/runner.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/base/utc.hpp"

namespace glidehelm::simulator {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t kFirstTick = 1000;  // any positive monotonic start will do
constexpr milliseconds kLastBytes{300};    // for the last bytes before a link falls
constexpr milliseconds kAskAgain{20};
constexpr int kInterrupt = 2, kTerminate = 15;

milliseconds as_ms(double seconds) { return milliseconds{static_cast<std::int64_t>(std::ceil(seconds * 1e3))}; }

}  // namespace

Runner::Runner(world::Net& net, world::Clock& wall, Simulation& simulation, std::vector<Port> ports, Instant start,
               Pace pace, Told told)
    : net_{net},
      wall_{wall},
      simulation_{simulation},
      ports_{std::move(ports)},
      start_{start},
      now_{start},
      pace_{std::move(pace)},
      told_{std::move(told)},
      counted_from_(ports_.size(), 0),
      surfacings_told_(ports_.size(), 0),
      to_greet_(ports_.size(), false),
      clock_{net, ClockServer::Told{[this] { begin(); }, [this] { on_daemon_lost(); },
                                    [this](const Idle& idle) { on_idle(idle); },
                                    [this](const std::string& line) {
                                      end(RunOutcome::no_daemon,
                                          "the daemon's clock connection said something else than idle: " + line);
                                    }}} {}

Runner::~Runner() = default;

RunOutcome Runner::run() {
  for (const auto& port : ports_) {
    lines_.push_back(std::make_unique<DialogLine>(
        net_, wall_, port.address,
        DialogLine::Told{[this] { proceed(); },
                         [this, name = port.name](const std::string& text) { say(name + ": " + text); }}));
    if (const auto started = lines_.back()->start(); !started) {
      say(started.error().message());
      return RunOutcome::failed;
    }
  }
  for (const int signal : {kInterrupt, kTerminate})
    net_.on_signal(signal, [this] { end(RunOutcome::stopped, "stopped by a signal"); });
  if (!pace_.clock.empty()) {
    if (const auto listening = clock_.listen(pace_.clock); !listening) {
      say(listening.error().message());
      return RunOutcome::failed;
    }
  } else {
    wall_start_ = wall_.tick();
  }
  expect_answer();
  net_.post([this] { proceed(); });
  net_.run();
  for (auto& line : lines_) line->close();
  clock_.close();
  return outcome_;
}

void Runner::end(RunOutcome outcome, const std::string& why) {
  if (state_ == State::over) return;
  state_ = State::over;
  outcome_ = outcome;
  if (!why.empty()) say(why);
  if (watchdog_) wall_.cancel(*watchdog_);
  if (pacer_) wall_.cancel(*pacer_);
  if (poll_) wall_.cancel(*poll_);
  net_.stop();
}

/// A daemon has connected to the clock: its count of bytes starts at 0.
void Runner::begin() {
  for (std::size_t i = 0; i < lines_.size(); ++i) counted_from_[i] = lines_[i]->total();
  next_timer_ms_.reset();
  if (!started_) wall_start_ = wall_.tick();
  started_ = true;
  tell(State::told_time);  // a daemon opens its lines only when it has a time
}

void Runner::on_daemon_lost() {
  if (state_ == State::over) return;
  say("the daemon's clock connection ended; waiting for a new one, simulated time stands still");
  state_ = State::waiting;
  for (auto& line : lines_) line->drop();  // they led to a daemon that is gone
  expect_answer();
}

bool Runner::everybody_there() const {
  return (pace_.clock.empty() || clock_.connected()) &&
         std::all_of(lines_.begin(), lines_.end(), [](const auto& line) { return line->open(); });
}

/// Only lines that the daemon dials are missing, and it is there.
bool Runner::daemon_must_dial() const {
  return clock_.connected() && std::all_of(lines_.begin(), lines_.end(),
                                           [](const auto& line) { return line->open() || !line->address().connect; });
}

/// Whether the daemon has a timer for its next dial is known only when it says so after it has noticed that the line is gone: it
/// is asked again and again at the same simulated time, for daemon_wait_s of wall time.
void Runner::wait_for_a_dial() {
  if (poll_) return;
  if (!missing_since_) missing_since_ = wall_.tick();
  if (wall_.tick() - *missing_since_ > as_ms(pace_.daemon_wait_s))
    return end(RunOutcome::no_daemon, "no daemon: nobody dialled a line that it was to dial");
  poll_ = wall_.call_at(wall_.tick() + kAskAgain, [this] {
    poll_.reset();
    if (state_ == State::waiting && clock_.connected()) tell(State::told_time);
  });
}

bool Runner::greet_again() {
  missing_since_.reset();
  bool any = false;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (!to_greet_[i]) continue;
    to_greet_[i] = false;
    lines_[i]->write("\r\n");
    any = true;
  }
  if (any) tell(State::told_bytes);
  return any;
}

void Runner::let_links_fall() {
  for (const auto& fall : std::exchange(to_drop_, {})) {
    if (fall.noticed)
      lines_[fall.line]->drop();
    else
      lines_[fall.line]->abandon();
    to_greet_[fall.line] = true;
  }
}

std::int64_t Runner::tick_of(Instant t) const { return kFirstTick + (t - start_).count(); }

/// When wall time reaches the simulated instant; none without a pace.
std::optional<Tick> Runner::wall_due(Instant t) const {
  if (!pace_.realtime) return std::nullopt;
  return wall_start_ + as_ms(static_cast<double>((t - start_).count()) * 1e-3 / *pace_.realtime);
}

/// The simulator gives up when nothing answers for daemon_wait_s of wall time.
void Runner::expect_answer() {
  if (watchdog_) wall_.cancel(*watchdog_);
  if (pace_.clock.empty()) return;
  watchdog_ = wall_.call_at(wall_.tick() + as_ms(pace_.daemon_wait_s), [this] {
    watchdog_.reset();
    if (state_ == State::pacing) return;
    end(RunOutcome::no_daemon, state_ == State::waiting ? "no daemon: nobody connected to the clock and to every line"
                                                        : "the daemon does not become idle");
  });
}

void Runner::proceed() {
  if (state_ == State::over) return;
  if (pace_.clock.empty()) return free_running();
  if (state_ == State::told_time || state_ == State::told_bytes || state_ == State::pacing) return;
  const auto event = simulation_.next_event();
  if (!event) return end(RunOutcome::finished, {});
  Instant target = *event;
  if (!everybody_there()) {
    if (!daemon_must_dial()) return;
    const bool timer_first = next_timer_ms_ && start_ + milliseconds{*next_timer_ms_ - kFirstTick} <= target;
    if (!timer_first) return wait_for_a_dial();
  } else if (greet_again()) {
    return;
  }
  if (next_timer_ms_) target = std::min(target, start_ + milliseconds{*next_timer_ms_ - kFirstTick});
  target = std::max(target, now_);
  const auto due = wall_due(target);
  if (due && *due > wall_.tick()) {
    state_ = State::pacing;
    if (watchdog_) wall_.cancel(*watchdog_);
    watchdog_.reset();
    pacer_ = wall_.call_at(*due, [this] {
      pacer_.reset();
      if (state_ != State::pacing) return;
      state_ = State::waiting;
      expect_answer();
      proceed();
    });
    return;
  }
  now_ = target;
  tell(State::told_time);
}

void Runner::tell(State state) {
  state_ = state;
  std::vector<std::pair<std::string, std::uint64_t>> bytes;
  for (std::size_t i = 0; i < lines_.size(); ++i)
    bytes.emplace_back(ports_[i].name, lines_[i]->total() - counted_from_[i]);
  if (pace_.charge_computing || pace_.realtime)
    for (auto& port : ports_) port.folder->remember(now_);
  if (told_.time_comes) told_.time_comes(now_);
  asked_at_ = wall_.tick();
  expect_answer();
  clock_.run(now_, tick_of(now_), bytes);
}

void Runner::on_idle(const Idle& idle) {
  if (state_ != State::told_time && state_ != State::told_bytes) return;
  next_timer_ms_ = idle.next_timer_ms;
  if (pace_.charge_computing || pace_.realtime) {
    const auto took = std::chrono::duration<double>(wall_.tick() - asked_at_).count() * pace_.realtime.value_or(1.0);
    for (auto& port : ports_) port.folder->hide_news_until(now_ + as_ms(took));
  }
  const auto event = simulation_.next_event();
  const bool happens = state_ == State::told_time && event && *event <= now_ && everybody_there();
  state_ = State::waiting;
  if (happens) {
    let_it_happen();
    return tell(State::told_bytes);
  }
  // A link falls only after its last bytes have arrived: closing a stream may throw away what is still under way.
  let_links_fall();
  proceed();
}

void Runner::let_it_happen() {
  for (auto& output : simulation_.step()) {
    if (output.event.kind != LineEvent::Kind::bytes)
      to_drop_.push_back({output.glider, output.event.kind == LineEvent::Kind::dropped});
    else
      lines_[output.glider]->write(std::move(output.event.bytes));
  }
  for (std::size_t i = 0; i < ports_.size(); ++i) {
    for (const auto& all = simulation_.surfacings(i); surfacings_told_[i] < all.size(); ++surfacings_told_[i])
      if (told_.surfacing) told_.surfacing(all[surfacings_told_[i]]);
    if (const auto trouble = ports_[i].folder->take_trouble(); !trouble.empty()) say(ports_[i].name + ": " + trouble);
  }
}

void Runner::free_running() {
  if (pacer_) return;
  const auto event = simulation_.next_event();
  if (!event) return end(RunOutcome::finished, {});
  pacer_ = wall_.call_at(*wall_due(*event), [this] {
    pacer_.reset();
    if (state_ == State::over) return;
    if (const auto now = simulation_.next_event(); now && told_.time_comes) told_.time_comes(*now);
    let_it_happen();
    if (!to_drop_.empty()) wall_.call_at(wall_.tick() + kLastBytes, [this] { let_links_fall(); });
    proceed();
  });
}

void run_alone(Simulation& simulation, const std::function<void(const SurfacingRecord&)>& told) {
  std::vector<std::size_t> seen(simulation.count(), 0);
  while (simulation.next_event()) {
    simulation.step();
    for (std::size_t i = 0; i < seen.size(); ++i)
      for (const auto& all = simulation.surfacings(i); seen[i] < all.size(); ++seen[i])
        if (told) told(all[seen[i]]);
  }
}

}  // namespace glidehelm::simulator
