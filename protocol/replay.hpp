#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/surfacing.hpp"
#include "protocol/accept_fix.hpp"
#include "protocol/dialog.hpp"

/// Recorded dialogs, read again. A log has no clock but the glider's, so each fix is taken as heard at its `Curr Time`,
/// read as UTC.
namespace glidehelm::protocol {

/// One distinct fix of a log, used or refused. Prints of the same fix (S4) are one entry: place, age and times are
/// those of the first print; mission and reason those of the first print that had them; the rest is the last that was
/// said.
struct ReplayedFix {
  int line{};  ///< of the `GPS Location:` line
  std::string glider, mission, segment;
  std::optional<Instant> fix_time, heard_time;  ///< none without a `Curr Time`; fix_time also without an age
  std::string lat_ddmm, lon_ddmm;               ///< as printed; empty when the line was damaged
  std::optional<double> lat_deg, lon_deg;       ///< none when they are no coordinate
  std::optional<double> fix_age_s;              ///< none when never updated
  std::optional<model::SurfaceReason> because;
  bool at_surface{};
  std::optional<double> until_diving_s;
  std::optional<model::AimLine> aim;
  std::optional<model::LocalVelocity> water;
  bool water_is_final{};
  std::map<std::string, double> sensors;
  std::string rule, reason;  ///< of the refusal; empty when the fix is used
  friend bool operator==(const ReplayedFix&, const ReplayedFix&) = default;
};

struct ReplayedLog {
  std::string glider;  ///< the first name heard; lower case
  DialogCounts counts;
  int distinct_fixes{};  ///< with a position, used or refused
  int repeated_fixes{};  ///< further complete prints of one of them
  std::vector<ReplayedFix> surfacings, refused;
  friend bool operator==(const ReplayedLog&, const ReplayedLog&) = default;
};

/// Replays logs one after the other, as one long watch: a fix that an earlier log of the same glider has shown is
/// unchanged and refused by S6.
class Replay {
 public:
  explicit Replay(Limits limits) : limits_{std::move(limits)} {}
  /// Reads one log in chunks of `chunk` bytes (0: whole); the result is the same for every chunk size. `name` is how
  /// refusals of later logs call it.
  ReplayedLog add(std::string_view bytes, const std::string& name, std::size_t chunk = 0);

 private:
  struct Shown {
    model::Surfacing fix;
    std::string name;
  };
  [[nodiscard]] ReplayedFix judge(SurfaceBlock block, const std::string& name, std::vector<Shown>& now) const;

  Limits limits_;
  std::vector<Shown> shown_;  ///< the used fixes of earlier logs
};

/// One log alone.
ReplayedLog replay_log(std::string_view bytes, const Limits& limits, std::size_t chunk = 0);

}  // namespace glidehelm::protocol
