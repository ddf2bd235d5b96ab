#include "simulator/scenario_draft.hpp"
#include "simulator/scenario_keys.hpp"

namespace glidehelm::simulator {

using namespace keys;

Fields<ErrorDraft> ocean_error_fields() {
  using E = ErrorDraft;
  Fields<E> f;
  f.number({"shift_km", "everything lies this much elsewhere"}, &E::shift_km, 1, between(0, 500));
  f.number({"shift_toward_deg", "in this direction, clockwise from north"}, &E::shift_toward_deg, 1,
           between(-360, 360));
  f.number({"late_h", "everything happens this much later"}, &E::late_h, 1, between(-240, 240));
  f.number({"noise_m_per_s", "root mean square speed of added eddies"}, &E::noise_m_per_s, 1, between(0, 2));
  f.number({"longest_km", "longest wavelength of them"}, &E::longest_km, 1, between(1, 2000));
  f.number({"shortest_km", "shortest wavelength of them"}, &E::shortest_km, 1, between(0.5, 2000));
  f.number({"slope", "of their kinetic energy over wave number: E(k) ∝ k^slope"}, &E::slope, 1, between(-6, 2));
  f.number({"lasting_h", "e-folding time of the longest ones"}, &E::lasting_h, 1, between(1, 1e4));
  f.number({"fading_m", "their e-folding depth; 0: as strong at every depth"}, &E::fading_m, 1, between(0, 1e5));
  f.number({"tide_m_per_s", "added M2 current, major axis"}, &E::tide_m_per_s, 1, between(0, 3));
  f.number({"tide_toward_deg", "direction of its major axis"}, &E::tide_toward_deg, 1, between(-360, 360));
  f.number({"tide_ratio", "minor to major axis"}, &E::tide_ratio, 1, between(-1, 1));
  f.maybe_whole({"seed", "of the added currents", false, "the scenario's seed"}, &E::own_seed, between(0, 9e15));
  return f;
}

Fields<ForecastDraft> forecast_fields() {
  using F = ForecastDraft;
  Fields<F> f;
  f.text({"folder", "where they appear, made if absent"}, &F::folder);
  f.section({"area", "box of the files", true}, area_fields<F>());
  f.number({"step_deg", "grid spacing"}, &F::step_deg, 1, between(0.002, 5));
  f.number({"every_h", "from one reference time to the next, counted from midnight"}, &F::every_h, 1, between(1, 240));
  f.number({"delay_h", "from the reference time until the file is there"}, &F::delay_h, 1, between(0, 240));
  f.number({"hours", "length of each"}, &F::hours, 1, between(1, 8760));
  f.number({"time_step_h", "between two times of a file"}, &F::time_step_h, 1, above_zero(240));
  f.whole({"keep", "newest files that stay"}, &F::keep, between(1, 1000));
  f.number({"cycle_noise_m_per_s", "root mean square speed of the error that is each cycle's own"},
           &F::cycle_noise_m_per_s, 1, between(0, 2));
  Fields<ForecastGrid> grid;
  numbers(grid, {"depths_m", "depth levels, rising; none: the surface alone, without a depth axis"},
          &ForecastGrid::depths_m, 200, between(0, 11000));
  f.include(&F::grid, grid);
  return f;
}

Fields<FleetDraft> fleet_fields(const Fields<GliderDraft>& each) {
  using F = FleetDraft;
  Fields<F> f;
  f.whole({"count", "number of gliders", true}, &F::count, between(1, 999));
  f.text({"name", "beginning of their names: NAME01, NAME02, …"}, &F::name, config::kName);
  f.section({"area", "box in which starts and goals are drawn", true}, area_fields<F>());
  f.number({"leg_km", "from each start to its goal, in a drawn direction"}, &F::leg, 1000, between(5, 2000));
  f.number({"goal_radius_m", "distance that counts as arrived"}, &F::goal_radius, 1, between(50, 1e5));
  f.number({"spread_h", "time over which they start one after the other"}, &F::spread_h, 1, between(0, 240));
  f.text({"folder", "folder above their dockserver folders, which have their names"}, &F::folder);
  f.text({"connect", "HOST:PORT of the first one's line, the next ports are the others'"}, &F::connect);
  f.flag({"mixed_firmware", "every third one prints as an older G2, every tenth over a modem"}, &F::mixed_firmware);
  f.part({"each", "what all of them are"}, &F::each, each);
  return f;
}

}  // namespace glidehelm::simulator
