#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/utc.hpp"
#include "core/mission/pilot.hpp"
#include "tests/support/verdict.hpp"

namespace glidehelm::test {

/// A pilot on a desk: the test plays dialog, planner, verifier and emitter, and sees every effect. Time stands until
/// the test moves it.
struct PilotDesk {
  mission::Pilot pilot{"sim01"};
  mission::Moment now{*utc_from_text("2026-11-25T10:00:00Z"), Tick{std::chrono::hours{5}}};
  std::vector<mission::Event> events;
  std::vector<mission::Effects> effects;

  explicit PilotDesk(mission::Mission m = mission_to_goal()) {
    step(mission::MissionChanged{{{std::move(m), "yaml", "sha-1"}}, false, "start"});
  }

  static mission::Mission mission_to_goal() {
    mission::Mission m;
    m.name = "leg-2";
    m.glider = "sim01";
    m.goal = geo_point(29.1667, -15.5);
    m.approval = mission::Approval::automatic;
    m.slocum_mission = "glide.mi";
    return m;
  }

  const mission::Effects& step(decltype(mission::Event::what) what) {
    events.push_back({now, std::move(what)});
    effects.push_back(pilot.step(events.back()));
    return effects.back();
  }

  void wait(Seconds dt) {
    now.utc = after(now.utc, dt);
    now.tick += std::chrono::duration_cast<Tick::duration>(dt);
  }

  /// A fix taken `age` seconds ago, as a connection block tells it.
  [[nodiscard]] model::Surfacing heard(double lat, double lon, double age_s = 60) const {
    model::Surfacing s;
    s.glider = "sim01";
    s.heard = now.utc;
    s.fix = geo_point(lat, lon);
    s.fix_age = Seconds{age_s};
    s.fix_taken = after(now.utc, Seconds{-age_s});
    s.curr_time = GliderTime{std::chrono::floor<std::chrono::seconds>(now.utc.time_since_epoch())};
    s.lat_ddmm = fmt::format("{:.3f}", lat * 100);
    s.lon_ddmm = fmt::format("{:.3f}", lon * 100);
    return s;
  }

  [[nodiscard]] static model::Surfacing at_surface(model::Surfacing s, std::string segment = "0007.0003",
                                                   std::string mi = "GLIDE.MI") {
    s.at_surface = true;
    s.segment = std::move(segment);
    s.mission = std::move(mi);
    s.until_diving = Seconds{235};
    return s;
  }

  template <class E>
  static std::vector<E> all(const mission::Effects& effects) {
    std::vector<E> found;
    for (const auto& effect : effects)
      if (const auto* e = std::get_if<E>(&effect)) found.push_back(*e);
    return found;
  }
  template <class E>
  [[nodiscard]] std::vector<E> last() const {
    return all<E>(effects.back());
  }

  [[nodiscard]] mission::Candidate candidate(std::uint64_t request, std::uint64_t number,
                                             const std::string& method) const {
    mission::Candidate c;
    c.request = request;
    c.number = number;
    c.plan.method = method;
    c.plan.status = planning::PlanStatus::reaches_goal;
    c.plan.arrival_s = epoch_seconds(now.utc) + 90'000;
    c.promise.next_surfacing = geo_point(28.6, -15.2);
    c.file_name = "goto_l10.ma";
    c.file_bytes = fmt::format("bytes of {} {}", request, number);
    return c;
  }

  /// Plays planner and verifier until the pilot emits or keeps; every file passes unless `failing` names a rule.
  void answer(const std::string& failing = {}) {
    const auto begun = last<mission::BeginPlanning>();
    if (begun.empty()) return;
    const auto id = begun.back().request.id;
    auto verify = all<mission::Verify>(step(mission::CandidateFound{candidate(id, 1, "direct")}));
    step(mission::PlanningEnded{id, ""});
    while (!verify.empty()) {
      const auto& v = verify.back();
      const auto verdict = verdict_on(v.dossier.file_name, v.dossier.file_bytes, failing);
      verify = all<mission::Verify>(step(mission::Judged{v.request, v.number, verdict, ""}));
    }
  }

  /// One whole surfacing: connection block, plan, verdict, at-surface block, emission, dive.
  void surface_and_dive(double lat, double lon, const std::string& segment) {
    const auto s = heard(lat, lon);
    step(mission::SurfacingHeard{s, std::nullopt});
    answer();
    wait(Seconds{15});
    auto again = at_surface(s, segment);
    again.heard = now.utc;
    again.fix_age = Seconds{75};
    again.curr_time += std::chrono::seconds{15};
    const auto emit = all<mission::Emit>(step(mission::SurfacingHeard{again, std::nullopt}));
    if (!emit.empty())
      step(mission::EmissionEnded{mission::EmissionEnded::Outcome::queued, emit[0].surfacing, "goto_l10.ma is queued"});
    wait(Seconds{200});
    step(mission::DiveBegan{});
  }
};

}  // namespace glidehelm::test
