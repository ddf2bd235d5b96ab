#include "config/load.hpp"

#include <catch2/catch.hpp>

#include "tests/support/config.hpp"

using namespace glidehelm;
using namespace glidehelm::config;
using Lines = std::vector<std::string>;
using FileMap = std::map<std::string, std::string>;

namespace {

const char* const kDaemon =
    "schema: glidehelm/daemon/v1\nmissions: [m/*.yaml]\ncoast: sea.coast\ngliders:\n"
    "  - {name: sim01, line: {listen: \"127.0.0.1:6500\"}, to_glider: /g/sim01}\n"
    "  - {name: sim02, line: {listen: \"127.0.0.1:6501\"}, to_glider: /g/sim02}\n";

std::string mission_yaml(const std::string& name, const std::string& glider, const std::string& more = {}) {
  return "schema: glidehelm/mission/v1\nname: " + name + "\nglider: " + glider +
         "\ngoal: {lat_deg: 29, lon_deg: -15}\ncurrents: {files: [c.nc]}\n" + more;
}

/// A file system of the test: `m/*.yaml` matches by its head and tail.
Sources sources(const FileMap& files) {
  return {test::files_of(files), [files](const std::string& pattern) {
            std::vector<std::string> found;
            const auto star = pattern.find('*');
            for (const auto& [path, text] : files)
              if (star == std::string::npos
                      ? path == pattern
                      : path.rfind(pattern.substr(0, star), 0) == 0 && path.size() >= pattern.size() &&
                            path.substr(path.size() - (pattern.size() - star - 1)) == pattern.substr(star + 1))
                found.push_back(path);
            return found;
          }};
}

Lines errors(FileMap files) {
  files.emplace("d/d.yaml", kDaemon);
  const auto result = load("d/d.yaml", sources(files));
  Lines messages;
  if (!result)
    for (const auto& error : result.error()) messages.push_back(error.message());
  return messages;
}

}  // namespace

TEST_CASE("a daemon file and its missions load together, with the hash of each file") {
  const auto one = mission_yaml("leg-1", "sim01"), two = mission_yaml("leg-2", "sim02", "safety: {coast: own.coast}\n");
  const auto result =
      load("d/d.yaml", sources({{"d/d.yaml", kDaemon}, {"d/m/a.yaml", one}, {"d/m/b.yaml", two}, {"d/m/c.txt", "?"}}));
  REQUIRE(result);
  CHECK(result->file == "d/d.yaml");
  CHECK(result->daemon.gliders.size() == 2);
  CHECK(result->sha256 == Sha256::of(std::string_view{kDaemon}));
  REQUIRE(result->missions.size() == 2);
  CHECK(result->missions[0].file == "d/m/a.yaml");
  CHECK(result->missions[0].sha256 == Sha256::of(std::string_view{one}));
  CHECK(result->missions[0].text == one);
  CHECK(result->missions[0].mission.coast_file == "d/sea.coast");  // the daemon's
  CHECK(result->missions[0].mission.currents.files == std::vector<std::string>{"d/m/c.nc"});
  CHECK(result->missions[1].mission.coast_file == "d/m/own.coast");
  CHECK(result->missions[1].follows.empty());
}

TEST_CASE("no mission at all is no mistake") { CHECK(errors({}).empty()); }

TEST_CASE("errors of all files are told at once") {
  CHECK(errors({{"d/m/a.yaml", mission_yaml("leg-1", "sim01", "lst: {}\n")},
                {"d/m/b.yaml", mission_yaml("leg-2", "sim03", "list: {slot: 100}\n")},
                {"d/m/c.yaml", mission_yaml("leg-3", "sim3")}}) ==
        Lines{"d/m/a.yaml:6:1: lst: unknown key; did you mean list?",
              "d/m/b.yaml:6:14: list.slot: out of range; found 100; allowed: 0 to 99",
              "d/m/c.yaml:3:9: glider: no such glider in d/d.yaml; found sim3; did you mean sim01?"});
}

TEST_CASE("a daemon file with a mistake does not hide those of its missions") {
  std::string daemon = kDaemon;
  daemon.replace(daemon.find("coast"), 5, "coasd");
  const auto found = errors({{"d/d.yaml", daemon}, {"d/m/a.yaml", mission_yaml("leg-1", "sim01", "planing: 1\n")}});
  CHECK(found == Lines{"d/d.yaml:3:1: coasd: unknown key; did you mean coast?",
                       "d/m/a.yaml:6:1: planing: unknown key; did you mean planning?"});
}

TEST_CASE("a mission for a glider that is not configured names the nearest or all of them") {
  CHECK(errors({{"d/m/a.yaml", mission_yaml("leg-1", "sim02x")}}) ==
        Lines{"d/m/a.yaml:3:9: glider: no such glider in d/d.yaml; found sim02x; did you mean sim02?"});
  CHECK(errors({{"d/m/a.yaml", mission_yaml("leg-1", "waverider")}}) ==
        Lines{"d/m/a.yaml:3:9: glider: no such glider in d/d.yaml; found waverider; allowed: sim01, sim02"});
}

TEST_CASE("two missions for one glider and two of one name are mistakes that name both files") {
  CHECK(errors({{"d/m/a.yaml", mission_yaml("leg-1", "sim01")}, {"d/m/b.yaml", mission_yaml("leg-2", "sim01")}}) ==
        Lines{"d/m/b.yaml:3:9: glider: two missions for glider sim01; the other is d/m/a.yaml"});
  CHECK(errors({{"d/m/a.yaml", mission_yaml("leg-1", "sim01")}, {"d/m/b.yaml", mission_yaml("leg-1", "sim02")}}) ==
        Lines{"d/m/b.yaml:2:7: name: two missions named leg-1; the other stands in d/m/a.yaml"});
}

TEST_CASE("a mission that another one leads to waits for its turn") {
  const auto result =
      load("d/d.yaml", sources({{"d/d.yaml", kDaemon},
                                {"d/m/a.yaml", mission_yaml("leg-2", "sim01")},
                                {"d/m/b.yaml", mission_yaml("leg-1", "sim01", "after_goal: next leg-2\n")}}));
  REQUIRE(result);
  CHECK(result->missions[0].follows == "leg-1");
  CHECK(result->missions[1].follows.empty());
}

TEST_CASE("after_goal must lead to one mission of the same glider, and not in a circle") {
  CHECK(errors({{"d/m/a.yaml", mission_yaml("leg-1", "sim01", "after_goal: next leg-2\n")},
                {"d/m/b.yaml", mission_yaml("leg-2", "sim02")}}) ==
        Lines{"d/m/a.yaml:6:13: after_goal: no mission named leg-2 for glider sim01"});
  CHECK(errors({{"d/m/a.yaml", mission_yaml("leg-1", "sim01", "after_goal: next leg-3\n")},
                {"d/m/b.yaml", mission_yaml("leg-2", "sim01", "after_goal: next leg-3\n")},
                {"d/m/c.yaml", mission_yaml("leg-3", "sim01")}}) ==
        Lines{"d/m/b.yaml:6:13: after_goal: mission leg-3 follows leg-1 already",
              "d/m/b.yaml:3:9: glider: two missions for glider sim01; the other is d/m/a.yaml"});
  CHECK(errors({{"d/m/a.yaml", mission_yaml("leg-1", "sim01", "after_goal: next leg-1\n")}}) ==
        Lines{"d/m/a.yaml:6:13: after_goal: follows, in a circle, a mission that follows it: none begins"});
  CHECK(errors({{"d/m/a.yaml", mission_yaml("leg-1", "sim01", "after_goal: next leg-2\n")},
                {"d/m/b.yaml", mission_yaml("leg-2", "sim01", "after_goal: next leg-1\n")}})
            .size() == 2);
}

TEST_CASE("files that cannot be read are errors without a line") {
  const auto none = load("d/d.yaml", sources({}));
  REQUIRE_FALSE(none);
  CHECK(none.error().size() == 1);
  CHECK(none.error()[0].message() == "d/d.yaml: cannot be read: No such file or directory");

  auto unreadable = sources({{"d/d.yaml", kDaemon}});
  unreadable.matches = [](const std::string&) { return std::vector<std::string>{"d/m/a.yaml"}; };
  const auto result = load("d/d.yaml", unreadable);
  REQUIRE_FALSE(result);
  CHECK(result.error()[0].message() == "d/m/a.yaml: cannot be read: No such file or directory");

  const std::string named =
      "schema: glidehelm/daemon/v1\nmissions: [a.yaml]\ngliders:\n  - {name: a, line: {connect: \"h:1\"}, to_glider: "
      "/g}\n";
  const auto missing = load("d.yaml", sources({{"d.yaml", named}}));
  REQUIRE_FALSE(missing);
  CHECK(missing.error()[0].message() == "d.yaml: missions: no such file: a.yaml");
}

TEST_CASE("a file that two patterns match is loaded once") {
  std::string daemon = kDaemon;
  daemon.replace(daemon.find("[m/*.yaml]"), 10, "[m/*.yaml, m/a.yaml]");
  const auto result = load("d/d.yaml", sources({{"d/d.yaml", daemon}, {"d/m/a.yaml", mission_yaml("leg-1", "sim01")}}));
  REQUIRE(result);
  CHECK(result->missions.size() == 1);
}
