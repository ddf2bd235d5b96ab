#include "daemon/world/terminal.hpp"

#include <unistd.h>

namespace glidehelm::world {

bool is_terminal(int descriptor) { return isatty(descriptor) == 1; }

}  // namespace glidehelm::world
