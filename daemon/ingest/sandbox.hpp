#pragma once

#include <string>

#include "core/base/expected.hpp"

/// How this program gives up what it does not need before it looks at the first byte of a stranger.
namespace glidehelm::ingest {

/// From now on this process computes: it reads the system's own files (libraries, the units' database; with `network` also
/// what a name resolver and TLS need, and it may use /tmp), makes, renames and removes files in `output_folder`, starts nothing, signals nobody
/// and, unless `network`, opens no socket. What is open stays open. Limits of memory, CPU time, file size and descriptors are
/// set by whoever starts the program (daemon/ingest_client). docs/decisions/017 says what each fence is good for.
///
/// The text is a kernel that has a fence and refuses it; a kernel without one is no error.
Expected<Done, std::string> enter_sandbox(const std::string& output_folder, bool network);

}  // namespace glidehelm::ingest
