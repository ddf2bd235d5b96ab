#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/time.hpp"
#include "core/model/surfacing.hpp"
#include "protocol/line_splitter.hpp"

namespace glidehelm::protocol {

/// One of the four location lines, complete, as printed.
struct LocationLine {
  std::string lat, lon;  ///< texts: `5949.127`, `69696969.000`
  char lat_letter{'N'}, lon_letter{'E'};
  double age_s{};
  int line{};  ///< of the stream, from 1
  friend bool operator==(const LocationLine&, const LocationLine&) = default;
};

struct SensorLine {
  double value{};
  std::string unit;
  double age_s{};
  friend bool operator==(const SensorLine&, const SensorLine&) = default;
};

struct WaypointLine {
  std::string lat, lon;  ///< latitude first, unlike a mafile
  double range_m{}, bearing_deg{};
  friend bool operator==(const WaypointLine&, const WaypointLine&) = default;
};

/// What one block said: facts as printed, sentinels and stale values included. `accept_fix` decides what they are worth.
struct SurfaceBlock {
  enum class Kind {
    connection,  ///< printed at once when the console opens
    at_surface,  ///< from `Glider X at surface.`
    other,       ///< `where` and its like: a position report, no surfacing (S8)
  } kind{Kind::other};
  std::string vehicle;  ///< as printed; empty when not printed
  std::optional<GliderTime> curr_time;
  std::optional<long> mission_time_s;
  std::optional<LocationLine> dead_reckoned, too_far, invalid, gps;
  std::map<std::string, SensorLine> sensors;
  std::string mission, mission_number, segment;
  std::optional<model::SurfaceReason> because;
  std::optional<WaypointLine> waypoint;
  bool water_complete{};  ///< `Water Velocity Calculations COMPLETE`
  std::optional<int> until_diving_s;
  int first_line{};
  Instant heard;  ///< when its GPS line was complete; of its first line without one
  friend bool operator==(const SurfaceBlock&, const SurfaceBlock&) = default;
};

struct ConnectionOpened {
  friend bool operator==(ConnectionOpened, ConnectionOpened) = default;
};
struct NameHeard {
  std::string name;
  friend bool operator==(const NameHeard&, const NameHeard&) = default;
};
/// A block that is worth reading: a connection block when its sensors end, an at-surface block at `Time until diving`, any block with
/// a fix when another begins or the line falls silent.
struct BlockRead {
  SurfaceBlock block;
  friend bool operator==(const BlockRead&, const BlockRead&) = default;
};
/// `Time until diving` outside of a block that was read with it.
struct WindowHeard {
  int seconds{};
  friend bool operator==(const WindowHeard&, const WindowHeard&) = default;
};
struct WindowExtended {
  friend bool operator==(WindowExtended, WindowExtended) = default;
};
struct MissionResumed {
  friend bool operator==(MissionResumed, MissionResumed) = default;
};
struct MissionEnded {
  friend bool operator==(MissionEnded, MissionEnded) = default;
};
struct DockserverBlock {
  std::string text;  ///< from `<dockserver` on, without the end tag
  friend bool operator==(const DockserverBlock&, const DockserverBlock&) = default;
};
struct TransferStarted {
  std::string file;
  friend bool operator==(const TransferStarted&, const TransferStarted&) = default;
};
struct TransferDone {
  std::string file;
  friend bool operator==(const TransferDone&, const TransferDone&) = default;
};
struct MafilesReread {
  friend bool operator==(MafilesReread, MafilesReread) = default;
};

using DialogEvent = std::variant<ConnectionOpened, NameHeard, BlockRead, WindowHeard, WindowExtended, MissionResumed,
                                 MissionEnded, DockserverBlock, TransferStarted, TransferDone, MafilesReread>;

struct DialogCounts {
  std::uint64_t connections{}, at_surface_blocks{}, gps_lines{}, gps_sentinels{}, sensor_lines{}, damaged_lines{},
      dockserver_blocks{}, discarded_bytes{};
  friend bool operator==(const DialogCounts&, const DialogCounts&) = default;
};

/// Reads a dialog from bytes in any chunking (slocum.md 6.1, R1–R7): same bytes, same events. Bounded memory: lines of 4 KiB,
/// dockserver blocks of 64 KiB, 256 sensors a block; beyond that bytes are discarded and counted. Linear. Fields bind to the most recent
/// `Curr Time`; a line that matches only in part is damaged, counted and used for nothing.
class DialogReader {
 public:
  /// `heard`: our clock when the bytes came.
  std::vector<DialogEvent> append(std::string_view bytes, Instant heard);
  /// The line has been silent for a while: gives a block that waits for its end.
  std::vector<DialogEvent> flush_idle(Instant heard);
  /// The connection ended: likewise; a line without an end is dropped.
  std::vector<DialogEvent> end(Instant heard);

  [[nodiscard]] const DialogCounts& counts() const { return counts_; }
  [[nodiscard]] int line() const { return line_; }

 private:
  void take_line(std::string_view line, Instant heard);
  bool take_fact(std::string_view line, Instant heard);
  bool take_location(std::string_view line, Instant heard);
  bool take_sensor(std::string_view line);
  bool take_event(std::string_view line);
  void begin(SurfaceBlock::Kind kind, Instant heard);
  void give_block();

  LineSplitter splitter_;
  SurfaceBlock block_;
  bool open_{}, given_{};  ///< a block is open; it was given already
  bool console_{}, first_{true}, shell_{};
  int line_{};
  DialogCounts counts_;
  std::vector<DialogEvent> out_;
};

/// Limits of the rules that need no memory.
struct FixLimits {
  double oldest_s{1200};
  friend bool operator==(const FixLimits&, const FixLimits&) = default;
};

/// S1–S4 and S7, as far as they need no memory: a surfacing from a block, or the refusal that names the rule. `glider` is the name heard on
/// this connection. A block without a GPS line gives a refusal too (rule S3).
Expected<model::Surfacing, model::Refusal> accept_fix(const SurfaceBlock& block, const std::string& glider,
                                                      const FixLimits& limits = {});

}  // namespace glidehelm::protocol
