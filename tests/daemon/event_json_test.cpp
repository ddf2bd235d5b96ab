#include "daemon/event_json.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "config/mission.hpp"
#include "tests/support/pilot_desk.hpp"

using namespace glidehelm;
using namespace glidehelm::mission;
using daemon::event_from_json;
using daemon::event_json;
using nlohmann::json;
using test::PilotDesk;

namespace {

constexpr const char* kYaml =
    "schema: glidehelm/mission/v1\nname: leg-2\nglider: sim01\ngoal: {lat_deg: 29.1667, lon_deg: -15.5}\n"
    "currents: {files: [/x/*.nc]}\n";

MissionText mission_text() {
  const auto nothing = [](const std::string& path) -> glidehelm::Expected<std::string, config::Unreadable> {
    return unexpected(config::Unreadable{path});
  };
  return {config::read_mission(kYaml, "m.yaml", nothing).value(), kYaml, "sha"};
}

/// A surfacing with every member set to something that is not its default.
model::Surfacing full_surfacing(const PilotDesk& desk) {
  auto s = PilotDesk::at_surface(desk.heard(28.123456789012345, -179.99999999999997));
  s.because = {"pitch not commanded", "surface_4", 2.0};
  s.water = model::LocalVelocity{MetresPerSecond{0.1}, MetresPerSecond{-1.0 / 3}};
  s.water_is_final = true;
  s.aim = model::AimLine{geo_point(28.7, -15.2), Metres{9000}, 20};
  s.believed_speed = MetresPerSecond{0.2815};
  s.current_correction = 1;
  s.magnetic_variation = Radians{0.082};
  s.sensors = {{"m_battery", 14.9021}, {"m_depth", -0.0}};
  return s;
}

Candidate full_candidate(const PilotDesk& desk) {
  auto c = desk.candidate(7, 2, "best");
  c.plan.arrival_s = std::numeric_limits<double>::infinity();
  c.plan.remaining = Metres{1.0 / 3};
  c.plan.reason = "\xc3\xa4\x01 \"quoted\"\n";
  c.plan.stints.resize(2);
  c.plan.stints[1].heading = Heading{Radians{1.25}};
  c.list.points = {{geo_point(28.7, -15.2), model::WaypointRole::aim},
                   {geo_point(29.1, -15.5), model::WaypointRole::goal}};
  c.forecast = "rtofs";
  return c;
}

/// One event of every kind.
std::vector<Event> one_of_each() {
  const PilotDesk desk;
  const model::Refusal refusal_of = [] {
    model::Refusal r;
    r.rule = "S3";
    r.reason = "minutes";
    r.glider = "sim01";
    r.lat_ddmm = "2860.000";
    return r;
  }();
  std::vector<decltype(Event::what)> whats{
      SurfacingHeard{full_surfacing(desk),
                     Metres{-12.5},
                     Current{MetresPerSecond{0.1}, MetresPerSecond{0.2}},
                     {{"bay", 0.25}, {"globe", 0.75}},
                     true},
      SurfacingHeard{desk.heard(-0.5, 0), std::nullopt, std::nullopt},
      FixRefused{refusal_of},
      WindowHeard{Seconds{235}},
      WindowExtended{Seconds{300}},
      DiveBegan{},
      TransferHeard{"goto_l10.ma", true},
      TransferFailed{"goto_l10.ma"},
      ListReread{},
      CandidateFound{full_candidate(desk)},
      PlanningEnded{7, "no way"},
      Judged{7, 2, test::verdict_on("goto_l10.ma", "bytes", "2 land"), ""},
      Judged{7, 2, std::nullopt, "it died"},
      EmissionEnded{EmissionEnded::Outcome::unknown, "sim01/t", "detail"},
      FolderSeen{FolderSeen::Found::foreign, "goto_l10.ma"},
      TimerFired{Timer::late_page, 12},
      MissionChanged{{mission_text()}, true, "uid 1000"},
      Restarted{EmissionEnded{EmissionEnded::Outcome::late, "sim01/t", ""}},
      Restarted{},
      ForecastWater{{{Metres{0.5}, 1.0 / 3, 35.25}, {Metres{100}, 10, 35}}, "temp \xc2\xb0 and salt"}};
  std::vector<Event> events;
  for (auto& what : whats) events.push_back({desk.now, std::move(what)});
  return events;
}

}  // namespace

TEST_CASE("every event comes back from its line of JSON as the same value, whatever its numbers and bytes") {
  std::vector<std::size_t> kinds(std::variant_size_v<decltype(Event::what)>);
  for (const auto& event : one_of_each()) {
    const auto text = event_json("sim01", event);
    CAPTURE(text);
    ++kinds[event.what.index()];
    CHECK(text.find('\n') == std::string::npos);
    const auto read = event_from_json(text);
    REQUIRE(read);
    CHECK(read->glider == "sim01");
    CHECK(read->event == event);
    CHECK(event_json("sim01", read->event) == text);
  }
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    CAPTURE(i);
    CHECK(kinds[i] > 0);  // none was forgotten above
  }
}

TEST_CASE("the names of events in the journal are what they were") {
  const std::vector<std::string> names{"surfacing_heard", "surfacing_heard", "fix_refused",    "window_heard",
                                       "window_extended", "dive_began",      "transfer_heard", "transfer_failed",
                                       "list_reread",     "candidate",       "planning_ended", "judged",
                                       "judged",          "emission_ended",  "folder_seen",    "timer_fired",
                                       "mission_changed", "restarted",       "restarted",      "forecast_water"};
  const auto events = one_of_each();
  REQUIRE(events.size() == names.size());
  for (std::size_t i = 0; i < events.size(); ++i)
    CHECK(json::parse(event_json("sim01", events[i])).at("event") == names[i]);
}

TEST_CASE("a surfacing of before sources had shares in it is one without") {
  const auto event = one_of_each().at(0);
  auto older = json::parse(event_json("sim01", event));
  REQUIRE(older.at("what").erase("shares") == 1);
  REQUIRE(older.at("what").erase("extrapolated") == 1);
  const auto read = event_from_json(older.dump());
  REQUIRE(read);
  auto wanted = event;
  std::get<SurfacingHeard>(wanted.what).shares.clear();
  std::get<SurfacingHeard>(wanted.what).extrapolated = false;
  CHECK(read->event == wanted);
}

TEST_CASE("a surfacing of before there was a forecast in it is one without") {
  const auto event = one_of_each().at(0);
  auto older = json::parse(event_json("sim01", event));
  REQUIRE(older.at("what").erase("forecast") == 1);
  const auto read = event_from_json(older.dump());
  REQUIRE(read);
  auto wanted = event;
  std::get<SurfacingHeard>(wanted.what).forecast.reset();
  CHECK(read->event == wanted);
}

TEST_CASE("a member that is missing, of another type or out of range is named, with the way to it") {
  const auto events = one_of_each();
  const auto broken = [&](std::size_t which, const char* pointer, const json& value) {
    auto j = json::parse(event_json("sim01", events.at(which)));
    j[json::json_pointer(pointer)] = value;
    const auto read = event_from_json(j.dump());
    return read ? std::string{"it was read"} : read.error();
  };
  CHECK(broken(0, "/what/surfacing/water_is_final", "yes").find("surfacing: water_is_final: ") == 0);
  CHECK(broken(0, "/what/surfacing/fix/lat_rad", 2.0) == "surfacing: fix: position out of range");
  CHECK(broken(13, "/what/outcome", 5) == "outcome: unknown choice");
  CHECK(broken(14, "/what/found", -1) == "found: unknown choice");
  CHECK(broken(15, "/what/timer", 99) == "timer: unknown choice");
  CHECK(broken(15, "/what/serial", 1.5) == "serial: not a whole number");
  CHECK(broken(16, "/what/chain/0/yaml", "schema: x").find("chain: mission of the journal") == 0);
  CHECK(broken(5, "/event", "whale_seen") == "unknown event whale_seen");
  auto j = json::parse(event_json("sim01", events.at(10)));
  j.at("what").erase("problem");
  CHECK(event_from_json(j.dump()).error() == "problem is missing");
}

TEST_CASE("what is no JSON, and a text cut anywhere, is an error and no crash") {
  const auto text = event_json("sim01", one_of_each().at(0));
  for (std::size_t n = 0; n < text.size(); ++n) {
    if (event_from_json(text.substr(0, n))) FAIL("read of " << n << " bytes");
  }
  for (const char* bad : {"", "[]", "null", "7", "{}", "{\"glider\":1}",
                          "{\"glider\":\"x\",\"now\":[],\"event\":\"judged\",\"what\":[]}"})
    CHECK_FALSE(event_from_json(bad));
}

TEST_CASE("effects are lines of JSON that tell them apart") {
  PilotDesk desk;
  desk.surface_and_dive(28.5, -15.3, "0007.0003");
  std::set<std::string> kinds;
  for (const auto& effects : desk.effects)
    for (const auto& effect : effects) {
      const auto j = json::parse(daemon::effect_json(effect));
      kinds.insert(j.at("effect").get<std::string>());
      if (const auto* emit = std::get_if<Emit>(&effect)) {
        CHECK(j.at("what").at("bytes") == emit->file.bytes());
        CHECK(j.at("what").at("sha256") == emit->file.verdict().of.hex());
      }
    }
  for (const char* kind : {"begin_planning", "verify", "emit", "inspect_folder", "set_timer", "say", "record"})
    CHECK(kinds.count(kind) == 1);
}
