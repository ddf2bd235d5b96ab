#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace glidehelm::protocol {

/// Finds many fixed phrases in one pass over a text: what a dialog line says is searched for, never expected at a
/// column (slocum.md R5). Two small table look-ups per byte tell whether a phrase can begin there; only then are the
/// phrases with these first two bytes compared. `const` use of one object from several threads is safe.
class Phrases {
 public:
  /// Phrases of fewer than two bytes are ignored. Indices are what `find` reports.
  explicit Phrases(const std::vector<std::string_view>& phrases);
  Phrases(const Phrases&) = delete;  // it points into itself
  Phrases& operator=(const Phrases&) = delete;

  struct Hit {
    std::size_t phrase{}, begin{}, end{};
  };
  /// Calls `take(Hit)` for each occurrence, in the order of their beginnings. Of phrases that begin at the same byte
  /// the longest alone is reported, of equal ones the first.
  template <class Take>
  void find(std::string_view text, Take&& take) const {
    if (text.size() < 2) return;
    std::size_t first = class_of(text[0]);
    for (std::size_t i = 0; i + 1 < text.size(); ++i) {
      const std::size_t second = class_of(text[i + 1]);
      const auto group = group_of_[first << kBits | second];
      first = second;
      if (group == 0) continue;
      for (const auto& phrase : groups_[group - 1])
        if (text.substr(i, phrase.text.size()) == phrase.text) {
          take(Hit{phrase.index, i, i + phrase.text.size()});
          break;
        }
    }
  }

 private:
  struct Phrase {
    std::string_view text;
    std::size_t index{};
  };
  static constexpr std::size_t kBits = 6;  ///< of a class: 63 different bytes at the beginning of phrases

  [[nodiscard]] std::size_t class_of(char c) const { return class_of_[static_cast<unsigned char>(c)]; }
  std::size_t add_class(char c);

  std::array<std::uint8_t, 256> class_of_{};              ///< 0: begins no phrase
  std::array<std::uint8_t, 1U << 2 * kBits> group_of_{};  ///< by the classes of two bytes; 0: none
  std::vector<std::vector<Phrase>> groups_;               ///< the longest first
  std::vector<std::vector<char>> texts_;                  ///< keeps the phrases alive and in place
};

}  // namespace glidehelm::protocol
