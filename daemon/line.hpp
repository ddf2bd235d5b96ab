#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/daemon.hpp"
#include "daemon/world/world.hpp"

namespace glidehelm::daemon {

/// The TCP line of one glider: listens or dials, one connection at a time, plain dialog bytes (product.md 4.1).
///
/// A new connection replaces the older one: a redial after a half-open drop is normal. When dialling, a lost or refused
/// connection is tried again after 1 s, doubling to 5 min, with ±20 % jitter so that a fleet does not call at once
/// (trust.md K-9). Never writes.
class Line {
 public:
  struct Handlers {
    std::function<void(std::uint64_t connection, std::string_view peer, bool replaced)> opened;
    std::function<void(std::uint64_t connection, std::string_view bytes)> bytes;
    std::function<void(std::uint64_t connection, std::string_view reason)> closed;
    std::function<void(std::string_view problem)>
        trouble;  ///< a dial failed, a peer is not allowed: said once per cause
  };

  Line(world::World world, config::Line line, Handlers handlers);
  ~Line();
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  /// Listening fails at once when the port is taken; dialling never does.
  [[nodiscard]] Expected<Done, world::NetError> start();
  /// Ends the current connection from our side; `closed` is called with the reason.
  void drop(std::string_view reason);
  [[nodiscard]] bool connected() const { return stream_ != nullptr; }

 private:
  void take(std::shared_ptr<world::Stream> stream);
  void dial();
  void dial_later();
  void lost(std::uint64_t connection, std::string_view reason);

  world::World world_;
  config::Line line_;
  Handlers handlers_;
  std::unique_ptr<world::Listener> listener_;
  std::shared_ptr<world::Stream> stream_;
  std::shared_ptr<bool> alive_;
  std::uint64_t connection_{};
  Seconds back_off_{1};
  world::TimerId redial_{};
  std::string last_trouble_;
};

}  // namespace glidehelm::daemon
