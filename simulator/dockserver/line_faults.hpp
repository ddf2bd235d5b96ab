#pragma once

#include <string>
#include <vector>

#include "simulator/random.hpp"

namespace glidehelm::simulator {

/// What goes wrong with one call. `at` and `how` are drawn with each call and say where and how, each in [0, 1).
struct CallFaults {
  bool lost{};                 ///< no call at all: no byte, no file, no Ctrl-F
  bool not_taken{};            ///< the script does not run: files stay where they are
  bool no_connection_block{};  ///< the first block is lost; only at-surface blocks are read
  bool redial{};               ///< the link drops after the at-surface block; the glider calls again
  // the call
  bool cut{};        ///< the link falls somewhere in the middle of a line, and the glider does not call again
  bool half_open{};  ///< as redial, but nobody closes the older connection: both are open
  bool call_back{};  ///< `H 5`: the glider hangs up and calls again in five minutes, with the fix that it had
  bool
      late_script{};  ///< the script runs one to eleven minutes late, or not before the dive: the file is picked up late
  bool
      transfer_cut{};  ///< the link falls in the transfer: the glider keeps the first part of the file, the folder all of it
  bool science_files{};  ///< the script first fetches *.sbd and *.tbd: ZMODEM bytes in the dialog
  bool wrong_keys{};     ///< somebody types keys that the glider does not know
  bool chatter{};        ///< lines of device drivers between the others
  // the bytes
  bool garbled{};           ///< bytes are changed and lost
  bool injected{};          ///< a block of the dockserver in the middle of a line
  bool injected_lossily{};  ///< the same, and it eats bytes of that line
  bool duplicated{};        ///< what was printed comes twice
  bool slow{};              ///< the line passes few bytes a second
  double at{}, how{};
  friend bool operator==(const CallFaults&, const CallFaults&) = default;
};

/// The faults by their scenario keys, in the order above.
struct NamedFault {
  const char* name;
  bool CallFaults::*flag;
};
const std::vector<NamedFault>& fault_names();
/// Names of those that struck.
std::vector<std::string> struck(const CallFaults& faults);

/// Numbers that the faults of a line need.
struct LineSetup {
  double slow_bytes_per_s{120};    ///< of a slow line
  double garbled_per_kilobyte{1};  ///< places at which a garbled line changes or loses bytes
  friend bool operator==(const LineSetup&, const LineSetup&) = default;
};

/// What a bad line makes of the bytes of one print. Draws only from its own generator, and only for faults that struck.
class LineNoise {
 public:
  LineNoise(LineSetup setup, Random random) : setup_{setup}, random_{random} {}

  /// The bytes as they come out at the other end.
  std::string spoil(std::string bytes, const CallFaults& faults);
  [[nodiscard]] const LineSetup& setup() const { return setup_; }

  /// `size` bytes of a binary transfer: ZDLE escapes, line ends and anything else that a compressed file holds.
  static std::string binary(std::size_t size, Random random);

 private:
  void garble(std::string& bytes);
  void inject(std::string& bytes, bool lossily);

  LineSetup setup_;
  Random random_;
};

}  // namespace glidehelm::simulator
