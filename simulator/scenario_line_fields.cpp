#include "simulator/scenario_draft.hpp"
#include "simulator/scenario_keys.hpp"

namespace glidehelm::simulator {

using namespace keys;

Fields<FaultPlan> fault_fields() {
  Fields<FaultPlan> f;
  f.number({"probability", "chance at each surfacing"}, &FaultPlan::probability, 1, between(0, 1));
  wholes(f, {"surfacings", "surfacings that it always strikes, counted from 1"}, &FaultPlan::surfacings, 10'000,
         between(1, 1e6));
  return f;
}

Fields<CallSetup> dialog_fields() {
  Fields<CallSetup> f;
  f.word(
      {"firmware", "generation whose dialog it prints: telephone modem of 2012, older G2, or G3"}, &CallSetup::firmware,
      std::vector<std::pair<std::string, Firmware>>{{"g1", Firmware::g1}, {"g2", Firmware::g2}, {"g3", Firmware::g3}});
  f.whole({"aborts", "aborts since reset that its dialog tells of"}, &CallSetup::aborts, between(0, 999));
  Fields<Telling> tells;
  const std::vector<std::string> sensors(kDialogSensors.begin(), kDialogSensors.end());
  list_of(
      tells, {"without", "sensors that its dialog does not print"}, &Telling::without, 100,
      Fields<Telling>::word_shape(sensors),
      [sensors](const At& at) -> std::optional<std::string> {
        const auto which = config::read_word(at, sensors);
        return which ? std::optional{sensors[*which]} : std::nullopt;
      },
      [](const std::string& name) { return name; });
  tells.number({"mag_var_error_deg", "by which the m_gps_mag_var that it prints is off"}, &Telling::variation_error,
               kDegree, between(-180, 180));
  tells.word({"water",
              "final: the current is complete when it calls; awaited: it prints the initial one and dives with the "
              "final one"},
             &Telling::water_awaited, no_or_yes("final", "awaited"));
  tells.flag({"waypoint_line", "at-surface blocks have a `Waypoint:` line"}, &Telling::waypoint_line);
  return f.include(&CallSetup::tells, tells);
}

Fields<GliderDraft> faults_fields() {
  using G = GliderDraft;
  using L = LineFaultPlan;
  const auto fault = fault_fields();
  Fields<G> faults;
  faults.part({"lost_calls", "no call at all"}, &G::lost_calls, fault);
  faults.part({"not_taken", "the dockserver's script does not run"}, &G::not_taken, fault);
  faults.part({"no_connection_block", "the first block of the dialog is lost"}, &G::no_connection_block, fault);
  faults.part({"redial", "the link drops after the at-surface block and the glider calls again"}, &G::redial, fault);
  Fields<L> line;
  line.part({"cut", "the link falls in mid-line and the glider does not call again"}, &L::cut, fault);
  line.part({"half_open", "as redial, but the older connection stays open and silent"}, &L::half_open, fault);
  line.part({"call_back", "`H 5`: it hangs up and calls again in five minutes with the same fix"}, &L::call_back,
            fault);
  line.part({"late_script", "the script runs 1 to 11 minutes late, or not before the dive"}, &L::late_script, fault);
  line.part({"transfer_cut",
             "the link falls in the transfer: part of the file is on the glider, all of it stays in to-glider; in 7 of "
             "10 the glider calls again"},
            &L::transfer_cut, fault);
  line.part({"science_files", "the script first fetches *.sbd and *.tbd: ZMODEM bytes in the dialog"},
            &L::science_files, fault);
  line.part({"wrong_keys", "somebody types keys that the glider does not know"}, &L::wrong_keys, fault);
  line.part({"chatter", "lines of device drivers between the others"}, &L::chatter, fault);
  line.part({"garbled", "bytes are changed and lost"}, &L::garbled, fault);
  line.part({"injected", "a block of the dockserver in the middle of a line"}, &L::injected, fault);
  line.part({"injected_lossily", "the same, and it eats up to 12 bytes of the line"}, &L::injected_lossily, fault);
  line.part({"duplicated", "what was printed comes twice"}, &L::duplicated, fault);
  line.part({"slow", "few bytes a second"}, &L::slow, fault);
  Fields<LineSetup> setup;
  setup.number({"slow_bytes_per_s", "of a slow line"}, &LineSetup::slow_bytes_per_s, 1, between(30, 1e6));
  setup.number({"garbled_per_kilobyte", "places where a garbled line changes or loses bytes"},
               &LineSetup::garbled_per_kilobyte, 1, between(0, 1000));
  line.include(&L::setup, setup);
  return faults.include(&G::line_faults, line);
}

}  // namespace glidehelm::simulator
