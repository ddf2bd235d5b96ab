#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "config/mission.hpp"
#include "config/yaml_reader.hpp"
#include "core/base/expected.hpp"

namespace glidehelm::test {

/// A loader over files that exist only in the test.
inline config::LoadFile files_of(std::map<std::string, std::string> files) {
  return [files = std::move(files)](const std::string& path) -> Expected<std::string, config::Unreadable> {
    const auto found = files.find(path);
    if (found == files.end()) return unexpected(config::Unreadable{"No such file or directory"});
    return found->second;
  };
}
inline config::LoadFile no_files() { return files_of({}); }

/// "LINE:COLUMN KEY: PROBLEM…" of each error: the message without the file.
inline std::vector<std::string> lines_of(const std::vector<config::ConfigError>& errors) {
  std::vector<std::string> result;
  for (const auto& error : errors)
    result.push_back(std::to_string(error.line) + ":" + std::to_string(error.column) + " " + error.text());
  return result;
}

template <class T>
std::vector<std::string> errors_of(const Expected<T, std::vector<config::ConfigError>>& result) {
  return result ? std::vector<std::string>{} : lines_of(result.error());
}

inline std::string file_text(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  REQUIRE(file);
  return {std::istreambuf_iterator<char>{file}, {}};
}

/// The six lines of the smallest legal mission, with further lines after them.
inline std::string six_lines(const std::string& more = {}) {
  return "schema: glidehelm/mission/v1\n"
         "name: leg-2\n"
         "glider: sim01\n"
         "goal: {lat_deg: 29.1667, lon_deg: -15.5}\n"
         "currents: {files: [/var/lib/glidehelm/currents/*.nc]}\n"
         "approval: {mode: auto}\n" +
         more;
}

}  // namespace glidehelm::test
