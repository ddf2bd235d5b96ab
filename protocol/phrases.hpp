#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace glidehelm::protocol {

/// Finds many fixed phrases in one pass over a text (Aho and Corasick 1975, as a complete automaton): what a dialog line
/// says is searched for, never expected at a column (slocum.md R5). One table look-up per byte, whatever the number of
/// phrases. `const` use of one object from several threads is safe.
class Phrases {
 public:
  /// At most 65,000 bytes of phrases in all; empty phrases are ignored. Their indices are what `find` reports.
  explicit Phrases(const std::vector<std::string_view>& phrases);

  struct Hit {
    std::size_t phrase{}, begin{}, end{};
  };
  /// Calls `take(Hit)` for each occurrence, ordered by where it ends. Of phrases that end at the same byte the longest
  /// alone is reported.
  template <class Take>
  void find(std::string_view text, Take&& take) const {
    std::uint32_t state = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      state = next_[state + class_of_[static_cast<unsigned char>(text[i])]];
      if (const auto found = found_[state >> shift_]; found != 0) {
        const std::size_t end = i + 1;
        take(Hit{found - 1, end - length_[found - 1], end});
      }
    }
  }

 private:
  std::array<std::uint8_t, 256> class_of_{};  ///< 0: in no phrase
  std::uint32_t shift_{};                     ///< a row has 2^shift classes
  std::vector<std::uint32_t> next_;           ///< state × class → state; a state is the offset of its row
  std::vector<std::uint32_t> found_;          ///< state number → phrase + 1
  std::vector<std::size_t> length_;
};

}  // namespace glidehelm::protocol
