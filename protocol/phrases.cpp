#include "protocol/phrases.hpp"

#include <algorithm>
#include <cstdlib>

namespace glidehelm::protocol {

std::size_t Phrases::add_class(char c) {
  auto& cls = class_of_[static_cast<unsigned char>(c)];
  if (cls != 0) return cls;
  const auto used = *std::max_element(class_of_.begin(), class_of_.end());
  // More different bytes than classes: the last class is shared, which costs comparisons and no correctness.
  cls = static_cast<std::uint8_t>(std::min<std::size_t>(used + 1U, (1U << kBits) - 1U));
  return cls;
}

Phrases::Phrases(const std::vector<std::string_view>& phrases) {
  for (std::size_t i = 0; i < phrases.size(); ++i) {
    const auto phrase = phrases[i];
    if (phrase.size() < 2) continue;
    auto& group = group_of_[add_class(phrase[0]) << kBits | add_class(phrase[1])];
    if (group == 0) {
      if (groups_.size() == 255) std::abort();  // of our own words; nothing of the dialog comes here
      groups_.emplace_back();
      group = static_cast<std::uint8_t>(groups_.size());
    }
    texts_.emplace_back(phrase.begin(), phrase.end());
    groups_[group - 1U].push_back({std::string_view{texts_.back().data(), texts_.back().size()}, i});
  }
  for (auto& group : groups_)
    std::stable_sort(group.begin(), group.end(),
                     [](const Phrase& a, const Phrase& b) { return a.text.size() > b.text.size(); });
}

}  // namespace glidehelm::protocol
