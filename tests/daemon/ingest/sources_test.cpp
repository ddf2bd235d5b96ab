#include "daemon/ingest/sources.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/support/netcdf.hpp"

using namespace glidehelm;
using glidehelm::ingest::Sources;

namespace {

constexpr std::uint64_t kAtMost = 1'000'000;

struct Folder {
  test::ScratchFolder scratch;
  std::vector<std::string> names;
  Folder() {
    for (const char* name : {"a.nc", "b.nc", "c.nc"}) {
      names.push_back(scratch / name);
      test::write_bytes(names.back(), std::string(1000, name[0]));
    }
  }
};

}  // namespace

TEST_CASE("sources are identified by their content, in order, before any is handed out") {
  const Folder folder;
  auto sources = Sources::open(folder.names, kAtMost);
  REQUIRE(sources);
  REQUIRE(sources->identify(Seconds{0}, kAtMost));
  REQUIRE(sources->size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string bytes(1000, "abc"[i]);
    CHECK(sources->identities()[i] == ocean::GridSource{folder.names[i], Sha256::of(bytes)});
    CHECK(sources->stat(i).size == 1000);
    CHECK(sources->take(i).value() == bytes);
  }
}

TEST_CASE("a source that was not kept is copied again, and must be the same bytes") {
  const Folder folder;
  auto sources = Sources::open(folder.names, kAtMost);
  REQUIRE(sources);
  REQUIRE(sources->identify(Seconds{0}, 1500));  // room for the first alone
  CHECK(sources->take(1).value() == std::string(1000, 'b'));
  // Somebody who rewrites a file within one tick of its clock and puts its time back is found out by the content.
  const auto time = std::filesystem::last_write_time(folder.names[2]);
  test::write_bytes(folder.names[2], std::string(1000, 'X'));
  std::filesystem::last_write_time(folder.names[2], time);
  const auto taken = sources->take(2);
  REQUIRE_FALSE(taken);
  CHECK(taken.error().file == 2);
  CHECK(taken.error().what == "is still being written: it changed while it was read");
  CHECK(taken.error().passing);
  std::filesystem::remove(folder.names[0]);
  CHECK(sources->take(0).value() == std::string(1000, 'a'));  // the kept copy needs no file
  CHECK(sources->take(0).error().what == "was taken away while it was read");
}

TEST_CASE("a source that cannot be opened is named by its number") {
  Folder folder;
  std::filesystem::remove(folder.names[1]);
  const auto sources = Sources::open(folder.names, kAtMost);
  REQUIRE_FALSE(sources);
  CHECK(sources.error().file == 1);
  CHECK(sources.error().what == "is not there (any more)");
  CHECK(sources.error().passing);
  CHECK(Sources::open({folder.names[0]}, 999).error().passing == false);
}
