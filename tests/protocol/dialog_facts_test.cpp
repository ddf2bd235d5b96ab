#include "protocol/dialog_facts.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "protocol/line_splitter.hpp"
#include "tests/protocol/dialog_text.hpp"

using namespace glidehelm;
using namespace glidehelm::protocol;

namespace {

std::vector<Fact> facts_of(std::string line, std::size_t joined_at = Line::kWhole, const DialogWords& words = {}) {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
  std::vector<Fact> facts;
  FactFinder{words}.find(line, joined_at, facts);
  return facts;
}

std::vector<Say> says(const std::string& line) {
  std::vector<Say> all;
  for (const auto& fact : facts_of(line)) all.push_back(fact.say);
  return all;
}

}  // namespace

TEST_CASE("a label is searched for, wherever in the line it stands") {
  CHECK(says("^R  9050 12 behavior surface_4: User typed Control-R, resuming") == std::vector{Say::typed_resume});
  CHECK(says("  9110    behavior surface_4: MAFILES will be re-read") == std::vector{Say::reread});
  CHECK(says("Connection Event: Carrier Detect found.81.25    Iridium console active and ready...") ==
        std::vector{Say::connection_event, Say::iridium});
  CHECK(says("x_halfConnection Event: Carrier Detect found.") == std::vector{Say::connection_event});
  CHECK(says("GliderDos N -1 >412.50    No login script found") == std::vector{Say::gliderdos, Say::login});
}

TEST_CASE("lines of a menu, of reports and of history say nothing") {
  for (const char* line :
       {"   Hit Control-R to RESUME the mission, i.e. dive!", "   Hit Control-C to END    the mission, i.e. GliderDos",
        "   Hit Control-E to extend surface time by 5 minutes.", "   Hit ! <GliderDos cmd>  to execute <GliderDos cmd>",
        "  1310    sensor: m_altimeter_voltage = 2.51 volts",
        "ABORT HISTORY: last abort cause: MS_ABORT_USER_INTERRUPT",
        "  9070    behavior surface_4: SUBSTATE 7 ->10 : Waiting for final gps fix", "   m_lat(lat) 2901.250300",
        "Mission Name:   x.mi", "Mission completed normally", ""})
    CHECK(says(line).empty());
}

TEST_CASE("two facts on one line are both found when the line end between them was lost") {
  auto first = test::gps_line(2901.25, -1528.4, 48.25);
  first.resize(first.size() - 2);
  CHECK(says(first + test::sensor_line("m_battery", "volts", 14.9, 3)) == std::vector{Say::gps, Say::sensor});
}

TEST_CASE("a label behind a letter is another word") {
  auto line = test::gps_line(2901.25, -1528.4, 48.25);
  CHECK(says("x" + line).empty());
  CHECK(says("^C" + line).empty());
  CHECK(says("> " + line) == std::vector{Say::gps});
}

TEST_CASE("a label without the rest of its line is a fact that is not whole") {
  for (const char* line : {"GPS Location:  29", "Curr Time: Sun M", "   sensor:m_bat", "Waypoint: (29", "Because:pitch",
                           "MissionName:can", "Time until diving is: 2", "Water Velocity Calc",
                           "devices:(t/m/s) errs:", "Vehicle Name: ", "Vehicle Name: a b",
                           "Water Velocity Calculations C", "ABORT HISTORY: total since reset: x"}) {
    const auto facts = facts_of(line);
    INFO(line);
    if (std::string_view{line} == "Water Velocity Calc") {
      CHECK(facts.empty());  // not even the label
      continue;
    }
    REQUIRE(facts.size() == 1);
    CHECK_FALSE(facts.front().whole);
  }
}

TEST_CASE("a sensor line that spans a join is not trusted when its head is long") {
  const std::string line = "   sensor:m_leakdetect_voltage_forward(volts)=2.51318181818182       16.104 secs ago";
  const auto value = line.find('=') + 1;
  CHECK(facts_of(line, value + 4).front().whole == false);
  CHECK_FALSE(facts_of(line, value - 9).front().whole);  // a name that lost bytes may be another sensor's
  CHECK_FALSE(facts_of(line, line.find(':') + 1).front().whole);
  CHECK(facts_of(line, line.find(':') - 2).front().whole);  // in the label: a fixed word
  CHECK(facts_of(line, line.size() - 3).front().whole);     // in the words behind the age
  const auto aligned = test::sensor_line("m_battery", "volts", 14.9021, 30.25);
  CHECK(facts_of(aligned, aligned.find('=') + 3).front().whole);  // the column proves that nothing is lost
}

TEST_CASE("of a line of free layout that spans a join nothing is used, whatever it says") {
  // The line, and the value in it that may have lost a byte where the join is.
  const std::pair<const char*, const char*> lines[] = {
      {"Waypoint: (2910.5000,-1530.0000) Range: 17321m, Bearing: 352deg, Age: 1:4h:m", "17321"},
      {"Waypoint: (2910.5000,-1530.0000) Range: 17321m, Bearing: 352deg, Age: 1:4h:m", "2910"},
      {"Time until diving is: 235 secs", "235"},
      {"Extending surface time by 15 minutes", "15"},
      {"Because:pitch not commanded [behavior surface_14 start_when = 2.0]", "14"},
      {"MissionName:canary.mi MissionNum:alba-2026-122-4-3 (0112.0003)", "canary"},
      {"Vehicle Name: alba", "alba"},
      {"devices:(t/m/s) errs:   0/   0/   0 warn:   1/   0/   0 odd:  47/   2/   1", "47"},
      {"ABORT HISTORY: total since reset: 12", "12"},
      {"Glider alba at surface.", "alba"},
      {"GliderDos A 18 >", "18"},
      {"Mission completed: MS_COMPLETED_NORMALLY(-1)", "MS_"},
      {"I heard a character ('CR')", "CR"},
      {"zModem transfer DONE for file goto_l10.ma", "10"},
      {"behavior surface_4: ! succeeded:dockzr *", "dockzr"}};
  for (const auto& [line, value] : lines) {
    const std::string text{line};
    const auto whole = facts_of(text);
    REQUIRE(whole.size() == 1);
    REQUIRE(whole.front().whole);
    const auto found = facts_of(text, text.find(value) + 1);
    INFO(line);
    REQUIRE(found.size() == 1);
    CHECK(found.front().say == whole.front().say);
    CHECK_FALSE(found.front().whole);
    CHECK(found.front().value.index() == Fact{}.value.index());
  }
  CHECK(facts_of("Water Velocity Calculations waiting for final gps fix", 29)
            .front()
            .whole);  // fixed words prove themselves
  CHECK(facts_of("Water Velocity Calculations COMPLETE", 30).front().whole);
  CHECK(facts_of("Curr Time: Sun May  3 04:10:20 2026 MT:    9000", 31).front().whole);  // so do fixed widths
}

TEST_CASE("the words of uploads and re-reads can be replaced") {
  DialogWords words;
  words.reread = {"LISTS READ AGAIN"};
  words.transfer_done = {"received "};
  CHECK(facts_of("LISTS READ AGAIN", Line::kWhole, words).front().say == Say::reread);
  CHECK(facts_of("MAFILES will be re-read", Line::kWhole, words).empty());
  const auto done = facts_of("received goto_l10.ma ok", Line::kWhole, words);
  REQUIRE(done.size() == 1);
  CHECK(std::get<std::string>(done.front().value) == "goto_l10.ma");
}

TEST_CASE("commands and transfers tell how they ended") {
  const auto only = [](const std::string& line, const DialogWords& words = {}) {
    const auto facts = facts_of(line, Line::kWhole, words);
    REQUIRE(facts.size() == 1);
    return std::pair{facts.front().say, std::get<std::string>(facts.front().value)};
  };
  CHECK(only("  9051 60 ERROR behavior surface_4: ! FAILED: dockzs -num=3") ==
        std::pair{Say::command_failed, std::string{"dockzs -num=3"}});
  CHECK(only("  9051    behavior surface_4: ! succeeded:zr") == std::pair{Say::command_succeeded, std::string{"zr"}});
  CHECK(only("zModem transfer FAILED for file goto_l10.ma") ==
        std::pair{Say::transfer_failed, std::string{"goto_l10.ma"}});
  DialogWords words;
  words.transfer_failed = {"lost: ", "given up: "};
  words.command_failed = {"cannot: "};
  words.command_succeeded.clear();
  CHECK(only("given up: goto_l10.ma after 3 tries", words) ==
        std::pair{Say::transfer_failed, std::string{"goto_l10.ma"}});
  CHECK(only("cannot: dockzr *", words) == std::pair{Say::command_failed, std::string{"dockzr *"}});
  CHECK(facts_of("behavior surface_4: ! succeeded:zr", Line::kWhole, words).empty());
  CHECK_FALSE(facts_of("zModem transfer DONE for file ").front().whole);
}

TEST_CASE("a file's name follows its words behind any blanks, and is never the tail of a longer word") {
  DialogWords words;
  words.transfer_failed = {"Could not send", "ERROR:"};
  const auto failed = [&](const std::string& line) {
    const auto facts = facts_of(line, Line::kWhole, words);
    REQUIRE(facts.size() == 1);
    REQUIRE(facts.front().say == Say::transfer_failed);
    return facts.front().whole ? std::get<std::string>(facts.front().value) : std::string{"damaged"};
  };
  CHECK(failed("Could not send goto_l10.ma") == "goto_l10.ma");
  CHECK(failed("Could not send \t goto_l10.ma, retry") == "goto_l10.ma");
  CHECK(failed("Could not send \"goto_l10.ma\".") == "goto_l10.ma");
  CHECK(failed("Could not send ...") == "damaged");
  CHECK(failed("ERROR:goto_l10.ma") == "goto_l10.ma");
  CHECK(failed("Could not sendgoto_l10.ma") == "damaged");
  CHECK(failed("Could not send") == "damaged");
  CHECK(failed("Could not send   ") == "damaged");
}

TEST_CASE("the dockserver's words for an empty folder can be replaced") {
  CHECK(FactFinder{DialogWords{}}.nothing_to_send("\nnot found>*<\n"));
  CHECK_FALSE(FactFinder{DialogWords{}}.nothing_to_send("1 file sent\n"));
  DialogWords words;
  words.nothing_to_send = {"", "empty folder"};
  CHECK(FactFinder{words}.nothing_to_send("an empty folder"));
  CHECK_FALSE(FactFinder{words}.nothing_to_send("not found>*<"));
}

TEST_CASE("keys that somebody typed are named") {
  const auto key = [](const char* line) { return std::get<std::string>(facts_of(line).at(0).value); };
  CHECK(key("   I heard a Control-R") == "Control-R");
  CHECK(key("I heard a character ('CR'), but not the right one") == "CR");
  CHECK(key("I heard a keystroke ('NUL'), but not the right one!") == "NUL");
  CHECK(facts_of("I heard a noise").empty());
}
