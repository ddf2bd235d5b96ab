#include "config/yaml_reader.hpp"

#include <catch2/catch.hpp>
#include <chrono>

#include "tests/support/config.hpp"

using namespace glidehelm;
using config::Node;
using config::read_yaml;
using test::lines_of;
using Lines = std::vector<std::string>;

TEST_CASE("a document comes back as nodes with line and column") {
  const auto document = read_yaml("a: 1\nb:\n  - x y\n  - {c: \"2\"}\nd:\n", "f.yaml");
  REQUIRE(document.errors.empty());
  REQUIRE(document.readable);
  const auto& root = document.root;
  REQUIRE(root.is(Node::Kind::map));
  REQUIRE(root.members.size() == 3);
  CHECK(root.find("a")->text == "1");
  CHECK_FALSE(root.find("a")->quoted);
  CHECK(root.find("a")->place == config::Place{1, 4});
  const auto& list = *root.find("b");
  REQUIRE(list.items.size() == 2);
  CHECK(list.items[0].text == "x y");
  CHECK(list.items[0].place == config::Place{3, 5});
  CHECK(list.items[1].find("c")->quoted);
  CHECK(list.items[1].find("c")->place == config::Place{4, 9});
  CHECK(root.find("d")->is(Node::Kind::empty));
  CHECK(root.find("d")->place == config::Place{5, 1});
  CHECK(root.find("e") == nullptr);
}

TEST_CASE("a message has the file, line and column first, then the key, the problem and what helps") {
  config::ConfigError error;
  error.file = "m.yaml";
  error.line = 8;
  error.column = 3;
  error.key = "planning.headigns";
  error.problem = "unknown key";
  error.nearest = "headings";
  CHECK(error.message() == "m.yaml:8:3: planning.headigns: unknown key; did you mean headings?");
  error.nearest.clear();
  error.found = "7";
  error.allowed = "0 to 6";
  CHECK(error.message() == "m.yaml:8:3: planning.headigns: unknown key; found 7; allowed: 0 to 6");
  error.line = 0;
  CHECK(error.message() == "m.yaml: planning.headigns: unknown key; found 7; allowed: 0 to 6");
}

TEST_CASE("columns count characters, not bytes") {
  const auto document = read_yaml("{ñandú: 1, ñandú: 2}\n", "f");
  CHECK(lines_of(document.errors) == Lines{"1:12 ñandú: duplicate key; it stands first in line 1"});
}

TEST_CASE("what YAML takes and a configuration does not is refused with its place") {
  struct Row {
    const char* yaml;
    Lines errors;
  };
  const auto row = GENERATE(values<Row>({
      {"a: 1\nb: 2\na: 3\n", {"3:1 a: duplicate key; it stands first in line 1"}},
      {"g: {r: 1, s: 2, r: 3}\n", {"1:17 g.r: duplicate key; it stands first in line 1"}},
      {"l:\n  - {k: 1}\n  - {k: 1, k: 2}\n", {"3:12 l[1].k: duplicate key; it stands first in line 3"}},
      {"a: &x 1\nb: *x\n",
       {"1:4 a: anchors are not taken", "2:4 b: aliases are not taken; found *; allowed: the value itself"}},
      {"a: !!str 1\n", {"1:4 a: tags are not taken; found tag:yaml.org,2002:str"}},
      {"a: ! 1\n", {"1:4 a: tags are not taken; found !"}},
      {"a: !x {b: 1}\n", {"1:4 a: tags are not taken; found !x"}},
      {"b: {<<: {c: 1}}\n", {"1:5 b: merge keys are not taken; found <<; allowed: the keys themselves"}},
      {"? [a, b]\n: 1\n", {"1:3 a key must be one word; allowed: KEY: VALUE"}},
      {"a: 1\n---\nb: 2\n", {"2:1 a second document in the file; allowed: one document"}},
      {"a:\t1\n", {"1:3 tab; found \\x09; allowed: blanks"}},
      {"a: 1\n\tb: 2\n# x\ty\n",
       {"2:1 tab; found \\x09; allowed: blanks", "3:4 tab; found \\x09; allowed: blanks",
        "2:3 not YAML: illegal map value"}},
      {"a: x\x01y\n", {"1:5 control character; found \\x01"}},
      {"a: \x7F\n", {"1:4 control character; found \\x7f"}},
      {"a: 1\rb: 2\n", {"1:5 control character; found \\x0d"}},
      {"a: [1, 2\nb: 3\n", {"2:2 not YAML: end of sequence flow not found"}},
      {"a: \"half", {"1:9 not YAML: illegal EOF in scalar"}},
      {"a: \"half\n", {"1:4 a: a quote that does not end; found half "}},
      {"a: 'it''s\n", {"1:4 a: a quote that does not end; found it's "}},
      {"a: \"half\\\"\n", {"1:4 a: a quote that does not end; found half\" "}},
  }));
  CAPTURE(row.yaml);
  auto found = lines_of(read_yaml(row.yaml, "f").errors);
  auto wanted = row.errors;
  std::sort(found.begin(), found.end());
  std::sort(wanted.begin(), wanted.end());
  CHECK(found == wanted);
}

TEST_CASE("errors of one file stand in the order of their places and all of them are told") {
  const auto document = read_yaml("a: &x 1\nb:\n  c: 1\n  c: 2\na: *x\n", "f");
  CHECK(lines_of(document.errors) == Lines{"1:4 a: anchors are not taken",
                                           "4:3 b.c: duplicate key; it stands first in line 3",
                                           "5:1 a: duplicate key; it stands first in line 1",
                                           "5:4 aliases are not taken; found *; allowed: the value itself"});
  CHECK(document.readable);
}

TEST_CASE("a NUL byte and broken UTF-8 are named, never cut off silently") {
  CHECK(lines_of(read_yaml(std::string_view{"a: 1\nb: \0 2\n", 11}, "f").errors) ==
        Lines{"2:4 control character; found \\x00"});
  // yaml-cpp takes this byte for the end of the file.
  CHECK(lines_of(read_yaml("a: 1\n\x04\nb: 2\n", "f").errors) == Lines{"2:1 control character; found \\x04"});
  for (const char* broken : {"\xC0\xAF", "\xED\xA0\x80", "\xF5\x80\x80\x80", "\x80", "\xE2\x82"})
    CHECK(lines_of(read_yaml(std::string{"a: "} + broken, "f").errors).front().rfind("1:4 not UTF-8 text", 0) == 0);
}

TEST_CASE("a byte-order mark and CR LF line ends are taken") {
  const auto document = read_yaml(
      "\xEF\xBB\xBF"
      "a: 1\r\nb: x\r\n",
      "f");
  CHECK(document.errors.empty());
  REQUIRE(document.readable);
  CHECK(document.root.find("a")->place == config::Place{1, 4});
  CHECK(document.root.find("b")->text == "x");
}

TEST_CASE("nothing and null are empty, at the key they belong to") {
  const auto document = read_yaml("a:\nb: ~\nc: null\nd: [1, ~]\n", "f");
  REQUIRE(document.errors.empty());
  for (const char* key : {"a", "b", "c"}) CHECK(document.root.find(key)->is(Node::Kind::empty));
  CHECK(document.root.find("b")->place == config::Place{2, 1});
  CHECK(document.root.find("d")->items[1].place == config::Place{4, 8});
  CHECK(read_yaml("", "f").root.is(Node::Kind::empty));
  CHECK(read_yaml("# only a comment\n", "f").readable);
}

TEST_CASE("nesting ends at sixteen levels") {
  const auto nested = [](int levels) {
    return std::string(static_cast<std::size_t>(levels), '[') + std::string(static_cast<std::size_t>(levels), ']');
  };
  CHECK(read_yaml(nested(16), "f").errors.empty());
  CHECK(lines_of(read_yaml(nested(17), "f").errors) == Lines{"1:17 nested deeper than 16 levels"});
}

TEST_CASE("hostile texts are refused at once") {
  // Ten thousandfold what an honest file needs; the limit is far below what a quadratic or recursive reader would take.
  const auto start = std::chrono::steady_clock::now();
  std::string block, lines, keys;
  for (int i = 0; i < 200'000; ++i) block += "- ";
  for (int i = 0; i < 200'000; ++i) keys += "? ";
  for (int i = 0; i < 200'000; ++i) lines += "[\n";
  for (const auto& text : {std::string(200'000, '['), std::string(200'000, '{'), block, lines, keys,
                           "a: " + std::string(1'000'000, '!'), "a: '" + std::string(1'000'000, 'x')})
    CHECK_FALSE(read_yaml(text, "f").errors.empty());
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const auto last = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last + ", " + last + ", " + last + ", " +
            last + "]\n";
  }
  const auto document = read_yaml(bomb, "f");
  CHECK(document.errors.size() == 12 + 44);  // every anchor and every alias, none expanded
  CHECK(document.root.members.size() == 12);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds{10});
}

TEST_CASE("files, values and errors are bounded") {
  CHECK(lines_of(read_yaml(std::string(config::kLargestFile + 1, '#'), "f").errors) ==
        Lines{"1:1 the file is too large; found 1048577 bytes; allowed: up to 1048576 bytes"});
  std::string list = "[";
  for (std::size_t i = 0; i < config::kMostValues; ++i) list += "1,";
  CHECK(lines_of(read_yaml(list + "]", "f").errors) == Lines{"1:131072 more than 65536 values"});
  std::string twice;
  for (int i = 0; i < 150; ++i) twice += "a: 1\n";
  const auto errors = read_yaml(twice, "f").errors;
  REQUIRE(errors.size() == config::kMostErrors + 1);
  CHECK(errors.back().text() == "more errors than the 100 shown");
}

TEST_CASE("what a file says cannot forge a line of a log") {
  CHECK(config::shown("a\nb\x1B[31m") == "a\\x0ab\\x1b[31m");
  // yaml-cpp quotes the byte after the backslash in its message: here the one that it takes for the end of the file.
  CHECK(lines_of(read_yaml("a: \"b\\", "f").errors) == Lines{"1:7 not YAML: unknown escape character: \\x04"});
  CHECK(config::shown(std::string(100, 'x')) == std::string(60, 'x') + "…");
}
