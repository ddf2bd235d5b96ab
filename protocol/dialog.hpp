#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/accept_fix.hpp"
#include "protocol/dialog_event.hpp"
#include "protocol/dialog_facts.hpp"

namespace glidehelm::protocol {

/// What a reader has seen so far.
struct DialogCounts {
  std::uint64_t connections{};
  std::uint64_t at_surface_blocks{};  ///< `Glider X at surface.`
  std::uint64_t gps_lines{};          ///< complete `GPS Location:` lines, sentinels and reprints included
  std::uint64_t sensor_lines{};       ///< complete ones
  std::uint64_t damaged_lines{};      ///< match in part, or were cut
  std::uint64_t dockserver_blocks{};
  std::uint64_t lost_blocks{};      ///< dockserver blocks without an end
  std::uint64_t long_lines{};       ///< beyond 4 KiB
  std::uint64_t discarded_bytes{};  ///< of long lines, lost blocks and transfers
  friend bool operator==(const DialogCounts&, const DialogCounts&) = default;
};

/// Reads the surface dialog of one line: bytes in, events out, the same events for every chunking (slocum.md R1).
///
/// A block is given (BlockRead)
///  - of a connection, as soon as it is complete: at the first line behind its sensors that is neither blank nor noise
///    (so that a GliderDos prompt is known when it is given), or at `flush_idle`;
///  - at the surface, at its `Time until diving` line;
///  - in any case before the next block begins, at `flush_idle` and at `end` with what is there, when it has a
///    `GPS Location:` line.
/// Nothing is given of a block without one. What a block says belongs to the `Curr Time` in it; a location that comes
/// where another block must have begun starts one without a time. Partial state ends at a connection border.
///
/// Memory is bounded by one line (4 KiB), one dockserver block (64 KiB) and one surface block. Time is linear.
class DialogReader final : private LineSink {
 public:
  DialogReader();
  explicit DialogReader(const DialogWords& words);

  /// `heard` is our clock when these bytes came.
  std::vector<DialogEvent> append(std::string_view bytes, Instant heard);
  /// The line has been silent for a moment: understands a prompt that has no line end and gives the block as it stands.
  std::vector<DialogEvent> flush_idle(Instant heard);
  /// The connection ended: gives the block as it stands, drops the unfinished line, and starts afresh.
  std::vector<DialogEvent> end(Instant heard);

  [[nodiscard]] DialogCounts counts() const;

 private:
  void take_line(const Line& line) override;
  void take_block(DockserverBlock block) override;
  [[nodiscard]] bool join_with_last(const Line& line);
  [[nodiscard]] bool apply_all();
  void apply(Fact& fact);
  void apply_damaged(Say say);
  void note_damage(std::string_view text);
  [[nodiscard]] bool ends_connection_block(std::string_view text) const;
  void finish_connection_block();

  void carrier(const Fact& fact);
  void open_connection();
  void hear_name(const std::string& name);
  void begin_block(bool at_surface);
  void begin_block_after_time();
  [[nodiscard]] bool has_location() const;
  void finish_block();
  void give_block(SurfaceBlock block);
  void locate(Say say, Location* location);
  void read_sensor(SensorReading reading);
  void window(double seconds);
  void resume(MissionResumed::By by);
  void end_mission(std::string cause);
  void prompt(const Fact& fact);

  LineSplitter splitter_;
  std::shared_ptr<const FactFinder> finder_;
  std::vector<DialogEvent> events_;
  std::vector<Fact> facts_;  ///< of the line that is read
  Instant heard_;
  int line_{};  ///< number of the line that is read
  DialogCounts counts_;

  // the line before, as long as it may be the first half of a line that a dockserver block tore apart
  std::string last_text_;
  bool last_damaged_{};
  bool ends_later_{};  ///< it ends the connection block unless it is such a half

  // the connection
  enum class Greeting { none, carrier, console } greeting_{};
  std::string name_;
  WaterState water_{};
  Console console_{};
  PromptSeen prompt_;
  bool resumed_{}, ended_{};

  // the block
  bool open_{}, changed_{};
  SurfaceBlock block_;
};

}  // namespace glidehelm::protocol
