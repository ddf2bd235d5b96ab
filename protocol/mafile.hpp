#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/geo.hpp"

namespace glidehelm::protocol {

enum class Severity { warning, error };

/// Something about a mafile that its pilot should know. Lines and columns count from 1, columns in bytes; 0 means the
/// file as a whole. Codes are stable for scripts:
///
///   behavior-name       the first line is not behavior_name=WORD
///   unknown-behavior    no behaviour of that name is known to be read from a mafile
///   section             a section is opened twice, never opened, never closed, or closed without having been opened
///   stray-text          text where a section tag, a b_arg or a comment belongs
///   b-arg-form          not b_arg: NAME(UNIT) NUMBER
///   bad-number          a value is missing or is not a number
///   text-after-value    text without # behind a value or a waypoint; `| name` occurs
///   duplicate-b-arg     given before; which one wins on the glider is unknown, the last one wins here
///   unknown-b-arg       no such b_arg of goto_list, surface, yo or sample is known; kept as it is
///   unit                not the unit of masterdata (decoration: it flies)
///   range               outside what masterdata allows, or at odds with another b_arg (pitch, depths)
///   not-whole           an enum or a count that is not a whole number
///   missing-b-arg       left out: the glider takes masterdata's default, not the mission's value
///   count-mismatch      num_waypoints differs from the list; the listed ones count
///   too-many-waypoints  more than the documented maximum
///   no-waypoints        the list is empty or absent
///   third-number        a waypoint has more than two numbers
///   coordinate          not DDMM.mm, 60 minutes or more, out of range, or never set
///   null-position       0/0
///   quits-at-end        num_legs_to_run -2 without end_action 6: goto_list ends behind the last waypoint
///   decimal-degrees     reading both numbers as decimal degrees lies closer to the glider
///   swapped             reading latitude first lies closer to the glider
///   far-away            more than 500 km from the glider
///   inside-radius       the first waypoint is nearer to the glider than the radius: it counts as reached at once
///   encoding            a byte that is not printable ASCII
///   line-ends           CR LF, or no newline at the end
///   size                the file or a line is longer than the reader takes
struct MafileProblem {
  int line{}, column{};
  std::string code;
  Severity severity{};
  std::string message;
  [[nodiscard]] std::string text() const;  ///< "line 12, column 3: error: … [code]"
  friend bool operator==(const MafileProblem&, const MafileProblem&) = default;
};

struct BArg {
  std::string name;
  std::optional<double> value;  ///< none when it could not be read
  std::string text;             ///< the value as written
  std::string unit;
  int line{}, column{};  ///< of the value
  friend bool operator==(const BArg&, const BArg&) = default;
};

struct MafileWaypoint {
  std::string lon_text, lat_text;
  std::optional<GeoPoint> at;  ///< none when it is not a position
  int line{}, column{};
  friend bool operator==(const MafileWaypoint&, const MafileWaypoint&) = default;
};

struct Mafile {
  std::string behavior;      ///< lower case; empty when not readable
  std::vector<BArg> b_args;  ///< in the order of the file, duplicates included
  std::vector<MafileWaypoint> waypoints;
  std::vector<MafileProblem> problems;  ///< in the order of the file
  /// True without a problem of severity error.
  [[nodiscard]] bool valid() const;
  /// The last b_arg of that name.
  [[nodiscard]] const BArg* b_arg(std::string_view name) const;
  /// What the glider takes (slocum.md 2.2): the last value given or, when the file does not name the b_arg, masterdata's
  /// default, not the mission's value. None when the value is no number or no default is known.
  [[nodiscard]] std::optional<double> in_force(std::string_view name) const;
  friend bool operator==(const Mafile&, const Mafile&) = default;
};

struct MafileOptions {
  /// strict: what we would send ourselves. lenient: what pilots write and gliders fly; doubts are warnings.
  enum class Mode { lenient, strict } mode{Mode::lenient};
  std::optional<GeoPoint> near;  ///< the glider: waypoints are checked for plausibility against it
  int max_waypoints{8};
};

inline constexpr std::size_t kLargestMafile = 256U << 10;
inline constexpr std::size_t kLongestMafileLine = 1000;

/// Reads any mafile (goto_list, surface, yo, sample, set_heading, …) by the grammar of slocum.md 2.1 and checks what is
/// known of its behaviour (2.2, 2.6). Always answers: what cannot be read is a problem with its place. Linear in the
/// length; any bytes are safe.
Mafile read_mafile(std::string_view bytes, const MafileOptions& options);

}  // namespace glidehelm::protocol
