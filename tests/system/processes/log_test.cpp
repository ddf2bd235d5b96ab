#include "tests/system/processes/sea.hpp"

using namespace glidehelm;
using namespace glidehelm::test;

TEST_CASE("the log of a flight tells each surfacing, its plan and its file once, in lines of one form") {
  Sea sea;
  auto daemon = sea.start_daemon();
  auto simulator = sea.start_simulator();
  REQUIRE(simulator->wait(kFlightLimit).code == 0);
  REQUIRE(daemon->wait(kStepLimit).code == 0);
  const auto log = sea.daemon_log();
  INFO(log);
  REQUIRE(!log.empty());
  CHECK(log.back() == '\n');

  // daemon/log.hpp: time, SIMULATED, level, glider or "-", fact.
  const std::regex form{
      "[0-9]{4}-[01][0-9]-[0-3][0-9]T[0-2][0-9]:[0-5][0-9]:[0-6][0-9]Z SIMULATED "
      "(info |note |ALERT|PAGE |clear) (sim01|-) +[^ ].*[^ ]"};
  std::string last;
  for (const auto& line : lines_of(log)) {
    CAPTURE(line);
    CHECK(std::regex_match(line, form));
    CHECK(std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c <= '~'; }));
    CHECK(line.substr(0, 20) >= last);  // ISO times compare as text
    last = line.substr(0, 20);
  }

  // In this order at each surfacing, and nothing of it twice.
  const auto story = lines_with(log, "sim01 +(surfacing [0-9]+: fix|plan by |goto_l10\\.ma is queued)");
  const auto surfacings = sea.surfacings().size();
  REQUIRE(surfacings >= 4);
  REQUIRE(story.size() == 3 * surfacings);
  for (std::size_t i = 0; i < surfacings; ++i) {
    CHECK(story[3 * i].find("surfacing " + std::to_string(i + 1) + ": fix ") != std::string::npos);
    CHECK(std::regex_search(story[3 * i + 1], std::regex{"plan by [a-z-]+: .*[0-9]+ s left in the window$"}));
    CHECK(story[3 * i + 2].find("goto_l10.ma is queued in " + sea.path("run/sim01/to-glider")) != std::string::npos);
  }
  CHECK(lines_with(log, "ALERT|PAGE").empty());  // nobody is woken by a flight on which nothing went wrong
}
