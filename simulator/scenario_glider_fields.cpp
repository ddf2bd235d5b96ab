#include "simulator/scenario_draft.hpp"
#include "simulator/scenario_keys.hpp"

namespace glidehelm::simulator {

using namespace keys;

namespace {

Fields<Body> body_fields() {
  Fields<Body> f;
  f.number({"volume_l", "V_g, hull at the surface"}, &Body::volume_m3, 1e-3, between(10, 500));
  f.number({"wing_area_m2", "S, to which all coefficients refer"}, &Body::wing_area_m2, 1, above_zero(5));
  f.number({"aspect_ratio", "span² / area of the wings"}, &Body::aspect_ratio, 1, between(1, 30));
  f.number({"sweep_deg", "of the quarter-chord line"}, &Body::sweep, kDegree, between(0, 75));
  f.number({"span_efficiency", "e of the induced drag"}, &Body::span_efficiency, 1, between(0.3, 1));
  f.number({"hull_lift", "a_h, per radian"}, &Body::hull_lift, 1, between(0, 20));
  f.number({"parasite_drag", "C_D0"}, &Body::parasite_drag, 1, between(0.005, 2));
  f.number({"hull_induced_drag", "C_D1 of the hull, per radian²"}, &Body::hull_induced_drag, 1, between(0, 20));
  f.number({"compressibility_per_pa", "ε of the hull"}, &Body::compressibility_per_pa, 1, between(0, 1e-8));
  f.number({"pump_dive_cc", "ΔV of the buoyancy pump while diving"}, &Body::pump_dive_m3, kCubicCentimetre,
           between(-2000, 0));
  f.number({"pump_climb_cc", "ΔV of the buoyancy pump while climbing"}, &Body::pump_climb_m3, kCubicCentimetre,
           between(0, 2000));
  f.number({"pitch_dive_deg", "nose below the horizon"}, &Body::pitch_dive, kDegree, between(5, 80));
  f.number({"pitch_climb_deg", "nose above the horizon"}, &Body::pitch_climb, kDegree, between(5, 80));
  f.number({"ballast_density_kg_per_m3", "water in which it is neutral at the surface"}, &Body::ballast_density, 1,
           between(990, 1050));
  f.number({"surface_density_kg_per_m3", "of the water at the surface"}, &Body::surface_density, 1, between(990, 1050));
  f.number({"density_per_km", "kg/m³ by which water is denser a kilometre down"}, &Body::density_per_m, 1e-3,
           between(0, 100));
  return f;
}

Fields<SurfaceRules> surfacing_fields() {
  using R = SurfaceRules;
  Fields<R> f;
  f.maybe_whole(
      {"half_cycles", "the yo ends after so many (then stint_h does not count)", false, "stint_h ends a dive"},
      &R::half_cycles, between(1, 10'000));
  f.maybe_number({"every_h", "since the dive, start_when 9; the climb begins then", false, "never"}, &R::every_s,
                 kPerHour, above_zero(240));
  f.maybe_number({"no_comms_h", "since the last call that came through, start_when 12", false, "never"}, &R::no_comms_s,
                 kPerHour, above_zero(240));
  f.flag({"at_waypoint", "when a waypoint is hit, start_when 8"}, &R::at_waypoint);
  f.word({"heading_idle", "when a list with end_action 0 is through, start_when 3"}, &R::heading_idle,
         std::vector<std::pair<std::string, R::Idle>>{
             {"quit", R::Idle::quit}, {"resume", R::Idle::resume}, {"ignore", R::Idle::ignore}});
  return f;
}

Fields<AbortRules> abort_fields() {
  using A = AbortRules;
  Fields<A> f;
  f.maybe_number({"max_wpt_distance_m", "abend of the mission: reckoned distance to the waypoint", false, "off"},
                 &A::max_wpt_distance, 1, above_zero(1e7));
  f.maybe_number({"overdepth_m", "abort when deeper", false, "off"}, &A::overdepth, 1, above_zero(6000));
  f.whole({"fallback_calls", "calls from the surface in lastgasp.mi after an abort; 0: the run ends with it"},
          &A::fallback_calls, between(0, 1000));
  f.number({"fallback_every_min", "from the end of one such surface interval to the next"}, &A::fallback_every_s, 60,
           between(5, 1440));
  return f;
}

Fields<GpsSetup> gps_fields() {
  Fields<GpsSetup> f;
  f.number({"noise_m", "standard deviation of each component of a fix"}, &GpsSetup::noise, 1, between(0, 1000));
  f.number({"far_off_m", "how far away the fixes of the fault far_fixes are"}, &GpsSetup::far_off, 1,
           between(100, 5e6));
  return f;
}

Fields<EnergySpec> energy_fields() {
  using E = EnergySpec;
  Fields<E> f;
  f.number({"pump_volume_cc", "moved at an inflection"}, &E::pump_volume_m3, kCubicCentimetre, between(0, 4000));
  f.number({"pump_efficiency", "work against the pressure over energy drawn"}, &E::pump_efficiency, 1,
           between(0.05, 1));
  f.number({"dive_w", "everything that runs under water"}, &E::dive_w, 1, between(0, 200));
  f.number({"surface_w", "everything that runs on the surface"}, &E::surface_w, 1, between(0, 200));
  f.number({"call_w", "added during a call"}, &E::call_w, 1, between(0, 200));
  f.number({"battery_wh", "what the battery holds at the start; 0: not watched"}, &E::battery_wh, 1, between(0, 1e5));
  f.number({"volts_full", "printed when full"}, &E::volts_full, 1, between(1, 60));
  f.number({"volts_empty", "printed when empty"}, &E::volts_empty, 1, between(1, 60));
  return f;
}

}  // namespace

void add_vehicle_keys(Fields<GliderDraft>& f) {
  using D = FlightDraft;
  Fields<D> d;
  d.word({"motion", "point: the two keys above; force_balance: speed and angle of each leg from `body` (Thesis 2.2.3)"},
         &D::force_balance, no_or_yes("point", "force_balance"));
  d.part({"body", "what the force balance takes"}, &D::body, body_fields());
  d.number({"biofouling_percent_per_day", "of the speed that growth takes each day, from what is left"},
           &D::fouling_per_day, kPercent, between(0, 20));
  d.number({"target_altitude_m", "height above the floor at which a dive turns; negative: never"}, &D::target_altitude,
           1, between(-1, 500));
  d.number({"altimeter_range_m", "farther away the floor is not heard"}, &D::altimeter_range, 1, between(1, 500));
  d.word({"speed_estimate",
          "fixed: believed_speed; depth_rate: measured from depth rate and angle, m_avg_speed is the last dive's"},
         &D::speed_by_depth_rate, no_or_yes("fixed", "depth_rate"));
  d.number({"angle_error_deg", "by which the glider takes its path to be steeper (depth_rate)"}, &D::angle_error,
           kDegree, between(-20, 20));
  f.include(&GliderDraft::flight, d);
}

void add_behaviour_keys(Fields<GliderDraft>& f) {
  using D = FlightDraft;
  Fields<WindSetup> setup;
  setup.number({"speed_m_per_s", "mean"}, &WindSetup::speed, 1, between(0, 60));
  setup.number({"gusts_m_per_s", "standard deviation of each component"}, &WindSetup::gusts, 1, between(0, 30));
  setup.number({"lasting_h", "e-folding time of the gusts"}, &WindSetup::lasting_s, kPerHour, between(0.1, 1000));
  setup.number({"leeway_percent", "of the wind with which it drifts"}, &WindSetup::leeway, kPercent, between(0, 20));
  Fields<D> wind;
  wind.number({"from_deg", "where it comes from, clockwise from north"}, &D::wind_from, kDegree, between(0, 360));
  wind.include(&D::wind, setup);
  Fields<D> d;
  d.part({"surfacing", "surface behaviours of its mission"}, &D::surfacing, surfacing_fields());
  d.part({"aborts", "what ends the mission, and what follows"}, &D::aborts, abort_fields());
  d.part({"gps", "its receiver"}, &D::gps, gps_fields());
  d.section({"wind", "adds to the leeway while on the surface"}, wind);
  d.part({"energy", "a simple model of what it draws"}, &D::energy, energy_fields());
  f.include(&GliderDraft::flight, d);
}

void add_instrument_faults(Fields<GliderDraft>& f) {
  using D = FlightDraft;
  const auto fault = fault_fields();
  Fields<GpsSetup> gps;
  gps.part({"stale_fixes", "no fix at all: the older one is printed with its age"}, &GpsSetup::stale, fault);
  gps.part({"invalid_fixes", "the receiver flags the fix: GPS Invalid is new, GPS Location old"}, &GpsSetup::invalid,
           fault);
  gps.part({"far_fixes", "a fix that looks valid, gps.far_off_m away"}, &GpsSetup::far, fault);
  Fields<D> d;
  d.include(&D::gps, gps);
  d.part({"silent_altimeter", "the next dive does not hear the floor"}, &D::altimeter_silent, fault);
  f.include(&GliderDraft::flight, d);
}

Fields<SeabedDraft> seabed_fields() {
  using S = SeabedDraft;
  Fields<S> f;
  f.word({"kind",
          "none; truth: where the true ocean ends below (also under its grid's last level); plane: the keys below"},
         &S::kind,
         std::vector<std::pair<std::string, SeabedSpec::Kind>>{
             {"none", SeabedSpec::Kind::none}, {"truth", SeabedSpec::Kind::truth}, {"plane", SeabedSpec::Kind::plane}});
  f.number({"depth_m", "at the origin"}, &S::depth, 1, between(0, 11'000));
  f.number({"slope_percent", "metres deeper per hundred metres"}, &S::slope, kPercent, between(0, 100));
  f.number({"deepens_toward_deg", "in this direction"}, &S::deepens, kDegree, between(0, 360));
  f.number({"hump_m", "height of a bank at the origin"}, &S::hump_height, 1, between(0, 11'000));
  f.number({"hump_radius_m", "standard deviation of its Gaussian shape"}, &S::hump_radius, 1, between(10, 1e6));
  f.part({"origin", "of slope and bank (without it each glider's start)"}, &S::origin, place_fields<PlaceDraft>());
  return f;
}

void check_flight(const GliderDraft& g, const std::string& path, config::Reading& reading) {
  const auto& d = g.flight;
  const auto is_set = [&](const char* key) { return reading.places.count(path + "." + key) > 0; };
  if (d.force_balance) {
    if (const auto why = cannot_reach(d.body, g.dive_depth))
      reading.complain(path + ".vehicle.body", "no yo down to dive_depth_m", why->message(),
                       "a pump volume that outweighs stratification and compression");
    for (const char* key : {"vehicle.horizontal_speed_m_per_s", "vehicle.glide_angle_deg"})
      if (is_set(key))
        reading.complain(path + "." + key, "given beside motion: force_balance", {}, "left out: it follows from body");
    if (!g.believed_speed && !d.speed_by_depth_rate)
      reading.complain(path + ".vehicle.motion", "nothing that the glider believes of its speed", {},
                       "believed_speed_m_per_s, or speed_estimate: depth_rate");
  } else if (is_set("vehicle.body")) {
    reading.complain(path + ".vehicle.body", "not used by motion: point", {}, "motion: force_balance");
  }
  if (d.energy.volts_empty >= d.energy.volts_full)
    reading.complain(path + ".energy.volts_empty", "not below volts_full", {}, "less than volts_full");
}

void put_flight(const GliderDraft& g, GliderSetup& s) {
  const auto& d = g.flight;
  if (d.force_balance) {
    s.hull.body = d.body;
    // Until it has measured one, the glider takes its speed for that of the descent at half depth.
    const auto down = steady_flight(d.body, true, 0.5 * g.dive_depth);
    if (!g.believed_speed && down) s.belief.speed = down->horizontal;
  }
  s.hull.fouling_per_day = d.fouling_per_day;
  s.hull.target_altitude = d.target_altitude;
  s.hull.altimeter_range = d.altimeter_range;
  s.speed_by_depth_rate = d.speed_by_depth_rate;
  s.angle_error = d.angle_error;
  s.surfacing = d.surfacing;
  s.aborts = d.aborts;
  s.gps = d.gps;
  s.wind = d.wind;
  s.wind.from = Bearing{d.wind_from};
  s.energy = d.energy;
  s.altimeter_silent = d.altimeter_silent;
}

SeabedSpec seabed_of(const SeabedDraft& d, GeoPoint otherwise) {
  SeabedSpec s;
  s.kind = d.kind;
  s.depth = d.depth;
  s.origin = d.origin.lat_deg && d.origin.lon_deg
                 ? GeoPoint::from_degrees(*d.origin.lat_deg, *d.origin.lon_deg).value_or(otherwise)
                 : otherwise;
  s.slope = d.slope;
  s.deepens = Bearing{d.deepens};
  s.hump_height = d.hump_height;
  s.hump_radius = d.hump_radius;
  return s;
}

}  // namespace glidehelm::simulator
