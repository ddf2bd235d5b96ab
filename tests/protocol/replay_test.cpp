#include "protocol/replay.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>
#include <utility>

#include "core/base/utc.hpp"
#include "protocol/latlon.hpp"
#include "tests/protocol/cuts.hpp"
#include "tests/protocol/dialog_text.hpp"
#include "tests/support/data.hpp"

using namespace glidehelm;
using namespace glidehelm::protocol;

namespace {

std::string file_bytes(const std::string& path) {
  std::ifstream file{path, std::ios::binary};
  REQUIRE(file);
  return {std::istreambuf_iterator<char>{file}, {}};
}

constexpr std::size_t kChunks[] = {1, 7, 64, 0};

/// The replay, which every chunk size must give.
ReplayedLog replayed(const std::string& bytes) {
  const auto whole = replay_log(bytes, Limits{});
  for (const auto chunk : kChunks) REQUIRE(replay_log(bytes, Limits{}, chunk) == whole);
  return whole;
}

/// The dialogs of tests/replay, by name.
std::vector<std::filesystem::path> own_dialogs() {
  std::vector<std::filesystem::path> all;
  for (const auto& entry : std::filesystem::directory_iterator{GLIDEHELM_SOURCE "/tests/replay"})
    if (entry.path().extension() == ".dialog") all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

std::string dialog_bytes(const std::filesystem::path& path) {
  auto bytes = file_bytes(path.string());
  while (bytes.rfind("# ", 0) == 0) bytes.erase(0, bytes.find('\n') + 1);  // the header says what the dialog is
  return bytes;
}

std::string number(double value) {
  char text[48];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

void describe_fix(const ReplayedFix& fix, std::ostream& out) {
  out << (fix.rule.empty() ? "surfacing" : "refused " + fix.rule) << " line " << fix.line << " " << fix.glider << " ["
      << fix.lat_ddmm << " " << fix.lon_ddmm << "]";
  if (fix.lat_deg && fix.lon_deg) out << " = " << number(*fix.lat_deg) << " " << number(*fix.lon_deg);
  out << " taken " << (fix.fix_time ? utc_text(*fix.fix_time, true) : "?");
  if (fix.fix_age_s) out << " age " << number(*fix.fix_age_s);
  out << '\n';
  if (!fix.mission.empty()) out << "  mission " << fix.mission << " segment " << fix.segment << '\n';
  if (fix.because) out << "  because " << fix.because->text << " by " << fix.because->behavior << '\n';
  if (fix.until_diving_s) out << "  dives in " << *fix.until_diving_s << '\n';
  if (fix.aim)
    out << "  steers to " << number(fix.aim->at.lat.degrees()) << " " << number(fix.aim->at.lon.degrees()) << " at "
        << fix.aim->range.si() << " m\n";
  if (fix.water)
    out << "  water " << fix.water->x.si() << " " << fix.water->y.si() << (fix.water_is_final ? " final" : " initial")
        << '\n';
  out << "  " << (fix.at_surface ? "at the surface" : "connection only") << ", " << fix.sensors.size() << " sensors\n";
  if (!fix.rule.empty()) out << "  " << fix.reason << '\n';
}

/// What a dialog gives, as text that a person can review as a difference.
std::string describe(const ReplayedLog& log) {
  std::ostringstream out;
  const auto& c = log.counts;
  out << "glider " << log.glider << "\nconnections " << c.connections << "\nat-surface blocks " << c.at_surface_blocks
      << "\ngps lines " << c.gps_lines << "\nfixes " << log.distinct_fixes << " repeated " << log.repeated_fixes
      << "\nsensor lines " << c.sensor_lines << "\ndamaged lines " << c.damaged_lines << "\ndockserver blocks "
      << c.dockserver_blocks << "\nlong lines " << c.long_lines << "\ndiscarded bytes " << c.discarded_bytes << '\n';
  for (const auto* list : {&log.surfacings, &log.refused})
    for (const auto& fix : *list) describe_fix(fix, out);
  return out.str();
}

struct EventText {
  std::string operator()(const ConnectionOpened&) const { return "connection opened"; }
  std::string operator()(const NameHeard& e) const { return "name " + e.name; }
  std::string operator()(const BlockRead& e) const {
    return "block with the fix of line " + std::to_string(e.block.line) +
           (e.block.water == WaterState::complete  ? ", water final"
            : e.block.water == WaterState::waiting ? ", water waits for the final fix"
                                                   : "");
  }
  std::string operator()(const WindowHeard& e) const { return "dives in " + std::to_string(e.seconds); }
  std::string operator()(const WindowExtended& e) const { return "window longer by " + number(e.by.count()); }
  std::string operator()(const MissionResumed& e) const {
    return std::string{"resumed by "} + (e.by == MissionResumed::By::key    ? "key"
                                         : e.by == MissionResumed::By::time ? "time"
                                                                            : "the console going off");
  }
  std::string operator()(const MissionEnded& e) const { return "mission ended: " + e.cause; }
  std::string operator()(const AbortSeen& e) const { return "abort: " + e.cause; }
  std::string operator()(const PromptSeen& e) const {
    return std::string{"prompt "} + (e.console == Console::gliderlab ? "GliderLAB " : "GliderDos ") + e.state + " " +
           std::to_string(e.code);
  }
  std::string operator()(const DockserverBlock& e) const {
    return "dockserver: " + e.command + (e.complete ? "" : " (never ended)");
  }
  std::string operator()(const TransferStarted& e) const { return "transfer starts: " + e.file; }
  std::string operator()(const TransferDone& e) const { return "transfer done: " + e.file; }
  std::string operator()(const TransferFailed& e) const { return "transfer failed: " + e.file; }
  std::string operator()(const CommandEnded& e) const {
    return (e.succeeded ? "command succeeded: " : "command failed: ") + e.command;
  }
  std::string operator()(const NothingToSend& e) const { return "nothing to send: " + e.command; }
  std::string operator()(const MafilesReread&) const { return "mafiles re-read"; }
  std::string operator()(const KeyHeard& e) const { return "key " + e.key; }
};

/// What the reader says while it hears the dialog, in its order.
std::string describe_events(const std::string& bytes) {
  DialogReader reader;
  std::string out = "events\n";
  for (const auto& events : {reader.append(bytes, Instant{}), reader.end(Instant{})})
    for (const auto& event : events) out += "  " + std::visit(EventText{}, event) + "\n";
  return out;
}

}  // namespace

TEST_CASE("the dialogs of tests/replay give what their .expected files say") {
  // GLIDEHELM_WRITE_EXPECTED=1 writes the files anew, to be reviewed as a difference.
  const bool write = std::getenv("GLIDEHELM_WRITE_EXPECTED") != nullptr;
  for (const auto& path : own_dialogs()) {
    auto expected = path;
    expected.replace_extension(".expected");
    const auto found = describe(replayed(dialog_bytes(path))) + describe_events(dialog_bytes(path));
    if (write) std::ofstream{expected, std::ios::binary} << found;
    INFO(path.filename().string());
    CHECK(found == file_bytes(expected.string()));
  }
  CHECK(own_dialogs().size() == 13);
}

TEST_CASE("a dialog of ours that is cut behind any byte never says what the whole does not say") {
  for (const auto& path : own_dialogs()) {
    INFO(path.filename().string());
    const test::CutDialog dialog{dialog_bytes(path)};
    const auto counts = dialog.check_every_byte();
    CHECK(counts.cuts == dialog.bytes().size());
    // The copies of the reader hear what a reader of its own hears, in chunks of every size.
    for (std::size_t chunk = 1; chunk <= 69; ++chunk) dialog.check(dialog.bytes().size() * chunk / 69, chunk);
  }
}

TEST_CASE("dialogs of ours are the same in chunks of 1 to 69 bytes") {
  for (const auto& path : own_dialogs()) {
    const auto bytes = dialog_bytes(path);
    const auto whole = replay_log(bytes, Limits{});
    INFO(path.filename().string());
    for (std::size_t chunk = 1; chunk <= 69; ++chunk) CHECK(replay_log(bytes, Limits{}, chunk) == whole);
  }
}

TEST_CASE("prints of one fix are one entry that keeps the first place and the last news") {
  auto later = test::at_surface_block("alba", 100);
  later.replace(later.find("(2910.5000,-1530.0000)"), 22, "(2908.7500,-1531.2500)");
  later.replace(later.find("0112.0003"), 9, "0112.0004");
  const auto log = replayed(test::connection_block() + test::at_surface_block() + later);
  REQUIRE(log.surfacings.size() == 1);
  const auto& fix = log.surfacings.front();
  CHECK(log.distinct_fixes == 1);
  CHECK(log.repeated_fixes == 2);
  CHECK(fix.line == 7);
  CHECK(fix.fix_age_s == 48.25);
  CHECK(fix.fix_time == utc_from_text("2026-05-03T04:09:31.75Z"));
  CHECK(fix.heard_time == utc_from_text("2026-05-03T04:10:20Z"));
  CHECK(fix.segment == "0112.0003");
  CHECK(fix.until_diving_s == 100);
  CHECK(std::abs(fix.aim->at.lat.degrees() - (29 + 8.75 / 60)) < 1e-12);
  CHECK(fix.at_surface);
  CHECK(fix.sensors.size() == 3);
}

TEST_CASE("a call-back that has not yet said so leaves a final water velocity final") {
  auto call_back = test::connection_block();
  call_back.insert(call_back.find("  9000    No login"), test::sensor_line("m_water_vx", "m/s", -0.05, 300.0) +
                                                             test::sensor_line("m_water_vy", "m/s", 0.2, 300.0));
  const auto log = replayed(test::connection_block() + test::at_surface_block() + call_back);
  REQUIRE(log.surfacings.size() == 1);
  CHECK(log.surfacings.front().water_is_final);
  CHECK(log.surfacings.front().water->x.si() == -0.0415);
  const auto initial = replayed(call_back);
  REQUIRE(initial.surfacings.size() == 1);
  CHECK_FALSE(initial.surfacings.front().water_is_final);
  CHECK(replayed(call_back + test::at_surface_block()).surfacings.front().water_is_final);
}

TEST_CASE("S6: a fix that an earlier log of the same glider has shown is refused") {
  Replay watch{Limits{}};
  const auto text = test::connection_block();
  CHECK(watch.add(text, "one.log").surfacings.size() == 1);
  const auto second = watch.add(text, "two.log");
  CHECK(second.surfacings.empty());
  REQUIRE(second.refused.size() == 1);
  CHECK(second.refused.front().rule == "S6");
  CHECK(second.refused.front().reason ==
        "unchanged since one.log: the glider has had no new fix since 2026-05-03T04:09:31Z");
  CHECK(second.distinct_fixes == 1);
  CHECK(watch.add(test::connection_block("brisa"), "three.log").surfacings.size() == 1);
}

TEST_CASE("a log of another glider gives refusals") {
  Limits limits;
  limits.glider = "brisa";
  const auto log = replay_log(test::connection_block(), limits);
  CHECK(log.surfacings.empty());
  REQUIRE(log.refused.size() == 1);
  CHECK(log.refused.front().rule == "S2");
  CHECK(log.glider == "alba");
}

TEST_CASE("a print that no rule takes gives way to a later one that is taken") {
  auto damaged = test::connection_block();
  damaged.replace(damaged.find("Sun"), 3, "Mon");
  const auto log = replayed(damaged + test::at_surface_block());
  CHECK(log.refused.empty());
  REQUIRE(log.surfacings.size() == 1);
  CHECK(log.surfacings.front().fix_time);
  CHECK(log.repeated_fixes == 1);
}

namespace {

/// One row of expected.csv, which an independent script computed.
using Row = std::map<std::string, std::string>;

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> all(1);
  for (const char c : line) {
    if (c == ',')
      all.emplace_back();
    else if (c != '\r')
      all.back() += c;
  }
  return all;
}

std::vector<Row> rows(const std::string& path) {
  std::istringstream in{file_bytes(path)};
  std::string line;
  std::getline(in, line);
  const auto names = cells(line);
  std::vector<Row> all;
  while (std::getline(in, line)) {
    const auto values = cells(line);
    REQUIRE(values.size() == names.size());
    Row row;
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = values[i];
    all.push_back(row);
  }
  return all;
}

/// Every fix of a log, used or refused.
std::vector<ReplayedFix> all_fixes(const ReplayedLog& log) {
  auto all = log.surfacings;
  all.insert(all.end(), log.refused.begin(), log.refused.end());
  return all;
}

std::vector<ReplayedFix> with_position(const ReplayedLog& log) {
  auto all = all_fixes(log);
  std::erase_if(all, [](const ReplayedFix& f) { return !f.lat_deg; });
  return all;
}

std::vector<SurfaceBlock> blocks_of(const std::string& bytes) {
  DialogReader reader;
  auto events = reader.append(bytes, Instant{});
  for (auto& event : reader.end(Instant{})) events.push_back(std::move(event));
  std::vector<SurfaceBlock> blocks;
  for (auto& event : events)
    if (auto* read = std::get_if<BlockRead>(&event)) blocks.push_back(std::move(read->block));
  return blocks;
}

std::string cell(const std::optional<double>& value) {
  if (!value) return {};
  char text[48];
  std::snprintf(text, sizeof text, "%.15g", *value);
  return text;
}

/// `2026-05-03T04:09:31 2901.250 -1528.400 29.020833 -15.473333`: time, texts, degrees. The script truncates the time to
/// the second; six decimals of a degree are 0.6e-4 minute, so that equal texts mean the 1e-4 minute that are asked for.
std::string fix_cell(const ReplayedFix& fix) {
  char text[96];
  std::snprintf(text, sizeof text, " %s %s %.6f %.6f", fix.lat_ddmm.c_str(), fix.lon_ddmm.c_str(), *fix.lat_deg,
                *fix.lon_deg);
  return fix.fix_time ? utc_text(*fix.fix_time).substr(0, 19) + text : "no time" + std::string{text};
}

std::string waypoint_cell(const std::optional<WaypointLine>& line) {
  if (!line) return {};
  char text[128];
  const int age = static_cast<int>(line->age_min);
  std::snprintf(text, sizeof text, "%s %s %.0f %.0f %d:%d", line->lat_text.c_str(), line->lon_text.c_str(),
                line->range_m, line->bearing_deg, age / 60, age % 60);
  return text;
}

/// A set of texts as the script writes it.
std::string listed(std::vector<std::string> all) {
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::string out;
  for (const auto& text : all) out += (out.empty() ? "" : ";") + text;
  return out;
}

/// What this reader makes of a log, in the columns of expected.csv.
Row our_row(const std::string& bytes) {
  const auto log = replayed(bytes);
  const auto fixes = with_position(log);
  REQUIRE(static_cast<int>(fixes.size()) == log.distinct_fixes);
  Row row{{"vehicle", log.glider},
          {"console_ready", std::to_string(log.counts.connections)},
          {"at_surface", std::to_string(log.counts.at_surface_blocks)},
          {"gps_location_lines", std::to_string(log.counts.gps_lines)},
          {"distinct_fixes", std::to_string(log.distinct_fixes)},
          {"repeated_fixes", std::to_string(log.repeated_fixes)},
          {"sensor_lines", std::to_string(log.counts.sensor_lines)},
          {"dockserver_blocks", std::to_string(log.counts.dockserver_blocks)},
          {"first_fix", fixes.empty() ? "" : fix_cell(fixes.front())},
          {"last_fix", fixes.empty() ? "" : fix_cell(fixes.back())}};
  std::vector<std::string> because, mission;
  std::optional<WaypointLine> waypoint;
  std::optional<double> vx, vy;
  int sentinels = 0, last_line = 0;
  for (const auto& block : blocks_of(bytes)) {
    if (block.because)
      because.push_back(block.because->text + "|" + block.because->behavior + "|" + [&] {
        char text[32];
        std::snprintf(text, sizeof text, "%.1f", block.because->start_when);
        return std::string{text};
      }());
    if (block.mission)
      mission.push_back(block.mission->file + " " + block.mission->number + " (" + block.mission->segment + ")");
    if (block.waypoint) waypoint = block.waypoint;
    const auto* x = block.sensor("m_water_vx");
    const auto* y = block.sensor("m_water_vy");
    if (x != nullptr && x->age_s < 1e8) vx = x->value;
    if (y != nullptr && y->age_s < 1e8) vy = y->value;
    if (block.gps && block.line != std::exchange(last_line, block.line) && block.gps->lat_text == "69696969.000")
      ++sentinels;
  }
  row["because"] = listed(because);
  row["mission"] = listed(mission);
  row["waypoint_last"] = waypoint_cell(waypoint);
  row["m_water_vx_last"] = cell(vx);
  row["m_water_vy_last"] = cell(vy);
  row["gps_sentinel"] = std::to_string(sentinels);
  return row;
}

struct Disagreement {
  std::string ours, theirs, who;
};

/// Where the script of expected.csv and this reader differ, by log and column; each was looked at byte by byte. The
/// table of docs/dialogs.md says the same.
const std::map<std::pair<std::string, std::string>, Disagreement>& disagreements() {
  static const std::string never =
      "we are: the line says 0 with the age 1e+308, a value that was never measured (slocum.md 1.2)";
  static const std::map<std::pair<std::string, std::string>, Disagreement> all{
      {{"calanus_zoc_where_excerpt.log", "m_water_vx_last"}, {"", "0", never}},
      {{"calanus_zoc_where_excerpt.log", "m_water_vy_last"}, {"", "0", never}},
      {{"koskelo_20231109T071702_network_net_0.log", "m_water_vx_last"}, {"", "0", never}},
      {{"koskelo_20231109T071702_network_net_0.log", "m_water_vy_last"}, {"", "0", never}},
  };
  return all;
}

}  // namespace

TEST_CASE("real data: the 38 dialogs give every column of expected.csv, but for the listed disagreements") {
  GLIDEHELM_NEEDS_DATA(folder);
  std::size_t logs = 0, cells_compared = 0, differences = 0;
  std::map<std::string, long> sums;
  for (const auto& row : rows(folder + "/slocum/logs/expected.csv")) {
    const auto& name = row.at("file");
    ++logs;
    for (const auto& [column, ours] : our_row(file_bytes(folder + "/slocum/logs/" + name))) {
      INFO(name << " " << column);
      ++cells_compared;
      if (ours.find_first_not_of("0123456789") == std::string::npos && !ours.empty()) sums[column] += std::stol(ours);
      const auto known = disagreements().find({name, column});
      if (known == disagreements().end()) {
        CHECK(ours == row.at(column));
        continue;
      }
      ++differences;
      CHECK(ours == known->second.ours);
      CHECK(row.at(column) == known->second.theirs);
    }
  }
  CHECK(logs == 38);
  CHECK(sums["distinct_fixes"] == 36);
  CHECK(differences == disagreements().size());
  std::cout << "expected.csv: " << logs << " logs, " << cells_compared << " cells, " << differences << " differ;";
  for (const auto& [column, sum] : sums) std::cout << " " << column << " " << sum;
  std::cout << '\n';
}

TEST_CASE("real data: what a surfacing says of its mission is what expected.csv lists") {
  GLIDEHELM_NEEDS_DATA(folder);
  std::size_t at_surface = 0;
  for (const auto& row : rows(folder + "/slocum/logs/expected.csv")) {
    INFO(row.at("file"));
    const auto log = replay_log(file_bytes(folder + "/slocum/logs/" + row.at("file")), Limits{});
    for (const auto& fix : log.surfacings) {
      CHECK(fix.at_surface == !row.at("because").empty());
      if (!fix.at_surface) continue;
      ++at_surface;
      REQUIRE(fix.because);
      CHECK(row.at("because").find(fix.because->text + "|" + fix.because->behavior) != std::string::npos);
      CHECK(row.at("mission").find("(" + fix.segment + ")") != std::string::npos);
    }
  }
  CHECK(at_surface == 27);
}

namespace {

struct RealLogs {
  std::vector<test::CutDialog> dialogs;
  std::size_t bytes{};
};

RealLogs real_logs(const std::string& folder) {
  RealLogs logs;
  for (const auto& row : rows(folder + "/slocum/logs/expected.csv")) {
    logs.dialogs.emplace_back(file_bytes(folder + "/slocum/logs/" + row.at("file")));
    logs.bytes += logs.dialogs.back().bytes().size();
  }
  return logs;
}

void report(const char* what, const test::CutDialog::Counts& counts) {
  std::cout << what << ": " << counts.cuts << " cuts, " << counts.fixes << " fixes accepted in them, of which "
            << counts.early << " before the prompt that refuses them; " << counts.empty << " cuts without a fix\n";
}

}  // namespace

TEST_CASE("real data: a log that is cut behind any byte never has a fix that the whole does not have") {
  GLIDEHELM_NEEDS_DATA(folder);
  const auto logs = real_logs(folder);
  test::CutDialog::Counts all;
  for (const auto& dialog : logs.dialogs) all += dialog.check_every_byte();
  CHECK(all.cuts == logs.bytes);
  CHECK(all.fixes > all.cuts / 2);
  report("every byte", all);
}

TEST_CASE("real data: 20 000 cuts in chunks of 1 to 69 bytes have no fix that the whole does not have") {
  GLIDEHELM_NEEDS_DATA(folder);
  constexpr std::size_t kCuts = 20'000;
  const auto logs = real_logs(folder);
  test::CutDialog::Counts all;
  std::size_t before = 0, cut = 0;  // bytes of the logs before; cuts are spread evenly over all of them
  for (const auto& dialog : logs.dialogs) {
    for (; cut < kCuts && cut * logs.bytes / kCuts < before + dialog.bytes().size(); ++cut)
      all += dialog.check(cut * logs.bytes / kCuts - before + 1, 1 + cut % 69);
    before += dialog.bytes().size();
  }
  CHECK(all.cuts == kCuts);
  report("sampled", all);
}

TEST_CASE("real data: the logs are the same in chunks of 1 to 69 bytes") {
  GLIDEHELM_NEEDS_DATA(folder);
  for (const auto& row : rows(folder + "/slocum/logs/expected.csv")) {
    const auto bytes = file_bytes(folder + "/slocum/logs/" + row.at("file"));
    const auto whole = replay_log(bytes, Limits{});
    INFO(row.at("file"));
    for (std::size_t chunk = 1; chunk <= 69; ++chunk) CHECK(replay_log(bytes, Limits{}, chunk) == whole);
  }
}

TEST_CASE("real data: of the 36 fixes 33 are surfacings, and the others are refused with a reason") {
  GLIDEHELM_NEEDS_DATA(folder);
  Replay watch{Limits{}};
  std::map<std::string, std::string> refused;
  std::size_t used = 0;
  for (const auto& row : rows(folder + "/slocum/logs/expected.csv")) {
    const auto& name = row.at("file");
    const auto log = watch.add(file_bytes(folder + "/slocum/logs/" + name), name);
    used += log.surfacings.size();
    for (const auto& fix : log.refused) refused[name] = fix.rule;
  }
  CHECK(used == 33);
  CHECK(refused == std::map<std::string, std::string>{
                       {"calanus_zoc_where_excerpt.log", "S8"},               // and never had a fix: not one of the 36
                       {"koskelo_20231109T071702_network_net_0.log", "S8"},   // at the GliderLAB prompt
                       {"koskelo_20231109T085514_network_net_0.log", "S8"},   // at the GliderDos prompt
                       {"uivelo_20231109T132040_network_net_0.log", "S6"}});  // the fix of the log before
}

TEST_CASE("real data: no single bit flipped in a fix line gives a fix more than the rules that remember allow") {
  GLIDEHELM_NEEDS_DATA(folder);
  // Flips that turn a digit into another digit keep the line whole: S5 sees those. Any other flip must leave the fix as
  // it is, or give none (trust.md I-2).
  std::size_t flips = 0;
  for (const char* name : {"koskelo_20231109T100705_network_net_0.log", "rusalka_modem_20120719T154158.log",
                           "unit_1033_20250126T072155_network_net_0.log", "uivelo_20231109T083858_network_net_0.log"}) {
    const auto whole = file_bytes(folder + "/slocum/logs/" + name);
    const auto gps = whole.find("GPS Location:");
    const auto block = whole.substr(0, whole.find("No login", gps) + 40);
    const auto fix = replay_log(block, Limits{}).surfacings.at(0);
    for (std::size_t at = gps; at < whole.find('\n', gps) + 1; ++at)
      for (unsigned bit = 0; bit < 8; ++bit) {
        auto flipped = block;
        flipped[at] = static_cast<char>(static_cast<unsigned char>(flipped[at]) ^ (1U << bit));
        const auto digit = [](char c) { return c >= '0' && c <= '9'; };
        if (digit(block[at]) && digit(flipped[at])) continue;
        ++flips;
        INFO(name << " byte " << at - gps << " bit " << bit);
        for (const auto& s : replay_log(flipped, Limits{}).surfacings) {
          CHECK(s.lat_ddmm == fix.lat_ddmm);
          CHECK(s.lon_ddmm == fix.lon_ddmm);
        }
      }
  }
  CHECK(flips > 1500);
}
