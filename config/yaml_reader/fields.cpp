#include "config/yaml_reader/fields.hpp"

#include <algorithm>

#include "core/base/text.hpp"

namespace glidehelm::config {

namespace {

/// The key that was probably meant: nearest by edits, or the only one that adds to the word (`lat` for `lat_deg`).
std::string nearest_key(const std::string& word, const std::vector<std::string>& names) {
  if (word.empty() || word.size() > 64) return {};
  if (auto nearest = nearest_word(word, names)) return *nearest;
  std::string longer;
  for (const auto& name : names) {
    if (name.rfind(word + "_", 0) != 0) continue;
    if (!longer.empty()) return {};
    longer = name;
  }
  return longer;
}

}  // namespace

void Keys::read(const At& at, void* target) const {
  std::vector<std::string> names;
  for (const auto& entry : entries_) names.push_back(entry.spec.key);
  const auto prefix = at.path.empty() ? "" : at.path + ".";
  for (const auto& member : at.node.members) {
    const auto entry =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.spec.key == member.key; });
    if (entry == entries_.end()) {
      const auto nearest = nearest_key(member.key, names);
      at.reading.problems.add(member.place, prefix + shown(member.key), "unknown key", {},
                              nearest.empty() ? joined(names) : "", nearest);
      continue;
    }
    const auto path = prefix + member.key;
    if (member.value.is(Node::Kind::empty)) {
      if (entry->spec.absent.empty())
        at.reading.problems.add(member.place, path, "no value", {}, "a value, or leave the key out");
      continue;
    }
    at.reading.places[path] = member.value.place;
    entry->read(At{member.value, &at.node, path, at.reading}, target);
  }
  for (const auto& entry : entries_)
    if (entry.spec.required && at.node.find(entry.spec.key) == nullptr)
      at.reading.problems.add(at.node.place, prefix + entry.spec.key, "missing; the key is required");
}

void Keys::print(const void* target, const std::string& path, Effective& out) const {
  for (const auto& entry : entries_)
    entry.print(target, path.empty() ? entry.spec.key : path + "." + entry.spec.key, out);
}

std::vector<KeySpec> Keys::specs() const {
  std::vector<KeySpec> result;
  for (const auto& entry : entries_) result.push_back(entry.spec);
  return result;
}

std::string Effective::indent() {
  std::string result(static_cast<std::size_t>(depth_) * 2, ' ');
  if (dash_) result.replace(result.size() - 2, 1, "-");
  dash_ = false;
  return result;
}

void Effective::leaf(const std::string& path, const std::string& key, const std::string& yaml,
                     const std::string& absent) {
  std::string origin = yaml.empty() && !absent.empty() ? "default: " + absent : "default";
  if (reading_ != nullptr)
    if (const auto place = reading_->places.find(path); place != reading_->places.end())
      origin = shown(reading_->problems.file()) + ":" + std::to_string(place->second.line);
  auto start = indent();
  lines_.push_back({start + key + (yaml.empty() ? ":" : ": " + yaml), origin});
}

void Effective::open(const std::string& key) {
  auto start = indent();
  lines_.push_back({start + key + ":", {}});
  ++depth_;
}

void Effective::open_item() {
  ++depth_;
  dash_ = true;
}

std::string Effective::text() const {
  constexpr std::size_t kWidest = 60;
  std::size_t column = 0;
  for (const auto& line : lines_)
    if (line.text.size() <= kWidest) column = std::max(column, line.text.size());
  std::string result;
  for (const auto& line : lines_) {
    result += line.text;
    if (!line.origin.empty())
      result += std::string(line.text.size() < column ? column - line.text.size() : 0, ' ') + "  # " + line.origin;
    result += '\n';
  }
  return result;
}

}  // namespace glidehelm::config
