#include "simulator/lockstep.hpp"

#include <charconv>

namespace glidehelm::simulator {
namespace {

constexpr std::size_t kLongestLine = 256;

std::optional<std::int64_t> whole(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Idle> idle_from(std::string_view line) {
  constexpr std::string_view kWord = "idle ";
  if (line.substr(0, kWord.size()) != kWord) return std::nullopt;
  line.remove_prefix(kWord.size());
  const auto blank = line.find(' ');
  if (blank == std::string_view::npos) return std::nullopt;
  const auto tick = whole(line.substr(0, blank));
  const auto next = line.substr(blank + 1);
  if (!tick) return std::nullopt;
  if (next == "none") return Idle{*tick, std::nullopt};
  const auto timer = whole(next);
  if (!timer) return std::nullopt;
  return Idle{*tick, timer};
}

std::string run_line(Instant utc, std::int64_t tick_ms,
                     const std::vector<std::pair<std::string, std::uint64_t>>& bytes) {
  std::string line = "run " + std::to_string(utc.time_since_epoch().count()) + " " + std::to_string(tick_ms);
  for (const auto& [name, count] : bytes) line += " " + name + "=" + std::to_string(count);
  return line + "\n";
}

Expected<Done, world::NetError> ClockServer::listen(const std::string& path) {
  std::weak_ptr<int> alive = alive_;
  auto listener = net_.listen_unix(path, 0600, [this, alive](std::shared_ptr<world::Stream> stream) {
    if (!alive.expired()) adopt(std::move(stream));
  });
  if (!listener) return unexpected(listener.error());
  listener_ = std::move(*listener);
  return Done{};
}

void ClockServer::adopt(std::shared_ptr<world::Stream> stream) {
  if (stream_) {
    stream_->close();
    stream_.reset();
    if (told_.lost) told_.lost();
  }
  stream_ = std::move(stream);
  partial_.clear();
  std::weak_ptr<int> alive = alive_;
  const auto* mine = stream_.get();
  stream_->start({[this, alive, mine](std::string_view bytes) {
                    if (!alive.expired() && stream_.get() == mine) hear(bytes);
                  },
                  [this, alive, mine](std::string_view) {
                    if (alive.expired() || stream_.get() != mine) return;
                    stream_.reset();
                    if (told_.lost) told_.lost();
                  }});
  stream_->write("glidersim-clock 1\n");
  if (told_.connected) told_.connected();
}

void ClockServer::hear(std::string_view bytes) {
  partial_ += bytes;
  for (auto end = partial_.find('\n'); stream_ && end != std::string::npos; end = partial_.find('\n')) {
    const std::string line = partial_.substr(0, end);
    partial_.erase(0, end + 1);
    const auto idle = idle_from(line);
    if (!idle || idle->tick_ms != asked_ms_) {
      if (told_.nonsense) told_.nonsense(line.substr(0, kLongestLine));
      partial_.clear();
      return;
    }
    if (told_.idle) told_.idle(*idle);
  }
  if (partial_.size() > kLongestLine) {
    if (told_.nonsense) told_.nonsense(partial_.substr(0, kLongestLine));
    partial_.clear();
  }
}

void ClockServer::run(Instant utc, std::int64_t tick_ms,
                      const std::vector<std::pair<std::string, std::uint64_t>>& bytes) {
  asked_ms_ = tick_ms;
  stream_->write(run_line(utc, tick_ms, bytes));
}

void ClockServer::close() {
  listener_.reset();
  if (stream_) stream_->close();
  stream_.reset();
}

}  // namespace glidehelm::simulator
