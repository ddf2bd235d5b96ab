#include "protocol/dialog.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "core/base/utc.hpp"
#include "tests/protocol/dialog_text.hpp"

using namespace glidehelm;
using namespace glidehelm::protocol;

namespace {

using Events = std::vector<DialogEvent>;
const Instant kNow = utc_from_text("2026-05-03T04:10:21Z").value();

struct Heard {
  Events events;
  DialogCounts counts;
  friend bool operator==(const Heard&, const Heard&) = default;
};

Heard hear_in_chunks(std::string_view bytes, std::size_t chunk) {
  DialogReader reader;
  Heard heard;
  const auto keep = [&](Events events) {
    for (auto& e : events) heard.events.push_back(std::move(e));
  };
  for (std::size_t at = 0; at < bytes.size(); at += chunk) keep(reader.append(bytes.substr(at, chunk), kNow));
  keep(reader.end(kNow));
  heard.counts = reader.counts();
  return heard;
}

/// What is heard, which is the same for every chunking.
Heard hear(std::string_view bytes) {
  auto whole = hear_in_chunks(bytes, bytes.size() + 1);
  for (const std::size_t chunk : {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{64}})
    REQUIRE(hear_in_chunks(bytes, chunk) == whole);
  return whole;
}

template <class T>
std::vector<T> all(const Events& events) {
  std::vector<T> found;
  for (const auto& e : events)
    if (const auto* is = std::get_if<T>(&e)) found.push_back(*is);
  return found;
}
std::vector<SurfaceBlock> blocks(const Events& events) {
  std::vector<SurfaceBlock> found;
  for (const auto& e : all<BlockRead>(events)) found.push_back(e.block);
  return found;
}

}  // namespace

TEST_CASE("a connection block is given as soon as the line behind its sensors comes") {
  DialogReader reader;
  const auto text = test::connection_block();
  const auto before = text.substr(0, text.size() - test::login_line().size());
  CHECK(blocks(reader.append(before, kNow)).empty());
  const auto given = blocks(reader.append(test::login_line(), kNow));
  REQUIRE(given.size() == 1);
  const auto& block = given.front();
  CHECK(block.vehicle == "alba");
  CHECK(block.curr_time->time_since_epoch().count() == 1777781420);  // date -u -d '2026-05-03 04:10:20' +%s
  CHECK(block.mission_time_s == 9000);
  CHECK(block.gps == Location{"2901.250", "-1528.400", 'N', 'E', 48.25});
  CHECK(block.dead_reckoned->lat_text == "2901.260");
  CHECK(block.too_far->lat_text == "69696969.000");
  CHECK(block.invalid->age_s == 136.25);
  CHECK(block.line == 7);
  CHECK(block.heard == kNow);
  CHECK(block.sensor("m_battery")->value == 14.9021);
  CHECK(block.sensor("m_depth") == nullptr);
  CHECK_FALSE(block.at_surface);
  CHECK(block.console == Console::unknown);
}

TEST_CASE("an at-surface block is given at its window line, with everything in it, and the window after it") {
  const auto heard = hear(test::connection_block() + test::at_surface_block());
  const auto given = blocks(heard.events);
  REQUIRE(given.size() == 2);
  const auto& block = given[1];
  CHECK(block.at_surface);
  CHECK(block.console == Console::mission);
  CHECK(block.mission == MissionLine{"CANARY.MI", "alba-2026-122-4-3", "0112.0003"});
  CHECK(block.because == BecauseLine{"pitch not commanded", "surface_4", 2.0});
  CHECK(block.waypoint == WaypointLine{"2910.5000", "-1530.0000", 17321, 352, 64});
  CHECK(block.water == WaterState::complete);
  CHECK(block.until_diving_s == 236);
  CHECK(block.devices->oddities == std::array<int, 3>{7, 2, 1});
  CHECK(block.aborts == 2);
  CHECK(block.sensors.size() == 2);
  const auto& events = heard.events;
  REQUIRE(events.size() == 5);
  CHECK(std::holds_alternative<ConnectionOpened>(events[0]));
  CHECK(events[1] == DialogEvent{NameHeard{"alba"}});
  CHECK(events[4] == DialogEvent{WindowHeard{236}});
  CHECK(heard.counts.connections == 1);
  CHECK(heard.counts.at_surface_blocks == 1);
  CHECK(heard.counts.gps_lines == 2);
  CHECK(heard.counts.sensor_lines == 3);
  CHECK(heard.counts.damaged_lines == 0);
}

TEST_CASE("random chunks give the same events as the whole") {
  std::mt19937 rng{11};
  const auto text =
      test::connection_block() + test::at_surface_block() +
      "^EExtending surface time by 5 minutes\r\nDR  Lo<dockserver command=\"x\">\nt\n</dockserver>\ncation:\r\n" +
      test::at_surface_block("alba", 400) + "   RESUMING MISSION\r\nGliderDos N -1 >";
  const auto whole = hear_in_chunks(text, text.size());
  for (int round = 0; round < 200; ++round) {
    DialogReader reader;
    Heard heard;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t size = 1 + rng() % 150;
      for (auto& e : reader.append(std::string_view{text}.substr(at, size), kNow)) heard.events.push_back(std::move(e));
      at += size;
    }
    for (auto& e : reader.end(kNow)) heard.events.push_back(std::move(e));
    heard.counts = reader.counts();
    REQUIRE(heard == whole);
  }
}

TEST_CASE("silence gives the block as it stands, and what comes later gives it again with more") {
  DialogReader reader;
  const auto text = test::connection_block();
  const auto sensor = text.find("   sensor:");
  CHECK(blocks(reader.append(text.substr(0, sensor), kNow)).empty());
  const auto early = blocks(reader.flush_idle(kNow));
  REQUIRE(early.size() == 1);
  CHECK(early.front().sensors.empty());
  CHECK(reader.flush_idle(kNow).empty());  // nothing new
  const auto later = blocks(reader.append(text.substr(sensor), kNow));
  REQUIRE(later.size() == 1);
  CHECK(later.front().sensors.size() == 1);
  CHECK(later.front().line == early.front().line);
}

TEST_CASE("silence gives nothing of a block without a fix, and nothing of an unfinished line") {
  DialogReader reader;
  const auto text = test::connection_block();
  const auto gps = text.find("GPS Location:");
  CHECK(blocks(reader.append(text.substr(0, gps + 50), kNow)).empty());
  CHECK(reader.flush_idle(kNow).empty());
  CHECK(blocks(reader.append(text.substr(gps + 50), kNow)).size() == 1);
}

TEST_CASE("a prompt has no line end: silence lets it be understood, once") {
  const std::string before = "Connection Event: Carrier Detect found.\r\n\r\n", prompt = "GliderDos N -1 >",
                    after = "412.50    No login script found for processing.\r\n";
  DialogReader reader;
  CHECK(reader.append(before + prompt, kNow).size() == 1);
  CHECK(reader.flush_idle(kNow) == Events{PromptSeen{Console::gliderdos, 'N', -1}});
  CHECK(reader.flush_idle(kNow).empty());
  CHECK(reader.append(after, kNow).empty());
  CHECK(hear(before + prompt + after).events == Events{ConnectionOpened{}, PromptSeen{Console::gliderdos, 'N', -1}});
}

TEST_CASE("a position printed at a prompt is marked as such, before and behind the prompt") {
  const auto text = test::connection_block();
  const auto block = text.substr(0, text.size() - test::login_line().size());
  const auto called = blocks(hear(block + "\r\nGliderDos N -1 >" + test::login_line()).events);
  REQUIRE(called.size() == 1);
  CHECK(called.front().console == Console::gliderdos);
  const auto where = blocks(hear("GliderLAB I -3 >where\r\n" + block.substr(block.find("Vehicle")) + "\r\n").events);
  REQUIRE(where.size() == 1);
  CHECK(where.front().console == Console::gliderlab);
}

TEST_CASE("a mission that runs again takes the prompt back") {
  const auto events = hear("GliderDos N -1 >\r\n" + test::connection_block() + test::at_surface_block()).events;
  for (const auto& block : blocks(events)) CHECK(block.console != Console::gliderdos);
}

TEST_CASE("fields bind to the most recent time, and a damaged time leaves none") {
  auto second = test::at_surface_block();
  second.replace(second.find("Sun"), 3, "Mon");
  const auto given = blocks(hear(test::connection_block() + second).events);
  REQUIRE(given.size() == 2);
  CHECK(given[0].curr_time);
  CHECK_FALSE(given[1].curr_time);
  CHECK(given[1].damaged.size() == 1);
}

TEST_CASE("a location behind the sensors of a block is another block's, which has no time") {
  const auto given = blocks(hear(test::connection_block() + test::gps_line(2901.3, -1528.4, 10)).events);
  REQUIRE(given.size() == 2);
  CHECK_FALSE(given[1].curr_time);
  CHECK(given[1].vehicle == "alba");  // the connection's
}

TEST_CASE("two fixes in a row never share a time") {
  const auto given = blocks(hear(test::console_line() + "Vehicle Name: alba\r\n" + test::time_line() +
                                 "GPS Location:  garbled\r\n" + test::gps_line(2901.25, -1528.4, 48.25))
                                .events);
  REQUIRE(given.size() == 2);
  CHECK(given[0].gps_damaged);
  CHECK_FALSE(given[0].gps);
  CHECK_FALSE(given[1].curr_time);
}

TEST_CASE("a reconnection in the middle of a line ends the old block and opens a new connection") {
  const auto first = test::connection_block();
  const auto cut = first.substr(0, first.find("secs ago\r\n   sensor") + 10) + "   sensor:m_bat";
  const auto heard = hear(cut + test::connection_block() + test::at_surface_block());
  CHECK(heard.counts.connections == 2);
  CHECK(heard.counts.damaged_lines == 1);
  CHECK(blocks(heard.events).size() == 3);
  CHECK(all<NameHeard>(heard.events).size() == 2);
}

TEST_CASE("nothing of a line that the end of the connection cut is used") {
  const auto text = test::connection_block();
  const auto gps_end = text.find("secs ago", text.find("GPS Location:")) + 8;
  const auto heard = hear(text.substr(0, gps_end));  // whole but for the line end
  CHECK(heard.counts.gps_lines == 0);
  CHECK(heard.counts.damaged_lines == 1);
  CHECK(blocks(heard.events).empty());
  CHECK(blocks(hear(text.substr(0, gps_end + 1)).events).size() == 1);
  CHECK(all<NameHeard>(hear("Vehicle Name: al").events).empty());
}

TEST_CASE("a carrier on which nothing is said is no connection of its own") {
  const std::string found = "Connection Event: Carrier Detect found.", lost = "Connection Event: Carrier Detect lost.";
  CHECK(hear(found + lost + found + "  9000    Iridium console active and ready...\r\n").counts.connections == 1);
  CHECK(hear(test::connection_block() + lost + "\r\n" + test::connection_block()).counts.connections == 2);
  CHECK(hear("RING\r\nCONNECT 4800\r\n 41250    Iridium console active and ready...\r\n").counts.connections == 1);
  CHECK(hear(test::console_line() + test::console_line()).counts.connections == 2);
}

TEST_CASE("a second name on a connection is said") {
  const auto names = all<NameHeard>(hear(test::connection_block("alba") + test::at_surface_block("brisa")).events);
  CHECK(names == std::vector<NameHeard>{{"alba"}, {"brisa"}});
  CHECK(all<NameHeard>(hear(test::connection_block("Alba") + test::at_surface_block("ALBA")).events) ==
        std::vector<NameHeard>{{"alba"}});
}

TEST_CASE("a dive is said once, however it begins") {
  const auto by = [](const std::string& text) {
    const auto dives = all<MissionResumed>(hear(test::connection_block() + test::at_surface_block() + text).events);
    REQUIRE(dives.size() == 1);
    return dives.front().by;
  };
  using enum MissionResumed::By;
  const std::string off = "  9071    disabling Iridium console...\r\n";
  CHECK(by("^R  9050 12 behavior surface_4: User typed Control-R, resuming\r\n   RESUMING MISSION\r\n" + off) == key);
  CHECK(by("  9050 12 behavior surface_4: TIMED OUT WAITING FOR A CHARACTER\r\n   RESUMING MISSION\r\n" + off) == time);
  CHECK(by(off) == console_off);
  const auto twice = hear(test::at_surface_block() + off + test::at_surface_block() + off);
  CHECK(all<MissionResumed>(twice.events).size() == 2);
}

TEST_CASE("the end of a mission and an abort are said, history is not") {
  const auto end = hear(
      "  9 behavior ?_-1: layered_control(): Mission completed normally\r\n"
      "  9 behavior ?_-1: run_mission(): Mission completed: MS_COMPLETED_NORMALLY(-1)\r\n"
      "post_mission_cleanup(): End of Mission\r\n");
  CHECK(end.events == Events{MissionEnded{"MS_COMPLETED_NORMALLY(-1)"}});
  const auto aborted =
      hear("  9    Mission completed: MS_ABORT_BEH_ERROR(6)\r\n\r\nGliderDos A 6 >\r\nGliderDos A 6 >\r\n");
  CHECK(aborted.events == Events{MissionEnded{"MS_ABORT_BEH_ERROR(6)"}, AbortSeen{"MS_ABORT_BEH_ERROR(6)"},
                                 PromptSeen{Console::gliderdos, 'A', 6}, AbortSeen{"GliderDos A 6"}});
  CHECK(hear("ABORT HISTORY: last abort cause: MS_ABORT_USER_INTERRUPT\r\n").events.empty());
}

TEST_CASE("windows, transfers, re-reads and keys are said in their order") {
  const auto heard = hear(
      "Time until diving is: 108 secs\r\n^EExtending surface time by 5 minutes\r\n"
      "I heard a character ('CR'), but not the right one\r\n"
      "Starting zModem transfer of goto_l10.ma to/from alba size is 812\r\n"
      "zModem transfer DONE for file goto_l10.ma\r\n"
      "^F  9110    behavior surface_4: MAFILES will be re-read\r\n"
      "<dockserver command=\"!dockzr *\">\n not found>*<\n</dockserver>\n");
  CHECK(heard.events == Events{WindowHeard{108}, WindowExtended{Seconds{300}}, KeyHeard{"CR"},
                               TransferStarted{"goto_l10.ma"}, TransferDone{"goto_l10.ma"}, MafilesReread{},
                               DockserverBlock{"!dockzr *", "\n not found>*<\n", true}, NothingToSend{"!dockzr *"}});
  CHECK(heard.counts.dockserver_blocks == 1);
}

TEST_CASE("how commands and transfers ended is said") {
  const auto heard = hear(
      "  9051 60 ERROR behavior surface_4: ! FAILED: dockzs *\r\n"
      "<dockserver command=\"dockzr *\">\nStarting\n</dockserver>\n"
      "Starting zModem transfer of goto_l10.ma to/from alba size is 812\r\n"
      "zModem transfer FAILED for file goto_l10.ma\r\n"
      "  9080    behavior surface_4: ! succeeded:dockzr *\r\n");
  CHECK(heard.events == Events{CommandEnded{"dockzs *", false}, DockserverBlock{"dockzr *", "\nStarting\n", true},
                               TransferStarted{"goto_l10.ma"}, TransferFailed{"goto_l10.ma"},
                               CommandEnded{"dockzr *", true}});
  // A block that never ended says nothing for sure.
  CHECK(hear("<dockserver command=\"dockzr *\">\nnot found>*<\n").events ==
        Events{DockserverBlock{"dockzr *", "\nnot found>*<\n", false}});
}

TEST_CASE("a word that the beginning of a transfer cuts is not used") {
  for (const char* line : {"Vehicle Name: alb", "zModem transfer DONE for file goto_l1", "! succeeded:dockz"}) {
    const auto heard = hear(std::string{line} + "**B00000000000000\r\nb\r\n");
    INFO(line);
    CHECK(heard.events.empty());
    CHECK(heard.counts.damaged_lines == 1);
  }
  CHECK(hear("*^XB0800000000022d\r\nb\r\n").counts.damaged_lines == 0);
}

TEST_CASE("of a torn line that steers nothing is used unless its layout proves it whole") {
  const std::string block = "<dockserver command=\"x\">\nt\n</dockserver>";
  const auto text = test::connection_block() + test::at_surface_block();
  const auto whole = blocks(hear(text).events).back();
  const auto torn_at = [&](const std::string& word, std::size_t lost) {
    auto torn = text;
    const auto at = torn.find(word);
    REQUIRE(at != std::string::npos);
    torn.replace(at, lost, block);
    return hear_in_chunks(torn, 11);
  };
  const auto steers = torn_at("7321m", 1);  // 17321 m would have become 1321 m
  CHECK_FALSE(blocks(steers.events).back().waypoint);
  CHECK(blocks(steers.events).back().until_diving_s == whole.until_diving_s);
  CHECK(steers.counts.damaged_lines == 1);
  const auto dives = torn_at("36 secs", 1);  // 236 s would have become 26 s
  CHECK(all<WindowHeard>(dives.events).empty());
  CHECK_FALSE(blocks(dives.events).back().until_diving_s);
  CHECK_FALSE(blocks(torn_at("ANARY.MI", 1).events).back().mission);
  CHECK(all<NameHeard>(torn_at("lba at surface", 1).events) == std::vector{NameHeard{"alba"}});
}

TEST_CASE("the water velocity is final only when this connection and this dive said so") {
  auto waiting = test::at_surface_block();
  const std::string complete = "Calculations COMPLETE";
  waiting.replace(waiting.find(complete), complete.size(), "Calculations waiting for final gps fix(ideally -57 secs)");
  const auto given =
      blocks(hear(waiting + test::at_surface_block() + "   RESUMING MISSION\r\n" + test::connection_block()).events);
  REQUIRE(given.size() == 3);
  CHECK(given[0].water == WaterState::waiting);
  CHECK(given[1].water == WaterState::complete);
  CHECK(given[2].water == WaterState::unknown);
}

TEST_CASE("a fix line that a dockserver block tore apart is put together, wherever it tore") {
  const auto text = test::connection_block();
  const auto gps = text.find("GPS Location:");
  const auto size = text.find('\r', gps) - gps;
  const auto whole = blocks(hear(text).events).front();
  for (const std::string block : {"\n<dockserver command=\"dockzr *\">\nnot found>*<\n</dockserver>\n",
                                  "<dockserver command=\"dockzr *\">\nnot found>*<\n</dockserver>"})
    for (std::size_t at = 1; at < size; ++at) {
      auto torn = text;
      torn.insert(gps + at, block);
      const auto heard = hear_in_chunks(torn, 5);
      const auto given = blocks(heard.events);
      INFO("torn behind byte " << at);
      REQUIRE(given.size() == 1);
      CHECK(given.front().gps == whole.gps);
      CHECK(given.front().curr_time == whole.curr_time);
      CHECK(heard.counts.damaged_lines == 0);
    }
}

TEST_CASE("a torn fix line that lost bytes at the tear is damaged, never patched") {
  const auto text = test::connection_block();
  const auto gps = text.find("GPS Location:");
  const auto size = text.find('\r', gps) - gps;
  const std::string block = "\n<dockserver command=\"dockzr *\">\nnot found>*<\n</dockserver>\n";
  for (std::size_t lost = 1; lost <= 12; ++lost)
    for (std::size_t at = 1; at + lost < size; ++at) {
      auto torn = text;
      torn.replace(gps + at, lost, block);
      INFO("lost " << lost << " behind byte " << at);
      for (const auto& given : blocks(hear_in_chunks(torn, torn.size()).events)) CHECK_FALSE(given.gps);
    }
}

TEST_CASE("lines beside a dockserver block that are whole are not put together") {
  const auto text = test::connection_block();
  auto with = text;
  const auto gps = text.find("GPS Location:");
  with.insert(gps, "<dockserver command=\"x\">\nt\n</dockserver>\n");
  CHECK(blocks(hear(with).events).front().gps == blocks(hear(text).events).front().gps);
}

TEST_CASE("noise inside a block does not end it") {
  auto text = test::connection_block();
  text.insert(text.find("   sensor:"), ":OOD:digifin_mgr_ctrl:OUT OF DEADBAND: M_FIN:0.1 C_FIN:0.0\r\n");
  const auto given = blocks(hear(text).events);
  REQUIRE(given.size() == 1);
  CHECK(given.front().sensors.size() == 1);
}

TEST_CASE("memory is bounded whatever comes") {
  std::string endless(200'000, 'x');
  for (int i = 0; i < 3000; ++i) endless += test::sensor_line("m_battery", "volts", 14.9, 1);
  endless += test::gps_line(2901.25, -1528.4, 1) + test::login_line();
  const auto heard = hear_in_chunks(endless, 4096);
  CHECK(heard.counts.sensor_lines == 2999);  // the first is the tail of the endless line
  CHECK(heard.counts.long_lines == 1);
  for (const auto& block : blocks(heard.events)) CHECK(block.sensors.size() <= 512);
}

TEST_CASE("dockserver blocks without an end are counted apart from those that had one") {
  std::string text = "<dockserver command=\"dockzr *\">sent</dockserver>\n<dockserver command=\"dockzr *\">\n";
  for (int i = 0; i < 700; ++i) text += std::string(99, 'x') + "\n";
  const auto heard = hear_in_chunks(text + test::connection_block(), 4096);
  CHECK(heard.counts.dockserver_blocks == 2);
  CHECK(heard.counts.lost_blocks == 1);
  CHECK(heard.counts.discarded_bytes > 0);
  CHECK(blocks(heard.events).size() == 1);
}

TEST_CASE("no change of one byte of a fix line gives another position, unless it makes a digit, a sign or a blank") {
  // A new digit or sign, or a blank for the first of a number, can keep the layout, so only the rules that remember
  // (S5) can see it; all else is seen here.
  const auto text = test::connection_block();
  const auto gps = text.find("GPS Location:");
  const auto end = text.find("secs ago", gps);
  int accepted = 0;
  for (std::size_t at = gps; at < end + 10; ++at)
    for (int c = 0; c < 256; ++c) {
      const char now = static_cast<char>(c);
      if (now == text[at] || (now >= '0' && now <= '9') || now == '-' || now == ' ') continue;
      auto changed = text;
      changed[at] = now;
      for (const auto& block : blocks(hear_in_chunks(changed, changed.size()).events)) {
        if (!block.gps) continue;
        ++accepted;
        INFO("byte " << at - gps << " became " << c);
        CHECK(block.gps->lat_text == "2901.250");
        CHECK(block.gps->lon_text == "-1528.400");
        CHECK((block.gps->age_s == 48.25 || block.gps->age_s > 1e8));  // an exponent, which S3 refuses
      }
    }
  CHECK(accepted > 0);  // other letters than N and E are the next rule's
}
