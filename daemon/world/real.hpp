#pragma once

#include "daemon/world/real_clock.hpp"
#include "daemon/world/real_files.hpp"
#include "daemon/world/real_net.hpp"
#include "daemon/world/real_procs.hpp"
#include "daemon/world/real_rng.hpp"
#include "daemon/world/world.hpp"

namespace glidehelm::world {

/// The adapters of this machine, wired to one loop.
class RealWorld {
 public:
  [[nodiscard]] World world() { return {clock_, files_, net_, rng_, procs_}; }
  /// The same with another clock: the simulated one.
  [[nodiscard]] World world_with(Clock& clock) { return {clock, files_, net_, rng_, procs_}; }

 private:
  RealLoop loop_;
  RealClock clock_{loop_};
  RealFiles files_;
  RealNet net_{loop_};
  RealRng rng_;
  RealProcs procs_{loop_};
};

}  // namespace glidehelm::world
