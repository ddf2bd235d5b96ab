#include "daemon/cli/replay.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/base/utc.hpp"
#include "protocol/replay.hpp"

namespace glidehelm::cli {

namespace {

using Json = nlohmann::ordered_json;
using protocol::ReplayedFix;
using protocol::ReplayedLog;

/// A whole deployment of raw dialog is some tens of megabytes.
constexpr std::size_t kLargestLog = 1U << 30;

struct ReadLog {
  std::string file;
  ReplayedLog log;
};

Json time_or_null(const std::optional<Instant>& t) { return t ? Json(utc_text(*t, true)) : Json(nullptr); }
template <class T>
Json value_or_null(const std::optional<T>& v) {
  return v ? Json(*v) : Json(nullptr);
}
Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json fix_json(const std::string& file, const ReplayedFix& fix) {
  Json j{{"file", file},
         {"line", fix.line},
         {"glider", fix.glider},
         {"mission", text_or_null(fix.mission)},
         {"segment", text_or_null(fix.segment)},
         {"fix_time", time_or_null(fix.fix_time)},
         {"heard_time", time_or_null(fix.heard_time)},
         {"lat_ddmm", text_or_null(fix.lat_ddmm)},
         {"lon_ddmm", text_or_null(fix.lon_ddmm)},
         {"lat_deg", value_or_null(fix.lat_deg)},
         {"lon_deg", value_or_null(fix.lon_deg)},
         {"fix_age_s", value_or_null(fix.fix_age_s)},
         {"because", fix.because ? Json(fix.because->text) : Json(nullptr)},
         {"at_surface", fix.at_surface},
         {"time_until_diving_s", value_or_null(fix.until_diving_s)}};
  j["waypoint"] = nullptr;
  if (fix.aim)
    j["waypoint"] = {{"lat_deg", fix.aim->at.lat.degrees()},
                     {"lon_deg", fix.aim->at.lon.degrees()},
                     {"range_m", fix.aim->range.si()},
                     {"bearing_deg", fix.aim->bearing_deg}};
  j["water_vx_m_per_s"] = fix.water ? Json(fix.water->x.si()) : Json(nullptr);
  j["water_vy_m_per_s"] = fix.water ? Json(fix.water->y.si()) : Json(nullptr);
  j["water_is_final"] = fix.water_is_final;
  j["sensors"] = Json::object();
  for (const auto& [name, value] : fix.sensors) j["sensors"][name] = value;
  return j;
}

Json file_json(const ReadLog& read) {
  const auto& counts = read.log.counts;
  return {{"file", read.file},
          {"glider", text_or_null(read.log.glider)},
          {"connections", counts.connections},
          {"at_surface_blocks", counts.at_surface_blocks},
          {"gps_lines", counts.gps_lines},
          {"distinct_fixes", read.log.distinct_fixes},
          {"repeated_fixes", read.log.repeated_fixes},
          {"sensor_lines", counts.sensor_lines},
          {"damaged_lines", counts.damaged_lines},
          {"dockserver_blocks", counts.dockserver_blocks}};
}

void print_json(const std::vector<ReadLog>& logs, std::ostream& out) {
  Json j{{"files", Json::array()}, {"surfacings", Json::array()}, {"refused", Json::array()}};
  for (const auto& read : logs) {
    j["files"].push_back(file_json(read));
    for (const auto& fix : read.log.surfacings) j["surfacings"].push_back(fix_json(read.file, fix));
    for (const auto& fix : read.log.refused) {
      auto entry = fix_json(read.file, fix);
      entry["rule"] = fix.rule;
      entry["reason"] = fix.reason;
      j["refused"].push_back(std::move(entry));
    }
  }
  // File names come from the command line in any encoding; a byte that is not UTF-8 must not end the document.
  out << j.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

std::string count(std::uint64_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

void print_fix(const ReplayedFix& fix, std::ostream& out) {
  char age[32] = "no age";
  if (fix.fix_age_s) std::snprintf(age, sizeof age, "age %.0f s", *fix.fix_age_s);
  out << "  " << (fix.fix_time ? utc_text(*fix.fix_time) : std::string{"no time"}) << "  "
      << (fix.lat_ddmm.empty() ? "no position" : fix.lat_ddmm + " N " + fix.lon_ddmm + " E") << ", " << age << ", line "
      << fix.line;
  if (!fix.mission.empty()) out << ", " << fix.mission << " " << fix.segment;
  if (fix.because) out << ", " << fix.because->text;
  if (fix.until_diving_s) out << ", dives in " << static_cast<long>(*fix.until_diving_s) << " s";
  if (!fix.rule.empty()) out << "\n    refused by " << fix.rule << ": " << fix.reason;
  out << '\n';
}

void print_text(const std::vector<ReadLog>& logs, std::ostream& out) {
  for (const auto& [file, log] : logs) {
    out << file << ": " << (log.glider.empty() ? "no glider named" : log.glider) << ", "
        << count(log.counts.connections, "connection", "connections") << ", "
        << count(log.counts.at_surface_blocks, "at-surface block", "at-surface blocks") << ", "
        << count(log.counts.gps_lines, "GPS line", "GPS lines") << ", "
        << count(static_cast<std::uint64_t>(log.distinct_fixes), "fix", "fixes") << " (" << log.repeated_fixes
        << " repeated), " << count(log.counts.sensor_lines, "sensor line", "sensor lines") << ", "
        << log.counts.damaged_lines << " damaged, "
        << count(log.counts.dockserver_blocks, "dockserver block", "dockserver blocks") << '\n';
    for (const auto& fix : log.surfacings) print_fix(fix, out);
    for (const auto& fix : log.refused) print_fix(fix, out);
  }
}

}  // namespace

int run_replay(const ReplayOptions& options, world::Files& files, std::ostream& out, std::ostream& err) {
  if (options.logs.empty()) {
    err << "replay: name at least one log\n";
    return 2;
  }
  protocol::Limits limits;
  limits.glider = options.glider;
  protocol::Replay replay{limits};
  std::vector<ReadLog> logs;
  bool unreadable = false;
  for (const auto& file : options.logs) {
    const auto bytes = files.read(file, kLargestLog);
    if (!bytes) {
      err << file << ": cannot be read: " << bytes.error().message() << '\n';
      unreadable = true;
      continue;
    }
    logs.push_back({file, replay.add(*bytes, file)});
  }
  options.json ? print_json(logs, out) : print_text(logs, out);
  return unreadable ? 1 : 0;
}

}  // namespace glidehelm::cli
