#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/expected.hpp"
#include "core/base/hash.hpp"
#include "core/chart/chart.hpp"
#include "core/model/dive_schedule.hpp"
#include "core/model/glider.hpp"
#include "core/model/surfacing.hpp"
#include "core/model/waypoint_list.hpp"
#include "core/ocean/corrected.hpp"

/// Judges bytes. Knows no planner: its own reader of goto lists, its own integrator of the glider's law.
namespace glidehelm::safety {

/// Limits a file must keep (product.md 7, trust.md 3). Defaults are the product's.
struct Rules {
  Metres coast_margin{2000};
  int max_waypoints{8};
  int slot{10};                            ///< NN of goto_lNN.ma
  std::optional<Metres> max_wpt_distance;  ///< abend limit of the glider's mission; the list keeps 0.9 of it
  double arrival_tolerance{0.02};          ///< re-flown against promised arrival, of the travel time
  double surfacing_tolerance{0.03};        ///< next surfacing against the promise, of the stint's length
  MetresPerSecond refused_speed{5.0};
  /// What the tail is flown with ("2 tail"): shares by which stints may be shorter or longer, the glider slower or faster.
  double tail_stint{0.05}, tail_slower{0.10}, tail_faster{0.05};
  friend bool operator==(const Rules&, const Rules&) = default;
};

/// What the planner says the list will do if no further file reaches the glider.
struct Promise {
  std::vector<model::Waypoint> points;  ///< as meant, before any text
  GeoPoint next_surfacing;              ///< end of the first stint
  std::optional<double>
      list_arrival_s;  ///< epoch second when the list alone enters the goal radius; none if it does not
  GeoPoint goal;
  Metres goal_radius;
  std::optional<Metres> radius;        ///< list_when_wpt_dist as meant; none: any that keeps the rules
  std::optional<model::AtEnd> at_end;  ///< likewise
  friend bool operator==(const Promise&, const Promise&) = default;
};

/// Everything the verdict depends on beside the ocean and the chart.
struct Dossier {
  std::string file_name;  ///< "goto_l10.ma"
  std::string file_bytes;
  std::string glider_expected;    ///< the configured name
  model::Surfacing at;            ///< the surfacing that the file answers
  std::string current_surfacing;  ///< key of the surfacing that is current now …
  std::string answers_surfacing;  ///< … and of the one the file was made for
  model::Glider glider;
  std::optional<Current> believed_current;  ///< ĉ for the first stint (correction 1): the measured DAC, true frame
  model::DiveSchedule schedule;
  std::optional<ocean::LocalCorrection> correction;  ///< of the currents that the list is flown in
  double fix_s{};                                    ///< epoch second of the fix
  double horizon_s{};                                ///< epoch second to which the list is re-flown at most
  Rules rules;
  Promise promise;
  double judged_s{}, deadline_s{};  ///< epoch seconds: when this is judged, and when it is too late
  friend bool operator==(const Dossier&, const Dossier&) = default;
};

/// One rule's outcome; a verdict holds one per rule, always all of them.
struct Margin {
  std::string rule;  ///< "1 waypoints", "2 land", …: stable identifiers, see rules.hpp
  bool holds{};
  double found{}, limit{};  ///< in `unit`; NaN when the rule has no number
  std::string unit;
  std::string message;  ///< what, where, what is allowed
  /// Two absent numbers are the same: a verdict equals its replay.
  friend bool operator==(const Margin& a, const Margin& b) {
    const auto same = [](double x, double y) { return x == y || (x != x && y != y); };
    return a.rule == b.rule && a.holds == b.holds && same(a.found, b.found) && same(a.limit, b.limit) &&
           a.unit == b.unit && a.message == b.message;
  }
};

struct Verdict {
  Sha256 of;  ///< hash of the bytes that were judged
  bool accepted{};
  std::vector<Margin> margins;
  std::string file_name;  ///< the name that was judged with them
  friend bool operator==(const Verdict&, const Verdict&) = default;
};

/// Judges the bytes of `dossier` in the given ocean (3-D where the field has depths) and chart. Never throws on input;
/// takes at most a few hundred milliseconds. Everything unknown is refused. `issued_s`: epoch second from which the
/// forecast behind `full` ages (ocean/freshness.hpp); none when it does not.
Verdict judge(const Dossier& dossier, ocean::FieldRef full, const chart::Chart& chart,
              std::optional<double> issued_s = std::nullopt);

/// Bytes that passed. Only `accept` makes one, only this can be emitted: the type is the proof.
class VerifiedFile {
 public:
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] const Verdict& verdict() const { return verdict_; }
  friend bool operator==(const VerifiedFile&, const VerifiedFile&) = default;

 private:
  friend Expected<VerifiedFile, Verdict> accept(std::string name, std::string bytes, const Verdict& verdict);
  VerifiedFile(std::string name, std::string bytes, Verdict verdict);
  std::string name_, bytes_;
  Verdict verdict_;
};

/// Hashes the bytes again and compares with the verdict: gives the proof, or the verdict with the margin that failed
/// ("4 hash": other bytes or another name; "4 verdict": refused, or not one margin for every rule, as `judge` writes
/// it). Tests that need a proof without an ocean take tests/support/verdict.hpp.
Expected<VerifiedFile, Verdict> accept(std::string name, std::string bytes, const Verdict& verdict);

}  // namespace glidehelm::safety
