#include "protocol/line_splitter.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace glidehelm::protocol;

namespace {

/// Writes down what the splitter gives: `3:text`, `|` where pieces were joined, `!` cut, `>` behind a block.
struct Notes final : LineSink {
  std::vector<std::string> all;
  std::vector<DockserverBlock> blocks;
  void take_line(const Line& line) override {
    std::string text{line.text};
    if (line.joined_at != Line::kWhole) text.insert(line.joined_at, "|");
    all.push_back(std::to_string(line.number) + ":" + (line.after_block ? ">" : "") + text + (line.cut ? "!" : "") +
                  (line.altered ? "~" : ""));
  }
  void take_block(DockserverBlock block) override {
    all.push_back("<" + block.command + (block.complete ? "" : "?") + ">");
    blocks.push_back(std::move(block));
  }
};

struct Split {
  std::vector<std::string> lines;
  std::uint64_t long_lines{}, discarded{};
  std::vector<DockserverBlock> blocks;
  friend bool operator==(const Split&, const Split&) = default;
};

Split split_in_chunks(const std::string& bytes, std::size_t chunk) {
  LineSplitter splitter;
  Notes notes;
  for (std::size_t at = 0; at < bytes.size(); at += chunk)
    splitter.append(std::string_view{bytes}.substr(at, chunk), notes);
  splitter.end(notes);
  return {notes.all, splitter.long_lines(), splitter.discarded_bytes(), notes.blocks};
}

/// The result, which every chunking must give.
Split split(const std::string& bytes) {
  auto whole = split_in_chunks(bytes, bytes.size() + 1);
  for (const std::size_t chunk : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{7}, std::size_t{64}})
    REQUIRE(split_in_chunks(bytes, chunk) == whole);
  return whole;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("LF, CR LF and CR CR LF end one line") {
  CHECK(split("a\nb\r\nc\r\r\nd\n").lines == Lines{"1:a", "2:b", "3:c", "4:d"});
  CHECK(split("a\n\n\r\nb\n").lines == Lines{"1:a", "2:", "3:", "4:b"});
}

TEST_CASE("a lone CR ends a line when text follows it, also at the beginning of a line") {
  CHECK(split("a\rb\n\rSCI: c\n").lines == Lines{"1:a", "1:b", "2:SCI: c"});
  CHECK(split("a\rb\rc\r").lines == Lines{"1:a", "1:b", "1:c"});
}

TEST_CASE("control characters are dropped, tab and bytes beyond ASCII stay") {
  CHECK(split(std::string{"a\0b\x7f\x03 \b\b\tc \xc3\xa9\n", 14}).lines == Lines{"1:ab \tc \xc3\xa9~"});
  CHECK(split(std::string{"a\0b\x7f"
                          "c\nd\n",
                          8})
            .lines == Lines{"1:abc", "2:d"});  // padding alters nothing
}

TEST_CASE("what the connection's end leaves unfinished is cut, unless a CR had come") {
  CHECK(split("a\nGPS Loc").lines == Lines{"1:a", "2:GPS Loc!"});
  CHECK(split("a\nb\r").lines == Lines{"1:a", "2:b"});
  CHECK(split("").lines.empty());
}

TEST_CASE("a line beyond 4 KiB is discarded up to its end and counted") {
  const std::string most(LineSplitter::kLongestLine, 'x');
  CHECK(split(most + "\n").lines == Lines{"1:" + most});
  const auto beyond = split("a\n" + most + "y\nb\n");
  CHECK(beyond.lines == Lines{"1:a", "3:b"});
  CHECK(beyond.long_lines == 1);
  CHECK(beyond.discarded == most.size() + 1);
  CHECK(split(std::string(1'000'000, 'x')).long_lines == 1);
}

TEST_CASE("a connection that opens at the end of an endless line is not lost with it") {
  CHECK(split(std::string(50'000, 'x') + "Connection Event: Carrier Detect found.\nb\n").lines ==
        Lines{"1:Connection Event: Carrier Detect found.", "2:b"});
}

TEST_CASE("a dockserver block is cut out of the middle of a line") {
  const auto s = split("DR  Locat<dockserver command=\"dockzr *\">\nnot found>*<\n</dockserver>ion: x\nb\n");
  CHECK(s.lines == Lines{"<dockzr *>", "3:DR  Locat|ion: x", "4:b"});
  CHECK(s.blocks.front().text == "\nnot found>*<\n");
}

TEST_CASE("a dockserver block between two lines is marked on the second") {
  CHECK(split("abc\n<dockserver command=\"x\">\nt\n</dockserver>\ndef\n").lines == Lines{"1:abc", "<x>", "5:>def"});
  CHECK(split("ab<dockserver command=\"x\">t</dockserver>\ncd\n").lines == Lines{"<x>", "1:ab", "2:>cd"});
  CHECK(split("<dockserver>t</dockserver>cd\n").lines == Lines{"<>", "1:>cd"});
}

TEST_CASE("a line torn twice is joined twice") {
  CHECK(split("ab<dockserver>1</dockserver>cd<dockserver>2</dockserver>ef\n").lines == Lines{"<>", "<>", "1:ab|cdef"});
}

TEST_CASE("a block that never ends is given up when a console opens") {
  for (const std::string sign : {"Connection Event: Carrier Detect found.",
                                 " 12    Iridium console active and ready...", "Vehicle Name: alba"}) {
    const auto s = split("ab<dockserver command=\"x\">\nlost\n" + sign + "\nb\n");
    CHECK(s.lines == Lines{"<x?>", "1:ab!", "3:" + sign, "4:b"});
    CHECK(s.discarded == 6);  // two line ends and "lost"
  }
  CHECK(split("<dockserver command=\"x\">\n<dockserver command=\"y\">t</dockserver>\nb\n").lines ==
        Lines{"<x?>", "<y>", "3:>b"});
}

TEST_CASE("a block that never ends is given up at 64 KiB") {
  std::string bytes = "<dockserver command=\"x\">\n";
  for (int i = 0; i < 700; ++i) bytes += std::string(99, 'x') + "\n";
  const auto s = split(bytes + "b\n");
  CHECK(s.lines.front() == "<x?>");
  CHECK(s.lines.back() == "702:b");
  CHECK(s.discarded > LineSplitter::kLargestBlock);
  CHECK(s.discarded <= LineSplitter::kLargestBlock + 100);  // one line more than the limit
  CHECK(split("<dockserver command=\"x\">\ncut").lines == Lines{"<x?>"});
}

TEST_CASE("Zmodem is skipped until plain text comes") {
  const auto s = split("a\n**B0100000012abc4\r\n\x18\x43\x80\x81\nb\n");
  CHECK(s.lines == Lines{"1:a", "4:b"});
  CHECK(s.discarded == 17 + 4);
  CHECK(split("START **\x18"
              "B00\nb\n")
            .lines == Lines{"1:START **!", "2:b"});
  CHECK(split("x**^XB0800000000099dAbout\nb\n").lines == Lines{"1:x**!", "2:b"});
}

TEST_CASE("a call that begins inside a transfer is heard") {
  CHECK(split("\x18\x80\x81\n\x80\x81xConnection Event: Carrier Detect found.\nb\n").lines ==
        Lines{"2:Connection Event: Carrier Detect found.", "3:b"});
}

TEST_CASE("the unfinished line can be looked at and taken") {
  LineSplitter splitter;
  Notes notes;
  splitter.append("a\nGliderDos N -1 >", notes);
  CHECK(splitter.unfinished() == "GliderDos N -1 >");
  splitter.forget(16);
  splitter.append("dir\n", notes);
  CHECK(notes.all == Lines{"1:a", "2:dir"});
  splitter.append("<dockserver>\nGliderDos N -1 >", notes);
  CHECK(splitter.unfinished().empty());  // it belongs to the block
}

TEST_CASE("after the end the splitter begins afresh and counts lines on") {
  LineSplitter splitter;
  Notes notes;
  splitter.append("a\nb<dockserver command=\"x\">\nc", notes);
  splitter.end(notes);
  splitter.append("d\n", notes);
  CHECK(notes.all == Lines{"1:a", "<x?>", "2:b!", "3:d"});
}
