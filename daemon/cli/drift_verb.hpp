#pragma once

#include "daemon/cli/arguments.hpp"

namespace glidehelm::cli {

/// Adds the verb `drift` to the program.
void add_drift(CLI::App& app, Action& action);

}  // namespace glidehelm::cli
