#include "daemon/world/simulated_clock.hpp"

#include <charconv>
#include <utility>

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

constexpr int kTries = 300;
constexpr std::chrono::milliseconds kBetweenTries{200};
constexpr std::size_t kLongestLine = 64U << 10;

}  // namespace

SimulatedClock::SimulatedClock(Net& net, Clock& wall, std::string socket, std::function<void(std::string_view)> lost)
    : net_{net}, wall_{wall}, socket_{std::move(socket)}, lost_{std::move(lost)} {}

void SimulatedClock::start(std::function<void()> ready) {
  ready_ = std::move(ready);
  connect(kTries);
}

SimulatedClock::~SimulatedClock() {
  *alive_ = false;
  if (stream_) stream_->close();
}

/// Once: whoever hears it may destroy this clock.
void SimulatedClock::lose(std::string_view reason) {
  if (stream_) std::exchange(stream_, nullptr)->close();
  running_ = false;
  if (const auto lost = std::exchange(lost_, nullptr)) lost(reason);
}

void SimulatedClock::connect(int tries_left) {
  net_.connect_unix(socket_, [this, tries_left, alive = alive_](Expected<std::shared_ptr<Stream>, NetError> stream) {
    if (!*alive) return;
    if (!stream) {
      if (tries_left == 0)
        lose(stream.error().message());
      else
        wall_.call_at(wall_.tick() + kBetweenTries, [this, tries_left, alive] {
          if (*alive) connect(tries_left - 1);
        });
      return;
    }
    stream_ = std::move(stream).value();
    stream_->start({[this, alive](std::string_view bytes) {
                      if (*alive) take_bytes(bytes);
                    },
                    [this, alive](std::string_view reason) {
                      if (*alive) lose(reason);
                    }});
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
  const auto alive = alive_;  // a line may end this clock
  for (auto end = partial_.find('\n'); stream_ && end != std::string::npos; end = partial_.find('\n')) {
    const auto line = partial_.substr(0, end);
    partial_.erase(0, end + 1);
    take_line(line);
    if (!*alive) return;
  }
  if (partial_.size() > kLongestLine) lose("the simulator sent a line without end");
}

void SimulatedClock::take_line(std::string_view line) {
  const std::string whole{line};
  const auto nonsense = [&] { lose("the simulator sent: " + whole.substr(0, 200)); };
  if (!greeted_) {
    greeted_ = line == "glidersim-clock 1";
    if (!greeted_) lose("the simulator speaks another version: " + whole.substr(0, 200));
    return;
  }
  std::int64_t utc_ms{}, tick_ms{};
  if (take_word(line) != "run" || !read_number(take_word(line), utc_ms) || !read_number(take_word(line), tick_ms))
    return nonsense();
  const Tick tick{std::chrono::milliseconds{tick_ms}};
  if (running_ || tick < tick_) return nonsense();  // a second `run` before our answer, or time that goes back
  while (!line.empty()) {
    const auto pair = take_word(line);
    const auto equals = pair.rfind('=');
    std::uint64_t total{};
    if (equals == std::string_view::npos || !read_number(pair.substr(equals + 1), total)) return nonsense();
    sent_[std::string{pair.substr(0, equals)}] = total;
  }
  utc_ = Instant{std::chrono::milliseconds{utc_ms}};
  tick_ = tick;
  running_ = true;
  if (on_run_) on_run_();
  if (ready_) std::exchange(ready_, nullptr)();
  settle();
}

/// Fires what is due and answers when all is done. Timers may make the daemon busy, or call back in here.
void SimulatedClock::settle() {
  if (!running_ || settling_ || busy_) return;
  settling_ = true;
  while (auto then = queue_.take_due(tick_)) (*then)();
  settling_ = false;
  if (busy_ || !running_ || !stream_) return;
  for (const auto& [line, total] : sent_)
    if (handled_[line] < total) return;
  running_ = false;
  const auto next = queue_.next();
  stream_->write("idle " + std::to_string(tick_.time_since_epoch().count()) + " " +
                 (next ? std::to_string(next->time_since_epoch().count()) : std::string{"none"}) + "\n");
}

}  // namespace glidehelm::world
