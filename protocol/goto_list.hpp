#pragma once

#include <string>
#include <string_view>

#include "core/base/expected.hpp"
#include "core/base/time.hpp"
#include "core/model/waypoint_list.hpp"

namespace glidehelm::protocol {

/// `goto_l07.ma`: two digits, lower case (DOS 8.3). Precondition: 0 ≤ slot ≤ 99.
std::string goto_list_name(int slot);

/// What the comment header of a file says. Text is limited to `[A-Za-z0-9 :._-]`; anything else becomes `_`, so that no outside
/// text can end a comment (trust.md V-18).
struct GotoListComment {
  Instant stamp;
  std::string plan_id, method;
};

/// The bytes of a goto list (slocum.md W1–W4): behaviour name first, comment header, every b_arg written out in SFMC's order with masterdata
/// units, longitude first, `%.4f` of DDMM through integer 1e-4 minutes; LF, ASCII, final newline, at most 4 KiB. num_waypoints equals
/// the list. `at_end: loop` is num_legs_to_run −1, `wait` is −2 with end_action 6. Precondition: 1–99 points, radius ≥ 10 m.
std::string write_goto_list(const model::WaypointList& list, const GotoListComment& comment);

/// Why bytes are not a list of ours.
struct BadList {
  int line{};
  std::string message;
  friend bool operator==(const BadList&, const BadList&) = default;
};

/// Reads back what `write_goto_list` writes and nothing else (W5): the same keys in the same order. Roles are told by place: the
/// file does not know them, every point comes back as an aim point.
Expected<model::WaypointList, BadList> read_goto_list(std::string_view bytes);

}  // namespace glidehelm::protocol
