#include "simulator/scenario_draft.hpp"
#include "simulator/scenario_keys.hpp"

namespace glidehelm::simulator {

using namespace keys;

namespace {

Fields<GoalDraft> goal_fields() {
  auto f = place_fields<GoalDraft>();
  f.number({"radius_m", "distance that counts as arrived"}, &GoalDraft::radius, 1, between(50, 1e5));
  return f;
}

Fields<CurrentDraft> current_fields(double most) {
  Fields<CurrentDraft> f;
  f.maybe_number({"east_m_per_s", "towards east", true}, &CurrentDraft::east, 1, between(-most, most));
  f.maybe_number({"north_m_per_s", "towards north", true}, &CurrentDraft::north, 1, between(-most, most));
  return f;
}

Fields<GliderDraft> vehicle_fields() {
  using G = GliderDraft;
  Fields<G> f;
  f.number({"horizontal_speed_m_per_s", "true speed through water"}, &G::speed, 1, above_zero(3));
  f.maybe_number({"believed_speed_m_per_s", "what the glider takes for its speed (m_avg_speed)", false, "the true one"},
                 &G::believed_speed, 1, above_zero(3));
  f.number({"glide_angle_deg", "of the path below the horizon"}, &G::glide_angle, kDegree, between(5, 60));
  f.number({"dive_depth_m", "lower turning depth"}, &G::dive_depth, 1, between(5, 6000));
  f.number({"climb_to_m", "upper turning depth of inner yos"}, &G::climb_to, 1, between(0, 6000));
  f.custom(
      {"current_correction", "u_use_current_correction: 0 ignores currents, 1 uses the last measured"},
      Fields<G>::whole_shape(between(0, 1)), std::to_string(G{}.correction),
      [](const At& at, G& g) {
        if (at.node.text == "2") return at.complain("not simulated: no source tells its algorithm", "2", "0 or 1");
        if (const auto v = config::read_whole(at, between(0, 1))) g.correction = static_cast<int>(*v);
      },
      [](const G& g, const std::string& path, Effective& out) {
        out.leaf(path, "current_correction", std::to_string(g.correction));
      });
  f.number({"heading_bias_deg", "true heading less wanted heading, clockwise"}, &G::heading_bias, kDegree,
           between(-90, 90));
  add_vehicle_keys(f);
  return f;
}

Fields<GliderDraft> schedule_fields() {
  using G = GliderDraft;
  Fields<G> f;
  f.number({"stint_h", "from dive to surfacing"}, &G::stint_s, kPerHour, above_zero(96));
  f.number({"stint_jitter_percent", "each stint is drawn within this of stint_h"}, &G::jitter, 0.01, between(0, 50));
  f.number({"cycle_s", "time between two looks at heading and waypoint"}, &G::cycle_s, 1, between(1, 300));
  // The interval of a pilot's schedule: from the fix that is printed to the dive.
  Fields<SurfaceTimes> times;
  times.number({"surface_min", "from the last fix to the dive"}, &SurfaceTimes::surface, kPerMinute, between(5, 240));
  f.include(&G::times, times);
  return f;
}

Fields<CallSetup> call_fields() {
  Fields<CallSetup> f;
  f.number({"after_fix_s", "from the last fix to the connection block"}, &CallSetup::call_after, 1, between(5, 600));
  f.number({"dockzr_after_s", "from the connection block to the script's `!dockzr *`"}, &CallSetup::dockzr_after, 1,
           between(16, 3600));
  f.number({"reprint_s", "between two at-surface blocks"}, &CallSetup::reprint_every, 1, between(10, 600));
  f.number({"bytes_per_s", "speed of a transfer to the glider"}, &CallSetup::bytes_per_s, 1, above_zero(1e6));
  f.word({"reread", "when the script presses Ctrl-F"}, &CallSetup::reread_always,
         std::vector<std::pair<std::string, bool>>{{"always", true}, {"after_transfer", false}});
  f.word({"resume", "when it presses Ctrl-R: at the end of the surface interval, or when it is through"},
         &CallSetup::resume_at_once, no_or_yes("at_end", "at_once"));
  return f;
}

/// What gliders of a list and of a fleet have alike.
void add_flight_keys(Fields<GliderDraft>& f) {
  using G = GliderDraft;
  Fields<G> frame;
  frame.maybe_number({"magnetic_variation_deg", "m_gps_mag_var, positive west", false, "0 without rotation_deg"},
                     &G::variation_deg, 1, between(-180, 180));
  frame.maybe_number(
      {"rotation_deg", "of the local frame's y axis, clockwise from true north", false, "from the variation"},
      &G::rotation_deg, 1, between(-180, 180));
  Fields<G> mission;
  mission.text({"file", "mission file it flies"}, &G::mission_file);
  mission.whole({"number", "MMMM of MMMM.SSSS"}, &G::mission_number, between(0, 9999));
  mission.whole({"slot", "NN of the goto_lNN.ma that it reads"}, &G::slot, between(0, 99));
  f.section({"vehicle", "the glider itself"}, vehicle_fields());
  f.section({"schedule", "dives and surface intervals"}, schedule_fields());
  f.section({"frame", "local frame: one of two keys"}, frame);
  f.part({"prior_water", "current measured before the start"}, &G::prior, current_fields(2.8));
  f.part({"leeway", "drift by wind while on the surface"}, &G::leeway, current_fields(1));
  add_behaviour_keys(f);
  f.section({"mission", "what it flies"}, mission);
  f.part({"call", "calls and the dockserver's script"}, &G::call, call_fields());
  f.number({"clock_skew_s", "its clock less UTC"}, &G::clock_skew_s, 1, between(-1e8, 1e8));
  f.part({"dialog", "what it prints"}, &G::call, dialog_fields());
  auto faults = faults_fields();
  add_instrument_faults(faults);
  f.section({"faults", "what goes wrong"}, faults);
}

Fields<GliderDraft> glider_fields() {
  using G = GliderDraft;
  Fields<LineDraft> line;
  line.text({"connect", "HOST:PORT of the daemon's `listen`"}, &LineDraft::connect);
  line.text({"listen", "ADDRESS:PORT that the daemon dials"}, &LineDraft::listen);
  Fields<G> f;
  f.text({"name", "name in its dialog", true}, &G::name, config::kName);
  f.part({"start", "where it lies on the surface at the start", true}, &G::start, place_fields<PlaceDraft>());
  f.part({"goal", "where it is meant to go", true}, &G::goal, goal_fields());
  f.text({"initial_list", "goto list on board at the start", false, "the goal alone"}, &G::initial_list);
  f.number({"initial_radius_m", "list_when_wpt_dist of a list that holds the goal alone"}, &G::initial_radius, 1,
           between(10, 1e5));
  f.text({"folder", "dockserver folder of this glider, made if absent", true}, &G::folder);
  f.part({"line", "where its dialog goes: `connect` or `listen`"}, &G::line, line);
  add_flight_keys(f);
  return f;
}

/// `params:` of an analytic field: numbers by name (true and false are 1 and 0), and `list` with rows for gaussians.
/// Which names a kind knows, the field itself says.
void read_params(const At& at, AnalyticDraft& draft) {
  if (!config::expect_map(at)) return;
  const Range any{-1e9, 1e9, false};
  for (const auto& member : at.node.members) {
    const At value{member.value, &at.node, at.path + "." + member.key, at.reading};
    if (member.key == "list") {
      if (!config::expect_list(value, 1, 1000)) continue;
      for (std::size_t i = 0; i < value.node.items.size(); ++i) {
        const auto row_at = value.item(i);
        if (!config::expect_list(row_at, 8, 8)) continue;
        std::vector<double> row;
        for (std::size_t j = 0; j < 8; ++j)
          if (const auto v = config::read_number(row_at.item(j), any)) row.push_back(*v);
        draft.gaussians.push_back(std::move(row));
      }
    } else if (member.value.text == "true" || member.value.text == "false") {
      if (const auto v = config::read_flag(value)) draft.params.emplace_back(member.key, *v ? 1.0 : 0.0);
    } else if (const auto v = config::read_number(value, any)) {
      draft.params.emplace_back(member.key, *v);
    }
  }
}

Fields<AnalyticDraft> analytic_fields() {
  using A = AnalyticDraft;
  Fields<A> f;
  f.text({"kind", "constant, source, sink, solid-body, shear, double-eddy, stuart, tiled, jet or gaussians", true},
         &A::kind);
  f.part({"origin", "position of x = y = 0", true}, &A::origin_deg, place_fields<PlaceDraft>());
  f.number({"length_scale_m", "metres to one unit of x and y"}, &A::length_scale, 1, above_zero(1e7));
  f.number({"speed_scale_m_per_s", "speed to one unit of (u, v)"}, &A::speed_scale, 1, above_zero(5));
  f.maybe_number({"time_scale_s", "seconds to one unit of time", false, "length by speed"}, &A::time_scale, 1,
                 above_zero(1e10));
  f.time({"t0", "when the field's time is 0", false, "the start"}, &A::t0);
  f.flag({"south", "signs of the southern hemisphere"}, &A::south);
  Shape map;
  map.kind = Shape::Kind::map;
  f.custom({"params", "parameters of the kind, as in a mission"}, map, "{}", read_params,
           [](const A&, const std::string& path, Effective& out) { out.leaf(path, "params", "{}"); });
  return f;
}

Fields<CoastalDraft> coastal_fields() {
  using C = CoastalDraft;
  Fields<C> f;
  f.section({"area", "box of the sea, at most 20° each way", true}, area_fields<C>());
  f.maybe_whole({"seed", "of this sea", false, "the scenario's seed"}, &C::seed, between(0, 9e15));
  f.word({"variant", "what the water does, or what the model says of it"}, &C::variant,
         std::vector<std::pair<std::string, Variant>>{{"truth", Variant::truth}, {"forecast", Variant::forecast}});
  f.part({"from", "start of the straight way that the jets follow (without it the first glider's)"}, &C::from,
         place_fields<PlaceDraft>());
  f.part({"to", "end of that way (without it the first glider's goal)"}, &C::to, place_fields<PlaceDraft>());
  Fields<CoastalSpec> sea;
  sea.number({"jet_m_per_s", "against the straight way, on it"}, &CoastalSpec::jet, 1, between(-3, 3));
  sea.number({"counter_jet_m_per_s", "along the straight way, beside it"}, &CoastalSpec::counter_jet, 1,
             between(-3, 3));
  sea.number({"jet_width_km", "half width of both jets"}, &CoastalSpec::jet_width_km, 1, between(0.5, 200));
  sea.number({"jet_offset_km", "between the jets"}, &CoastalSpec::jet_offset_km, 1, between(0, 500));
  sea.number({"eddy_m_per_s", "strongest eddy"}, &CoastalSpec::eddy, 1, between(0, 3));
  sea.number({"tide_m_per_s", "M2, major axis"}, &CoastalSpec::tide, 1, between(0, 3));
  sea.number({"fading_m", "e-folding depth of jets and eddies; 0: as strong at every depth"}, &CoastalSpec::fading_m, 1,
             between(0, 1e5));
  sea.number({"shift_km", "by which the truth's eddies are elsewhere"}, &CoastalSpec::shift_km, 1, between(0, 200));
  sea.number({"tide_lag_deg", "phase of the truth's tide ahead of the forecast's"}, &CoastalSpec::tide_lag_deg, 1,
             between(-360, 360));
  sea.number({"noise_m_per_s", "small eddies that only the truth has"}, &CoastalSpec::noise, 1, between(0, 1));
  return f.include(&C::spec, sea);
}

}  // namespace

const Fields<ScenarioDraft>& scenario_fields() {
  using S = ScenarioDraft;
  static const Fields<S> kFields = [] {
    Fields<TruthDraft> truth;
    truth.text({"grid", "grid file of glidehelm-ingest"}, &TruthDraft::grid);
    truth.list({"analytic", "analytic fields, added up"}, &TruthDraft::analytic, analytic_fields(), 0);
    truth.part({"coastal", "a made-up sea"}, &TruthDraft::coastal, coastal_fields());
    truth.flag({"still", "no current anywhere"}, &TruthDraft::still);
    truth.part({"error", "how the water differs from that: what a forecast does not know"}, &TruthDraft::error,
               ocean_error_fields());
    Fields<EndPlan> end;
    end.flag({"at_goal", "after the surface interval that follows the arrival"}, &EndPlan::at_goal);
    end.maybe_whole({"surfacings", "after so many", false, "never"}, &EndPlan::surfacings, between(1, 1e6));
    end.maybe_number({"days", "after so long", false, "never"}, &EndPlan::days, 1, above_zero(3650));
    Fields<S> f;
    f.constant({"schema", "what this file is", true}, kScenarioSchema);
    f.whole({"seed", "of everything that is drawn"}, &S::seed, between(0, 9e15));
    f.time({"start", "when the simulation begins, UTC", true}, &S::start);
    f.text({"coast", "coast file: what is land", false, "the truth's own land"}, &S::coast);
    f.text({"clock", "Unix socket on which the daemon is handed its time (`clock: {simulated: …}` there)", false,
            "needed unless --realtime"},
           &S::clock);
    f.word({"compute_time", "whether the daemon's computing takes simulated time"}, &S::charge_computing,
           no_or_yes("free", "measured"));
    f.number({"daemon_wait_s", "how long a missing daemon is waited for"}, &S::daemon_wait_s, 1, between(0, 3600));
    f.part({"truth", "what the water does: one of four keys, and its error", true}, &S::truth, truth);
    f.part({"forecasts", "files that reach a folder while the gliders fly"}, &S::forecasts, forecast_fields());
    f.part({"seabed", "the floor under the gliders"}, &S::seabed, seabed_fields());
    f.part({"end", "when a run is over"}, &S::end, end);
    f.list({"gliders", "the gliders, needed unless there is a fleet"}, &S::gliders, glider_fields(), 1);
    Fields<GliderDraft> each;
    add_flight_keys(each);
    f.part({"fleet", "many gliders in few lines"}, &S::fleet, fleet_fields(each));
    return f;
  }();
  return kFields;
}

}  // namespace glidehelm::simulator
