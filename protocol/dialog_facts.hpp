#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/dialog_lines.hpp"
#include "protocol/dialog_words.hpp"
#include "protocol/phrases.hpp"

namespace glidehelm::protocol {

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
  transfer_failed,
  command_succeeded,
  command_failed,
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
  /// `joined_at` is where two pieces of the line were put together (Line::kWhole: nowhere). A fact that spans it is not
  /// whole unless the layout of its line proves that no byte was lost there: location lines, times and sensor lines of short heads
  /// have fields of fixed width, fixed words are words; of `Range: 86m` nobody can tell that it was 486 (slocum.md R3).
  void find(std::string_view text, std::size_t joined_at, std::vector<Fact>& facts) const;
  /// A text of the dockserver that says that there was nothing to send.
  [[nodiscard]] bool nothing_to_send(std::string_view text) const;

 private:
  struct Built {
    std::vector<Say> says;
    std::vector<std::string_view> phrases;
    std::vector<std::string> nothing_to_send;
  };
  static Built build(const DialogWords& words);
  FactFinder(const Built& built)
      : says_{built.says}, phrases_{built.phrases}, nothing_to_send_{built.nothing_to_send} {}

  std::vector<Say> says_;  ///< by phrase
  Phrases phrases_;
  std::vector<std::string> nothing_to_send_;
};

}  // namespace glidehelm::protocol
