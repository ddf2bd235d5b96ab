#include "simulator/dockserver/dock_folder.hpp"

#include <catch2/catch.hpp>

#include "core/base/utc.hpp"
#include "daemon/world/real_files.hpp"
#include "tests/simulator/temp_folder.hpp"

using namespace glidehelm;
using namespace glidehelm::test;
using simulator::DockFolder;

namespace {

const Instant kNow = *utc_from_text("2026-03-01T04:05:06Z");

}  // namespace

TEST_CASE("a dockserver folder is made with its marker, and found again") {
  TempFolder temp;
  world::RealFiles files;
  const auto path = (temp.path / "gliders/sim01").string();
  REQUIRE(DockFolder::make(files, path));
  CHECK(temp.has("gliders/sim01/.glidersim"));
  CHECK(temp.has("gliders/sim01/to-glider"));
  CHECK(temp.has("gliders/sim01/archive"));
  CHECK(DockFolder::make(files, path));
}

TEST_CASE("a folder that somebody else made is refused") {
  TempFolder temp;
  world::RealFiles files;
  std::filesystem::create_directories(temp.path / "real/to-glider");
  const auto made = DockFolder::make(files, (temp.path / "real").string());
  REQUIRE_FALSE(made);
  CHECK(made.error().message().find("was not made by glidersim") != std::string::npos);
  CHECK_FALSE(temp.has("real/.glidersim"));
}

TEST_CASE("files are seen by name, dot files and folders are not, and a sent file is archived and unlinked") {
  TempFolder temp;
  world::RealFiles files;
  auto dock = DockFolder::make(files, (temp.path / "d").string());
  REQUIRE(dock);
  temp.write("d/to-glider/goto_l10.ma", "one");
  temp.write("d/to-glider/.hidden", "two");
  std::filesystem::create_directory(temp.path / "d/to-glider/folder");
  const auto seen = (*dock)->contents(kNow);
  REQUIRE(seen.size() == 1);
  CHECK(seen[0] == simulator::OfferedFile{"goto_l10.ma", "one"});
  (*dock)->sent(seen[0], kNow);
  CHECK_FALSE(temp.has("d/to-glider/goto_l10.ma"));
  CHECK(temp.read("d/archive/20260301T040506_goto_l10.ma") == "one");
  CHECK((*dock)->take_trouble().empty());
}

TEST_CASE("what is archived are the bytes that were sent, though the file was exchanged meanwhile") {
  TempFolder temp;
  world::RealFiles files;
  auto dock = DockFolder::make(files, (temp.path / "d").string());
  temp.write("d/to-glider/goto_l10.ma", "old");
  const auto seen = (*dock)->contents(kNow);
  temp.write("d/to-glider/goto_l10.ma", "new");
  (*dock)->sent(seen.at(0), kNow);
  CHECK(temp.read("d/archive/20260301T040506_goto_l10.ma") == "old");
  CHECK_FALSE(temp.has("d/to-glider/goto_l10.ma"));
}

TEST_CASE("a file that computing put there is not seen before its time is charged") {
  TempFolder temp;
  world::RealFiles files;
  auto dock = DockFolder::make(files, (temp.path / "d").string());
  (*dock)->remember(kNow);
  temp.write("d/to-glider/goto_l10.ma", "one");
  (*dock)->hide_news_until(kNow + std::chrono::seconds{30});
  CHECK((*dock)->contents(kNow + std::chrono::seconds{29}).empty());
  (*dock)->remember(kNow + std::chrono::seconds{10});  // must not let the file through
  CHECK((*dock)->contents(kNow + std::chrono::seconds{29}).empty());
  CHECK((*dock)->contents(kNow + std::chrono::seconds{30}).size() == 1);
}

TEST_CASE("trouble with the files is told once") {
  TempFolder temp;
  world::RealFiles files;
  auto dock = DockFolder::make(files, (temp.path / "d").string());
  (*dock)->sent({"never_was.ma", "x"}, kNow);
  CHECK((*dock)->take_trouble().find("never_was.ma") != std::string::npos);
  CHECK((*dock)->take_trouble().empty());
}

TEST_CASE("files from the glider and logs of calls lie where a dockserver keeps them") {
  TempFolder temp;
  world::RealFiles files;
  auto dock = DockFolder::make(files, (temp.path / "d").string());
  REQUIRE(dock);
  (*dock)->received({"00010002.scd", "binary"}, kNow);
  (*dock)->received({"00010002.scd", "again"}, kNow);  // fetched again after a redial
  (*dock)->logged({"sim01", "network_net_0", kNow, "what was heard"});
  CHECK(temp.read("d/from-glider/00010002.scd") == "again");
  CHECK(temp.read("d/logs/sim01_20260301T040506_network_net_0.log") == "what was heard");
  CHECK((*dock)->take_trouble().empty());
}
