#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/expected.hpp"

namespace glidehelm::world {

struct NetError {
  std::string operation;  ///< "listen", "connect", "resolve", …
  std::string address;
  std::string reason;
  [[nodiscard]] std::string message() const { return operation + " " + address + ": " + reason; }
};

/// One byte stream. Callbacks come from the loop; after `close` or after `ended` there are none.
class Stream {
 public:
  virtual ~Stream() = default;
  struct Handlers {
    std::function<void(std::string_view)> bytes;
    std::function<void(std::string_view reason)> ended;  ///< peer closed, error, time-out
  };
  virtual void start(Handlers handlers) = 0;
  virtual void write(std::string bytes) = 0;  ///< queued; bounded at 1 MiB, beyond that the stream ends
  virtual void close() = 0;
  [[nodiscard]] virtual std::string peer() const = 0;        ///< "127.0.0.1:53124" or "uid 1000 pid 77"
  [[nodiscard]] virtual std::uint32_t peer_uid() const = 0;  ///< of a Unix socket (SO_PEERCRED); 0xffffffff else
};

class Listener {
 public:
  virtual ~Listener() = default;  ///< stops listening
  [[nodiscard]] virtual std::uint16_t port() const = 0;
};

/// Streams and the event loop. Everything but `post` is called from the loop's thread.
class Net {
 public:
  virtual ~Net() = default;
  using Accepted = std::function<void(std::shared_ptr<Stream>)>;
  using Connected = std::function<void(Expected<std::shared_ptr<Stream>, NetError>)>;
  [[nodiscard]] virtual Expected<std::unique_ptr<Listener>, NetError> listen_tcp(const std::string& address,
                                                                                 std::uint16_t port,
                                                                                 Accepted accepted) = 0;
  [[nodiscard]] virtual Expected<std::unique_ptr<Listener>, NetError> listen_unix(const std::string& path,
                                                                                  unsigned mode, Accepted accepted) = 0;
  virtual void connect_tcp(const std::string& host, std::uint16_t port, Connected connected) = 0;
  virtual void connect_unix(const std::string& path, Connected connected) = 0;
  /// Calls `then` from the loop for SIGTERM, SIGINT, SIGHUP, …
  virtual void on_signal(int number, std::function<void()> then) = 0;
  /// Runs `work` in the loop; the only call that other threads may make.
  virtual void post(std::function<void()> work) = 0;
  virtual void run() = 0;  ///< until stop()
  virtual void stop() = 0;
};

}  // namespace glidehelm::world
