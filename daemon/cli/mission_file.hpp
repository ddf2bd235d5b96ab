#pragma once

#include <string>

#include "core/base/expected.hpp"
#include "core/mission/mission.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::cli {

/// A failure with its exit code.
struct Trouble {
  int code{};
  std::string message;
};

/// Reads a mission file that a user named, with the area files that it names. Every error of it, one line each; code 2.
/// `text` is left with its bytes.
Expected<mission::Mission, Trouble> mission_from(const std::string& path, world::Files& files, std::string& text);

}  // namespace glidehelm::cli
