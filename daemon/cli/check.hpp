#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "daemon/world/world.hpp"

namespace glidehelm::cli {

/// `glidehelm check FILE… [--effective] [--json]`.
struct CheckOptions {
  std::vector<std::string> files;
  bool effective{};  ///< print the values in force with the origin of each
  bool json{};
};

/// Checks mission and daemon files, told apart by `schema:`. A daemon file is checked together with the mission files that
/// its patterns match, which are then reported like files of the command line. Opens no socket and changes nothing.
///
/// Text: every error on `err`, one line each; on `out` the YAML of `--effective`, or one "FILE: MISSION NAME …: right" line.
/// JSON on `out`: {"files": [{"file", "kind": "mission" | "daemon" | "unknown", "valid", "problems": [{"line", "column",
/// "key", "message"}], "effective" (with --effective, when valid)}]}; line and column are 0 when the file as a whole is
/// meant. Returns 0 when every file is right, 1 when one is not, 2 without files.
int run_check(const CheckOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
