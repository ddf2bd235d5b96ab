#include "simulator/scenario_draft.hpp"

namespace glidehelm::simulator {
namespace {

using config::At;
using config::Effective;
using config::Fields;
using config::Range;
using config::Shape;

Range between(double low, double high) { return {low, high, false}; }
Range above_zero(double high) { return {0, high, true}; }
constexpr double kPerMinute = 60, kPerHour = 3600, kDegree = kPi / 180;

Fields<PlaceDraft> place_fields() {
  Fields<PlaceDraft> f;
  f.latitude({"lat_deg", "latitude, north positive", true}, &PlaceDraft::lat_deg);
  f.longitude({"lon_deg", "longitude, east positive", true}, &PlaceDraft::lon_deg);
  return f;
}

Fields<GoalDraft> goal_fields() {
  Fields<GoalDraft> f;
  f.latitude({"lat_deg", "latitude, north positive", true}, &GoalDraft::lat_deg);
  f.longitude({"lon_deg", "longitude, east positive", true}, &GoalDraft::lon_deg);
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
  f.whole({"current_correction", "u_use_current_correction: 0 ignores currents, 1 uses the last measured"},
          &G::correction, between(0, 1));
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
  Shape minutes = Fields<G>::number_shape(between(5, 240));
  f.custom(
      {"surface_min", "from the last fix to the dive"}, minutes, "15",
      [](const At& at, G& g) {
        if (const auto v = config::read_number(at, between(5, 240))) g.times.surface = *v * kPerMinute;
      },
      [](const G& g, const std::string& path, Effective& out) {
        out.leaf(path, "surface_min", config::yaml_number(g.times.surface, kPerMinute));
      });
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
         &CallSetup::resume_at_once, std::vector<std::pair<std::string, bool>>{{"at_end", false}, {"at_once", true}});
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
  f.part({"start", "where it lies on the surface at the start", true}, &G::start, place_fields());
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
  f.part({"origin", "position of x = y = 0", true}, &A::origin_deg, place_fields());
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

template <class Member>
void strength(Fields<CoastalDraft>& f, const char* name, const char* meaning, Member member, double low, double high) {
  const CoastalSpec standard;
  f.custom(
      {name, meaning}, Fields<CoastalDraft>::number_shape(between(low, high)), config::yaml_number(standard.*member),
      [member, low, high](const At& at, CoastalDraft& d) {
        if (const auto v = config::read_number(at, between(low, high))) d.spec.*member = *v;
      },
      [member, name](const CoastalDraft& d, const std::string& path, Effective& out) {
        out.leaf(path, name, config::yaml_number(d.spec.*member));
      });
}

Fields<CoastalDraft> coastal_fields() {
  using C = CoastalDraft;
  Fields<C> area;
  area.maybe_number({"west_deg", "western edge", true}, &C::west_deg, 1, between(-180, 360));
  area.maybe_number({"east_deg", "eastern edge, greater than the western", true}, &C::east_deg, 1, between(-180, 540));
  area.maybe_number({"south_deg", "southern edge", true}, &C::south_deg, 1, between(-85, 85));
  area.maybe_number({"north_deg", "northern edge", true}, &C::north_deg, 1, between(-85, 85));
  Fields<C> f;
  f.section({"area", "box of the sea, at most 20° each way", true}, area);
  f.maybe_whole({"seed", "of this sea", false, "the scenario's seed"}, &C::seed, between(0, 9e15));
  f.word({"variant", "what the water does, or what the model says of it"}, &C::variant,
         std::vector<std::pair<std::string, Variant>>{{"truth", Variant::truth}, {"forecast", Variant::forecast}});
  f.part({"from", "start of the straight way that the jets follow (without it the first glider's)"}, &C::from,
         place_fields());
  f.part({"to", "end of that way (without it the first glider's goal)"}, &C::to, place_fields());
  strength(f, "jet_m_per_s", "against the straight way, on it", &CoastalSpec::jet, -3, 3);
  strength(f, "counter_jet_m_per_s", "along the straight way, beside it", &CoastalSpec::counter_jet, -3, 3);
  strength(f, "jet_width_km", "half width of both jets", &CoastalSpec::jet_width_km, 0.5, 200);
  strength(f, "jet_offset_km", "between the jets", &CoastalSpec::jet_offset_km, 0, 500);
  strength(f, "eddy_m_per_s", "strongest eddy", &CoastalSpec::eddy, 0, 3);
  strength(f, "tide_m_per_s", "M2, major axis", &CoastalSpec::tide, 0, 3);
  strength(f, "fading_m", "e-folding depth of jets and eddies; 0: as strong at every depth", &CoastalSpec::fading_m, 0,
           1e5);
  strength(f, "shift_km", "by which the truth's eddies are elsewhere", &CoastalSpec::shift_km, 0, 200);
  strength(f, "tide_lag_deg", "phase of the truth's tide ahead of the forecast's", &CoastalSpec::tide_lag_deg, -360,
           360);
  strength(f, "noise_m_per_s", "small eddies that only the truth has", &CoastalSpec::noise, 0, 1);
  return f;
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
           std::vector<std::pair<std::string, bool>>{{"free", false}, {"measured", true}});
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
