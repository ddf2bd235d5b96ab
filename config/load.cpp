#include "config/load.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/text.hpp"

namespace glidehelm::config {

namespace {

ConfigError whole_file(const std::string& file, const std::string& key, std::string problem) {
  ConfigError error;
  error.file = file;
  error.key = key;
  error.problem = std::move(problem);
  return error;
}

ConfigError at_key(const LoadedMission& m, const std::string& key, std::string problem) {
  return error_at(m.text, m.file, key, std::move(problem));
}

std::string next_name(const mission::Mission& m) {
  return m.after_goal.empty() ? std::string{} : m.after_goal.substr(5);
}

std::vector<std::string> mission_files(const std::vector<std::string>& patterns, const std::string& daemon_file,
                                       const Sources& sources, std::vector<ConfigError>& errors) {
  std::vector<std::string> files;
  for (const auto& pattern : patterns) {
    const auto found = sources.matches(pattern);
    if (found.empty() && pattern.find_first_of("*?[") == std::string::npos)
      errors.push_back(whole_file(daemon_file, "missions", "no such file: " + shown(pattern)));
    for (const auto& file : found)
      if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  }
  return files;
}

void check_gliders(const Configuration& c, std::vector<ConfigError>& errors) {
  std::vector<std::string> names;
  for (const auto& glider : c.daemon.gliders) names.push_back(glider.name);
  for (const auto& m : c.missions) {
    if (std::find(names.begin(), names.end(), m.mission.glider) != names.end()) continue;
    auto error = at_key(m, "glider", "no such glider in " + c.file);
    error.found = m.mission.glider;
    error.nearest = nearest_word(m.mission.glider, names).value_or("");
    if (error.nearest.empty())
      for (const auto& name : names) error.allowed += (error.allowed.empty() ? "" : ", ") + name;
    errors.push_back(std::move(error));
  }
}

void check_names(const Configuration& c, std::vector<ConfigError>& errors) {
  std::map<std::string, std::string> first;
  for (const auto& m : c.missions) {
    const auto [other, is_new] = first.emplace(m.mission.name, m.file);
    if (!is_new)
      errors.push_back(
          at_key(m, "name", "two missions named " + m.mission.name + "; the other stands in " + other->second));
  }
}

/// Who follows whom. A mission may be led to by one other mission of its glider.
void link(Configuration& c, std::vector<ConfigError>& errors) {
  for (const auto& m : c.missions) {
    const auto next = next_name(m.mission);
    if (next.empty()) continue;
    const auto target = std::find_if(c.missions.begin(), c.missions.end(), [&](const LoadedMission& other) {
      return other.mission.name == next && other.mission.glider == m.mission.glider;
    });
    if (target == c.missions.end())
      errors.push_back(at_key(m, "after_goal", "no mission named " + next + " for glider " + m.mission.glider));
    else if (!target->follows.empty())
      errors.push_back(at_key(m, "after_goal", "mission " + next + " follows " + target->follows + " already"));
    else
      target->follows = m.mission.name;
  }
}

void check_one_each(const Configuration& c, std::vector<ConfigError>& errors) {
  std::map<std::string, const LoadedMission*> flown;
  for (const auto& m : c.missions) {
    if (!m.follows.empty()) continue;
    const auto [first, is_new] = flown.emplace(m.mission.glider, &m);
    if (!is_new)
      errors.push_back(
          at_key(m, "glider", "two missions for glider " + m.mission.glider + "; the other is " + first->second->file));
  }
}

/// Missions that follow each other in a circle never begin.
void check_circles(const Configuration& c, std::vector<ConfigError>& errors) {
  std::map<std::string, std::string> follows;
  for (const auto& m : c.missions) follows.emplace(m.mission.name, m.follows);
  for (const auto& m : c.missions) {
    auto name = m.mission.name;
    for (std::size_t steps = 0; steps <= c.missions.size() && !name.empty(); ++steps) name = follows[name];
    if (!name.empty())
      errors.push_back(at_key(m, "after_goal", "follows, in a circle, a mission that follows it: none begins"));
  }
}

}  // namespace

ConfigError error_at(const std::string& text, const std::string& file, const std::string& key, std::string problem) {
  auto error = whole_file(file, key, std::move(problem));
  const auto document = read_yaml(text, file);
  const Node* node = document.readable ? &document.root : nullptr;
  for (std::size_t begin = 0; node != nullptr && begin <= key.size();) {
    const auto end = std::min(key.find('.', begin), key.size());
    node = node->find(key.substr(begin, end - begin));
    if (node != nullptr) {  // of a nested key at least the place of what holds it
      error.line = node->place.line;
      error.column = node->place.column;
    }
    begin = end + 1;
  }
  return error;
}

Expected<Configuration, std::vector<ConfigError>> load(const std::string& daemon_file, const Sources& sources) {
  const auto text = sources.read(daemon_file);
  if (!text)
    return unexpected(std::vector<ConfigError>{whole_file(daemon_file, "", "cannot be read: " + text.error().reason)});
  auto daemon = read_daemon_file(*text, daemon_file);
  if (!daemon) {  // the missions' own errors are told in the same go
    std::vector<ConfigError> errors = daemon.error(), ignored;
    for (const auto& file : mission_files(mission_patterns(*text, daemon_file), daemon_file, sources, ignored))
      if (const auto bytes = sources.read(file))
        if (const auto m = read_mission(*bytes, file, sources.read); !m)
          errors.insert(errors.end(), m.error().begin(), m.error().end());
    return unexpected(std::move(errors));
  }

  Configuration c;
  c.file = daemon_file;
  c.daemon = std::move(daemon->config);
  c.sha256 = Sha256::of(std::string_view{*text});
  std::vector<ConfigError> errors;
  for (const auto& file : mission_files(c.daemon.missions, daemon_file, sources, errors)) {
    auto bytes = sources.read(file);
    if (!bytes) {
      errors.push_back(whole_file(file, "", "cannot be read: " + bytes.error().reason));
      continue;
    }
    auto m = read_mission(*bytes, file, sources.read);
    if (!m) {
      errors.insert(errors.end(), m.error().begin(), m.error().end());
      continue;
    }
    if (m->coast_file.empty()) m->coast_file = c.daemon.coast;
    const auto sha256 = Sha256::of(std::string_view{*bytes});
    c.missions.push_back(LoadedMission{file, std::move(*m), std::move(*bytes), sha256, {}});
  }
  const bool all_read = errors.empty();
  check_gliders(c, errors);
  check_names(c, errors);
  if (all_read) link(c, errors);  // a mission that could not be read may be the one that is led to
  if (all_read) check_one_each(c, errors);
  if (errors.empty()) check_circles(c, errors);
  if (!errors.empty()) return unexpected(std::move(errors));
  return c;
}

}  // namespace glidehelm::config
