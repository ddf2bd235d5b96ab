#pragma once

#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "core/chart/coast.hpp"
#include "daemon/ingest_client.hpp"
#include "daemon/world/world.hpp"

namespace glidehelm::cli {

/// `glidehelm field animate FILE… --out NEW.html|NEW.kml [--coast FILE] [--depth M]`.
struct FieldAnimateOptions {
  std::vector<std::string> files;
  daemon::IngestOptions ingest;
  std::string out;                ///< a new file; what it becomes is told by its ending
  std::string coast;              ///< a .coast file to draw; empty: none
  std::optional<double> depth_m;  ///< the level nearest to this depth; none: the shallowest
};

/// What is drawn: one level of a field on a part of its nodes, and the shore.
struct Animation {
  std::string title, depth_text, decimation;  ///< a stranger's words: to be escaped
  std::vector<std::string> warnings;
  std::vector<double> times_s;  ///< empty: the same at every instant
  std::vector<double> lats_deg, lons_deg;
  std::vector<std::int16_t>
      mm_per_s;  ///< east, north, interleaved, [time][latitude][longitude]; kNoCurrent without a value
  std::vector<std::vector<std::pair<double, double>>>
      shores;  ///< longitude, latitude; lines that are not closed by themselves
  static constexpr std::int16_t kNoCurrent = -32768;
  [[nodiscard]] std::size_t frames() const { return times_s.empty() ? 1 : times_s.size(); }
};

/// The animation of a level. Its size is bounded: of more than 40 000 nodes every k-th row and column is kept (the first
/// kept; the smallest k that is enough), then of more than 1 500 000 nodes over all times every m-th time. What was left out
/// stands in `decimation`. Shores: corners nearer than a thousandth of the field's extent to the last one are left out, and
/// rings that lie wholly outside. Speeds are rounded to mm/s.
Animation animation_of(const ocean::GridView& view, std::size_t level, const chart::Coast* coast);

/// Writes a page or a map that plays.
///
/// `.html`: one file that needs no network and no other file: speed in colours, particles or arrows towards which the water
/// flows, a slider of times, play and pause (space, arrow keys), a legend in m/s, the shore, and the current under the cursor.
/// `.kml`: arrows in five colours of speed with a TimeSpan each, at most 20 by 20 at a time and 120 times, for Google Earth and its like.
/// Text from the files is escaped. Returns 0; 1 when files are refused or the file cannot be written (one that exists is
/// never replaced); 2 for misuse.
int run_field_animate(const FieldAnimateOptions& options, world::World& world, std::ostream& out, std::ostream& err);

}  // namespace glidehelm::cli
