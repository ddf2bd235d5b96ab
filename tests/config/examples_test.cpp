#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "config/daemon.hpp"
#include "config/mission.hpp"
#include "config/yaml_reader/schema.hpp"
#include "tests/support/config.hpp"
#include "tests/support/json_schema.hpp"

using namespace glidehelm;
using namespace glidehelm::config;
using nlohmann::json;

namespace {

const std::string kRoot = GLIDEHELM_SOURCE;

std::vector<std::string> examples() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator{kRoot + "/config/examples"})
    files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

bool is_daemon(const std::string& text) { return text.find("glidehelm/daemon/v1") != std::string::npos; }

/// A YAML file as JSON, by yaml-cpp's own reader and the core schema's rules for plain words: nothing of ours.
json as_json(const YAML::Node& node) {
  if (node.IsNull()) return nullptr;
  if (node.IsSequence()) {
    auto list = json::array();
    for (const auto& item : node) list.push_back(as_json(item));
    return list;
  }
  if (node.IsMap()) {
    auto map = json::object();
    for (const auto& member : node) map[member.first.Scalar()] = as_json(member.second);
    return map;
  }
  const auto& text = node.Scalar();
  if (node.Tag() == "!") return text;
  if (text == "true" || text == "false") return text == "true";
  const auto number = json::parse(text, nullptr, false);
  return number.is_number() ? number : json(text);
}

std::vector<std::string> schema_errors(const std::string& schema, const std::string& yaml) {
  test::JsonSchemaCheck check;
  check.check(json::parse(schema), as_json(YAML::Load(yaml)));
  return check.errors;
}

/// Compares a committed file with what the declarations give; with GLIDEHELM_WRITE=1 writes it anew.
void check_generated(const std::string& path, const std::string& wanted) {
  const char* write = std::getenv("GLIDEHELM_WRITE");
  if (write != nullptr && std::string{write} == "1") {
    std::ofstream file{path, std::ios::binary};
    file << wanted;
    REQUIRE(file.flush());
  }
  INFO(path << " differs from the declarations; GLIDEHELM_WRITE=1 config_tests \"*generated*\" writes it anew");
  CHECK(test::file_text(path) == wanted);
}

/// The text with what stands between two markers replaced.
std::string with_section(const std::string& text, const std::string& name, const std::string& content) {
  const std::string begin = "<!-- " + name + ": generated -->\n", end = "<!-- end of " + name + " -->";
  const auto from = text.find(begin), to = text.find(end);
  INFO("markers of " << name);
  REQUIRE(from != std::string::npos);
  REQUIRE(to != std::string::npos);
  return text.substr(0, from + begin.size()) + "\n" + content + "\n" + text.substr(to);
}

/// Paths of all keys below a shape, maps in lists and alternatives included.
void collect(const Shape& shape, const std::string& prefix, std::vector<KeySpec>& out) {
  for (auto spec : shape.keys) {
    const auto path = prefix + spec.key;
    const auto inner = spec.shape;
    spec.key = path;
    out.push_back(spec);
    collect(inner, path + ".", out);
  }
  for (const auto& part : shape.parts) collect(part, prefix, out);
}

}  // namespace

TEST_CASE("the committed schemas are generated from the declarations") {
  check_generated(kRoot + "/config/mission.schema.json", mission_schema());
  check_generated(kRoot + "/config/daemon.schema.json", daemon_schema());
}

TEST_CASE("the key tables of the manual are generated from the declarations") {
  const auto path = kRoot + "/docs/configuration.md";
  auto wanted = with_section(test::file_text(path), "mission keys", key_table(mission_shape()));
  wanted = with_section(wanted, "daemon keys", key_table(daemon_shape()));
  check_generated(path, wanted);
}

TEST_CASE("every example is read without a word and is valid against its schema") {
  const auto files = examples();
  REQUIRE(files.size() >= 6);
  for (const auto& file : files) {
    CAPTURE(file);
    const auto text = test::file_text(file);
    std::vector<std::string> errors;
    if (is_daemon(text)) {
      errors = test::errors_of(read_daemon_file(text, file));
    } else {
      errors = test::errors_of(read_mission(text, file, test::no_files()));
    }
    CHECK(errors == std::vector<std::string>{});
    CHECK(schema_errors(is_daemon(text) ? daemon_schema() : mission_schema(), text) == std::vector<std::string>{});
  }
}

TEST_CASE("what is in force of an example is valid against the schema too") {
  for (const auto& file : examples()) {
    CAPTURE(file);
    const auto text = test::file_text(file);
    const auto effective = is_daemon(text) ? read_daemon_file(text, file)->effective
                                           : read_mission_file(text, file, test::no_files())->effective;
    CAPTURE(effective);
    CHECK(schema_errors(is_daemon(text) ? daemon_schema() : mission_schema(), effective) == std::vector<std::string>{});
  }
}

TEST_CASE("the schema refuses what the reader refuses in one key") {
  const std::vector<std::string> wrong{
      "lst: {}",
      "list: {slot: 100}",
      "list: {slot: 1.5}",
      "list: {slot: '1'}",
      "vehicle: {horizontal_speed_m_per_s: 0}",
      "vehicle: {dive_depth_m: }",
      "planning: {cell_km: atuo}",
      "planning: {method: prm}",
      "after_goal: leg-3",
      "start: {time: yesterday}",
      "safety: {keep_in: [[{lat_deg: 1, lon_deg: 2}]]}",
      "safety: {keep_in: [[{lat_deg: 1, lon_deg: 2}, {lat_deg: 1}, {lat_deg: 1, lon_deg: 3}]]}",
      "glider_mission: a"};
  for (const auto& line : wrong) {
    CAPTURE(line);
    CHECK_FALSE(schema_errors(mission_schema(), test::six_lines(line + "\n")).empty());
    CHECK_FALSE(test::errors_of(read_mission(test::six_lines(line + "\n"), "m.yaml", test::no_files())).empty());
  }
  CHECK(schema_errors(mission_schema(), test::six_lines()).empty());
}

TEST_CASE("the example of every key names every key, with the default that the code has") {
  const auto full = test::file_text(kRoot + "/config/examples/full.yaml");
  std::vector<KeySpec> keys;
  collect(mission_shape(), "", keys);
  REQUIRE(keys.size() > 60);
  const auto yaml = as_json(YAML::Load(full));
  for (const auto& key : keys) {
    CAPTURE(key.key);
    // Parameters of the other analytic kinds stand in double-eddy.yaml and the manual.
    if (key.key.rfind("currents.analytic.params.", 0) != 0)
      CHECK(full.find(key.key.substr(key.key.find_last_of('.') + 1) + ":") != std::string::npos);
    if (key.default_text.empty()) continue;
    json value = yaml;
    for (std::size_t at = 0; at <= key.key.size() && !value.is_null();) {
      const auto dot = std::min(key.key.find('.', at), key.key.size());
      value = value.is_object() && value.contains(key.key.substr(at, dot - at))
                  ? json(value[key.key.substr(at, dot - at)])
                  : json();
      at = dot + 1;
    }
    if (!value.is_null()) CHECK(value == as_json(YAML::Load(key.default_text)));
  }
  const auto daemon = test::file_text(kRoot + "/config/examples/daemon-two-gliders.yaml");
  keys.clear();
  collect(daemon_shape(), "", keys);
  for (const auto& key : keys) {
    CAPTURE(key.key);
    CHECK(daemon.find(key.key.substr(key.key.find_last_of('.') + 1) + ":") != std::string::npos);
  }
}
