#include "daemon/world/program_version.hpp"

namespace glidehelm::world {

const char* program_version() { return GLIDEHELM_VERSION; }

}  // namespace glidehelm::world
