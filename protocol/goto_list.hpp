#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/base/expected.hpp"
#include "core/base/time.hpp"
#include "core/model/waypoint_list.hpp"

namespace glidehelm::protocol {

/// `goto_l07.ma`: two digits, lower case (DOS 8.3). Precondition: 0 ≤ slot ≤ 99, and aborts otherwise.
std::string goto_list_name(int slot);

/// What the comment header of a file says. Texts are cut at 60 characters and limited to `[A-Za-z0-9 :._-]`; anything
/// else becomes `_`, so that no outside text can end a comment (trust.md V-18).
struct GotoListComment {
  Instant stamp;
  std::string plan_id, method;
};

inline constexpr std::size_t kLargestGotoList = 4096;
inline constexpr double kSmallestRadius = 10.0;    ///< metres; masterdata's minimum of list_when_wpt_dist
inline constexpr double kLargestRadius = 100'000;  ///< metres; beyond it the list is no list

/// The bytes of a goto list (slocum.md W1–W4, trust.md V-1…V-4): behaviour name first, our comment header, every b_arg
/// written out in SFMC's order with masterdata units, then longitude and latitude in `%.4f` of DDMM through whole units
/// of 1e-4 minute; LF, ASCII, lines of at most 100 characters, a final newline. num_waypoints equals the list. `loop`
/// is num_legs_to_run −1 with end_action 0 (never reached), `wait` is −2 with end_action 6. The radius is written in
/// 0.1 m. Precondition: 1–99 points, kSmallestRadius ≤ radius ≤ kLargestRadius. The result is below 4 KiB then.
std::string write_goto_list(const model::WaypointList& list, const GotoListComment& comment);

/// Why bytes are not a list of ours; line 0 is the file as a whole.
struct BadList {
  int line{};
  std::string message;
  friend bool operator==(const BadList&, const BadList&) = default;
};

/// Reads back what we would send and nothing else (W5): a strict mafile without a problem, at most 4 KiB, each b_arg
/// present with the values above. A file does not know roles: every point comes back as an aim point.
Expected<model::WaypointList, BadList> read_goto_list(std::string_view bytes);

}  // namespace glidehelm::protocol
