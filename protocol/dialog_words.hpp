#pragma once

#include <string>
#include <vector>

namespace glidehelm::protocol {

/// The texts around a file on its way to the glider. No sample shows a list sent and re-read, and firmwares, dockservers and
/// the scripts of a site may differ (slocum.md 5, note on evidence), so each can be replaced by any number of others: key
/// `dialog` of a glider in the daemon file. Searched anywhere in a line, compared with case; one of fewer than two characters is
/// ignored. docs/dialogs.md says where each default comes from.
struct DialogWords {
  std::vector<std::string> reread{"MAFILES will be re-read", "MAFILES reread"};
  std::vector<std::string> transfer_starts{"Starting zModem transfer of"};      ///< a file name follows
  std::vector<std::string> transfer_done{"zModem transfer DONE for file"};      ///< a file name follows
  std::vector<std::string> transfer_failed{"zModem transfer FAILED for file"};  ///< a file name follows
  std::vector<std::string> command_succeeded{"! succeeded:"};                   ///< the command follows
  std::vector<std::string> command_failed{"! FAILED:"};                         ///< the command follows
  /// In what the dockserver prints, not in a line of the glider: there was no file to send.
  std::vector<std::string> nothing_to_send{"not found>"};
  friend bool operator==(const DialogWords&, const DialogWords&) = default;
};

}  // namespace glidehelm::protocol
