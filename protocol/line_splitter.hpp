#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace glidehelm::protocol {

/// One line of the dialog as it reached us, cleaned.
struct Line {
  static constexpr std::size_t kWhole = static_cast<std::size_t>(-1);
  std::string_view text;          ///< without line end and control characters; valid during the call only
  int number{};                   ///< of its first byte in the stream, from 1; counts '\n' only, as editors do
  std::size_t joined_at{kWhole};  ///< where a dockserver block was cut out of the middle of the line
  bool altered{};                 ///< control characters other than NUL and DEL were dropped: one may have been a digit
  bool after_block{};             ///< a dockserver block stood between the line before and this one
  bool cut{};                     ///< ends with the connection or before a marker, not with a line end
  bool before_noise{};            ///< cut by the beginning of a Zmodem transfer
};

/// What the dockserver printed into the stream: `<dockserver command="…">TEXT</dockserver>`.
struct DockserverBlock {
  std::string command, text;
  bool complete{};  ///< false: the end tag never came; 64 KiB or a connection ended it
  friend bool operator==(const DockserverBlock&, const DockserverBlock&) = default;
};

/// Takes what the splitter finds, in the order of the stream.
class LineSink {
 public:
  virtual ~LineSink() = default;
  virtual void take_line(const Line& line) = 0;
  virtual void take_block(DockserverBlock block) = 0;
};

/// Bytes of the dialog to lines, the same for every chunking (slocum.md R1–R4):
///  - a line ends with LF, or with CR when text follows it; CR before LF is dropped, as are NUL, DEL and all control
///    characters but tab. Bytes above 127 pass: UTF-8 is never required;
///  - dockserver blocks are cut out, also from the middle of a line, and handed over apart. One that never ends is
///    given up at 64 KiB or when a console opens (`Connection Event:`, `Iridium console active and ready`, `Vehicle
///    Name:`);
///  - from a Zmodem header or a ZDLE byte on nothing is given until a line of plain text comes;
///  - a line longer than 4 KiB is discarded up to its end, except for a `Connection Event:` in its last 256 bytes.
/// Memory: one line, one block. Time: linear.
class LineSplitter {
 public:
  static constexpr std::size_t kLongestLine = 4096;
  static constexpr std::size_t kLargestBlock = 64U << 10;

  void append(std::string_view bytes, LineSink& sink);
  /// The line that has begun, when it is not inside a block; empty otherwise. For prompts, which have no line end.
  [[nodiscard]] std::string_view unfinished() const;
  /// Forgets the first `bytes` of `unfinished()`: they were understood.
  void forget(std::size_t bytes) { line_.erase(0, bytes); }
  /// The connection ended: gives the unfinished line as cut and an open block as incomplete, and starts afresh (line
  /// numbers go on).
  void end(LineSink& sink);

  [[nodiscard]] std::uint64_t long_lines() const { return long_lines_; }
  [[nodiscard]] std::uint64_t discarded_bytes() const { return discarded_; }  ///< of long lines, lost blocks and Zmodem

 private:
  void take_piece(std::string_view piece, LineSink& sink);
  void extend(std::string_view text);
  void finish_line(LineSink& sink);
  void clean(std::string_view text, LineSink& sink);
  void clean_odd(std::string_view text, unsigned kinds, LineSink& sink);
  void outside_block(std::string_view text, LineSink& sink);
  void inside_block(std::string_view text, LineSink& sink);
  void give_up_block(LineSink& sink);
  void give(std::string_view text, int number, LineSink& sink);

  std::string line_;  ///< unfinished
  bool cr_{};         ///< the unfinished line was followed by CR
  bool long_{};       ///< the unfinished line is being discarded; its last bytes are kept in line_
  bool ending_{};     ///< the connection ends: what is given now is cut
  int number_{1};     ///< of the byte that comes next

  bool in_block_{};
  DockserverBlock block_;
  std::string prefix_;  ///< text of the line that the block interrupted
  int prefix_number_{};
  bool altered_{};      ///< of the line that is cleaned
  bool after_block_{};  ///< a block has just ended
  bool before_noise_{};
  std::size_t joined_at_{Line::kWhole};

  bool zmodem_{};
  std::uint64_t long_lines_{}, discarded_{};
};

}  // namespace glidehelm::protocol
