#pragma once

#include <string>
#include <variant>

#include "core/base/time.hpp"
#include "protocol/line_splitter.hpp"
#include "protocol/surface_block.hpp"

namespace glidehelm::protocol {

/// A console opened: `Connection Event: Carrier Detect found.` or `Iridium console active and ready...`, whichever came
/// first. What was half heard before is gone.
struct ConnectionOpened {
  friend bool operator==(ConnectionOpened, ConnectionOpened) = default;
};
/// The first vehicle name of a connection, and each time it changes (then somebody is on the wrong line).
struct NameHeard {
  std::string name;  ///< lower case
  friend bool operator==(const NameHeard&, const NameHeard&) = default;
};
/// A block with everything it said so far. One block may be given more than once, each time with more in it.
struct BlockRead {
  SurfaceBlock block;
  friend bool operator==(const BlockRead&, const BlockRead&) = default;
};
/// `Time until diving is: N secs`
struct WindowHeard {
  int seconds{};
  friend bool operator==(const WindowHeard&, const WindowHeard&) = default;
};
/// Ctrl-E: `Extending surface time by 5 minutes`
struct WindowExtended {
  Seconds by{300};
  friend bool operator==(const WindowExtended&, const WindowExtended&) = default;
};
/// The glider goes under: a key, or nobody typed one. Said once per dive.
struct MissionResumed {
  enum class By { key, time, console_off } by{};
  friend bool operator==(const MissionResumed&, const MissionResumed&) = default;
};
/// `Mission completed: MS_…`; `cause` is empty when only the end was heard. Said once per mission.
struct MissionEnded {
  std::string cause;
  friend bool operator==(const MissionEnded&, const MissionEnded&) = default;
};
/// A mission was aborted now (not in the history): a human is needed.
struct AbortSeen {
  std::string cause;  ///< `MS_ABORT_BEH_ERROR(6)` or the prompt, `GliderDos A 8`
  friend bool operator==(const AbortSeen&, const AbortSeen&) = default;
};
/// A prompt that differs from the one before it in this connection.
struct PromptSeen {
  Console console{};
  char state{};  ///< N normal, A after an abort, I initial
  int code{};
  friend bool operator==(const PromptSeen&, const PromptSeen&) = default;
};
struct TransferStarted {
  std::string file;  ///< as the dialog names it
  friend bool operator==(const TransferStarted&, const TransferStarted&) = default;
};
struct TransferDone {
  std::string file;
  friend bool operator==(const TransferDone&, const TransferDone&) = default;
};
/// A transfer ended without its file. What is on the glider now may be half of it.
struct TransferFailed {
  std::string file;
  friend bool operator==(const TransferFailed&, const TransferFailed&) = default;
};
/// `! succeeded:dockzr *`, `! FAILED: dockzs -num=3`: how a command behind `!` ended. Failed `dockzr`: nothing was sent.
struct CommandEnded {
  std::string command;  ///< as the dialog repeats it
  bool succeeded{};
  friend bool operator==(const CommandEnded&, const CommandEnded&) = default;
};
/// The dockserver was told to send files and there was none (`not found>*<`). Follows its DockserverBlock. When a list
/// lay in the folder before, somebody took it away; when it came later, it waits for the next surfacing.
struct NothingToSend {
  std::string command;  ///< `dockzr -archive *`; empty when the block did not say
  friend bool operator==(const NothingToSend&, const NothingToSend&) = default;
};
/// Ctrl-F was answered: the glider reads its mafiles again.
struct MafilesReread {
  friend bool operator==(MafilesReread, MafilesReread) = default;
};
/// The glider heard a key that somebody typed: `R`, `CR`, …
struct KeyHeard {
  std::string key;
  friend bool operator==(const KeyHeard&, const KeyHeard&) = default;
};

using DialogEvent = std::variant<ConnectionOpened, NameHeard, BlockRead, WindowHeard, WindowExtended, MissionResumed,
                                 MissionEnded, AbortSeen, PromptSeen, DockserverBlock, TransferStarted, TransferDone,
                                 TransferFailed, CommandEnded, NothingToSend, MafilesReread, KeyHeard>;

}  // namespace glidehelm::protocol
