#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/dialog_lines.hpp"
#include "protocol/phrases.hpp"

namespace glidehelm::protocol {

/// The texts that no sample shows and that may differ between firmwares and dockservers (slocum.md 5, note on
/// evidence).
struct DialogWords {
  std::vector<std::string> reread{"MAFILES will be re-read", "MAFILES reread"};
  std::vector<std::string> transfer_starts{"Starting zModem transfer of "};  ///< a file name follows
  std::vector<std::string> transfer_done{"zModem transfer DONE for file "};  ///< a file name follows
  friend bool operator==(const DialogWords&, const DialogWords&) = default;
};

/// What a line of the dialog can say.
enum class Say : std::size_t {
  connection_event,
  iridium,
  vehicle,
  curr_time,
  dr,
  too_far,
  invalid,
  gps,
  sensor,
  at_surface,
  because,
  mission,
  water,
  waypoint,
  until_diving,
  extending,
  typed_resume,
  resuming,
  timed_out,
  console_off,
  completed,
  end_of_mission,
  starting,
  aborts,
  devices,
  gliderdos,
  gliderlab,
  scidos,
  heard_a,
  noise,
  oddity,
  login,
  reread,
  transfer_starts,
  transfer_done,
};

struct CarrierLost {};
struct CarrierFound {};
struct Nothing {};

/// One thing that a line says. `whole` is false for a label whose line is not complete: it is counted and kept as text,
/// and nothing of it is used (slocum.md R7).
struct Fact {
  Say say{};
  bool whole{};
  std::variant<Nothing, CarrierFound, CarrierLost, std::string, CurrTime, Location, SensorReading, BecauseLine,
               MissionLine, WaypointLine, DevicesLine, WaterState, Prompt, double>
      value;
  std::size_t end{};  ///< behind the last character that belongs to it
};

/// Finds the facts of one line, in their order; several can stand in one line when line ends were lost. Keeps no memory
/// of other lines: `const` use from several threads is safe.
class FactFinder {
 public:
  explicit FactFinder(const DialogWords& words);
  /// `joined_at` is where two pieces of the line were put together (Line::kWhole: nowhere). A number that spans it is
  /// not trusted unless the layout of the line proves that no byte was lost.
  void find(std::string_view text, std::size_t joined_at, std::vector<Fact>& facts) const;

 private:
  struct Built {
    std::vector<Say> says;
    std::vector<std::string_view> phrases;
  };
  static Built build(const DialogWords& words);
  FactFinder(const Built& built) : says_{built.says}, phrases_{built.phrases} {}

  std::vector<Say> says_;  ///< by phrase
  Phrases phrases_;
};

}  // namespace glidehelm::protocol
