#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace glidehelm::protocol {

/// Bytes of a glider's line → lines of text (slocum.md R1–R4).
///
/// LF ends a line; CR is dropped before it and ends a line when text follows; NUL, DEL and other control characters but tab are dropped.
/// `<dockserver …> … </dockserver>` is cut out before lines are made, so that the text before and after it joins again; an
/// unterminated one ends at 64 KiB or at `Connection Event`. Lines beyond 4 KiB are discarded to their end. Lines that hold a ZMODEM
/// header or are mostly not text are dropped. Any chunking gives the same lines.
class LineSplitter {
 public:
  static constexpr std::size_t kLongestLine = 4096;
  static constexpr std::size_t kLongestBlock = 64U << 10;

  struct Sink {
    std::function<void(std::string_view line)> line;
    std::function<void(std::string_view block)> block;  ///< from `<dockserver` on, without the end tag
  };
  void append(std::string_view bytes, const Sink& sink);
  /// Forgets a line without an end and an open block; a block is given.
  void end(const Sink& sink);
  [[nodiscard]] std::uint64_t discarded() const { return discarded_; }

 private:
  void put(char c, const Sink& sink);
  void end_line(const Sink& sink);
  void put_in_block(char c, const Sink& sink);

  std::string line_, block_;
  bool in_block_{}, carriage_{}, too_long_{};
  std::size_t strange_{};  ///< bytes of the line that are no text
  std::uint64_t discarded_{};
};

}  // namespace glidehelm::protocol
