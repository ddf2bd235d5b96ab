#include "simulator/scenario_draft.hpp"

namespace glidehelm::simulator {
namespace {

using config::At;
using config::Effective;
using config::Fields;
using config::Range;
using config::Shape;

Range between(double low, double high) { return {low, high, false}; }

/// A fault of LineFaultPlan as a part of the glider's draft.
void line_fault(Fields<GliderDraft>& f, const char* name, const char* meaning, FaultPlan LineFaultPlan::*which) {
  const auto inner = fault_fields();
  f.custom(
      {name, meaning}, inner.shape(), "",
      [inner, which](const At& at, GliderDraft& g) {
        if (config::expect_map(at)) inner.read(at, g.line_faults.*which);
      },
      [inner, which, name](const GliderDraft& g, const std::string& path, Effective& out) {
        out.open(name);
        inner.print(g.line_faults.*which, path.empty() ? name : path + "." + name, out);
        out.close();
      });
}

void line_number(Fields<GliderDraft>& f, const char* name, const char* meaning, double LineSetup::*which, Range range) {
  f.custom(
      {name, meaning}, Fields<GliderDraft>::number_shape(range), config::yaml_number(LineSetup{}.*which),
      [which, range](const At& at, GliderDraft& g) {
        if (const auto v = config::read_number(at, range)) g.line_faults.setup.*which = *v;
      },
      [which, name](const GliderDraft& g, const std::string& path, Effective& out) {
        out.leaf(path, name, config::yaml_number(g.line_faults.setup.*which));
      });
}

}  // namespace

Fields<FaultPlan> fault_fields() {
  Fields<FaultPlan> f;
  f.number({"probability", "chance at each surfacing"}, &FaultPlan::probability, 1, between(0, 1));
  Shape numbers;
  numbers.kind = Shape::Kind::list;
  numbers.parts.push_back(Fields<FaultPlan>::whole_shape(between(1, 1e6)));
  f.custom(
      {"surfacings", "surfacings that it always strikes, counted from 1"}, numbers, "[]",
      [](const At& at, FaultPlan& plan) {
        if (!config::expect_list(at, 0, 10'000)) return;
        for (std::size_t i = 0; i < at.node.items.size(); ++i)
          if (const auto n = config::read_whole(at.item(i), between(1, 1e6)))
            plan.surfacings.push_back(static_cast<int>(*n));
      },
      [](const FaultPlan& plan, const std::string& path, Effective& out) {
        std::vector<std::string> texts;
        for (const int n : plan.surfacings) texts.push_back(std::to_string(n));
        out.leaf(path, "surfacings", config::yaml_list(texts));
      });
  return f;
}

Fields<CallSetup> dialog_fields() {
  Fields<CallSetup> f;
  f.word(
      {"firmware", "generation whose dialog it prints: telephone modem of 2012, older G2, or G3"}, &CallSetup::firmware,
      std::vector<std::pair<std::string, Firmware>>{{"g1", Firmware::g1}, {"g2", Firmware::g2}, {"g3", Firmware::g3}});
  f.whole({"aborts", "aborts since reset that its dialog tells of"}, &CallSetup::aborts, between(0, 999));
  return f;
}

Fields<GliderDraft> faults_fields() {
  using G = GliderDraft;
  using L = LineFaultPlan;
  Fields<G> faults;
  faults.part({"lost_calls", "no call at all"}, &G::lost_calls, fault_fields());
  faults.part({"not_taken", "the dockserver's script does not run"}, &G::not_taken, fault_fields());
  faults.part({"no_connection_block", "the first block of the dialog is lost"}, &G::no_connection_block,
              fault_fields());
  faults.part({"redial", "the link drops after the at-surface block and the glider calls again"}, &G::redial,
              fault_fields());
  line_fault(faults, "cut", "the link falls in mid-line and the glider does not call again", &L::cut);
  line_fault(faults, "half_open", "as redial, but the older connection stays open and silent", &L::half_open);
  line_fault(faults, "call_back", "`H 5`: it hangs up and calls again in five minutes with the same fix",
             &L::call_back);
  line_fault(faults, "late_script", "the script runs 1 to 11 minutes late, or not before the dive", &L::late_script);
  line_fault(faults, "transfer_cut",
             "the link falls in the transfer: part of the file is on the glider, all of it stays in to-glider; in 7 of "
             "10 the glider calls again",
             &L::transfer_cut);
  line_fault(faults, "science_files", "the script first fetches *.sbd and *.tbd: ZMODEM bytes in the dialog",
             &L::science_files);
  line_fault(faults, "wrong_keys", "somebody types keys that the glider does not know", &L::wrong_keys);
  line_fault(faults, "chatter", "lines of device drivers between the others", &L::chatter);
  line_fault(faults, "garbled", "bytes are changed and lost", &L::garbled);
  line_fault(faults, "injected", "a block of the dockserver in the middle of a line", &L::injected);
  line_fault(faults, "injected_lossily", "the same, and it eats up to 12 bytes of the line", &L::injected_lossily);
  line_fault(faults, "duplicated", "what was printed comes twice", &L::duplicated);
  line_fault(faults, "slow", "few bytes a second", &L::slow);
  line_number(faults, "slow_bytes_per_s", "of a slow line", &LineSetup::slow_bytes_per_s, between(30, 1e6));
  line_number(faults, "garbled_per_kilobyte", "places where a garbled line changes or loses bytes",
              &LineSetup::garbled_per_kilobyte, between(0, 1000));
  return faults;
}

}  // namespace glidehelm::simulator
