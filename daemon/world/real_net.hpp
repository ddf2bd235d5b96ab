#pragma once

#include "daemon/world/net.hpp"
#include "daemon/world/real_loop.hpp"

namespace glidehelm::world {

/// Boost.Asio streams on the shared loop. TCP peers are watched with keep-alive (30 s idle, 10 s apart, 3 tries) and
/// TCP_USER_TIMEOUT 60 s, so that a half-open Iridium call ends within a minute (trust.md K-9); a dial that nobody answers ends after 60 s.
class RealNet final : public Net {
 public:
  explicit RealNet(RealLoop& loop);
  ~RealNet() override;
  [[nodiscard]] Expected<std::unique_ptr<Listener>, NetError> listen_tcp(const std::string& address, std::uint16_t port,
                                                                         Accepted accepted) override;
  [[nodiscard]] Expected<std::unique_ptr<Listener>, NetError> listen_unix(const std::string& path, unsigned mode,
                                                                          Accepted accepted) override;
  void connect_tcp(const std::string& host, std::uint16_t port, Connected connected) override;
  void connect_unix(const std::string& path, Connected connected) override;
  void on_signal(int number, std::function<void()> then) override;
  void post(std::function<void()> work) override;
  void run() override;
  void stop() override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace glidehelm::world
