#pragma once

#include <string>
#include <string_view>

#include "core/base/expected.hpp"
#include "core/mission/event.hpp"

/// Events and effects of a pilot as one line of JSON each: what the journal holds. Exact: reading back gives the same value.
namespace glidehelm::daemon {

/// An event with the glider it happened to.
struct JournalledEvent {
  std::string glider;
  mission::Event event;
  friend bool operator==(const JournalledEvent&, const JournalledEvent&) = default;
};

std::string event_json(std::string_view glider, const mission::Event& event);
/// The mission of a MissionChanged is read again from its YAML. Members that came after the first journals may be missing. The
/// error says what is wrong and where.
Expected<JournalledEvent, std::string> event_from_json(std::string_view text);

/// For comparing a replay with what was done; effects are not read back.
std::string effect_json(const mission::Effect& effect);

}  // namespace glidehelm::daemon
