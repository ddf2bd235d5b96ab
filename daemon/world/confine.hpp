#pragma once

#include <string>
#include <vector>

#include "core/base/expected.hpp"

namespace glidehelm::world {

/// What this process still needs of the system; everything else is given up, for good.
struct Confinement {
  std::vector<std::string>
      read_below;  ///< folders (or files) that may still be opened for reading; absent ones are skipped
  std::vector<std::string> write_below;  ///< folders in which regular files may be made, renamed and removed
  bool network{};                        ///< sockets may be made
};

/// What the kernel took away: an older one knows less.
struct Confined {
  bool files{};  ///< Landlock: no file beside those of the order
  bool calls{};  ///< seccomp: no program, no other process, no socket (unless wanted), no administration
};

/// Gives up everything but what the order names. Descriptors that are open stay usable. Cannot be undone, and holds for
/// every thread that the calling one starts later: call it from `main`, before other threads.
///
/// Files are fenced by Landlock (Linux 5.13), system calls by a seccomp filter that forbids what a computation never needs:
/// starting programs and processes, tracing, signals to others and sockets give EPERM, the rest of the list (mounting,
/// modules, key rings, other processes' memory, a foreign calling convention) kills with SIGSYS. It forbids instead of
/// allowing, so that a new libc cannot turn every forecast into a crash. Where the kernel has one of the two not, that one
/// is left out and the result says so. The error is a kernel that has it and refuses.
///
/// Programs under AddressSanitizer or ThreadSanitizer keep their system calls: their reports need a second process.
Expected<Confined, std::string> confine(const Confinement& order);

}  // namespace glidehelm::world
