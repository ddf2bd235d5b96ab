#pragma once

#include <catch2/catch.hpp>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "protocol/dialog.hpp"
#include "protocol/replay.hpp"

/// The promise of slocum.md R7 as a property: a dialog that stops anywhere never says what the whole does not say.
namespace glidehelm::test {

/// What a surfacing is recognised by: the texts and the time of its fix.
using FixKey = std::tuple<std::string, std::string, std::string, std::int64_t>;

inline std::string fact_text(const protocol::SensorReading& s) {
  return "sensor " + s.name + " " + s.unit + " " + std::to_string(s.value) + " " + std::to_string(s.age_s);
}
inline std::string fact_text(const char* label, const protocol::Location& l) {
  return label + l.lat_text + l.lat_letter + l.lon_text + l.lon_letter + std::to_string(l.age_s);
}

/// Everything that a block says in numbers and names, one text per line of the dialog.
inline std::vector<std::string> facts_of(const protocol::SurfaceBlock& block) {
  std::vector<std::string> all{"vehicle " + block.vehicle};
  for (const auto& s : block.sensors) all.push_back(fact_text(s));
  const auto time = block.curr_time ? std::to_string(block.curr_time->time_since_epoch().count()) : "no time";
  if (block.curr_time) all.push_back("time " + time);
  if (block.gps) all.push_back(fact_text("gps ", *block.gps) + " at " + time);
  if (block.dead_reckoned) all.push_back(fact_text("dr ", *block.dead_reckoned));
  if (block.too_far) all.push_back(fact_text("far ", *block.too_far));
  if (block.invalid) all.push_back(fact_text("invalid ", *block.invalid));
  if (block.mission) all.push_back("mission " + block.mission->file + " " + block.mission->number);
  if (block.because) all.push_back("because " + block.because->text + " " + block.because->behavior);
  if (const auto& w = block.waypoint)
    all.push_back("waypoint " + w->lat_text + " " + w->lon_text + " " + std::to_string(w->range_m) + " " +
                  std::to_string(w->bearing_deg) + " " + std::to_string(w->age_min));
  if (block.until_diving_s) all.push_back("dives in " + std::to_string(*block.until_diving_s));
  if (block.aborts) all.push_back("aborts " + std::to_string(*block.aborts));
  return all;
}

/// What a dialog says as a whole, and the check of its cuts against it.
class CutDialog {
 public:
  struct Counts {
    std::size_t cuts{};   ///< tried
    std::size_t fixes{};  ///< surfacings accepted in them
    std::size_t early{};  ///< of these: the whole refuses the fix, because the prompt behind it came too late
    std::size_t empty{};  ///< cuts without a surfacing
    Counts& operator+=(const Counts& o) {
      cuts += o.cuts;
      fixes += o.fixes;
      early += o.early;
      empty += o.empty;
      return *this;
    }
  };

  explicit CutDialog(std::string bytes) : bytes_{std::move(bytes)} {
    protocol::DialogReader reader;
    auto events = reader.append(bytes_, Instant{});
    auto last = reader.end(Instant{});
    std::move(last.begin(), last.end(), std::back_inserter(events));
    for (const auto& event : events)
      if (const auto* read = std::get_if<protocol::BlockRead>(&event)) learn(read->block);
  }

  /// Cut behind `size` bytes, which come in chunks of `chunk`.
  Counts check(std::size_t size, std::size_t chunk) const {
    protocol::DialogReader reader;
    Counts counts{1, 0, 0, 0};
    const auto bytes = std::string_view{bytes_}.substr(0, size);
    for (std::size_t at = 0; at < size; at += chunk) judge(reader.append(bytes.substr(at, chunk), Instant{}), counts);
    judge(reader.end(Instant{}), counts);
    counts.empty = counts.fixes == 0 ? 1 : 0;
    return counts;
  }

  /// Cut behind every byte. The reader hears the bytes once; at each, a copy of it hears the end of the connection.
  Counts check_every_byte() const {
    protocol::DialogReader reader;
    Counts all, before;
    for (std::size_t at = 0; at < bytes_.size(); ++at) {
      judge(reader.append(std::string_view{bytes_}.substr(at, 1), Instant{}), before);
      auto copy = reader;
      Counts now{1, before.fixes, before.early, 0};
      judge(copy.end(Instant{}), now);
      now.empty = now.fixes == 0 ? 1 : 0;
      all += now;
    }
    return all;
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  static FixKey key_of(const model::Surfacing& s) {
    const auto taken = s.curr_time.time_since_epoch() - std::chrono::duration_cast<std::chrono::milliseconds>(
                                                            std::chrono::duration<double>(s.fix_age.count()));
    return {s.glider, s.lat_ddmm, s.lon_ddmm, std::chrono::duration_cast<std::chrono::milliseconds>(taken).count()};
  }

  void learn(const protocol::SurfaceBlock& block) {
    for (auto& fact : facts_of(block)) facts_.insert(std::move(fact));
    if (const auto fix = protocol::accept_fix(block, protocol::Limits{})) {
      used_.insert(key_of(*fix));
    } else if (fix.error().rule == "S8") {
      auto without_prompt = block;
      without_prompt.console = protocol::Console::unknown;
      if (const auto same = protocol::accept_fix(without_prompt, protocol::Limits{})) at_prompt_.insert(key_of(*same));
    }
  }

  void judge(const std::vector<protocol::DialogEvent>& events, Counts& counts) const {
    for (const auto& event : events) {
      const auto* read = std::get_if<protocol::BlockRead>(&event);
      if (read == nullptr) continue;
      // Most cuts give the block of the cut before: its answer is kept.
      if (last_.line == 0 || last_ != read->block) {
        last_ = read->block;
        last_counts_ = judge_block(last_);
      }
      counts += last_counts_;
    }
  }

  Counts judge_block(const protocol::SurfaceBlock& block) const {
    for (const auto& fact : facts_of(block))
      if (facts_.count(fact) == 0) FAIL_CHECK("only the cut dialog says: " << fact);
    const auto fix = protocol::accept_fix(block, protocol::Limits{});
    if (!fix) return {};
    if (used_.count(key_of(*fix)) > 0) return {0, 1, 0, 0};
    if (at_prompt_.count(key_of(*fix)) == 0) FAIL_CHECK("only the cut dialog has the fix " << fix->lat_ddmm);
    return {0, 1, 1, 0};
  }

  mutable protocol::SurfaceBlock last_;
  mutable Counts last_counts_;
  std::string bytes_;
  std::set<std::string> facts_;
  std::set<FixKey> used_, at_prompt_;
};

}  // namespace glidehelm::test
