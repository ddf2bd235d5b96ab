#pragma once

#include <string>
#include <string_view>

#include "daemon/world/files.hpp"

namespace glidehelm::cli {

/// Writes a file that does not exist yet, under the path that a user gave. What went wrong, or nothing.
inline std::string write_new_file(const std::string& path, std::string_view bytes, world::Files& files) {
  const auto slash = path.find_last_of('/');
  const auto folder_path = slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
  auto folder = files.open_folder(folder_path);
  if (!folder) return folder.error().message();
  const auto made = (*folder)->create(slash == std::string::npos ? path : path.substr(slash + 1), bytes, 0644);
  return made ? "" : made.error().message();
}

/// Why `write_new_file` would not write there, as far as that is known before: to be asked before long work. Empty: it would.
inline std::string why_not_new(const std::string& path, world::Files& files) {
  const auto slash = path.find_last_of('/');
  const auto folder_path = slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
  const auto folder = files.open_folder(folder_path);
  if (!folder) return folder.error().message();
  if ((*folder)->stat(slash == std::string::npos ? path : path.substr(slash + 1)))
    return path + " is there already and is not overwritten: name another file";
  return "";
}

}  // namespace glidehelm::cli
