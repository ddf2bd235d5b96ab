#include "daemon/world/failpoint.hpp"

#include <signal.h>

#include <charconv>
#include <cstdlib>
#include <string>

namespace glidehelm::world {

namespace {

struct Armed {
  std::string step;
  int countdown{1};
};

Armed read_environment() {
  const char* value = std::getenv("GLIDEHELM_FAILPOINT");
  if (value == nullptr) return {};
  std::string_view text{value};
  Armed armed;
  const auto at = text.find('@');
  armed.step = std::string{text.substr(0, at)};
  if (at != std::string_view::npos) std::from_chars(text.data() + at + 1, text.data() + text.size(), armed.countdown);
  return armed;
}

}  // namespace

void failpoint(std::string_view step) {
  static Armed armed;
  if (armed.step.empty()) armed = read_environment();
  if (armed.step.empty() || armed.step != step) return;
  if (--armed.countdown == 0) ::raise(SIGKILL);
}

}  // namespace glidehelm::world
