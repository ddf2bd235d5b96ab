#include "daemon/world/simulated_clock.hpp"

#include <charconv>

namespace glidehelm::world {

namespace {

std::string_view take_word(std::string_view& text) {
  const auto space = text.find(' ');
  const auto word = text.substr(0, space);
  text = space == std::string_view::npos ? std::string_view{} : text.substr(space + 1);
  return word;
}

template <class T>
bool read_number(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

constexpr std::size_t kLongestLine = 64U << 10;

}  // namespace

SimulatedClock::SimulatedClock(Net& net, std::string socket, std::function<void(std::string_view)> lost)
    : net_{net}, socket_{std::move(socket)}, lost_{std::move(lost)} {}

void SimulatedClock::start(std::function<void()> ready) {
  ready_ = std::move(ready);
  net_.connect_unix(socket_, [this](Expected<std::shared_ptr<Stream>, NetError> stream) {
    if (!stream) {
      lost_(stream.error().message());
      return;
    }
    stream_ = std::move(stream).value();
    stream_->start(
        {[this](std::string_view bytes) { take_bytes(bytes); }, [this](std::string_view reason) { lost_(reason); }});
  });
}

void SimulatedClock::handled(const std::string& line, std::uint64_t total) {
  handled_[line] = total;
  settle();
}

void SimulatedClock::set_busy(bool busy) {
  busy_ = busy;
  if (!busy) settle();
}

void SimulatedClock::take_bytes(std::string_view bytes) {
  partial_.append(bytes);
  std::size_t begin = 0;
  for (auto end = partial_.find('\n'); end != std::string::npos; end = partial_.find('\n', begin)) {
    take_line(std::string_view{partial_}.substr(begin, end - begin));
    begin = end + 1;
  }
  partial_.erase(0, begin);
  if (partial_.size() > kLongestLine) lost_("the simulator sent a line without end");
}

void SimulatedClock::take_line(std::string_view line) {
  const std::string whole{line};
  if (!greeted_) {
    greeted_ = line == "glidersim-clock 1";
    if (!greeted_) lost_("the simulator speaks another version: " + whole);
    return;
  }
  std::int64_t utc_ms{}, tick_ms{};
  if (take_word(line) != "run" || !read_number(take_word(line), utc_ms) || !read_number(take_word(line), tick_ms) ||
      Tick{std::chrono::milliseconds{tick_ms}} < tick_) {
    lost_("the simulator sent: " + whole);
    return;
  }
  while (!line.empty()) {
    const auto pair = take_word(line);
    const auto equals = pair.rfind('=');
    std::uint64_t total{};
    if (equals == std::string_view::npos || !read_number(pair.substr(equals + 1), total)) {
      lost_("the simulator sent: " + whole);
      return;
    }
    sent_[std::string{pair.substr(0, equals)}] = total;
  }
  utc_ = Instant{std::chrono::milliseconds{utc_ms}};
  tick_ = Tick{std::chrono::milliseconds{tick_ms}};
  running_ = true;
  if (ready_) std::exchange(ready_, nullptr)();
  settle();
}

/// Fires what is due and answers when all is done. Timers may make the daemon busy, or call back in here.
void SimulatedClock::settle() {
  if (!running_ || settling_ || busy_) return;
  settling_ = true;
  while (auto then = queue_.take_due(tick_)) (*then)();
  settling_ = false;
  if (busy_ || !running_) return;
  for (const auto& [line, total] : sent_)
    if (handled_[line] < total) return;
  running_ = false;
  const auto next = queue_.next();
  stream_->write("idle " + std::to_string(tick_.time_since_epoch().count()) + " " +
                 (next ? std::to_string(next->time_since_epoch().count()) : std::string{"none"}) + "\n");
}

}  // namespace glidehelm::world
