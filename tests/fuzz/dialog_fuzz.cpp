#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "protocol/replay.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

bool has(const std::vector<glidehelm::protocol::ReplayedFix>& fixes, const glidehelm::protocol::ReplayedFix& fix) {
  return std::any_of(fixes.begin(), fixes.end(), [&](const auto& f) {
    return f.lat_ddmm == fix.lat_ddmm && f.lon_ddmm == fix.lon_ddmm && f.fix_time && fix.fix_time &&
           std::abs(glidehelm::between(*f.fix_time, *fix.fix_time).count()) < 2.0;
  });
}

}  // namespace

/// Any bytes as a dialog: the same answer in pieces of a size that the input chooses, accepted fixes keep the promises
/// of accept_fix, idle flushes between the pieces lose no fix, and the dialog cut at a place that the input chooses has
/// no fix that the whole does not have.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glidehelm;
  using namespace glidehelm::protocol;
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  const std::size_t chunk = size == 0 ? 1 : 1 + data[size / 2] % 100U;
  const auto whole = replay_log(bytes, Limits{});
  require(replay_log(bytes, Limits{}, chunk) == whole);
  require(whole.distinct_fixes >= 0 && whole.repeated_fixes >= 0);
  for (const auto& fix : whole.surfacings) {
    require(fix.rule.empty() && fix.lat_deg && fix.lon_deg && fix.fix_time && fix.fix_age_s);
    require(*fix.fix_age_s <= 1200 && !fix.glider.empty());
  }
  for (const auto& fix : whole.refused) require(!fix.rule.empty() && !fix.reason.empty());

  const std::size_t cut = size == 0 ? 0 : size * data[size / 3] / 255U;
  for (const auto& fix : replay_log(bytes.substr(0, cut), Limits{}, chunk).surfacings)
    require(has(whole.surfacings, fix) || has(whole.refused, fix));  // refused: at a prompt that came behind the cut

  DialogReader reader;
  std::uint64_t blocks = 0;
  const auto count = [&](const std::vector<DialogEvent>& events) {
    for (const auto& event : events) blocks += std::holds_alternative<BlockRead>(event) ? 1U : 0U;
  };
  for (std::size_t at = 0; at < size; at += chunk) {
    count(reader.append(bytes.substr(at, chunk), Instant{}));
    count(reader.flush_idle(Instant{}));
  }
  count(reader.end(Instant{}));
  require(blocks >= whole.surfacings.size());
  require(reader.counts().gps_lines == whole.counts.gps_lines);
  return 0;
}
