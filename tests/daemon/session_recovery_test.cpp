#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "daemon/world/program_version.hpp"
#include "tests/support/session_desk.hpp"

using namespace glidehelm;
using test::SessionDesk;

namespace {

/// The records without what an older program did not write: `forecast` of a surfacing, the version of an epoch.
std::vector<daemon::JournalRecord> as_older(std::vector<daemon::JournalRecord> records) {
  int surfacings = 0;
  for (auto& record : records) {
    auto json = nlohmann::json::parse(record.payload);
    if (record.type == daemon::RecordType::epoch) json = nlohmann::json::object();
    if (record.type == daemon::RecordType::event && json.at("event") == "surfacing_heard")
      surfacings += static_cast<int>(json.at("what").erase("forecast"));
    record.payload = json.dump();
  }
  REQUIRE(surfacings > 0);
  return records;
}

/// What comes of the next surfacing after these records were replayed: the file's bytes.
std::string file_after(const std::vector<daemon::JournalRecord>& past) {
  SessionDesk desk;
  desk.world.clock.advance(Seconds{5 * 3600.0});
  desk.session->recover(past);
  desk.settle();
  REQUIRE(desk.session->start());
  desk.dial();
  desk.say(desk.connection_block(32) + desk.at_surface_block(32, 4));
  REQUIRE(desk.session->pilot().surfacings() == 2);
  const auto file = desk.world.files.get(SessionDesk::kFile);
  REQUIRE(file);
  return *file;
}

/// A flight of one surfacing, up to the dive.
std::vector<daemon::JournalRecord> flown() {
  SessionDesk desk;
  desk.fly();
  desk.say(desk.connection_block(30) + desk.at_surface_block(30, 3));
  desk.world.files.take(SessionDesk::kFile);
  desk.pass(Seconds{1});
  desk.say("RESUMING MISSION\r\n");
  return desk.journal->all().value();
}

}  // namespace

TEST_CASE("a journal of before events had their newest members replays to the same file, byte for byte") {
  const auto now = flown();
  CHECK(file_after(now) == file_after(as_older(now)));
}

TEST_CASE("an event that this version cannot read is named with the version that wrote it, and the others count") {
  auto past = flown();
  std::string expected = "written by version " + std::string{world::program_version()};
  SECTION("this one") {}
  SECTION("another one") {
    for (auto& record : past)
      if (record.type == daemon::RecordType::epoch) record.payload = "{\"version\":\"9.1.0\"}";
    expected = "written by version 9.1.0";
  }
  SECTION("one that did not say") {
    for (auto& record : past)
      if (record.type == daemon::RecordType::epoch) record.payload = "{}";
    expected = "written by an unknown version";
  }
  daemon::JournalRecord strange = past.back();
  strange.type = daemon::RecordType::event;
  strange.sequence = 4711;
  strange.payload = "{\"event\":\"whale_seen\",\"glider\":\"sim01\",\"now\":{\"utc_ms\":0,\"tick_ms\":0},\"what\":{}}";
  past.push_back(strange);
  SessionDesk desk;
  desk.session->recover(past);
  desk.settle();
  CHECK(desk.said("ALERT sim01     record 4711 of the journal, " + expected + ", cannot be replayed by this " +
                  world::program_version() + ": unknown event whale_seen") == 1);
  CHECK(desk.session->pilot().surfacings() == 1);
}

TEST_CASE("a session comes back with its surfacings, and answers none of them twice") {
  SessionDesk desk;
  desk.fly();
  const auto call = desk.connection_block(30) + desk.at_surface_block(30, 3);
  desk.say(call);
  REQUIRE(desk.world.files.get(SessionDesk::kFile));
  const auto inode = desk.world.files.get(SessionDesk::kFile);
  desk.world.files.kill();
  desk.world.net.stop();
  desk.session.reset();
  desk.open();
  desk.session->recover(desk.journal->past());
  desk.session->fly({SessionDesk::mission()}, "start");
  desk.settle();
  REQUIRE(desk.session->start());
  CHECK(desk.said("back with 1 surfacings from the journal") == 1);
  CHECK(desk.delivery() == mission::Delivery::queued);
  desk.dial();
  desk.say(call);
  CHECK(desk.session->pilot().surfacings() == 1);
  CHECK(desk.said("goto_l10.ma is queued in") == 1);
  CHECK(desk.world.files.get(SessionDesk::kFile) == inode);
}

TEST_CASE("events of another glider in the same journal change nothing") {
  auto past = flown();
  for (auto& record : past)
    if (record.type == daemon::RecordType::event) {
      auto json = nlohmann::json::parse(record.payload);
      json["glider"] = "sim02";
      record.payload = json.dump();
    }
  SessionDesk desk;
  desk.session->recover(past);
  CHECK(desk.session->pilot().surfacings() == 0);
  CHECK(desk.said("back with") == 0);
}
