#include "protocol/dialog_facts.hpp"

#include <catch2/catch.hpp>

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

TEST_CASE("a sensor value that spans a join is not trusted when its head is long") {
  const std::string line = "   sensor:m_leakdetect_voltage_forward(volts)=2.51318181818182       16.104 secs ago";
  const auto value = line.find('=') + 1;
  CHECK(facts_of(line, value + 4).front().whole == false);
  CHECK(facts_of(line, value - 9).front().whole);  // the join is in the name
  const auto aligned = test::sensor_line("m_battery", "volts", 14.9021, 30.25);
  CHECK(facts_of(aligned, aligned.find('=') + 3).front().whole);  // the column proves that nothing is lost
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

TEST_CASE("keys that somebody typed are named") {
  const auto key = [](const char* line) { return std::get<std::string>(facts_of(line).at(0).value); };
  CHECK(key("   I heard a Control-R") == "Control-R");
  CHECK(key("I heard a character ('CR'), but not the right one") == "CR");
  CHECK(key("I heard a keystroke ('NUL'), but not the right one!") == "NUL");
  CHECK(facts_of("I heard a noise").empty());
}
