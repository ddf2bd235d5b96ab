#include "protocol/replay.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "core/base/utc.hpp"
#include "protocol/latlon.hpp"
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

}  // namespace

TEST_CASE("the dialogs of tests/replay give what their .expected files say") {
  // GLIDEHELM_WRITE_EXPECTED=1 writes the files anew, to be reviewed as a difference.
  const bool write = std::getenv("GLIDEHELM_WRITE_EXPECTED") != nullptr;
  int dialogs = 0;
  for (const auto& entry : std::filesystem::directory_iterator{GLIDEHELM_SOURCE "/tests/replay"}) {
    if (entry.path().extension() != ".dialog") continue;
    ++dialogs;
    auto bytes = file_bytes(entry.path().string());
    while (bytes.rfind("# ", 0) == 0) bytes.erase(0, bytes.find('\n') + 1);  // the header says what the dialog is
    auto expected = entry.path();
    expected.replace_extension(".expected");
    const auto found = describe(replayed(bytes));
    if (write) std::ofstream{expected, std::ios::binary} << found;
    INFO(entry.path().filename().string());
    CHECK(found == file_bytes(expected.string()));
  }
  CHECK(dialogs == 10);
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

std::string count_text(std::uint64_t n) { return std::to_string(n); }

std::vector<std::string> words(const std::string& text) {
  std::istringstream in{text};
  return {std::istream_iterator<std::string>{in}, {}};
}

/// `2026-05-03T04:09:31 2901.250 -1528.400 29.020833 -15.473333`: time, texts, degrees.
void check_fix(const std::string& expected, const ReplayedFix& fix) {
  const auto w = words(expected);
  REQUIRE(w.size() == 5);
  REQUIRE(fix.fix_time);
  // The script truncates to the second, so it is up to one second early.
  const double late = between(utc_from_text(w[0]).value(), *fix.fix_time).count();
  CHECK((late >= 0 && late < 1.0));
  CHECK(fix.lat_ddmm == w[1]);
  CHECK(fix.lon_ddmm == w[2]);
  // Degrees have six decimals there: half of the last is 0.3e-4 minute, below the 1e-4 minute that are asked for.
  CHECK(std::abs(*fix.lat_deg - std::stod(w[3])) * 60 <= 1e-4);
  CHECK(std::abs(*fix.lon_deg - std::stod(w[4])) * 60 <= 1e-4);
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

void check_waypoint_and_water(const Row& row, const std::vector<ReplayedFix>& fixes) {
  std::optional<model::AimLine> aim;
  std::optional<double> vx, vy;
  for (const auto& fix : fixes) {
    if (fix.aim) aim = fix.aim;
    if (fix.sensors.count("m_water_vx") > 0) vx = fix.sensors.at("m_water_vx");
    if (fix.sensors.count("m_water_vy") > 0) vy = fix.sensors.at("m_water_vy");
  }
  const auto w = words(row.at("waypoint_last"));
  CHECK(aim.has_value() == !w.empty());
  if (aim && w.size() == 5) {
    CHECK(std::abs(aim->at.lat.degrees() - degrees_from_ddmm(w[0], Axis::latitude).value()) * 60 <= 1e-4);
    CHECK(std::abs(aim->at.lon.degrees() - degrees_from_ddmm(w[1], Axis::longitude).value()) * 60 <= 1e-4);
    CHECK(aim->range == Metres{std::stod(w[2])});
    CHECK(aim->bearing_deg == std::stod(w[3]));
  }
  // The script takes a water velocity of 0 with the age 1e+308 for a value; it was never measured.
  const bool never_measured = row.at("m_water_vx_last") == "0" && row.at("m_water_vy_last") == "0";
  const bool none = row.at("m_water_vx_last").empty() || never_measured;
  CHECK(vx.has_value() == !none);
  CHECK(vy.has_value() == !none);
  if (vx && !none) CHECK(*vx == std::stod(row.at("m_water_vx_last")));
  if (vy && !none) CHECK(*vy == std::stod(row.at("m_water_vy_last")));
}

}  // namespace

TEST_CASE("real data: the 38 dialogs give the counts, fixes, waypoints and water of expected.csv at every chunk size") {
  GLIDEHELM_NEEDS_DATA(folder);
  // Where the script of expected.csv and this reader differ, and why. Each was looked at byte by byte.
  const std::map<std::pair<std::string, std::string>, std::string> explained{
      // The second dockserver block stands between `   sensor:m_leakdetect_voltage` and `_forward(volts)=…`, with a
      // line end of its own on either side. The script cuts the block out and leaves a line end, so it sees no sensor
      // line; here the halves are joined to a line whose every field has the firmware's width (slocum.md R3).
      {{"koskelo_20231109T111452_network_net_0.log", "sensor_lines"}, "27"},
  };
  std::size_t logs = 0, distinct = 0, differences = 0;
  for (const auto& row : rows(folder + "/slocum/logs/expected.csv")) {
    const auto& name = row.at("file");
    INFO(name);
    ++logs;
    const auto log = replayed(file_bytes(folder + "/slocum/logs/" + name));
    const auto check = [&](const std::string& column, const std::string& ours) {
      const auto known = explained.find({name, column});
      INFO(column << ": ours " << ours << ", expected.csv " << row.at(column));
      if (known == explained.end()) {
        CHECK(ours == row.at(column));
        return;
      }
      ++differences;
      CHECK(ours == known->second);
      CHECK(ours != row.at(column));
    };
    check("vehicle", log.glider);
    check("console_ready", count_text(log.counts.connections));
    check("at_surface", count_text(log.counts.at_surface_blocks));
    check("gps_location_lines", count_text(log.counts.gps_lines));
    check("distinct_fixes", std::to_string(log.distinct_fixes));
    check("repeated_fixes", std::to_string(log.repeated_fixes));
    check("sensor_lines", count_text(log.counts.sensor_lines));
    check("dockserver_blocks", count_text(log.counts.dockserver_blocks));
    distinct += static_cast<std::size_t>(log.distinct_fixes);

    const auto fixes = with_position(log);
    REQUIRE(static_cast<int>(fixes.size()) == log.distinct_fixes);
    if (!fixes.empty()) check_fix(row.at("first_fix"), fixes.front());
    if (!fixes.empty()) check_fix(row.at("last_fix"), fixes.back());
    check_waypoint_and_water(row, all_fixes(log));
    for (const auto& fix : log.surfacings) {
      CHECK(fix.rule.empty());
      if (!row.at("because").empty()) {
        REQUIRE(fix.because);
        char because[128];
        std::snprintf(because, sizeof because, "%s|%s|%.1f", fix.because->text.c_str(), fix.because->behavior.c_str(),
                      fix.because->start_when);
        CHECK(row.at("because").find(because) != std::string::npos);
        CHECK(row.at("mission").find("(" + fix.segment + ")") != std::string::npos);
      }
      CHECK(fix.at_surface == !row.at("because").empty());
    }
    for (const auto& fix : log.refused) {
      CHECK_FALSE(fix.rule.empty());
      CHECK_FALSE(fix.reason.empty());
    }
  }
  CHECK(logs == 38);
  CHECK(distinct == 36);
  CHECK(differences == explained.size());
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
