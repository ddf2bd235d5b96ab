#include "protocol/line_splitter.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "core/base/text.hpp"

namespace glidehelm::protocol {

namespace {

constexpr std::size_t kTail = 256;
constexpr std::string_view kConnection = "Connection Event:";
constexpr std::string_view kBlockBegins = "<dockserver";
constexpr std::string_view kBlockEnds = "</dockserver>";
constexpr char kZdle = 0x18;

/// What a byte makes of its line; 0 for the text that nearly all lines consist of.
enum Kind : unsigned { kControl = 1, kHigh = 2, kMaybeZmodem = 4 };
constexpr std::array<std::uint8_t, 256> kinds_of_bytes() {
  std::array<std::uint8_t, 256> kinds{};
  for (std::size_t c = 0; c < kinds.size(); ++c) {
    if ((c < 0x20 && c != '\t') || c == 0x7f) kinds[c] = kControl;
    if (c >= 0x80) kinds[c] = kHigh;
    if (c == '*' || c == '^') kinds[c] = kMaybeZmodem;
  }
  kinds[static_cast<std::size_t>(kZdle)] = kControl | kMaybeZmodem;
  return kinds;
}
constexpr auto kKinds = kinds_of_bytes();

/// Where a Zmodem header or data begins: ZDLE, a hexadecimal header, or a header whose ZDLE a terminal wrote as `^X`.
std::size_t zmodem_begins(std::string_view text) {
  return std::min({text.find(kZdle), text.find("**B0"), text.find("^XB0")});
}

}  // namespace

void LineSplitter::append(std::string_view bytes, LineSink& sink) {
  while (!bytes.empty()) {
    const auto* lf = static_cast<const char*>(std::memchr(bytes.data(), '\n', bytes.size()));
    const std::size_t size = lf == nullptr ? bytes.size() : static_cast<std::size_t>(lf - bytes.data());
    take_piece(bytes.substr(0, size), sink);
    if (lf == nullptr) return;
    finish_line(sink);
    ++number_;
    bytes.remove_prefix(size + 1);
  }
}

/// Bytes without LF. A CR ends the line only once other text follows, so that CR LF and CR CR LF are one end.
void LineSplitter::take_piece(std::string_view piece, LineSink& sink) {
  while (!piece.empty()) {
    if (cr_ && piece.front() != '\r') {
      if (!line_.empty()) finish_line(sink);
      cr_ = false;
    }
    const auto* cr = static_cast<const char*>(std::memchr(piece.data(), '\r', piece.size()));
    const std::size_t size = cr == nullptr ? piece.size() : static_cast<std::size_t>(cr - piece.data());
    extend(piece.substr(0, size));
    if (cr == nullptr) return;
    cr_ = true;
    piece.remove_prefix(size + 1);
  }
}

void LineSplitter::extend(std::string_view text) {
  if (!long_ && line_.size() + text.size() <= kLongestLine) {
    line_.append(text);
    return;
  }
  if (!std::exchange(long_, true)) discarded_ += line_.size();
  discarded_ += text.size();
  line_.append(text.substr(text.size() > kTail ? text.size() - kTail : 0));
  if (line_.size() > kTail) line_.erase(0, line_.size() - kTail);
}

void LineSplitter::finish_line(LineSink& sink) {
  cr_ = false;
  if (std::exchange(long_, false)) {
    ++long_lines_;
    const auto connection = line_.find(kConnection);
    if (connection != std::string::npos) clean(std::string_view{line_}.substr(connection), sink);
  } else {
    clean(line_, sink);
  }
  line_.clear();
}

void LineSplitter::clean(std::string_view text, LineSink& sink) {
  unsigned kinds = 0;
  for (const char c : text) kinds |= kKinds[static_cast<unsigned char>(c)];
  if (kinds != 0) return clean_odd(text, kinds, sink);
  if (!text.empty()) zmodem_ = false;
  in_block_ ? inside_block(text, sink) : outside_block(text, sink);
}

void LineSplitter::clean_odd(std::string_view text, unsigned kinds, LineSink& sink) {
  const std::size_t marker = (kinds & kMaybeZmodem) != 0 ? zmodem_begins(text) : std::string_view::npos;
  const bool binary = zmodem_ && (kinds & (kControl | kHigh)) != 0;
  if (marker != std::string_view::npos || binary) {
    // The text before a header was printed before the transfer; a connection that opens ends the transfer.
    const std::size_t from = zmodem_ ? 0 : marker;
    if (from > 0) {
      const bool ending = std::exchange(ending_, true);  // it has no line end: only what needs none is complete
      before_noise_ = true;
      clean_odd(text.substr(0, from), kControl, sink);
      before_noise_ = false;
      ending_ = ending;
    }
    zmodem_ = true;
    const std::size_t connection = text.find(kConnection, from);
    discarded_ += std::min(connection, text.size()) - from;
    if (connection != std::string_view::npos) {
      zmodem_ = false;
      clean_odd(text.substr(connection), kControl, sink);
    }
    return;
  }
  zmodem_ = false;
  std::string plain;
  plain.reserve(text.size());
  for (const char c : text) {
    if ((kKinds[static_cast<unsigned char>(c)] & kControl) == 0)
      plain.push_back(c);
    else if (c != 0 && c != 0x7f)
      altered_ = true;
  }
  in_block_ ? inside_block(plain, sink) : outside_block(plain, sink);
  if (!in_block_) altered_ = false;  // a block passes it on to the line that it interrupts
}

void LineSplitter::outside_block(std::string_view text, LineSink& sink) {
  const auto begin = text.find('<') == std::string_view::npos ? std::string_view::npos : text.find(kBlockBegins);
  if (begin == std::string_view::npos) return give(text, number_, sink);
  prefix_ = text.substr(0, begin);
  prefix_number_ = number_;
  in_block_ = true;
  block_ = {};
  text.remove_prefix(begin + kBlockBegins.size());
  const auto tag_end = text.find('>');
  auto tag = text.substr(0, tag_end);
  if (constexpr std::string_view kCommand = "command=\""; tag.find(kCommand) != std::string_view::npos) {
    tag.remove_prefix(tag.find(kCommand) + kCommand.size());
    block_.command = tag.substr(0, tag.find('"'));
  }
  if (tag_end != std::string_view::npos) inside_block(text.substr(tag_end + 1), sink);
}

void LineSplitter::inside_block(std::string_view text, LineSink& sink) {
  const auto end = text.find(kBlockEnds);
  for (const std::string_view sign : {kConnection, std::string_view{"Iridium console active and ready"},
                                      std::string_view{"Vehicle Name:"}, kBlockBegins}) {
    if (text.find(sign) < end) {
      give_up_block(sink);
      return outside_block(text, sink);
    }
  }
  block_.text.append(text.substr(0, end));
  if (end == std::string_view::npos) {
    block_.text.push_back('\n');
    if (block_.text.size() > kLargestBlock) give_up_block(sink);
    return;
  }
  block_.complete = true;
  in_block_ = false;
  sink.take_block(std::move(block_));
  const auto rest = text.substr(end + kBlockEnds.size());
  if (trimmed(rest).empty()) {
    if (!prefix_.empty()) give(prefix_, prefix_number_, sink);
    after_block_ = true;
  } else if (prefix_.empty()) {
    after_block_ = true;
    outside_block(rest, sink);
  } else {
    if (joined_at_ == Line::kWhole) joined_at_ = prefix_.size();
    const std::string joined = prefix_ + std::string{rest};
    outside_block(joined, sink);
  }
}

/// The block is lost, and so is the line that it interrupted.
void LineSplitter::give_up_block(LineSink& sink) {
  in_block_ = false;
  discarded_ += block_.text.size();
  sink.take_block(std::move(block_));
  block_ = {};
  if (!prefix_.empty()) {
    const bool ending = std::exchange(ending_, true);
    give(prefix_, prefix_number_, sink);
    ending_ = ending;
  }
}

void LineSplitter::give(std::string_view text, int number, LineSink& sink) {
  Line line;
  line.text = text;
  line.number = number;
  line.joined_at = std::exchange(joined_at_, Line::kWhole);
  line.after_block = std::exchange(after_block_, false);
  line.cut = ending_;
  line.before_noise = before_noise_;
  line.altered = std::exchange(altered_, false);
  sink.take_line(line);
}

std::string_view LineSplitter::unfinished() const {
  return long_ || in_block_ || zmodem_ ? std::string_view{} : std::string_view{line_};
}

void LineSplitter::end(LineSink& sink) {
  ending_ = !cr_;
  if (!line_.empty()) finish_line(sink);
  if (in_block_) give_up_block(sink);
  ending_ = cr_ = zmodem_ = after_block_ = false;
  joined_at_ = Line::kWhole;
  prefix_.clear();
}

}  // namespace glidehelm::protocol
