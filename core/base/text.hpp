#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace glidehelm {

/// A decimal number that fills the whole text: C locale, finite, no hexadecimal, no leading or trailing blanks. A
/// leading '+' is taken. Nothing otherwise ("nan", "inf" and overflow included).
std::optional<double> number_from(std::string_view text);

/// The candidate nearest to `word` by edits (insert, delete, replace, swap of neighbours), compared without case;
/// nothing when even the nearest needs more than a third of the word's length + 1 edits.
std::optional<std::string> nearest_word(std::string_view word, std::span<const std::string> candidates);

/// Of ASCII, independent of the locale.
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
/// ASCII lower case, independent of the locale.
std::string lower(std::string_view text);
bool equal_without_case(std::string_view a, std::string_view b);
/// Blanks, tabs and line ends cut at both ends.
std::string_view trimmed(std::string_view text);
/// What follows the last '/' of a path; all of it when there is none.
constexpr std::string_view base_name(std::string_view path) { return path.substr(path.rfind('/') + 1); }

}  // namespace glidehelm
