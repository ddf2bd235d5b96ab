#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/geo.hpp"
#include "core/model/waypoint_list.hpp"

namespace glidehelm::safety {

/// Why some bytes are not a goto list that we would send. Lines and columns count from 1; line 0 is the file as a
/// whole.
struct ListProblem {
  int line{}, column{};
  std::string message;
  [[nodiscard]] std::string text() const;  ///< "line 12, column 3: …"
  friend bool operator==(const ListProblem&, const ListProblem&) = default;
};

/// A waypoint exactly as written: whole units of 1e-4 minute (0.19 m of latitude), so that comparing needs no rounding.
struct FilePoint {
  std::int64_t lat_units{}, lon_units{};
  GeoPoint at;
  int line{};
  friend bool operator==(const FilePoint&, const FilePoint&) = default;
};
inline constexpr double kUnitsPerDegree = 60.0 * 10'000.0;

/// What a goto list says.
struct GotoFile {
  std::vector<FilePoint> points;
  Metres radius;  ///< list_when_wpt_dist
  model::AtEnd at_end{model::AtEnd::loop};
  friend bool operator==(const GotoFile&, const GotoFile&) = default;
};

inline constexpr std::size_t kLargestFile = 4096;
inline constexpr std::size_t kLongestLine = 100;

/// Reads exactly the kind of file that Glidehelm sends (slocum.md 2.1, 6.4; trust.md V-1 … V-4), and nothing else that
/// a glider would take:
///  - at most 4096 bytes of ASCII, LF, lines of at most 100 characters, no control character but tab, a final newline;
///  - first line `behavior_name=goto_list`; comments `#` with [A-Za-z0-9 :._-] only; then one b_arg section, then one
///    waypoint section, whose end tag is the last line: a file cut anywhere is refused;
///  - every b_arg once, with the unit of masterdata and an allowed value: num_legs_to_run −1, or −2 with end_action 6;
///    start_when 0; list_stop_when 7; list_when_wpt_dist 10 … 100000 m; initial_wpt 0; num_waypoints = listed;
///    end_action 0 or 6 (may be left out with −1). An unknown or repeated b_arg is refused;
///  - 1 … max_waypoints lines `LON LAT` in [-]DDMM.mmmm with four decimals, minutes below 60, in range, not 0/0.
/// Linear in the length; any bytes are safe.
Expected<GotoFile, ListProblem> read_list(std::string_view bytes, int max_waypoints);

/// The file name the firmware takes for the slot: `goto_lNN.ma`, two digits, 8.3, lower case.
std::string list_name(int slot);

}  // namespace glidehelm::safety
