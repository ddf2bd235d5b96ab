#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glidehelm::protocol {

/// What is known of one b_arg (slocum.md 2.2 and 2.6). Nothing is refused for what is not known: a range without limits
/// is infinite, a default that no source names is none.
struct BArgRule {
  std::string_view behavior, name;
  std::string_view unit;           ///< of masterdata; decoration for the glider
  std::optional<double> fallback;  ///< what the glider takes when a mafile leaves it out; none: not known
  double least{}, most{};
  std::uint32_t allowed{};  ///< bit n for each allowed value n of an enum; 0: the range decides
  bool whole{};             ///< an enum or a count
  bool expected{};          ///< left out, its default surprises
};

/// The rule for a b_arg of a behaviour in lower case; null when nothing is known of it.
const BArgRule* b_arg_rule(std::string_view behavior, std::string_view name);
/// All rules of a behaviour, in the order of its mafiles.
std::vector<const BArgRule*> b_arg_rules(std::string_view behavior);
/// True for the behaviours of which every b_arg of the field is known, so that another name is worth a word: goto_list,
/// surface, yo and sample.
bool knows_all_b_args(std::string_view behavior);
/// Another behaviour that has a b_arg of that name and of which `behavior` has none; empty: none known.
std::string_view other_behavior_with(std::string_view behavior, std::string_view name);

/// A number as messages show it: ten digits, no trailing zeros.
std::string number_text(double value);
/// The allowed values in words: `0, 1, 2, 4`, `120 or more`, `0 to 900`.
std::string allowed_text(const BArgRule& rule);

}  // namespace glidehelm::protocol
