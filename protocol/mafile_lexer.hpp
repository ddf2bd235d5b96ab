#pragma once

#include <string_view>
#include <vector>

namespace glidehelm::protocol {

/// A run of characters without blanks, with its column from 1.
struct MafileWord {
  std::string_view text;
  int column{};
};

/// One line of a mafile in pieces. Strict and lenient reading share this tokenizer; they differ in what they say about
/// the pieces.
struct MafileLine {
  enum class Kind {
    blank,          ///< nothing, or a comment
    behavior_name,  ///< behavior_name=WORD: `name` is the word
    tag,            ///< <start:…> or <end:…>: `name` is the whole tag
    b_arg,          ///< b_arg: NAME(UNIT) …: `name`, `unit`, and in `words` what follows
    bad_b_arg,      ///< begins with b_arg but has not that form; `name.column` says where it ends to have it
    words,          ///< anything else, in `words`
  } kind{};
  int number{};
  MafileWord name, unit;
  std::vector<MafileWord> words;
  bool crlf{};
};

/// Splits a line without its LF. A `#` begins a comment, also glued to a word; CR at the end is dropped; blanks are
/// space and tab.
MafileLine lex_mafile_line(std::string_view line, int number);

}  // namespace glidehelm::protocol
