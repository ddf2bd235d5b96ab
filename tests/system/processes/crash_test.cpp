#include <chrono>
#include <iostream>
#include <map>
#include <variant>

#include "daemon/event_json.hpp"
#include "tests/system/processes/sea.hpp"

using namespace glidehelm;
using namespace glidehelm::test;

namespace {

/// Which file answered which surfacing, by the journal.
struct Answers {
  std::map<std::string, int> intended, visible;  ///< INTENTs; files known or believed to have become visible
  int open{};                                    ///< INTENTs without an end
};

Answers answers_in(const std::vector<daemon::JournalRecord>& records) {
  Answers answers;
  for (const auto& record : records) {
    const bool intent = record.type == daemon::RecordType::intent;
    const bool seen = record.type == daemon::RecordType::committed || record.type == daemon::RecordType::recovered;
    if (!intent && !seen && record.type != daemon::RecordType::aborted) continue;
    const std::string key = nlohmann::json::parse(record.payload).at("surfacing");
    answers.open += intent ? 1 : -1;
    if (intent) ++answers.intended[key];
    if (seen) ++answers.visible[key];
  }
  return answers;
}

/// The how-manieth pass of each step comes first at the given surfacing, counted in the journal of a flight without a crash.
struct Passes {
  int surfacing_recorded{}, planned{}, verified{};
};

Passes passes_before(int surfacing, const std::vector<daemon::JournalRecord>& records) {
  Passes passes{1, 1, 1};
  std::map<std::int64_t, bool> fixes;
  for (const auto& record : records) {
    if (record.type != daemon::RecordType::event) continue;
    const auto read = daemon::event_from_json(record.payload);
    REQUIRE(read);
    if (const auto* heard = std::get_if<mission::SurfacingHeard>(&read->event.what)) {
      fixes[heard->surfacing.fix_taken.time_since_epoch().count()] = true;
      if (static_cast<int>(fixes.size()) == surfacing) return passes;
      ++passes.surfacing_recorded;
    }
    if (std::holds_alternative<mission::CandidateFound>(read->event.what)) ++passes.planned;
    if (std::holds_alternative<mission::Judged>(read->event.what)) ++passes.verified;
  }
  FAIL("the flight is too short");
  return passes;
}

/// Every surfacing had one file, and the glider arrived.
void check_answered_once(const Sea& sea, int surfacings_without_crash) {
  const auto surfacings = sea.surfacings();
  CHECK(static_cast<int>(surfacings.size()) == surfacings_without_crash);
  for (const auto& line : surfacings) {
    CAPTURE(line);
    CHECK(line.find("file goto_l10.ma taken, re-read") != std::string::npos);
  }
  CHECK(sea.taken().size() == surfacings.size());
  CHECK(lines_with(sea.simulator_log(), "^sim01: arrived at ").size() == 1);
  const auto answers = answers_in(sea.journal());
  CHECK(answers.open == 0);
  CHECK(answers.visible.size() == surfacings.size());
  for (const auto& [key, count] : answers.visible) {
    CAPTURE(key);
    CHECK(count == 1);
  }
  // Files wait for the at-surface block, which comes 120 s after the surfacing and says 780 s: nobody may believe to have more.
  for (const auto& line : lines_with(sea.daemon_log(), "s left in the window")) {
    CAPTURE(line);
    std::smatch seconds;
    REQUIRE(std::regex_search(line, seconds, std::regex{"([0-9]+) s left in the window"}));
    CHECK(std::stoi(seconds[1]) <= 900 - 120);
  }
  // Nothing half-made stays behind, nothing waits for a glider that has everything.
  CHECK(std::filesystem::is_empty(sea.folder.path / "run/sim01/to-glider"));
  for (const auto& entry : std::filesystem::directory_iterator{sea.folder.path / "run/sim01/.glidehelm"})
    CHECK(entry.path().extension() != ".tmp");
}

}  // namespace

TEST_CASE("a daemon killed at any step of a surfacing and started again makes exactly one file for each surfacing") {
  Sea calm;
  auto daemon = calm.start_daemon();
  auto simulator = calm.start_simulator();
  const auto arrived = simulator->wait(kFlightLimit);
  INFO(calm.daemon_log() << calm.simulator_log());
  REQUIRE(arrived.code == 0);
  REQUIRE(daemon->wait(kStepLimit).code == 0);
  const int surfacings = static_cast<int>(calm.surfacings().size());
  REQUIRE(surfacings >= 4);
  check_answered_once(calm, surfacings);
  const auto second = passes_before(2, calm.journal()), third = passes_before(3, calm.journal());

  // One file a surfacing: the N-th pass of a step of the emission is the N-th surfacing.
  const std::vector<std::pair<std::string, int>> moments{{"first_byte", 1},
                                                         {"first_byte", 2 * second.surfacing_recorded},
                                                         {"surfacing_recorded", second.surfacing_recorded},
                                                         {"surfacing_recorded", third.surfacing_recorded + 1},
                                                         {"planned", second.planned},
                                                         {"staged", third.verified},
                                                         {"verified", second.verified},
                                                         {"before_intent", 3},
                                                         {"after_intent", 2},
                                                         {"before_rename", 3},
                                                         {"after_rename", 2},
                                                         {"after_folder_sync", 3},
                                                         {"before_committed", 2},
                                                         {"after_committed", 3}};
  for (const auto& [step, pass] : moments) {
    const auto moment = step + "@" + std::to_string(pass);
    CAPTURE(moment);
    Sea sea;
    const auto begin = WallClock::now();
    auto victim = sea.start_daemon(moment);
    auto sim = sea.start_simulator();
    const auto death = victim->wait(kFlightLimit);
    const auto at_death = sea.surfacings().size();
    REQUIRE(death.in_time);
    REQUIRE(death.signal == SIGKILL);
    REQUIRE(sim->running());
    auto successor = sea.start_daemon();
    const auto end = sim->wait(kFlightLimit);
    const auto stopped = successor->wait(kStepLimit);
    INFO(sea.daemon_log() << sea.simulator_log());
    CHECK(end.code == 0);
    CHECK(stopped.code == 0);
    check_answered_once(sea, surfacings);
    const std::chrono::duration<double> took = WallClock::now() - begin;
    std::cout << "kill -9 at " << moment << ": after " << at_death << " surfacings printed, " << sea.taken().size()
              << " files for " << sea.surfacings().size() << " surfacings, " << took.count() << " s\n";
  }
}

TEST_CASE("a daemon that dies again and again, also while it recovers, still makes one file for each surfacing") {
  Sea sea;
  const auto simulator = sea.start_simulator();
  // Each lives until it dies: before its file is visible, at the reprint that brings its successor to the same surfacing, when the
  // next file is just committed, and at the first byte after that.
  for (const std::string moment :
       {"after_intent@2", "verified@1", "surfacing_recorded@1", "after_committed@1", "first_byte@1"}) {
    CAPTURE(moment);
    const auto daemon = sea.start_daemon(moment);
    const auto death = daemon->wait(kFlightLimit);
    INFO(sea.daemon_log() << sea.simulator_log());
    REQUIRE(death.in_time);
    REQUIRE(death.signal == SIGKILL);
  }
  const auto last = sea.start_daemon();
  CHECK(simulator->wait(kFlightLimit).code == 0);
  CHECK(last->wait(kStepLimit).code == 0);
  INFO(sea.daemon_log() << sea.simulator_log());
  check_answered_once(sea, static_cast<int>(sea.surfacings().size()));
}
