#include "daemon/log.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>

#include "core/base/utc.hpp"

namespace glidehelm::daemon {

namespace {

std::string_view level_word(mission::Level level) {
  switch (level) {
    case mission::Level::info:
      return "info ";
    case mission::Level::note:
      return "note ";
    case mission::Level::alert:
      return "ALERT";
    case mission::Level::page:
      return "PAGE ";
    case mission::Level::clear:
      return "clear";
  }
  return "?";
}

/// Text from the line may hold control bytes; a log line holds none.
std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte >= 0x7f)
      result += fmt::format("\\x{:02x}", byte);
    else
      result += c;
  }
  return result;
}

}  // namespace

Log::Log(std::shared_ptr<spdlog::logger> sink, const world::Clock& clock) : sink_{std::move(sink)}, clock_{clock} {}

void Log::fact(mission::Level level, std::string_view glider, std::string_view text) const {
  const auto line = fmt::format("{} {}{} {:<9} {}", utc_text(clock_.utc()), clock_.simulated() ? "SIMULATED " : "",
                                level_word(level), glider.empty() ? "-" : glider, printable(text));
  sink_->log(level == mission::Level::info || level == mission::Level::clear ? spdlog::level::info
             : level == mission::Level::note                                 ? spdlog::level::warn
                                                                             : spdlog::level::err,
             line);
}

std::shared_ptr<spdlog::logger> stdout_sink() {
  auto logger = std::make_shared<spdlog::logger>("glidehelmd", std::make_shared<spdlog::sinks::stdout_sink_mt>());
  logger->set_pattern("%v");
  logger->flush_on(spdlog::level::info);
  return logger;
}

}  // namespace glidehelm::daemon
