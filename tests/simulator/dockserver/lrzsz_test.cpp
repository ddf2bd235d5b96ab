#include <catch2/catch.hpp>
#include <cstdlib>

#include "protocol/accept_fix.hpp"
#include "protocol/dialog.hpp"
#include "simulator/dockserver/line_faults.hpp"
#include "simulator/dockserver/report.hpp"
#include "tests/simulator/support.hpp"
#include "tests/simulator/temp_folder.hpp"

// What the simulator prints in place of a transfer is held against real ZMODEM: `sz` and `rz` (Debian's lrzsz) pass files to each
// other, and what they say to each other stands in the dialog where the transfer does.
using namespace glidehelm;
using namespace glidehelm::test;

namespace {

/// Both sides of one transfer.
struct Transfer {
  std::string sender, receiver;
};

Transfer transfer(const std::string& name, const std::string& bytes) {
  const TempFolder folder;
  folder.write(name, bytes);
  const std::string script = "cd '" + folder.path.string() +
                             "' && mkdir got && mkfifo up down && "
                             "{ (cd got && timeout 20 rz -b -q -y <../up 2>/dev/null | tee ../from_rz >../down) & "
                             "timeout 20 sz -b -q " +
                             name + " <down 2>/dev/null | tee from_sz >up; wait; }";
  REQUIRE(std::system(script.c_str()) == 0);
  REQUIRE(folder.read("got/" + name) == bytes);
  return {folder.read("from_sz"), folder.read("from_rz")};
}

/// What the daemon makes of a dialog that comes in pieces of so many bytes.
struct Heard {
  std::vector<model::Surfacing> surfacings;
  std::vector<std::string> transferred;
  friend bool operator==(const Heard&, const Heard&) = default;
};

Heard hear(const std::string& dialog, std::size_t piece) {
  Heard heard;
  protocol::DialogReader reader;
  const Instant now = instant_at(1.7e9 + 20'000);
  const auto take = [&](const std::vector<protocol::DialogEvent>& events) {
    for (const auto& event : events) {
      if (const auto* done = std::get_if<protocol::TransferDone>(&event)) heard.transferred.push_back(done->file);
      if (const auto* read = std::get_if<protocol::BlockRead>(&event); read != nullptr && read->block.gps)
        if (auto s = protocol::accept_fix(read->block, "sim01")) heard.surfacings.push_back(std::move(s).value());
    }
  };
  for (std::size_t from = 0; from < dialog.size(); from += piece) take(reader.append(dialog.substr(from, piece), now));
  take(reader.end(now));
  return heard;
}

}  // namespace

TEST_CASE("real ZMODEM in a dialog, by sz and rz, changes nothing of what the daemon hears") {
  if (std::system("command -v sz >/dev/null 2>&1 && command -v rz >/dev/null 2>&1") != 0) {
    WARN("not run: sz and rz are not installed (Debian package lrzsz)");
    return;
  }
  simulator::GliderSetup s;
  s.start = geo_point(40.0, 5.0);
  s.start_s = 1.7e9;
  s.cycle_s = 60;
  s.list.waypoints = {geo_point(41, 5)};
  s.list.initial = 0;
  simulator::Glider glider{s, ocean::Ocean{kUniform, kUniform}, kOpen};
  REQUIRE_FALSE(glider.take_fixes());
  REQUIRE_FALSE(glider.dive(glider.fix_s() + 900).accident);
  REQUIRE_FALSE(glider.take_fixes());
  const auto first = report_of(glider, glider.fix_s() + 45, 700), later = report_of(glider, glider.fix_s() + 120, 625);

  namespace dialog = simulator::dialog;
  const auto science = simulator::LineNoise::binary(5000, simulator::Random{3});
  const std::string list = "behavior_name=goto_list\n<start:waypoints>\n500.0 4100.0\n<end:waypoints>\n";
  const auto up = transfer("00010001.scd", science), down = transfer("goto_l10.ma", list);
  REQUIRE(up.sender.find("**\x18"
                         "B0") != std::string::npos);
  REQUIRE(up.sender.size() > science.size());
  // A file from the glider is its `sz`; of a file to the glider its `rz` is heard, and the next line begins where that ends.
  const auto dialog_with = [&](const std::string& from_sz, const std::string& from_rz) {
    return dialog::connection_block(first) + dialog::at_surface_block(first) +
           dialog::science_starts("00010001.scd", "sim01", science.size()) + from_sz +
           dialog::science_ends("00010001.scd", science.size()) +
           dialog::sending_starts("goto_l10.ma", "sim01", list.size()) + from_rz +
           dialog::sending_ends("goto_l10.ma", list.size()) + dialog::at_surface_block(later);
  };
  const auto quiet = hear(dialog_with("", ""), 1 << 20);
  REQUIRE(quiet.surfacings.size() >= 3);
  CHECK(quiet.transferred == std::vector<std::string>{"00010001.scd", "goto_l10.ma"});
  const auto real = dialog_with(up.sender, down.receiver);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{69}, std::size_t{4096}, real.size()}) {
    CAPTURE(piece);
    CHECK(hear(real, piece) == quiet);
  }
}
