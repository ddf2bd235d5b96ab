#pragma once

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace glidehelm::test {

/// A folder of its own that goes away with the test. Short, because a Unix socket's path has at most 107 bytes.
struct TempFolder {
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "gsimXXXXXX").string();
    REQUIRE(mkdtemp(pattern.data()) != nullptr);
    path = pattern;
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream{path / name, std::ios::binary} << bytes;
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream in{path / name, std::ios::binary};
    std::ostringstream bytes;
    bytes << in.rdbuf();
    return bytes.str();
  }
  [[nodiscard]] bool has(const std::string& name) const { return std::filesystem::exists(path / name); }
  std::filesystem::path path;
};

}  // namespace glidehelm::test
