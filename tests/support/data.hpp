#pragma once

#include <catch2/catch.hpp>
#include <cstdlib>
#include <optional>
#include <string>

namespace glidehelm::test {

/// The folder of real samples (GLIDEHELM_DATA), or nothing. Cases that use it are named "real data: …", so that the
/// test script can count them; with the variable set a missing file is a failure, not a skip.
inline std::optional<std::string> data_folder() {
  const char* folder = std::getenv("GLIDEHELM_DATA");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  return std::string{folder};
}

}  // namespace glidehelm::test

/// `GLIDEHELM_NEEDS_DATA(folder);` at the top of a "real data: …" case.
#define GLIDEHELM_NEEDS_DATA(variable)                                        \
  const auto variable##_ = ::glidehelm::test::data_folder();                  \
  if (!variable##_) {                                                         \
    WARN("not run: GLIDEHELM_DATA does not name the folder of real samples"); \
    return;                                                                   \
  }                                                                           \
  const std::string variable = *variable##_
