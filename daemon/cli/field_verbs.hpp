#pragma once

#include "daemon/cli/arguments.hpp"

namespace glidehelm::cli {

/// The words of `glidehelm field info | sample | diff | convert | animate`.
void add_field(CLI::App& app, Action& action);

}  // namespace glidehelm::cli
