#include "protocol/line_splitter.hpp"

#include <array>

namespace glidehelm::protocol {

namespace {

constexpr std::string_view kOpen = "<dockserver";
constexpr std::string_view kClose = "</dockserver>";
constexpr std::string_view kNewCall = "Connection Event";
constexpr std::string_view kZmodem = "**B0";
constexpr char kZdle = 0x18;
constexpr std::size_t kStrange = 8;  // stray bytes on a noisy line are fewer, a binary frame has more

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && std::string_view{text}.substr(text.size() - end.size()) == end;
}

/// What a byte means for a line.
enum class Class : unsigned char { text, line_feed, carriage, dropped, zdle };

constexpr std::array<Class, 256> make_classes() {
  std::array<Class, 256> classes{};
  for (std::size_t c = 0; c < 256; ++c) classes[c] = c < 0x20 || c == 0x7f ? Class::dropped : Class::text;
  classes['\t'] = Class::text;
  classes['\n'] = Class::line_feed;
  classes['\r'] = Class::carriage;
  classes[static_cast<unsigned char>(kZdle)] = Class::zdle;
  return classes;
}
constexpr auto kClasses = make_classes();

Class class_of(char c) { return kClasses[static_cast<unsigned char>(c)]; }

}  // namespace

void LineSplitter::append(std::string_view bytes, const Sink& sink) {
  std::size_t at = 0;
  while (at < bytes.size()) {
    // Runs of plain text are most of a dialog: they are copied whole. '<' and '>' need a look, because tags hide there.
    std::size_t run = at;
    if (!in_block_ && !carriage_ && !too_long_)
      while (run < bytes.size() && class_of(bytes[run]) == Class::text && bytes[run] != 'r' &&
             static_cast<unsigned char>(bytes[run]) < 0x80 && line_.size() + (run - at) < kLongestLine)
        ++run;
    if (run > at) {
      line_.append(bytes.substr(at, run - at));
      at = run;
      continue;
    }
    put(bytes[at++], sink);
  }
}

void LineSplitter::put(char c, const Sink& sink) {
  if (in_block_) {
    put_in_block(c, sink);
    return;
  }
  switch (class_of(c)) {
    case Class::line_feed:
      end_line(sink);
      return;
    case Class::carriage:
      carriage_ = true;
      return;
    case Class::zdle:
      strange_ += kStrange;
      return;
    case Class::dropped:
      ++strange_;
      return;
    case Class::text:
      break;
  }
  if (carriage_ && (!line_.empty() || too_long_)) end_line(sink);
  carriage_ = false;
  if (static_cast<unsigned char>(c) >= 0x80) ++strange_;
  if (line_.size() >= kLongestLine) {
    too_long_ = true;
    ++discarded_;
    return;
  }
  line_ += c;
  if (c == 'r' && ends_with(line_, kOpen)) {  // the last letter of the tag's name
    line_.resize(line_.size() - kOpen.size());
    block_ = kOpen;
    in_block_ = true;
  }
}

void LineSplitter::put_in_block(char c, const Sink& sink) {
  block_ += c;
  if (c == '>' && ends_with(block_, kClose)) {
    block_.resize(block_.size() - kClose.size());
  } else if (c == 't' && ends_with(block_, kNewCall)) {
    block_.resize(block_.size() - kNewCall.size());
    line_.clear();  // what the block cut off belongs to the call that ended
    line_ = kNewCall;
  } else if (block_.size() < kLongestBlock) {
    return;
  }
  in_block_ = false;
  carriage_ = false;
  sink.block(block_);
  block_.clear();
}

void LineSplitter::end_line(const Sink& sink) {
  carriage_ = false;
  const bool binary = strange_ >= kStrange && strange_ * 4 > line_.size();
  if (too_long_ || binary || line_.find(kZmodem) != std::string::npos)
    discarded_ += line_.size();
  else
    sink.line(line_);
  line_.clear();
  too_long_ = false;
  strange_ = 0;
}

void LineSplitter::end(const Sink& sink) {
  if (in_block_) sink.block(block_);
  discarded_ += line_.size();
  line_.clear();
  block_.clear();
  in_block_ = carriage_ = too_long_ = false;
  strange_ = 0;
}

}  // namespace glidehelm::protocol
