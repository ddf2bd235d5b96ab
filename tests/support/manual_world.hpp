#pragma once

#include "daemon/world/world.hpp"
#include "tests/support/fixed_rng.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/manual_net.hpp"
#include "tests/support/manual_procs.hpp"
#include "tests/support/memory_files.hpp"

namespace glidehelm::test {

/// The five manual twins in one hand: nothing outside the test happens.
struct ManualWorld {
  ManualClock clock;
  MemoryFiles files;
  ManualNet net;
  FixedRng rng;
  ManualProcs procs{net};

  [[nodiscard]] world::World world() { return {clock, files, net, rng, procs}; }

  /// Lets `dt` pass: timers and the loop take turns until both are quiet at the end of it.
  void pass(Seconds dt) {
    const Tick until = clock.tick() + std::chrono::round<Tick::duration>(dt);
    net.settle();
    while (const auto next = clock.next_timer()) {
      if (*next > until) break;
      clock.advance_to_next();
      net.settle();
    }
    clock.advance(until - clock.tick());
    net.settle();
  }
};

}  // namespace glidehelm::test
