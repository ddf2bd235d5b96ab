#include <malloc.h>

#include <catch2/catch.hpp>

#include "tests/support/session_desk.hpp"

using namespace glidehelm;
using test::SessionDesk;

namespace {

std::size_t held_bytes() { return mallinfo2().uordblks; }

}  // namespace

TEST_CASE("what a dialog says of commands and empty folders is in the log, once each") {
  SessionDesk desk;
  desk.fly();
  desk.say(desk.connection_block(30) + "  9051 60 ERROR behavior surface_4: ! FAILED: dockzs -num=3\r\n");
  CHECK(desk.said("note  sim01     the glider refused the command: dockzs -num=3") == 1);
  desk.say("  9060    behavior surface_4: ! succeeded:zr\r\n");
  CHECK(desk.said("refused the command") == 1);
  desk.say("<dockserver command=\"dockzr -archive *\">\nnot found>*<\n</dockserver>\n");
  CHECK(desk.said(
            "'dockzr -archive *' found no file in to-glider: a list that comes now waits for the next surfacing") == 1);
  desk.say("Mission completed: MS_ABORT_BEH_ERROR(6)\r\n");
  CHECK(desk.said("ALERT sim01     the dialog says that the glider's mission has ended: MS_ABORT_BEH_ERROR(6)") == 1);
  CHECK(desk.said("ALERT sim01     the dialog says that a mission was aborted: MS_ABORT_BEH_ERROR(6)") == 1);
}

TEST_CASE("a transfer of another file that fails is not the daemon's business") {
  SessionDesk desk;
  desk.fly();
  desk.say(desk.connection_block(30) + "zModem transfer FAILED for file 01710005.tcd\r\n");
  CHECK(desk.said("transfer") == 0);
}

TEST_CASE("the words of a site replace the usual ones, from its configuration to its log") {
  protocol::DialogWords words;
  words.transfer_failed = {"Could not send"};
  words.command_failed = {"NO SUCH COMMAND"};
  words.nothing_to_send = {"folder is empty"};
  words.reread = {"Lists read"};
  SessionDesk desk{words};
  desk.fly();
  desk.say(desk.connection_block(30) + "Could not send GOTO_L10.MA\r\n");
  CHECK(desk.said("the transfer of GOTO_L10.MA failed") == 1);
  desk.say(
      "NO SUCH COMMAND dockzs\r\n<dockserver command=\"dockzr *\">\nfolder is empty\n</dockserver>\nLists read\r\n");
  CHECK(desk.said("the glider refused the command: dockzs") == 1);
  CHECK(desk.said("'dockzr *' found no file in to-glider") == 1);
  CHECK(desk.said("the glider reads its lists again") == 1);
  desk.say("zModem transfer FAILED for file goto_l10.ma\r\n  9051 60 ! FAILED: dockzs\r\nMAFILES will be re-read\r\n");
  CHECK(desk.said("refused the command") == 1);
  CHECK(desk.said("the glider reads its lists again") == 1);
}

TEST_CASE("changed words are in force from the next connection on, the reload itself drops nothing") {
  SessionDesk desk;
  desk.fly();
  auto entry = desk.session->entry();
  entry.dialog.command_failed = {"NO SUCH COMMAND"};
  desk.session->apply(desk.session->prepare(entry).value());
  desk.say(desk.connection_block(30) + "! FAILED: dockzs\r\n");
  CHECK(desk.said("refused the command: dockzs") == 1);
  CHECK(desk.ended.empty());
  desk.hang_up();
  desk.dial();
  desk.say(desk.connection_block(30) + "NO SUCH COMMAND dockzr\r\n");
  CHECK(desk.said("refused the command: dockzr") == 1);
}

TEST_CASE("another glider's name, and a second name, close the line with an alert") {
  SessionDesk desk;
  desk.fly();
  SECTION("another") {
    desk.say("Vehicle Name: sim02\r\n" + desk.fix(30, 48.25) + "x\r\n");
    CHECK(desk.said("ALERT sim01     the dialog on this line is of glider 'sim02', configured is sim01") == 1);
  }
  SECTION("a second") {
    desk.say("Vehicle Name: sim01\r\n" + desk.curr_time() + "Vehicle Name: sim02\r\n" + desk.fix(30, 48.25) + "x\r\n");
    CHECK(desk.said("ALERT sim01     two names on one connection, sim01 and 'sim02': connection closed") == 1);
  }
  CHECK_FALSE(desk.ended.empty());
  CHECK(desk.session->pilot().surfacings() == 0);
}

TEST_CASE("what noise made of a fix is refused with the rule that forbids it") {
  struct Row {
    const char* line;
    const char* rule;
  };
  const auto row = GENERATE(values<Row>({
      {"GPS Location: 69696969.000 N 69696969.000 E measured     1e+308 secs ago", "fix refused (S3)"},
      {"GPS Location:  2860.000 N -1518.000 E measured      48.25 secs ago", "fix refused (S3)"},
      {"GPS Location:  2830.000 N -1518.000 E measured       1201 secs ago", "fix refused (S3)"},
      {"GPS Location:  2830.000 N -1518.0", "fix refused (R7)"},
  }));
  SessionDesk desk;
  desk.fly();
  CAPTURE(row.line);
  desk.say("Vehicle Name: sim01\r\n" + desk.curr_time() + row.line +
           "\r\n  9000    No login script found for processing.\r\n");
  desk.pass(Seconds{3});  // a block without a whole location is given when the line falls silent
  CHECK(desk.said(row.rule) == 1);
  CHECK(desk.session->pilot().surfacings() == 0);
}

TEST_CASE("lines beyond 4 KiB and dockserver blocks beyond 64 KiB are discarded, counted and named by rule") {
  SessionDesk desk;
  desk.fly();
  desk.say("Vehicle Name: sim01\r\n");
  desk.say(std::string(5000, 'x') + "\r\n" + std::string(4097, 'y') + "\r\n");
  std::string block = "<dockserver command=\"dockzr *\">\n";
  for (int i = 0; i < 700; ++i) block += std::string(99, 'z') + "\n";
  desk.say(block);
  desk.say("GPS Location:  28\r\n");
  CHECK(desk.session->pilot().surfacings() == 0);
  // What is true comes behind all that, and is taken.
  desk.say(desk.connection_block(30));
  CHECK(desk.session->pilot().surfacings() == 1);
  CHECK(desk.said("not used were 1 damaged lines (R7), 2 lines beyond 4 KiB (R4), 1 dockserver blocks without an end "
                  "(R3); ") == 1);
  desk.hang_up();
  CHECK(desk.said("not used were") == 1);  // nothing more since
  CHECK(desk.said("line: closed, ") == 1);
}

TEST_CASE("a line that never ends, a block that never ends and a transfer that never ends do not grow the daemon") {
  const auto* kind = GENERATE("line", "block", "transfer", "noise");
  CAPTURE(kind);
  SessionDesk desk;
  desk.fly();
  desk.say("Vehicle Name: sim01\r\n");
  std::string piece(64U << 10, 'x');
  if (std::string{kind} == "block") desk.say("<dockserver command=\"x\">");
  if (std::string{kind} == "transfer") {
    desk.say("**B00000000000000\r\n");
    for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = static_cast<char>(128 + i * 7 % 100);
  }
  if (std::string{kind} == "noise")
    for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = static_cast<char>(i * 2654435761U >> 13);
  desk.say(piece);
  desk.say(piece);
  const auto before = held_bytes();
  const auto records = desk.records();
  for (int i = 0; i < 100; ++i) desk.say(piece);
  // 6.5 MB came. The reader may hold one line, one block (64 KiB) and one surface block.
  CHECK(held_bytes() < before + (256U << 10));
  CHECK(desk.records() == records);
  CHECK(desk.handled >= 102 * piece.size());
  // And it is still there when the glider calls.
  desk.say("\r\n" + desk.connection_block(30));
  CHECK(desk.session->pilot().surfacings() == 1);
}

TEST_CASE("a dialog gives the same file in pieces of any size") {
  std::optional<std::string> whole;
  for (const std::size_t chunk : {0U, 1U, 7U, 69U}) {
    CAPTURE(chunk);
    SessionDesk desk;
    desk.world.net.chunk = chunk;
    desk.fly();
    desk.say(desk.connection_block(30) + desk.at_surface_block(30, 3));
    const auto file = desk.world.files.get(SessionDesk::kFile);
    REQUIRE(file);
    if (!whole) whole = file;
    CHECK(*file == *whole);
  }
}

TEST_CASE("what is whole when the line falls silent is used after two seconds") {
  SessionDesk desk;
  desk.fly();
  desk.say("Vehicle Name: sim01\r\n" + desk.fix(30, 48.25));
  CHECK(desk.session->pilot().surfacings() == 0);
  desk.pass(Seconds{1.9});
  CHECK(desk.session->pilot().surfacings() == 0);
  desk.pass(Seconds{0.2});
  CHECK(desk.session->pilot().surfacings() == 1);
}

TEST_CASE("a newer connection replaces the older one, and says so") {
  SessionDesk desk;
  desk.fly();
  desk.say("Vehicle Name: sim01\r\n" + desk.curr_time() + "GPS Location:  28");
  desk.dial();
  CHECK(desk.said("connected, replacing the older connection") == 1);
  desk.say("30.000 N -1518.000 E measured      48.25 secs ago\r\nx\r\n");
  CHECK(desk.session->pilot().surfacings() == 0);  // half of it was another call
}
