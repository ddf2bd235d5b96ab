#include "protocol/mafile_lexer.hpp"

#include <algorithm>
#include <cstddef>

namespace glidehelm::protocol {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_name(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; }

class Lexer {
 public:
  explicit Lexer(std::string_view line) : line_{line} {}

  MafileWord word_while(bool (*is)(char)) {
    const std::size_t from = at_;
    while (at_ < line_.size() && is(line_[at_])) ++at_;
    return {line_.substr(from, at_ - from), column(from)};
  }
  void blanks() { word_while(is_blank); }
  bool take(std::string_view text) {
    if (line_.substr(at_, text.size()) != text) return false;
    at_ += text.size();
    return true;
  }
  [[nodiscard]] bool ended() const { return at_ >= line_.size(); }
  [[nodiscard]] int column() const { return column(at_); }
  [[nodiscard]] MafileWord whole_word() const {
    auto copy = *this;
    return copy.word_while([](char c) { return !is_blank(c); });
  }
  std::vector<MafileWord> words() {
    std::vector<MafileWord> all;
    for (blanks(); !ended(); blanks()) all.push_back(word_while([](char c) { return !is_blank(c); }));
    return all;
  }

 private:
  static int column(std::size_t at) { return static_cast<int>(at) + 1; }
  std::string_view line_;
  std::size_t at_{};
};

void lex_b_arg(Lexer& lexer, MafileLine& out) {
  out.kind = MafileLine::Kind::bad_b_arg;
  const auto broken = [&] { out.name.column = lexer.column(); };
  lexer.blanks();
  if (!lexer.take(":")) return broken();
  lexer.blanks();
  const auto name = lexer.word_while(is_name);
  lexer.blanks();
  if (name.text.empty() || !lexer.take("(")) return broken();
  lexer.blanks();
  auto unit = lexer.word_while([](char c) { return c != ')' && c != '('; });
  if (!lexer.take(")")) return broken();
  while (!unit.text.empty() && is_blank(unit.text.back())) unit.text.remove_suffix(1);
  out.kind = MafileLine::Kind::b_arg;
  out.name = name;
  out.unit = unit;
  out.words = lexer.words();
}

}  // namespace

MafileLine lex_mafile_line(std::string_view line, int number) {
  MafileLine out;
  out.number = number;
  while (!line.empty() && line.back() == '\r') {
    out.crlf = true;
    line.remove_suffix(1);
  }
  Lexer lexer{line.substr(0, line.find('#'))};
  lexer.blanks();
  if (lexer.ended()) return out;
  constexpr std::string_view kBehavior = "behavior_name";
  if (lexer.take(kBehavior)) {
    lexer.blanks();
    if (lexer.take("=")) {
      out.kind = MafileLine::Kind::behavior_name;
      out.words = lexer.words();
      if (!out.words.empty()) {
        out.name = out.words.front();
        out.words.erase(out.words.begin());
      } else {
        out.name.column = lexer.column();
      }
      return out;
    }
    lexer = Lexer{line.substr(0, line.find('#'))};
    lexer.blanks();
  }
  if (const auto word = lexer.whole_word(); word.text.front() == '<') {
    out.kind = MafileLine::Kind::tag;
    out.words = lexer.words();
    out.name = out.words.front();
    out.words.erase(out.words.begin());
    return out;
  }
  if (lexer.take("b_arg")) {
    lex_b_arg(lexer, out);
    return out;
  }
  out.kind = MafileLine::Kind::words;
  out.words = lexer.words();
  return out;
}

}  // namespace glidehelm::protocol
