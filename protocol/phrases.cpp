#include "protocol/phrases.hpp"

#include <deque>

namespace glidehelm::protocol {

Phrases::Phrases(const std::vector<std::string_view>& phrases) {
  std::uint32_t classes = 1;
  for (const auto phrase : phrases)
    for (const char c : phrase)
      if (auto& cls = class_of_[static_cast<unsigned char>(c)]; cls == 0) cls = static_cast<std::uint8_t>(classes++);
  while ((1U << shift_) < classes) ++shift_;
  const std::uint32_t row_size = 1U << shift_;

  // The trie; 0 stands for "no child" until the automaton is completed, since no edge leads back to the root.
  std::vector<std::vector<std::uint32_t>> child{std::vector<std::uint32_t>(row_size, 0)};
  found_.assign(1, 0);
  for (std::size_t i = 0; i < phrases.size(); ++i) {
    length_.push_back(phrases[i].size());
    if (phrases[i].empty()) continue;
    std::uint32_t state = 0;
    for (const char c : phrases[i]) {
      const auto cls = class_of_[static_cast<unsigned char>(c)];
      if (child[state][cls] == 0) {
        child[state][cls] = static_cast<std::uint32_t>(child.size());
        child.emplace_back(row_size, 0);
        found_.push_back(0);
      }
      state = child[state][cls];
    }
    found_[state] = static_cast<std::uint32_t>(i + 1);
  }

  // Breadth first, so that the state to fall back to is complete before it is needed.
  std::vector<std::uint32_t> back(child.size(), 0);
  std::deque<std::uint32_t> queue;
  for (const auto state : child[0])
    if (state != 0) queue.push_back(state);
  while (!queue.empty()) {
    const auto state = queue.front();
    queue.pop_front();
    if (found_[state] == 0) found_[state] = found_[back[state]];
    for (std::uint32_t cls = 0; cls < row_size; ++cls) {
      const auto fallen = child[back[state]][cls];
      auto& next = child[state][cls];
      if (next == 0) {
        next = fallen;
      } else {
        back[next] = fallen;
        queue.push_back(next);
      }
    }
  }
  next_.reserve(child.size() * row_size);
  for (const auto& row : child)
    for (const auto state : row) next_.push_back(state << shift_);
}

}  // namespace glidehelm::protocol
