#include "protocol/replay.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/text.hpp"
#include "core/base/utc.hpp"
#include "protocol/latlon.hpp"

namespace glidehelm::protocol {

namespace {

constexpr double kNeverUpdated = 1e8;

Instant as_utc(GliderTime t) { return Instant{std::chrono::milliseconds{t.time_since_epoch()}}; }

/// What a block says, whether its fix is used or not. A fix that no rule reads still has its texts.
ReplayedFix described(const SurfaceBlock& block, const Limits& limits) {
  ReplayedFix out;
  out.line = block.line;
  out.glider = block.vehicle;
  if (block.curr_time) out.heard_time = as_utc(*block.curr_time);
  if (block.gps) {
    out.lat_ddmm = block.gps->lat_text;
    out.lon_ddmm = block.gps->lon_text;
    if (const auto lat = degrees_from_ddmm(out.lat_ddmm, Axis::latitude))
      out.lat_deg = block.gps->lat_letter == 'S' ? -*lat : *lat;
    if (const auto lon = degrees_from_ddmm(out.lon_ddmm, Axis::longitude))
      out.lon_deg = block.gps->lon_letter == 'W' ? -*lon : *lon;
    if (std::abs(block.gps->age_s) < kNeverUpdated) out.fix_age_s = block.gps->age_s;
    if (out.heard_time && out.fix_age_s) out.fix_time = after(*out.heard_time, Seconds{-*out.fix_age_s});
  }
  const auto rest = facts_beside_fix(block, limits);
  out.mission = rest.mission;
  out.segment = rest.segment;
  out.because = rest.because;
  out.at_surface = rest.at_surface;
  if (rest.until_diving) out.until_diving_s = rest.until_diving->count();
  out.aim = rest.aim;
  out.water = rest.water;
  out.water_is_final = rest.water_is_final;
  out.sensors = rest.sensors;
  return out;
}

/// Another print of the same fix: what it adds.
void merge(ReplayedFix& fix, ReplayedFix&& again) {
  if (fix.mission.empty()) fix.mission = std::move(again.mission);
  if (fix.segment.empty()) fix.segment = std::move(again.segment);
  if (!fix.because) fix.because = std::move(again.because);
  fix.at_surface = fix.at_surface || again.at_surface;
  if (again.until_diving_s) fix.until_diving_s = again.until_diving_s;
  if (again.aim) fix.aim = again.aim;
  // A call-back begins without the word that the velocity is final; it is no less so.
  if (again.water && (again.water_is_final || !fix.water_is_final)) {
    fix.water = again.water;
    fix.water_is_final = again.water_is_final;
  }
  for (auto& [name, value] : again.sensors) fix.sensors[name] = value;
}

/// S4 for prints of which some were refused: the same texts, and times that differ by less than 2 s. A print without a
/// time is the used fix of the same texts, or the refusal of the same texts and reason; a line that was too damaged to
/// have texts is like no other.
bool is_same(const ReplayedFix& a, const ReplayedFix& b) {
  if (a.lat_ddmm.empty() || b.lat_ddmm.empty()) return a.line == b.line;
  if (a.lat_ddmm != b.lat_ddmm || a.lon_ddmm != b.lon_ddmm || a.glider != b.glider) return false;
  if (a.fix_time && b.fix_time) return std::abs(between(*a.fix_time, *b.fix_time).count()) < 2.0;
  return a.rule.empty() != b.rule.empty() || a.reason == b.reason;
}

bool has_position(const ReplayedFix& fix) { return fix.lat_deg && fix.lon_deg; }

ReplayedFix* find_same(std::vector<ReplayedFix>& fixes, const ReplayedFix& fix) {
  const auto found = std::find_if(fixes.begin(), fixes.end(), [&](const ReplayedFix& f) { return is_same(f, fix); });
  return found == fixes.end() ? nullptr : &*found;
}

/// The entries of one log, one per distinct fix.
class Tally {
 public:
  /// One block; `fix.rule` says whether it is used.
  void take(ReplayedFix fix) {
    // A block may be given twice, the second time with more in it: that is one print.
    if (has_position(fix) && fix.line != std::exchange(last_line_, fix.line)) ++prints_;
    auto* used = find_same(used_, fix);
    auto* refused = find_same(refused_, fix);
    if (used != nullptr) {
      if (fix.rule.empty()) merge(*used, std::move(fix));  // a refused print of a used fix adds nothing
    } else if (refused == nullptr) {
      (fix.rule.empty() ? used_ : refused_).push_back(std::move(fix));
    } else if (fix.rule.empty()) {
      refused_.erase(refused_.begin() + (refused - refused_.data()));
      used_.push_back(std::move(fix));
    } else {
      merge(*refused, std::move(fix));
    }
  }

  void finish(ReplayedLog& out) {
    for (const auto* list : {&used_, &refused_})
      out.distinct_fixes += static_cast<int>(std::count_if(list->begin(), list->end(), has_position));
    out.repeated_fixes = prints_ - out.distinct_fixes;
    out.surfacings = std::move(used_);
    out.refused = std::move(refused_);
  }

 private:
  std::vector<ReplayedFix> used_, refused_;
  int prints_{}, last_line_{};
};

}  // namespace

ReplayedFix Replay::judge(SurfaceBlock block, const std::string& name, std::vector<Shown>& now) const {
  if (block.curr_time) block.heard = as_utc(*block.curr_time);
  auto fix = described(block, limits_);
  const auto accepted = accept_fix(block, limits_);
  if (!accepted) {
    fix.rule = accepted.error().rule;
    fix.reason = accepted.error().reason;
    return fix;
  }
  const auto earlier = std::find_if(shown_.begin(), shown_.end(), [&](const Shown& s) {
    return s.fix.glider == accepted->glider && model::same_fix(s.fix, *accepted);
  });
  if (earlier == shown_.end()) {
    now.push_back({*accepted, name});
    return fix;
  }
  fix.rule = "S6";
  fix.reason =
      "unchanged since " + earlier->name + ": the glider has had no new fix since " + utc_text(earlier->fix.fix_taken);
  return fix;
}

ReplayedLog Replay::add(std::string_view bytes, const std::string& name, std::size_t chunk) {
  DialogReader reader;
  ReplayedLog out;
  Tally tally;
  std::vector<Shown> now;
  const auto take = [&](std::vector<DialogEvent> events) {
    for (auto& event : events) {
      if (auto* heard = std::get_if<NameHeard>(&event); heard != nullptr && out.glider.empty())
        out.glider = heard->name;
      if (auto* read = std::get_if<BlockRead>(&event)) tally.take(judge(std::move(read->block), name, now));
    }
  };
  const std::size_t step = chunk == 0 ? std::max<std::size_t>(bytes.size(), 1) : chunk;
  for (std::size_t at = 0; at < bytes.size(); at += step) take(reader.append(bytes.substr(at, step), Instant{}));
  take(reader.end(Instant{}));
  out.counts = reader.counts();
  tally.finish(out);
  shown_.insert(shown_.end(), std::make_move_iterator(now.begin()), std::make_move_iterator(now.end()));
  return out;
}

ReplayedLog replay_log(std::string_view bytes, const Limits& limits, std::size_t chunk) {
  return Replay{limits}.add(bytes, "", chunk);
}

}  // namespace glidehelm::protocol
