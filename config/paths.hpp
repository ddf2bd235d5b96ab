#pragma once

#include <functional>
#include <string>

#include "core/base/expected.hpp"

namespace glidehelm::config {

/// Gives the bytes of a file, or the reason in words why not. Handed in: config/ opens no file itself.
using LoadFile = std::function<Expected<std::string, struct Unreadable>(const std::string& path)>;

/// Why a file cannot be read: "No such file or directory".
struct Unreadable {
  std::string reason;
};

/// A path that stands in `file`: relative ones are meant from the folder of that file, so that the daemon, the command
/// line and a test find the same thing from whatever folder they run in. An address ("http://…") stays what it is.
inline std::string path_beside(const std::string& file, const std::string& path) {
  const auto slash = file.find_last_of('/');
  if (path.empty() || path.front() == '/' || slash == std::string::npos || path.find("://") != std::string::npos)
    return path;
  return file.substr(0, slash + 1) + path;
}

}  // namespace glidehelm::config
