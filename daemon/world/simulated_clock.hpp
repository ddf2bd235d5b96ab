#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/world/net.hpp"
#include "daemon/world/timer_queue.hpp"

namespace glidehelm::world {

/// The clock that glidersim drives over a Unix socket (docs/lockstep.md). The daemon tells it what it has handled and
/// whether it is busy; it answers `idle` when everything of a `run` is done.
class SimulatedClock final : public Clock {
 public:
  /// `lost` is called when the simulator is gone or speaks nonsense: there is no time any more. `wall` paces the tries to
  /// connect: the simulator may be started a minute later.
  SimulatedClock(Net& net, Clock& wall, std::string socket, std::function<void(std::string_view reason)> lost);
  ~SimulatedClock() override;
  SimulatedClock(const SimulatedClock&) = delete;
  SimulatedClock& operator=(const SimulatedClock&) = delete;
  /// Connects; `ready` is called at the first `run`, when there is a time.
  void start(std::function<void()> ready);

  [[nodiscard]] Instant utc() const override { return utc_; }
  [[nodiscard]] Tick tick() const override { return tick_; }
  TimerId call_at(Tick when, std::function<void()> then) override { return queue_.add(when, std::move(then)); }
  void cancel(TimerId id) override { queue_.cancel(id); }
  [[nodiscard]] bool simulated() const override { return true; }
  /// The earliest timer, as `idle` tells it.
  [[nodiscard]] std::optional<Tick> next_timer() const { return queue_.next(); }
  /// Called for every `run` once the clock is set, before its timers fire.
  void on_run(std::function<void()> then) { on_run_ = std::move(then); }

  /// `total` bytes of this line, counted since this process began, were received and handled.
  void handled(const std::string& line, std::uint64_t total);
  /// True while planning, a verification, a child or an emission is under way.
  void set_busy(bool busy);

 private:
  void lose(std::string_view reason);
  void connect(int tries_left);
  void take_bytes(std::string_view bytes);
  void take_line(std::string_view line);
  void settle();

  Net& net_;
  Clock& wall_;
  std::string socket_;
  std::function<void(std::string_view)> lost_;
  std::function<void()> ready_, on_run_;
  std::shared_ptr<Stream> stream_;
  std::string partial_;
  bool greeted_{}, running_{}, busy_{}, settling_{};
  std::shared_ptr<bool> alive_{std::make_shared<bool>(true)};
  Instant utc_{};
  Tick tick_{};
  TimerQueue queue_;
  std::map<std::string, std::uint64_t> sent_, handled_;
};

}  // namespace glidehelm::world
