#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/base/expected.hpp"
#include "daemon/world/clock.hpp"
#include "daemon/world/net.hpp"
#include "simulator/scenario.hpp"

namespace glidehelm::simulator {

/// One glider's dialog on its way to the daemon: a TCP stream that the dockserver keeps open from call to call, dialled
/// by us or by the daemon. What is written while no stream is open is lost, as on a real line; whoever must not lose it
/// waits for `open()` first. Used from the loop's thread.
class DialogLine {
 public:
  struct Told {
    std::function<void()> changed;                 ///< opened or closed
    std::function<void(const std::string&)> said;  ///< what an operator of the simulator may want to know
  };
  DialogLine(world::Net& net, world::Clock& wall, LineAddress address, Told told);
  ~DialogLine();
  DialogLine(const DialogLine&) = delete;
  DialogLine& operator=(const DialogLine&) = delete;

  /// Listens, or dials until somebody answers (every 200 ms of wall time). Fails only when the port cannot be had.
  [[nodiscard]] Expected<Done, world::NetError> start();
  [[nodiscard]] bool open() const { return stream_ != nullptr; }
  void write(std::string bytes);
  /// The link falls: the stream is closed and a new one is sought at once.
  void drop();
  /// The link falls and nobody notices: the older stream stays open and silent, a new one is sought at once. Only the side
  /// that dials can do so; a line that listens drops.
  void abandon();
  /// Bytes written over the life of this line.
  [[nodiscard]] std::uint64_t total() const { return total_; }
  /// Bytes written to the stream that is open now; 0 when none is.
  [[nodiscard]] std::uint64_t on_stream() const { return stream_ ? on_stream_ : 0; }
  [[nodiscard]] const LineAddress& address() const { return address_; }
  void close();

 private:
  void dial();
  void adopt(std::shared_ptr<world::Stream> stream);
  void lost(std::string_view reason);

  world::Net& net_;
  world::Clock& wall_;
  LineAddress address_;
  Told told_;
  std::unique_ptr<world::Listener> listener_;
  std::shared_ptr<world::Stream> stream_, abandoned_;
  std::shared_ptr<int> alive_ = std::make_shared<int>(0);  ///< callbacks of the loop may outlive this object
  std::uint64_t total_{}, on_stream_{};
  bool closed_{}, complained_{};
};

}  // namespace glidehelm::simulator
