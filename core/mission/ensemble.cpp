#include "core/mission/ensemble.hpp"

#include <optional>

namespace glidehelm::mission {

namespace {

constexpr std::string_view kOpening = "{member";

/// `{member}` or `{member:W}` in a pattern.
struct Slot {
  std::size_t begin{}, end{};  ///< of the braces, `end` one behind
  std::size_t width{};         ///< W; 0: as many digits as the number has
};

/// None when it is not written as it must be.
std::optional<Slot> slot_in(std::string_view pattern) {
  Slot slot;
  slot.begin = pattern.find(kOpening);
  if (slot.begin == std::string_view::npos) return std::nullopt;
  auto rest = pattern.substr(slot.begin + kOpening.size());
  slot.end = slot.begin + kOpening.size();
  if (rest.size() > 2 && rest[0] == ':' && rest[1] >= '1' && rest[1] <= '6') {
    slot.width = static_cast<std::size_t>(rest[1] - '0');
    rest = rest.substr(2);
    slot.end += 2;
  }
  if (rest.empty() || rest.front() != '}') return std::nullopt;
  ++slot.end;
  return slot;
}

bool may_be_a_digit(char c) { return (c >= '0' && c <= '9') || c == '*' || c == '?' || c == '[' || c == ']'; }

}  // namespace

bool names_member(std::string_view pattern) { return pattern.find(kOpening) != std::string_view::npos; }

std::string trouble_of_pattern(std::string_view pattern, int first, int last) {
  const auto slot = slot_in(pattern);
  if (!slot) return "the member is written {member}, or {member:W} with W digits from 1 to 6";
  if (names_member(pattern.substr(slot->end))) return "a second {member}";
  if ((slot->begin > 0 && may_be_a_digit(pattern[slot->begin - 1])) ||
      (slot->end < pattern.size() && may_be_a_digit(pattern[slot->end])))
    return "{member} stands beside a wildcard or a digit, so that the number 1 would match others such as 10";
  if (slot->width > 0 && std::to_string(last).size() > slot->width)
    return "the numbers " + std::to_string(first) + " to " + std::to_string(last) + " do not fit " +
           std::to_string(slot->width) + " digits";
  return {};
}

std::string with_number(std::string_view pattern, int number) {
  const auto slot = slot_in(pattern).value();
  auto digits = std::to_string(number);
  if (digits.size() < slot.width) digits.insert(0, slot.width - digits.size(), '0');
  return std::string{pattern.substr(0, slot.begin)} + digits + std::string{pattern.substr(slot.end)};
}

std::vector<std::string> Ensemble::files_of(int member) const {
  std::vector<std::string> patterns;
  for (const auto& pattern : files) patterns.push_back(with_number(pattern, first + member));
  return patterns;
}

}  // namespace glidehelm::mission
