#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/time.hpp"
#include "daemon/world/files.hpp"

namespace glidehelm::world {

struct ProcessRequest {
  std::string program;  ///< absolute path, or a name looked up beside the running executable, then in PATH
  std::vector<std::string> arguments;
  std::string input;                      ///< written to its standard input, then closed
  std::shared_ptr<OpenFile> descriptor3;  ///< passed as descriptor 3 when set; all others but 0–2 are closed
  Seconds deadline{30};                   ///< then SIGKILL
  std::size_t output_at_most{16U << 20};  ///< of stdout and of stderr each; beyond that it is killed
  std::size_t memory_at_most{};           ///< RLIMIT_AS in bytes; 0 = none
  std::size_t file_at_most{};             ///< RLIMIT_FSIZE in bytes; 0 = none
  unsigned cpu_at_most_s{};               ///< RLIMIT_CPU: SIGXCPU, a second later SIGKILL; 0 = none
  unsigned descriptors_at_most{};         ///< RLIMIT_NOFILE; 0 = none
  /// A child that reads what strangers wrote: it can gain no privileges, gets an environment of LC_ALL=C alone, and is the
  /// system's first victim when memory runs out (OOM score +500).
  bool disposable{};
};

struct ProcessResult {
  enum class End { exited, signalled, deadline, output_too_long, not_started } end{End::not_started};
  int code{};  ///< exit code or signal number or errno
  std::string out, err;
  [[nodiscard]] bool succeeded() const { return end == End::exited && code == 0; }
};

/// How a child died of a signal, in words: the limits of a request end in signals of their own. "used more CPU time than it
/// may", "died of signal 11 (Segmentation fault)", …
std::string death_by(int signal);

/// Children: exec'd with an empty environment but for PATH, TMPDIR and LC_ALL=C, PR_SET_PDEATHSIG, closed descriptors, no
/// core dump.
class Procs {
 public:
  virtual ~Procs() = default;
  /// `then` is called from the loop. Starting is never an exception: not_started tells.
  virtual void run(ProcessRequest request, std::function<void(ProcessResult)> then) = 0;
  /// For the command line: blocks.
  [[nodiscard]] virtual ProcessResult run_and_wait(const ProcessRequest& request) = 0;
};

}  // namespace glidehelm::world
