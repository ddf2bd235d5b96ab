#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/time.hpp"
#include "daemon/world/net.hpp"

namespace glidehelm::simulator {

/// The daemon's answer to a `run`.
struct Idle {
  std::int64_t tick_ms{};
  std::optional<std::int64_t> next_timer_ms;
  friend bool operator==(const Idle&, const Idle&) = default;
};

/// Reads `idle TICK_MS NEXT`; nothing when the line is anything else.
std::optional<Idle> idle_from(std::string_view line);

/// `run UTC_MS TICK_MS LINE=BYTES …` with its line end.
std::string run_line(Instant utc, std::int64_t tick_ms,
                     const std::vector<std::pair<std::string, std::uint64_t>>& bytes);

/// The simulator's side of the lockstep clock (docs/lockstep.md): listens on a Unix socket, greets whoever connects,
/// hands out time, and hears when the daemon is idle. One daemon at a time; a newer connection replaces the older, so
/// that a daemon that was killed can come back. Used from the loop's thread.
class ClockServer {
 public:
  struct Told {
    std::function<void()> connected, lost;
    std::function<void(const Idle&)> idle;
    std::function<void(const std::string&)> nonsense;  ///< a line that is no answer to the last `run`
  };
  ClockServer(world::Net& net, Told told) : net_{net}, told_{std::move(told)} {}
  ~ClockServer() { close(); }
  ClockServer(const ClockServer&) = delete;
  ClockServer& operator=(const ClockServer&) = delete;

  [[nodiscard]] Expected<Done, world::NetError> listen(const std::string& path);
  [[nodiscard]] bool connected() const { return stream_ != nullptr; }
  /// Precondition: connected, and the last `run` was answered.
  void run(Instant utc, std::int64_t tick_ms, const std::vector<std::pair<std::string, std::uint64_t>>& bytes);
  void close();

 private:
  void adopt(std::shared_ptr<world::Stream> stream);
  void hear(std::string_view bytes);

  world::Net& net_;
  Told told_;
  std::unique_ptr<world::Listener> listener_;
  std::shared_ptr<world::Stream> stream_;
  std::shared_ptr<int> alive_ = std::make_shared<int>(0);
  std::string partial_;
  std::int64_t asked_ms_{};
};

}  // namespace glidehelm::simulator
