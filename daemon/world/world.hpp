#pragma once

#include "daemon/world/clock.hpp"
#include "daemon/world/files.hpp"
#include "daemon/world/net.hpp"
#include "daemon/world/procs.hpp"
#include "daemon/world/rng.hpp"

namespace glidehelm::world {

/// Everything a program may ask of the system, in one hand.
struct World {
  Clock& clock;
  Files& files;
  Net& net;
  Rng& rng;
  Procs& procs;
};

}  // namespace glidehelm::world
