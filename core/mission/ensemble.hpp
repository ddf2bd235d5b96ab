#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glidehelm::mission {

/// `currents.ensemble`: the forecast is several oceans that are all possible. Members count from 0, the control.
///
/// Where each member is published in files of its own, a file's name holds the member's number, and its pattern `{member}` in that place, or
/// `{member:W}` where the number is written with W digits (1 to 6), zeros before it.
struct Ensemble {
  int members{};                   ///< members; at least 1
  int first{};                     ///< first: number of the control in names of files
  std::vector<std::string> files;  ///< patterns with `{member}`; empty: the members lie along a dimension of each file
  /// The patterns of one member, 0 to members − 1.
  [[nodiscard]] std::vector<std::string> files_of(int member) const;
  friend bool operator==(const Ensemble&, const Ensemble&) = default;
};

/// Whether something that begins with `{member` stands in a pattern.
bool names_member(std::string_view pattern);
/// What is wrong with a pattern that names its member, for numbers from `first` to `last`; empty: nothing. There is one `{member}`;
/// its neighbours are no wildcard and no digit, or the number 1 would match the name of 10 or 21; every number fits its width.
std::string trouble_of_pattern(std::string_view pattern, int first, int last);
/// The pattern with a number in the place of `{member}`. Precondition: trouble_of_pattern finds none.
std::string with_number(std::string_view pattern, int number);

}  // namespace glidehelm::mission
