#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

struct Arrows {
  std::map<std::string, std::set<std::string>> rooms;                  // room → rooms it may include
  std::vector<std::pair<std::string, std::set<std::string>>> outside;  // header prefix → rooms that may
};

Arrows read_arrows() {
  std::ifstream file{fs::path{GLIDEHELM_SOURCE} / "cmake/arrows.txt"};
  REQUIRE(file);
  Arrows arrows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words{line};
    std::string first;
    words >> first;
    std::set<std::string> rest{std::istream_iterator<std::string>{words}, {}};
    if (first.front() == '@')
      arrows.outside.emplace_back(first.substr(1), rest);
    else
      arrows.rooms[first.substr(0, first.size() - 1)] = rest;
  }
  return arrows;
}

/// The room of a path below the root: the longest prefix that arrows.txt names; empty when none does.
std::string room_of(const std::string& path, const Arrows& arrows) {
  std::string best;
  for (const auto& [room, allowed] : arrows.rooms)
    if (path.rfind(room, 0) == 0 && (path[room.size()] == '/' || path[room.size()] == '.') && room.size() > best.size())
      best = room;
  return best;
}

struct Include {
  std::string file, header;
  bool quoted{};
  int line{};
};

std::vector<Include> includes_of(const fs::path& root) {
  std::vector<Include> found;
  for (const char* top : {"core", "protocol", "config", "daemon", "simulator"})
    for (const auto& entry : fs::recursive_directory_iterator{root / top}) {
      const auto extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp") continue;
      std::ifstream file{entry.path()};
      int number = 0;
      for (std::string line; std::getline(file, line);) {
        ++number;
        const auto start = line.find_first_not_of(" \t");
        if (start == std::string::npos || line.compare(start, 8, "#include") != 0) continue;
        const auto open = line.find_first_of("<\"", start);
        const auto close = line.find_first_of(">\"", open + 1);
        if (open == std::string::npos || close == std::string::npos) continue;
        found.push_back({fs::relative(entry.path(), root).string(), line.substr(open + 1, close - open - 1),
                         line[open] == '"', number});
      }
    }
  return found;
}

std::vector<std::string> offences(const std::vector<Include>& includes, const Arrows& arrows) {
  std::vector<std::string> bad;
  for (const auto& include : includes) {
    const auto from = room_of(include.file, arrows);
    const auto where = include.file + ":" + std::to_string(include.line) + " includes " + include.header;
    if (from.empty()) {
      bad.push_back(where + ", but the file lies in no room of cmake/arrows.txt");
      continue;
    }
    if (include.quoted) {
      const auto to = room_of(include.header, arrows);
      if (to.empty())
        bad.push_back(where + ", which names no room: include from the root");
      else if (to != from && arrows.rooms.at(from).count(to) == 0)
        bad.push_back(where + ": " + from + " may not know " + to);
      continue;
    }
    for (const auto& [prefix, rooms] : arrows.outside)
      if ((prefix.back() == '/' ? include.header.rfind(prefix, 0) == 0
                                : include.header == prefix || include.header.rfind(prefix + "/", 0) == 0 ||
                                      include.header.rfind(prefix + ".", 0) == 0) &&
          rooms.count(from) == 0)
        bad.push_back(where + ": " + from + " may not know it");
  }
  return bad;
}

}  // namespace

TEST_CASE("every include follows an arrow that is allowed") {
  const auto arrows = read_arrows();
  const auto includes = includes_of(GLIDEHELM_SOURCE);
  REQUIRE(includes.size() > 100);
  for (const auto& offence : offences(includes, arrows)) FAIL_CHECK(offence);
}

TEST_CASE("no arrow points from core outwards, and the arrows have no circle") {
  const auto arrows = read_arrows();
  for (const auto& [room, allowed] : arrows.rooms)
    if (room.rfind("core/", 0) == 0)
      for (const auto& to : allowed) CHECK(to.rfind("core/", 0) == 0);
  for (const auto& [room, allowed] : arrows.rooms)
    for (const auto& to : allowed) {
      REQUIRE(arrows.rooms.count(to) == 1);
      CHECK(arrows.rooms.at(to).count(room) == 0);
    }
}

TEST_CASE("a wrong arrow is found") {
  const auto arrows = read_arrows();
  CHECK(offences({{"core/safety/judge.cpp", "core/planning/planner.hpp", true, 3}}, arrows).size() == 1);
  CHECK(offences({{"simulator/glidersim.cpp", "protocol/dialog.hpp", true, 3}}, arrows).size() == 1);
  CHECK(offences({{"core/ocean/gridded.cpp", "netcdf.h", false, 3}}, arrows).size() == 1);
  CHECK(offences({{"core/ocean/gridded.cpp", "thread", false, 3}}, arrows).size() == 1);
  CHECK(offences({{"somewhere/else.cpp", "vector", false, 3}}, arrows).size() == 1);
  CHECK(offences({{"core/planning/astar.cpp", "core/vehicle/motion.hpp", true, 3}}, arrows).empty());
}
