#include "protocol/mafile_lexer.hpp"

#include <catch2/catch.hpp>

using namespace glidehelm::protocol;
using Kind = MafileLine::Kind;

TEST_CASE("blank lines and comments are blank") {
  for (const char* line : {"", "  \t", "# b_arg: x(m) 1", "\t # note", "\r"})
    CHECK(lex_mafile_line(line, 1).kind == Kind::blank);
}

TEST_CASE("the name line takes blanks around the name") {
  const auto line = lex_mafile_line("behavior_name=Goto_list \t\r", 1);
  CHECK(line.kind == Kind::behavior_name);
  CHECK(line.name.text == "Goto_list");
  CHECK(line.name.column == 15);
  CHECK(line.crlf);
  CHECK(lex_mafile_line("behavior_name=", 1).name.text.empty());
  CHECK(lex_mafile_line("behavior_name goto_list", 1).kind == Kind::words);
}

TEST_CASE("a b_arg is taken with any blanks and with a comment glued to its value") {
  for (const char* text : {"b_arg: initial_wpt(enum) -1#last", "\tb_arg:  initial_wpt(enum)  -1",
                           "b_arg:initial_wpt(enum)-1", "b_arg : initial_wpt ( enum ) -1 # x"}) {
    const auto line = lex_mafile_line(text, 4);
    INFO(text);
    REQUIRE(line.kind == Kind::b_arg);
    CHECK(line.number == 4);
    CHECK(line.name.text == "initial_wpt");
    CHECK(line.unit.text == "enum");
    REQUIRE(line.words.size() == 1);
    CHECK(line.words.front().text == "-1");
  }
}

TEST_CASE("a broken b_arg says where it breaks") {
  CHECK(lex_mafile_line("b_arg initial_wpt(enum) 1", 1).name.column == 7);
  CHECK(lex_mafile_line("b_arg: (enum) 1", 1).name.column == 8);
  CHECK(lex_mafile_line("b_arg: initial_wpt 1", 1).name.column == 20);
  CHECK(lex_mafile_line("b_arg: initial_wpt(enum 1", 1).name.column == 26);
  for (const char* text : {"b_arg initial_wpt(enum) 1", "b_arg: initial_wpt 1", "b_arg"})
    CHECK(lex_mafile_line(text, 1).kind == Kind::bad_b_arg);
}

TEST_CASE("tags keep what follows them, words keep their columns") {
  const auto tag = lex_mafile_line("<start:waypoints> x", 1);
  CHECK(tag.kind == Kind::tag);
  CHECK(tag.name.text == "<start:waypoints>");
  CHECK(tag.words.size() == 1);
  const auto words = lex_mafile_line(" 801\t5400 | a # b", 1);
  REQUIRE(words.words.size() == 4);
  CHECK(words.words[1].text == "5400");
  CHECK(words.words[1].column == 6);
}
