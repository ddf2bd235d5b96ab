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
  /// `lost` is called when the simulator is gone or speaks nonsense: there is no time any more.
  SimulatedClock(Net& net, std::string socket, std::function<void(std::string_view reason)> lost);
  /// Connects; `ready` is called at the first `run`, when there is a time.
  void start(std::function<void()> ready);

  [[nodiscard]] Instant utc() const override { return utc_; }
  [[nodiscard]] Tick tick() const override { return tick_; }
  TimerId call_at(Tick when, std::function<void()> then) override { return queue_.add(when, std::move(then)); }
  void cancel(TimerId id) override { queue_.cancel(id); }
  [[nodiscard]] bool simulated() const override { return true; }

  /// `total` bytes of this line, counted since its first connection, were received and handled.
  void handled(const std::string& line, std::uint64_t total);
  /// True while planning, a verification, a child or an emission is under way.
  void set_busy(bool busy);

 private:
  void take_bytes(std::string_view bytes);
  void take_line(std::string_view line);
  void settle();

  Net& net_;
  std::string socket_;
  std::function<void(std::string_view)> lost_;
  std::function<void()> ready_;
  std::shared_ptr<Stream> stream_;
  std::string partial_;
  bool greeted_{}, running_{}, busy_{}, settling_{};
  Instant utc_{};
  Tick tick_{};
  TimerQueue queue_;
  std::map<std::string, std::uint64_t> sent_, handled_;
};

}  // namespace glidehelm::world
