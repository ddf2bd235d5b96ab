#include <catch2/catch.hpp>

#include "tests/support/pilot_desk.hpp"

using namespace glidehelm;
using namespace glidehelm::mission;
using test::PilotDesk;

namespace {

bool said(const PilotDesk& desk, std::string_view words) {
  for (const auto& effects : desk.effects)
    for (const auto& say : PilotDesk::all<Say>(effects))
      if (say.text.find(words) != std::string::npos) return true;
  return false;
}

std::optional<Level> level_of(const PilotDesk& desk, std::string_view words) {
  for (const auto& effects : desk.effects)
    for (const auto& say : PilotDesk::all<Say>(effects))
      if (say.text.find(words) != std::string::npos) return say.level;
  return std::nullopt;
}

const GeoPoint kAim = geo_point(28.7, -15.2);

/// A candidate whose list has one aim point and the goal.
Candidate with_list(const PilotDesk& desk, std::uint64_t request, std::uint64_t number, GeoPoint aim = kAim) {
  auto c = desk.candidate(request, number, "direct");
  c.list.points = {{aim, model::WaypointRole::aim}, {geo_point(29.1667, -15.5), model::WaypointRole::goal}};
  return c;
}

/// A surfacing up to the emission.
void emit(PilotDesk& desk, double lat, const std::string& segment, GeoPoint aim = kAim) {
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(lat, -15.3), segment), std::nullopt});
  const auto request = desk.last<BeginPlanning>().at(0).request;
  auto verify = PilotDesk::all<Verify>(desk.step(CandidateFound{with_list(desk, request.id, 1, aim)}));
  desk.step(PlanningEnded{request.id, ""});
  desk.step(Judged{request.id, 1, test::verdict_on("goto_l10.ma", verify.at(0).dossier.file_bytes), ""});
  REQUIRE(desk.last<Emit>().size() == 1);
  desk.step(EmissionEnded{EmissionEnded::Outcome::queued, desk.pilot.surfacing_key(), "goto_l10.ma is queued"});
}

void dive_and_come_up(PilotDesk& desk) {
  desk.wait(Seconds{300});
  desk.step(DiveBegan{});
  desk.wait(Seconds{4 * 3600.0});
}

/// The file that is still there, judged for the surfacing at hand; `failing` names a rule it breaks.
void judge_queued(PilotDesk& desk, const PlanningRequest& request, const std::string& failing = {}) {
  auto old = with_list(desk, request.id, 1);
  old.plan.method = "queued";
  old.file_bytes = request.queued.value().bytes;
  const auto verify = PilotDesk::all<Verify>(desk.step(CandidateFound{old}));
  REQUIRE(verify.size() == 1);
  CHECK(verify[0].dossier.answers_surfacing == desk.pilot.surfacing_key());
  desk.step(Judged{request.id, 1, test::verdict_on("goto_l10.ma", old.file_bytes, failing), ""});
}

}  // namespace

TEST_CASE("folder and dialog tell how a file goes to the glider, and only a Waypoint: line says that it flies it") {
  PilotDesk desk;
  emit(desk, 28.5, "0007.0003");
  CHECK(desk.pilot.file().state() == Delivery::queued);
  desk.step(TransferHeard{"goto_l10.ma", false});
  CHECK(said(desk, "the dockserver is sending goto_l10.ma to the glider"));
  desk.step(TransferHeard{"goto_l10.ma", true});
  CHECK(said(desk, "goto_l10.ma went to the glider"));
  desk.step(FolderSeen{FolderSeen::Found::nothing, ""});
  CHECK(desk.pilot.file().state() == Delivery::gone);
  desk.step(ListReread{});
  CHECK(desk.pilot.file().state() == Delivery::reread);
  CHECK_FALSE(said(desk, "the glider flies our list"));
  dive_and_come_up(desk);
  auto s = PilotDesk::at_surface(desk.heard(28.55, -15.3), "0007.0004");
  s.aim = model::AimLine{kAim, Metres{9000}, 20};
  desk.step(SurfacingHeard{s, std::nullopt});
  CHECK(desk.pilot.file().state() == Delivery::flying);
  CHECK(said(desk, "the glider flies our list: it steers to waypoint 1 of goto_l10.ma, 28.7000,-15.2000"));
}

TEST_CASE("a glider that still steers by an older list is told of") {
  PilotDesk desk;
  emit(desk, 28.5, "0007.0003");
  desk.step(FolderSeen{FolderSeen::Found::nothing, ""});
  dive_and_come_up(desk);
  emit(desk, 28.55, "0007.0004", geo_point(28.8, -15.3));
  desk.step(FolderSeen{FolderSeen::Found::nothing, ""});
  dive_and_come_up(desk);
  auto s = PilotDesk::at_surface(desk.heard(28.6, -15.3), "0007.0005");
  s.aim = model::AimLine{kAim, Metres{9000}, 20};
  desk.step(SurfacingHeard{s, std::nullopt});
  CHECK(said(desk, "still steers to 28.7000,-15.2000 of an older list of ours"));
  CHECK(desk.pilot.file().state() == Delivery::gone);
}

TEST_CASE("a file that is still queued at the next surfacing is judged again and exchanged for the better one") {
  PilotDesk desk;
  emit(desk, 28.5, "0007.0003");
  dive_and_come_up(desk);
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.55, -15.3), "0007.0004"), std::nullopt});
  const auto request = desk.last<BeginPlanning>().at(0).request;
  REQUIRE(request.queued);
  CHECK(request.queued->bytes == "bytes of 1 1");
  CHECK(said(desk, "still lies in to-glider: it missed its call and is judged again"));
  desk.step(FolderSeen{FolderSeen::Found::ours, "goto_l10.ma"});
  judge_queued(desk, request);
  const auto verify = PilotDesk::all<Verify>(desk.step(CandidateFound{with_list(desk, request.id, 2)}));
  desk.step(PlanningEnded{request.id, ""});
  desk.step(Judged{request.id, 2, test::verdict_on("goto_l10.ma", verify.at(0).dossier.file_bytes), ""});
  REQUIRE(desk.last<Emit>().size() == 1);
  CHECK(desk.last<Emit>()[0].file.bytes() == "bytes of 2 2");
  desk.step(EmissionEnded{EmissionEnded::Outcome::queued, desk.pilot.surfacing_key(), "goto_l10.ma is queued"});
  CHECK(said(desk, "was exchanged for this one"));
}

TEST_CASE("a queued file that is proven again stays when nothing new is") {
  PilotDesk desk;
  emit(desk, 28.5, "0007.0003");
  dive_and_come_up(desk);
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.55, -15.3), "0007.0004"), std::nullopt});
  const auto request = desk.last<BeginPlanning>().at(0).request;
  judge_queued(desk, request);
  desk.step(PlanningEnded{request.id, "no way was found"});
  CHECK(desk.last<Emit>().empty());
  CHECK(desk.pilot.stage() == Stage::queued);
  CHECK(said(desk, "stays in to-glider: it was judged again and is safe from here; no new one: no way was found"));
}

TEST_CASE("a queued file that is not safe any more and has no successor pages somebody to take it away") {
  PilotDesk desk;
  emit(desk, 28.5, "0007.0003");
  dive_and_come_up(desk);
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.55, -15.3), "0007.0004"), std::nullopt});
  const auto request = desk.last<BeginPlanning>().at(0).request;
  judge_queued(desk, request, "2 land");
  desk.step(PlanningEnded{request.id, "no way was found"});
  CHECK(desk.pilot.stage() == Stage::kept);
  CHECK(level_of(desk, "is not safe from here: take it away by hand") == Level::page);
}

TEST_CASE("a queued file that is taken while the plan is made is no choice any more") {
  PilotDesk desk;
  emit(desk, 28.5, "0007.0003");
  dive_and_come_up(desk);
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.55, -15.3), "0007.0004"), std::nullopt});
  const auto request = desk.last<BeginPlanning>().at(0).request;
  judge_queued(desk, request);
  desk.step(FolderSeen{FolderSeen::Found::nothing, ""});
  desk.step(PlanningEnded{request.id, "no way was found"});
  CHECK(desk.pilot.stage() == Stage::kept);
}

TEST_CASE("a file that is there again after it was gone is judged again at once") {
  PilotDesk desk;
  emit(desk, 28.5, "0007.0003");
  desk.step(FolderSeen{FolderSeen::Found::nothing, ""});
  dive_and_come_up(desk);
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.55, -15.3), "0007.0004"), std::nullopt});
  CHECK_FALSE(desk.last<BeginPlanning>().at(0).request.queued);
  desk.step(FolderSeen{FolderSeen::Found::ours, "goto_l10.ma"});
  REQUIRE(desk.last<BeginPlanning>().size() == 1);
  CHECK(desk.last<BeginPlanning>()[0].request.queued);
}

namespace {
int times_said(const PilotDesk& desk, std::string_view words) {
  int count = 0;
  for (const auto& effects : desk.effects)
    for (const auto& say : PilotDesk::all<Say>(effects)) count += say.text.find(words) != std::string::npos ? 1 : 0;
  return count;
}
}  // namespace

TEST_CASE("a failed transfer is said once, recorded, queued again and judged at the next surfacing") {
  PilotDesk desk;
  emit(desk, 28.5, "0007.0003");
  desk.step(TransferHeard{"GOTO_L10.MA", false});
  REQUIRE(desk.pilot.file().state() == Delivery::sending);
  desk.step(TransferFailed{"GOTO_L10.MA"});
  CHECK(desk.pilot.file().state() == Delivery::queued);
  CHECK(desk.last<InspectFolder>().size() == 1);
  REQUIRE(desk.last<Record>().size() == 1);
  CHECK(desk.last<Record>()[0].kind == "emission");
  CHECK(level_of(desk, "the transfer of goto_l10.ma failed: half of it may be on the glider") == Level::alert);
  desk.step(TransferFailed{"GOTO_L10.MA"});  // the dockserver says it too
  CHECK(times_said(desk, "the transfer of goto_l10.ma failed") == 1);
  desk.step(FolderSeen{FolderSeen::Found::ours, "goto_l10.ma"});
  CHECK(desk.pilot.file().state() == Delivery::queued);
  dive_and_come_up(desk);
  desk.step(SurfacingHeard{PilotDesk::at_surface(desk.heard(28.55, -15.3), "0007.0004"), std::nullopt});
  const auto request = desk.last<BeginPlanning>().at(0).request;
  REQUIRE(request.queued);
  CHECK(request.queued->bytes == "bytes of 1 1");
  judge_queued(desk, request);
  desk.step(PlanningEnded{request.id, "no way was found"});
  CHECK(desk.pilot.stage() == Stage::queued);
}

TEST_CASE("each transfer that fails is said, and a re-read of half a list raises an alert until one went well") {
  PilotDesk desk;
  emit(desk, 28.5, "0007.0003");
  for (int failure = 1; failure <= 2; ++failure) {
    desk.step(TransferHeard{"goto_l10.ma", false});
    desk.step(TransferFailed{"goto_l10.ma"});
    CHECK(times_said(desk, "the transfer of goto_l10.ma failed") == failure);
  }
  desk.step(ListReread{});
  CHECK(level_of(desk, "half a list may be in force") == Level::alert);
  desk.step(TransferHeard{"goto_l10.ma", false});
  desk.step(TransferHeard{"goto_l10.ma", true});
  desk.step(ListReread{});
  CHECK(times_said(desk, "half a list may be in force") == 1);
  CHECK(desk.pilot.file().state() == Delivery::reread);
}

TEST_CASE("a file that is gone after its transfer failed is not said to be picked up") {
  PilotDesk desk;
  emit(desk, 28.5, "0007.0003");
  desk.step(TransferHeard{"goto_l10.ma", false});
  desk.step(TransferFailed{"goto_l10.ma"});
  desk.step(FolderSeen{FolderSeen::Found::nothing, ""});
  CHECK(desk.pilot.file().state() == Delivery::unknown);
  CHECK(level_of(desk, "is gone from to-glider, and its transfer failed") == Level::note);
  CHECK_FALSE(said(desk, "picked up, most likely"));
}

TEST_CASE("transfers of other files, and of any file without a mission, are nobody's business") {
  PilotDesk desk;
  emit(desk, 28.5, "0007.0003");
  const auto before = desk.effects.size();
  for (const char* file : {"01710005.tcd", "goto_l11.ma", "yo10.ma", ""}) {
    desk.step(TransferHeard{file, false});
    desk.step(TransferFailed{file});
  }
  for (std::size_t i = before; i < desk.effects.size(); ++i) CHECK(desk.effects[i].empty());
  Pilot idle{"sim01"};
  CHECK(idle.step({desk.now, TransferFailed{"goto_l10.ma"}}).empty());
}
