#include "daemon/world/failpoint.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>

using glidehelm::world::failpoint;

namespace {

/// Passes `steps` in a child with the variable set; how many it came through, or −1 when it was not killed.
int killed_after(const char* variable, std::initializer_list<const char*> steps) {
  std::array<int, 2> pipe{};
  REQUIRE(::pipe(pipe.data()) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    if (variable != nullptr) ::setenv("GLIDEHELM_FAILPOINT", variable, 1);
    for (const char* step : steps) {
      failpoint(step);
      static_cast<void>(!::write(pipe[1], "x", 1));
    }
    ::_exit(0);
  }
  ::close(pipe[1]);
  int passed = 0, status = 0;
  for (char c = 0; ::read(pipe[0], &c, 1) == 1;) ++passed;
  ::close(pipe[0]);
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL ? passed : -1;
}

}  // namespace

TEST_CASE("a process kills itself at the step it was told, the first or the N-th time") {
  const auto steps = {"first_byte", "planned", "first_byte", "planned", "planned"};
  CHECK(killed_after(nullptr, steps) == -1);
  CHECK(killed_after("", steps) == -1);
  CHECK(killed_after("first_byte", steps) == 0);
  CHECK(killed_after("planned", steps) == 1);
  CHECK(killed_after("planned@2", steps) == 3);
  CHECK(killed_after("planned@3", steps) == 4);
  CHECK(killed_after("planned@4", steps) == -1);
  CHECK(killed_after("plan", steps) == -1);
  CHECK(killed_after("other", steps) == -1);
}
