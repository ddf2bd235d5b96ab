#include <cctype>
#include <iostream>

#include "tests/system/processes/sea.hpp"

using namespace glidehelm;
using namespace glidehelm::test;

namespace {

/// A daemon whose glidehelm-verify also keeps what it is asked: programs look for their children in their own folder.
std::string daemon_with_witness(const Sea& sea) {
  std::filesystem::create_directory(sea.folder.path / "bin");
  std::filesystem::create_directory(sea.folder.path / "asked");
  std::filesystem::copy_file(GLIDEHELM_BIN "/glidehelmd", sea.folder.path / "bin/glidehelmd");
  std::ostringstream script;
  script << "#!/bin/sh\n"
         << "PATH=/usr/bin:/bin\n"
         << "cd " << sea.path("asked") << " || exit 1\n"
         << "n=0; while [ -e request-$n ]; do n=$((n+1)); done\n"
         << "cat > request-$n; cat <&3 > staged-$n\n"
         << "exec " GLIDEHELM_BIN "/glidehelm-verify < request-$n 3< staged-$n\n";
  sea.folder.write("bin/glidehelm-verify", script.str());
  std::filesystem::permissions(sea.folder.path / "bin/glidehelm-verify", std::filesystem::perms::owner_all);
  return sea.path("bin/glidehelmd");
}

int verify(const Sea& sea, const std::string& request, const std::string& staged) {
  const std::string command = "cd '" + sea.path("asked") + "' && exec '" GLIDEHELM_BIN "/glidehelm-verify' < " +
                              request + " 3< " + staged + " > verdict 2>&1";
  Program shell{{"/bin/sh", {"-c", command}, sea.path("shell.log"), {}, false}};
  const auto ended = shell.wait(kStepLimit);
  return ended.code.value_or(-1);
}

}  // namespace

TEST_CASE(
    "glidehelm-verify accepts a file as the daemon staged it and refuses it with any one digit of a waypoint changed") {
  Sea sea{{{40.71, 4.37}, "surfacings: 2"}};
  auto daemon = sea.start_daemon("", daemon_with_witness(sea));
  auto simulator = sea.start_simulator();
  REQUIRE(simulator->wait(kFlightLimit).in_time);
  REQUIRE(daemon->wait(kStepLimit).code == 0);
  INFO(sea.daemon_log() << sea.simulator_log());
  const auto files = sea.taken();
  REQUIRE(!files.empty());

  int request = -1;  // the one that was asked for the first file that went out
  for (int n = 0; sea.folder.has("asked/request-" + std::to_string(n)); ++n)
    if (sea.folder.read("asked/staged-" + std::to_string(n)) == files.front()) request = n;
  REQUIRE(request >= 0);
  const auto asked = "request-" + std::to_string(request);
  const auto& good = files.front();
  REQUIRE(verify(sea, asked, "staged-" + std::to_string(request)) == 0);

  int digits = 0, refused = 0;
  for (auto at = good.find("<start:waypoints>"); at < good.find("<end:waypoints>"); ++at) {
    if (std::isdigit(static_cast<unsigned char>(good[at])) == 0) continue;
    auto bad = good;
    bad[at] = good[at] == '9' ? '8' : static_cast<char>(good[at] + 1);
    sea.folder.write("asked/bad", bad);
    const int code = verify(sea, asked, "bad");
    ++digits;
    refused += code == 4 ? 1 : 0;
    CAPTURE(bad, code, sea.folder.read("asked/verdict"));
    CHECK(code == 4);
  }
  CHECK(digits >= 2 * 8);  // at least one waypoint of DDMM.mmmm DDMM.mmmm
  std::cout << "glidehelm-verify refused " << refused << " of " << digits << " files with one digit changed\n";
}
